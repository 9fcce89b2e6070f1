//! Models 1, 2 and 3 of a robot's forward dynamics.

use std::path::Path;
use std::sync::Arc;

use pyo3::prelude::*;
use rayon::prelude::*;
use reachtube::abstraction::{ExpansionPoint, ModelKind, PolynomialModel};

use crate::arrays::{Input, Output, array, values};
use crate::failure::{Failure, Result};
use crate::pool;
use crate::robot::NativeRobot;
use crate::watched::watched;

#[pyclass(frozen, name = "Abstraction", module = "reachtube._reachtube")]
pub(crate) struct NativeAbstraction {
    pub model: Arc<PolynomialModel>,
}

#[pymethods]
impl NativeAbstraction {
    /// Makes a model of a robot.
    #[new]
    #[pyo3(signature = (robot, model, order, expansion, progress=None))]
    fn new(
        py: Python<'_>,
        robot: PyRef<'_, NativeRobot>,
        model: u32,
        order: u32,
        expansion: Vec<f64>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let robot = Arc::clone(&robot.robot);
        watched(py, progress.as_ref(), move |_| {
            robot.check_physical()?;
            let point = ExpansionPoint::from_values(&expansion, robot.joint_count())?;
            Ok(PolynomialModel::new(&robot, ModelKind::try_from(model)?, order, &point)?)
        })
        .map(|model| Self { model: Arc::new(model) })
    }

    /// Reads the text of an abstraction's file; errors name it `origin`.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, origin: &str) -> PyResult<Self> {
        let model = PolynomialModel::parse(text, Path::new(origin));
        let model = model.map_err(|error| Failure::from(error).raised(py))?;
        Ok(Self { model: Arc::new(model) })
    }

    fn to_json(&self) -> String {
        self.model.to_json()
    }

    /// Returns the formulas, one for each joint.
    fn formulas(&self) -> String {
        self.model.to_string()
    }

    /// Returns the states of the model, count x N, at positions and velocities, count x n each.
    fn states<'py>(&self, py: Python<'py>, q: Input<'py>, qd: Input<'py>) -> PyResult<Output<'py>> {
        let found = || -> Result<_> {
            let n = self.model.joints();
            let count = q.as_array().shape().first().copied().unwrap_or(0);
            let (q, qd) = (values("q", &q, &[count, n])?, values("qd", &qd, &[count, n])?);
            let rows = q.chunks(n).zip(qd.chunks(n));
            let states = rows.flat_map(|(q, qd)| self.model.state(q, qd)).collect();
            Ok(array(py, states, &[count, self.model.states()]))
        };
        found().map_err(|failure| failure.raised(py))
    }

    /// Returns ẋ, count x N, at states (count x N) and inputs (count x n).
    fn rate<'py>(&self, py: Python<'py>, x: Input<'py>, u: Input<'py>) -> PyResult<Output<'py>> {
        pool::check()?;
        let found = || -> Result<_> {
            let (width, n) = (self.model.states(), self.model.joints());
            let count = x.as_array().shape().first().copied().unwrap_or(0);
            let (x, u) = (values("x", &x, &[count, width])?, values("u", &u, &[count, n])?);
            let mut rates = vec![0.0; count * width];
            let model = &self.model;
            py.detach(|| {
                rates.par_chunks_mut(width).enumerate().for_each_init(
                    || model.workspace::<f64>(),
                    |workspace, (k, rate)| {
                        let (x, u) = (&x[k * width..][..width], &u[k * n..][..n]);
                        model.rate_into(x, u, workspace, rate);
                    },
                );
            });
            Ok(array(py, rates, &[count, width]))
        };
        found().map_err(|failure| failure.raised(py))
    }
}
