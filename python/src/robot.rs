//! Robots and their dynamics.

use std::sync::Arc;

use pyo3::prelude::*;
use reachtube::Robot;
use reachtube::robot::{Lock, Parameter, ParameterKind, Urdf, UrdfOptions};

use crate::arrays::{Input, Output, array, values};
use crate::dynamics::{Kernel, friction, over_states, regressors};
use crate::failure::{Failure, Result};
use crate::pool;

/// A robot, and the URDF it was read from if there is one.
#[pyclass(frozen, name = "Robot", module = "reachtube._reachtube")]
pub(crate) struct NativeRobot {
    pub robot: Arc<Robot>,
    urdf: Option<Arc<Urdf>>,
}

impl NativeRobot {
    pub(crate) fn new(robot: Robot) -> Self {
        Self { robot: Arc::new(robot), urdf: None }
    }

    fn loaded(
        path: &str,
        base: Option<String>,
        tip: Option<String>,
        lock: &[String],
    ) -> Result<Self> {
        let locks = lock.iter().map(|text| text.parse::<Lock>()).collect::<Result<Vec<_>, _>>();
        let locks = locks.map_err(Failure::setting)?;
        if path.to_ascii_lowercase().ends_with(".urdf") {
            let urdf = Urdf::load(path, &UrdfOptions { base, tip, locks, ..Default::default() })?;
            let robot = Arc::new(urdf.robot().clone());
            return Ok(Self { robot, urdf: Some(Arc::new(urdf)) });
        }
        let robot = Robot::load_locked(path, &locks)?;
        if base.is_some() || tip.is_some() {
            return Err(Failure::Setting("only a URDF has a base and a tip".into()));
        }
        Ok(Self::new(robot))
    }

    /// Runs an algorithm over states whose arguments are count x n each.
    fn run<'py>(
        &self,
        py: Python<'py>,
        arguments: &[(&str, &Input<'py>)],
        shape: &[usize],
        kernel: Kernel,
    ) -> PyResult<Output<'py>> {
        let (count, arguments) = self.arguments(py, arguments)?;
        let width = shape.iter().product();
        let robot = &*self.robot;
        pool::check()?;
        let found = py.detach(|| over_states(robot, &arguments, width, kernel));
        Ok(array(py, found, &[&[count], shape].concat()))
    }

    /// Returns the number of states, and the values of each argument.
    fn arguments(
        &self,
        py: Python<'_>,
        arguments: &[(&str, &Input<'_>)],
    ) -> PyResult<(usize, Vec<Vec<f64>>)> {
        let count = arguments[0].1.as_array().shape().first().copied().unwrap_or(0);
        let shape = [count, self.robot.joint_count()];
        let all = arguments.iter().map(|(name, argument)| values(name, argument, &shape));
        let all = all.collect::<Result<_>>().map_err(|failure| failure.raised(py))?;
        Ok((count, all))
    }
}

#[pymethods]
impl NativeRobot {
    /// Loads an embedded robot by its name, or a TOML or URDF file.
    #[staticmethod]
    #[pyo3(signature = (path, base=None, tip=None, lock=vec![]))]
    fn load(
        py: Python<'_>,
        path: &str,
        base: Option<String>,
        tip: Option<String>,
        lock: Vec<String>,
    ) -> PyResult<Self> {
        Self::loaded(path, base, tip, &lock).map_err(|failure| failure.raised(py))
    }

    /// Reads the text of a robot file; errors name it `origin`.
    #[staticmethod]
    fn from_toml(py: Python<'_>, text: &str, origin: &str) -> PyResult<Self> {
        let robot = Robot::from_toml(text, origin);
        robot.map(Self::new).map_err(|error| Failure::from(error).raised(py))
    }

    /// Makes a robot of the JSON of a description.
    #[staticmethod]
    fn from_description(py: Python<'_>, text: &str) -> PyResult<Self> {
        let robot = || -> Result<_> {
            let description = serde_json::from_str(text)
                .map_err(|error| Failure::json("the description", &error))?;
            Ok(Self::new(Robot::from_description(&description)?))
        };
        robot().map_err(|failure| failure.raised(py))
    }

    fn to_toml(&self) -> String {
        self.robot.description().to_toml()
    }

    /// Returns the text of the URDF with the values of another robot, and its companion.
    fn updated_urdf(&self, py: Python<'_>, robot: &Self) -> PyResult<Option<(String, String)>> {
        let Some(urdf) = &self.urdf else { return Ok(None) };
        let text = urdf.updated(&robot.robot).map_err(|error| Failure::from(error).raised(py))?;
        Ok(Some((text, urdf.companion(&robot.robot))))
    }

    /// Returns the description as JSON.
    fn description(&self) -> String {
        serde_json::to_string(self.robot.description()).expect("a description has string keys")
    }

    fn rnea<'py>(
        &self,
        py: Python<'py>,
        q: Input<'py>,
        qd: Input<'py>,
        qdd: Input<'py>,
    ) -> PyResult<Output<'py>> {
        let n = self.robot.joint_count();
        let robot = &self.robot;
        self.run(py, &[("q", &q), ("qd", &qd), ("qdd", &qdd)], &[n], &|s, tau| {
            robot.rnea(&s.sin, &s.cos, &s.arguments[0], &s.arguments[1], &mut s.workspace, tau);
        })
    }

