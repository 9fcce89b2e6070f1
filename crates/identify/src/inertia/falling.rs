//! Viscous friction that is fitted together with the inertial parameters, and must rise with speed.

use crate::bodies::RisingFriction;
use crate::friction::falling::{FallingFriction, rising};
use crate::regression::triangular_factor::TriangularFactor;
use nalgebra::DVector;
use reachtube_robot::{Parameter, ParameterKind, Robot};

/// The friction columns of a fit that corrects the friction of a known robot.
pub(super) struct ViscousColumns<'a> {
    pub known: &'a Robot,
    pub columns: &'a [Parameter],
    /// Speed up to which the friction of each joint must rise \[rad/s\].
    pub limits: &'a [f64],
    /// The rows of the fit.
    pub data: &'a TriangularFactor,
}

impl ViscousColumns<'_> {
    /// Returns the columns of v1, v2 and v3 of a joint.
    fn of_joint(&self, joint: usize) -> [Option<usize>; 3] {
        [ParameterKind::Viscous1, ParameterKind::Viscous2, ParameterKind::Viscous3]
            .map(|kind| self.columns.iter().position(|column| *column == Parameter { joint, kind }))
    }

    /// Returns the condition on the friction of a joint with values `x`.
    fn condition(&self, joint: usize, x: &DVector<f64>) -> RisingFriction {
        let viscous = &self.known.joints()[joint].friction.viscous;
        let known = [viscous.v1, viscous.v2, viscous.v3];
        let columns = self.of_joint(joint);
        let condition = |own| rising(columns, known, own, self.limits[joint], self.data);
        condition(condition(known).viscous(x.as_slice()))
    }

    /// Returns the joints whose fitted friction falls with speed before its limit, with the speed.
    fn falling(&self, x: &DVector<f64>) -> Vec<(usize, f64)> {
        let fitted = (0..self.limits.len()).filter(|joint| self.of_joint(*joint)[0].is_some());
        let falls = |joint: usize| {
            let viscous = self.condition(joint, x).viscous(x.as_slice());
            Some((joint, FallingFriction::speed(viscous, self.limits[joint])?))
        };
        fitted.filter_map(falls).collect()
    }

    /// Solves anew under conditions on the friction of joints whose friction falls in `x`, until
    /// none does. Returns the friction that was replaced; `sizes` are the root mean squares of the
    /// joints' residuals.
    pub(super) fn rise<E>(
        &self,
        x: &mut DVector<f64>,
        solve: impl Fn(&[RisingFriction]) -> Result<DVector<f64>, E>,
        sizes: impl Fn(&DVector<f64>) -> Vec<f64>,
    ) -> Result<Vec<FallingFriction>, E> {
        let (plain, mut replaced): (_, Vec<(usize, f64)>) = (x.clone(), Vec::new());
        loop {
            let falls = self.falling(x).into_iter();
            let new: Vec<_> = falls
                .filter(|(joint, _)| replaced.iter().all(|(known, _)| known != joint))
                .collect();
            if new.is_empty() {
                break;
            }
            replaced.extend(new);
            let conditions = replaced.iter().map(|(joint, _)| self.condition(*joint, &plain));
            *x = solve(&conditions.collect::<Vec<_>>())?;
        }
        let [before, after] = [&plain, x].map(sizes);
        let described = replaced.into_iter().map(|(joint, falls_beyond)| FallingFriction {
            joint: self.known.joints()[joint].name.clone(),
            viscous: self.condition(joint, &plain).viscous(plain.as_slice()),
            falls_beyond,
            limit: self.limits[joint],
            residuals: [before[joint], after[joint]],
        });
        Ok(described.collect())
    }
}
