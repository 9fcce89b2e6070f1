//! A polynomial model as a system whose reachable sets are enclosed.

use std::any::Any;

use nalgebra::DMatrix;
use reachtube_ode::VectorField;
use reachtube_reach::{Nonlinear, PolynomialSystem, ReachError, Slopes};
use reachtube_scalar::Lanes;

use crate::field::ModelField;
use crate::linearisation::Linearisation;
use crate::polynomial_model::PolynomialModel;

impl Nonlinear for PolynomialModel {
    fn states(&self) -> usize {
        2 * self.joints()
    }

    fn inputs(&self) -> usize {
        self.joints()
    }

    fn lift(&self, x: &[f64]) -> Vec<f64> {
        let (q, qd) = x.split_at(self.joints());
        self.state(q, qd)
    }

    fn field(&self) -> Box<dyn VectorField<f64> + '_> {
        Box::new(ModelField::new(self))
    }

    fn field_of_many(&self) -> Box<dyn VectorField<Lanes<8>> + '_> {
        Box::new(ModelField::new(self))
    }

    fn slopes(&self) -> Box<dyn Slopes + '_> {
        Box::new(Linearisation::new(self))
    }

    fn polynomial_system(&self) -> Result<&PolynomialSystem, ReachError> {
        if let Some(system) = self.system.get() {
            return Ok(system);
        }
        let system = self.flowpipe_system()?;
        Ok(self.system.get_or_init(|| system))
    }

    fn any(&self) -> &dyn Any {
        self
    }
}

impl Slopes for Linearisation {
    fn at(&mut self, x: &[f64], u: &[f64]) -> (&DMatrix<f64>, &DMatrix<f64>) {
        self.at(x, u)
    }

    fn along(
        &mut self,
        points: &[(&[f64], &[f64])],
        visit: &mut dyn FnMut(usize, [&DMatrix<f64>; 2]),
    ) {
        self.along(points, |at, a, b| visit(at, [a, b]));
    }
}