    fn aba<'py>(
        &self,
        py: Python<'py>,
        q: Input<'py>,
        qd: Input<'py>,
        tau: Input<'py>,
    ) -> PyResult<Output<'py>> {
        let n = self.robot.joint_count();
        let robot = &self.robot;
        self.run(py, &[("q", &q), ("qd", &qd), ("tau", &tau)], &[n], &|s, qdd| {
            robot.aba(&s.sin, &s.cos, &s.arguments[0], &s.arguments[1], &mut s.workspace, qdd);
        })
    }

    fn mass_matrix<'py>(&self, py: Python<'py>, q: Input<'py>) -> PyResult<Output<'py>> {
        let n = self.robot.joint_count();
        let robot = &self.robot;
        self.run(py, &[("q", &q)], &[n, n], &|s, m| {
            robot.crba(&s.sin, &s.cos, &mut s.workspace, m);
        })
    }

    fn gravity<'py>(&self, py: Python<'py>, q: Input<'py>) -> PyResult<Output<'py>> {
        let n = self.robot.joint_count();
        let robot = &self.robot;
        self.run(py, &[("q", &q)], &[n], &|s, g| {
            robot.gravity(&s.sin, &s.cos, &mut s.workspace, g);
        })
    }

    fn coriolis<'py>(
        &self,
        py: Python<'py>,
        q: Input<'py>,
        qd: Input<'py>,
    ) -> PyResult<Output<'py>> {
        let n = self.robot.joint_count();
        let robot = &self.robot;
        self.run(py, &[("q", &q), ("qd", &qd)], &[n], &|s, c| {
            robot.coriolis(&s.sin, &s.cos, &s.arguments[0], &mut s.workspace, c);
        })
    }

    /// Returns the torques of friction: viscous and Coulomb friction under the load of gravity.
    fn friction<'py>(
        &self,
        py: Python<'py>,
        q: Input<'py>,
        qd: Input<'py>,
    ) -> PyResult<(Output<'py>, Output<'py>)> {
        let n = self.robot.joint_count();
        let (count, arguments) = self.arguments(py, &[("q", &q), ("qd", &qd)])?;
        let robot = &*self.robot;
        pool::check()?;
        let [viscous, coulomb] = py.detach(|| friction(robot, &arguments));
        Ok((array(py, viscous, &[count, n]), array(py, coulomb, &[count, n])))
    }

    fn regressor<'py>(
        &self,
        py: Python<'py>,
        q: Input<'py>,
        qd: Input<'py>,
        qdd: Input<'py>,
    ) -> PyResult<Output<'py>> {
        let (count, motion) = self.arguments(py, &[("q", &q), ("qd", &qd), ("qdd", &qdd)])?;
        let parameters = self.inertial_parameters();
        let robot = &*self.robot;
        pool::check()?;
        let found = py.detach(|| regressors(robot, &parameters, &motion));
        Ok(array(py, found, &[count, robot.joint_count(), parameters.len()]))
    }

    /// Returns the names of the regressor's columns, and their values in the description.
    fn parameters(&self) -> (Vec<String>, Vec<f64>) {
        let parameters = self.inertial_parameters();
        let names = parameters.iter().map(ToString::to_string).collect();
        (names, self.robot.parameter_values(&parameters))
    }
}

impl NativeRobot {
    fn inertial_parameters(&self) -> Vec<Parameter> {
        let kinds = [&ParameterKind::INERTIAL[..], &[ParameterKind::MotorInertia]].concat();
        Parameter::of_joints(self.robot.joint_count(), &kinds)
    }
}
