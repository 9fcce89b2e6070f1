//! How well a model predicts the input along the recordings.

use nalgebra::DVector;

use crate::error::Result;
use crate::fitting::data::Track;
use crate::nominal::correction::InputCorrection;
use crate::nominal::corrector::Corrector;
use crate::problem::problem::Setup;

/// Accelerations are differences of velocities over this time, s.
const SPAN: f64 = 0.02;

/// Returns the root mean square of the input minus what the robot needs for the recorded motion,
/// n, N m. The motion is the middle between the highest and the lowest recording of each case.
///
/// # Errors
///
/// When the correction does not fit the robot.
pub(super) fn residual(setup: &Setup, tracks: &[Track]) -> Result<Vec<f64>> {
    let n = setup.robot.joint_count();
    // The robot's own viscous friction is taken whole, whatever the order of the model.
    let mut correction = setup.correction.clone().unwrap_or_else(|| InputCorrection::none(n));
    correction.joints.iter_mut().for_each(|j| (j.quadratic, j.cubic) = (0.0, 0.0));
    let (mut sums, mut count) = (vec![0.0; n], 0.0f64);
    for track in tracks {
        let (case, times) = (&track.case, track.case.grid.times());
        let condition = &case.condition;
        let mut corrector = Corrector::new(&setup.robot, &correction, &setup.settings, condition)?;
        let middle =
            |k: usize, i: usize| 0.5 * (case.measured.upper(k, i) + case.measured.lower(k, i));
        let reach = times.partition_point(|t| *t <= SPAN).max(1);
        for k in reach..case.measured.len().saturating_sub(reach) {
            let of = |from: usize| -> Vec<f64> { (from..from + n).map(|i| middle(k, i)).collect() };
            let (q, qd) = (of(0), of(n));
            let span = times[k + reach] - times[k - reach];
            let mut u = case.inputs[k * n..(k + 1) * n].to_vec();
            corrector.take_off(&q, &qd, &mut u);
            let qdd: Vec<f64> =
                (n..2 * n).map(|i| (middle(k + reach, i) - middle(k - reach, i)) / span).collect();
            let needed = setup.robot.mass_matrix(&q) * DVector::from_vec(qdd)
                + setup.robot.coriolis_torque(&q, &qd)
                + setup.robot.viscous_torque(&qd);
            for ((sum, u), needed) in sums.iter_mut().zip(&u).zip(&needed) {
                *sum += (u - needed).powi(2);
            }
            count += 1.0;
        }
    }
    Ok(sums.into_iter().map(|sum| (sum / count.max(1.0)).sqrt()).collect())
}
