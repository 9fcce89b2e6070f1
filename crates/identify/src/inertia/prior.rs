use crate::bodies::pseudo_inertia::{PER_LINK, pseudo_inertia};
use crate::settings::Prior;
use nalgebra::{Cholesky, Matrix4, Vector4};
use reachtube_robot::Robot;

/// Mass of a ball before it is adapted to the data \[kg\], if the description has no mass.
const FIRST_MASS: f64 = 1.0;

/// Second moment of a ball per mass before it is adapted \[m²\], as of a solid ball with a radius
/// of 0.1 m.
const FIRST_SPREAD: f64 = 0.2 * 0.1 * 0.1;

/// Relative change of the balls that is worth another round.
const SETTLED: f64 = 0.02;

/// The prior of the links: the links of the description, and balls about the origins of the others.
pub(super) struct LinkPrior {
    /// Pseudo-inertias of the description's links; `None` for a link that has a ball.
    described: Vec<Option<Matrix4<f64>>>,
    /// Mass of each ball \[kg\].
    mass: f64,
    /// Second moment of each ball along each axis \[kg m²\].
    second: f64,
}

impl LinkPrior {
    /// Returns the prior before it is adapted: balls have the mean mass of the description's links.
    pub(super) fn new(robot: &Robot, prior: Prior) -> Self {
        let usable = |p: &Matrix4<f64>| prior == Prior::Description && Cholesky::new(*p).is_some();
        let described: Vec<Option<Matrix4<f64>>> = pseudo_inertias(&robot.inertial_parameters())
            .map(|p| usable(&p).then_some(p))
            .collect();
        let masses: Vec<f64> = described.iter().flatten().map(|p| p[(3, 3)]).collect();
        let mass = if masses.is_empty() { FIRST_MASS } else { mean(masses.into_iter()) };
        Self { described, mass, second: FIRST_SPREAD * mass }
    }

    /// Gives the balls the mean mass and the mean second moment of the links with parameters `x`.
    ///
    /// Returns whether they changed. Among balls of one size these are the most likely ones for the
    /// links (a minimum of the divergence). Without this step, balls of 1 kg would outweigh the
    /// data of a heavy arm.
    pub(super) fn adapt(&mut self, x: &[f64]) -> bool {
        if self.described.iter().all(Option::is_some) {
            return false;
        }
        let links: Vec<Matrix4<f64>> =
            pseudo_inertias(&x[..PER_LINK * self.described.len()]).collect();
        let before = [self.mass, self.second];
        self.mass = mean(links.iter().map(|p| p[(3, 3)]));
        self.second = mean(links.iter().map(|p| (p.trace() - p[(3, 3)]) / 3.0));
        let changed = |(now, before): (f64, f64)| (now / before - 1.0).abs() > SETTLED;
        [self.mass, self.second].into_iter().zip(before).any(changed)
    }

    pub(super) fn inertias(&self) -> Vec<Matrix4<f64>> {
        let ball =
            Matrix4::from_diagonal(&Vector4::new(self.second, self.second, self.second, self.mass));
        self.described.iter().map(|described| described.unwrap_or(ball)).collect()
    }

    pub(super) fn balls(&self, robot: &Robot) -> Vec<String> {
        let links = robot.joints().iter().zip(&self.described);
        links.filter(|(_, p)| p.is_none()).map(|(joint, _)| joint.name.clone()).collect()
    }
}

fn pseudo_inertias(parameters: &[f64]) -> impl Iterator<Item = Matrix4<f64>> {
    parameters.chunks_exact(PER_LINK).map(pseudo_inertia)
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}
