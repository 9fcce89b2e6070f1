//! How well an arm predicts the input along the recordings.

use reachtube_conform::Result;
use reachtube_conform::data::Case;

use crate::arm::Arm;
use crate::correction::InputCorrection;
use crate::corrector::Corrector;

/// Accelerations are differences of velocities over at least this time to both sides, s.
const SPAN: f64 = 0.02;

/// Samples of a case at most: they lie so close that more show nothing new.
const MOST_SAMPLES: usize = 200;

/// Compares along the middle between the highest and the lowest recording of a case: returns the
/// sums of the squares of the input minus what the robot needs, n, and the number of samples.
///
/// # Errors
///
/// When the correction does not fit the robot.
pub(super) fn of_case(arm: &Arm, case: &Case) -> Result<(Vec<f64>, usize)> {
    let (robot, n) = (arm.robot(), case.parts());
    // The robot's own viscous friction is taken whole, whatever the order of the model.
    let mut correction = arm.correction.clone().unwrap_or_else(|| InputCorrection::none(n));
    correction.joints.iter_mut().for_each(|j| (j.quadratic, j.cubic) = (0.0, 0.0));
    let mut corrector = Corrector::new(arm, &correction, &case.condition)?;
    Ok(along(case, |[q, qd, qdd], u| {
        corrector.take_off(None, q, qd, u);
        let needed = robot.motion_torque(q, qd, qdd) + robot.viscous_torque(qd);
        u.iter_mut().zip(&needed).for_each(|(u, needed)| *u -= needed);
    }))
}

/// Returns the same for a case whose inputs are accelerations.
pub(super) fn of_accelerations(case: &Case) -> (Vec<f64>, usize) {
    along(case, |[_, _, qdd], u| u.iter_mut().zip(qdd).for_each(|(u, qdd)| *u -= qdd))
}

/// Returns the sums of the squares of what `subtract` leaves of the input, and the number of
/// samples.
fn along(case: &Case, mut subtract: impl FnMut([&[f64]; 3], &mut [f64])) -> (Vec<f64>, usize) {
    let (n, times) = (case.parts(), case.grid.times());
    let middle = |k: usize, i: usize| 0.5 * (case.measured.upper(k, i) + case.measured.lower(k, i));
    let (mut squares, mut samples) = (vec![0.0; n], 0);
    let reach = times.partition_point(|t| *t < SPAN).max(1);
    let stride = times.len().div_ceil(MOST_SAMPLES);
    for k in (reach..case.measured.len().saturating_sub(reach)).step_by(stride) {
        let of = |from: usize| -> Vec<f64> { (from..from + n).map(|i| middle(k, i)).collect() };
        let (q, qd) = (of(0), of(n));
        let span = times[k + reach] - times[k - reach];
        let mut u = case.inputs[k * n..(k + 1) * n].to_vec();
        let qdd: Vec<f64> =
            (n..2 * n).map(|i| (middle(k + reach, i) - middle(k - reach, i)) / span).collect();
        subtract([&q, &qd, &qdd], &mut u);
        squares.iter_mut().zip(&u).for_each(|(sum, left)| *sum += left * left);
        samples += 1;
    }
    (squares, samples)
}
