use crate::friction::form::CoulombForm;
use crate::friction::sample::FrictionSample;
use reachtube_robot::FrictionDescription;
use reachtube_robot::friction::Stribeck;

/// The regression of a joint's friction: Coulomb friction of a form, viscous friction, the joint's
/// inertia, and the Stribeck effect at a known speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FrictionModel {
    /// Dependence of Coulomb friction on the load.
    pub form: CoulombForm,
    /// Stribeck speed \[rad/s\]; `None` for no Stribeck effect.
    pub stribeck: Option<f64>,
}

impl FrictionModel {
    /// Returns the number of columns.
    pub(super) fn columns(&self) -> usize {
        self.form.columns() + usize::from(self.stribeck.is_some())
    }

    /// Returns the row of a sample: the columns of the form, then the column of the Stribeck
    /// effect.
    pub(super) fn row(&self, s: &FrictionSample) -> Vec<f64> {
        let mut row = self.form.row(s);
        row.extend(self.stribeck.map(|speed| s.factors[0] * rise(s, speed)));
        row
    }

    /// Returns the derivative of a sample's torque with respect to the Stribeck speed, for a
    /// solution \[N s\].
    pub(super) fn speed_derivative(&self, s: &FrictionSample, x: &[f64]) -> f64 {
        let Some(speed) = self.stribeck else { return 0.0 };
        let slope = 2.0 * s.qd.powi(2) / speed.powi(3);
        x[self.columns() - 1] * s.factors[0] * rise(s, speed) * slope
    }

    /// Returns the indices of v1, v2 and v3.
    pub(super) fn viscous(&self) -> [usize; 3] {
        [4, 3, 2].map(|before| self.form.columns() - before)
    }

    /// Returns the index of the joint's inertia.
    pub(super) fn inertia(&self) -> usize {
        self.form.columns() - 1
    }

    /// Returns the friction of a solution.
    pub(super) fn description(&self, x: &[f64]) -> FrictionDescription {
        let stribeck = self.stribeck.map(|speed| Stribeck { excess: x[self.columns() - 1], speed });
        FrictionDescription { stribeck, ..self.form.description(x) }
    }

    /// Returns the standard errors of the friction, given the errors of a solution and of the
    /// Stribeck speed \[rad/s\] as the last of them.
    pub(super) fn errors(&self, e: &[f64]) -> FrictionDescription {
        let last = self.columns();
        let stribeck = self.stribeck.map(|_| Stribeck { excess: e[last - 1], speed: e[last] });
        FrictionDescription { stribeck, ..self.form.errors(e) }
    }
}

/// Returns the Stribeck effect of a sample per excess.
fn rise(s: &FrictionSample, speed: f64) -> f64 {
    Stribeck { excess: 1.0, speed }.torque(s.qd)
}
