//! The size of compensated inputs, which shows a wrong unit.

use crate::plausibility::scale::{number, unit_words};
use crate::prepare::log::{PreparedLog, spread};
use crate::samples::Sampling;
use reachtube_robot::Robot;
use std::cmp::Ordering;

/// Number of recordings that are looked at, at most.
const LOGS: usize = 16;

/// Number of samples of each, at most.
const SAMPLES: usize = 256;

/// Factor between the inputs and the inputs that the description needs beyond which a warning is
/// given. The controllers that compensate by a description need a good one.
const MOST_TIMES: f64 = 10.0;

/// Returns a warning if the inputs of compensated recordings, free of gravity and dry friction, are
/// far larger or smaller than the description needs for these motions.
///
/// The logs have the gravity torque of the description added, in whose sum a wrong unit is hard to
/// see: inputs in kN m hardly change it. There is no warning for a description without masses.
pub(crate) fn input_unit_warning(
    robot: &Robot,
    logs: &[PreparedLog],
    sampling: &Sampling,
) -> Option<String> {
    let n = robot.joint_count();
    // Sums of squares of each joint's recorded and needed inputs.
    let mut sums = vec![[0.0; 2]; n];
    for log in spread(logs, LOGS) {
        let moves = log.moving_mask(&sampling.slow, sampling.margin);
        for k in (0..log.len()).step_by(log.len().div_ceil(SAMPLES).max(1)) {
            let (q, qd) = (log.q(k), log.qd(k));
            let input = robot.input_from_motor_torque(q, qd, log.tau(k));
            let rigid = robot.inverse_dynamics(q, qd, log.qdd(k)) - robot.gravity_torque(q);
            let model = &rigid + robot.viscous_torque(qd);
            for j in (0..n).filter(|j| moves[k * n + j] && rigid[*j] != 0.0) {
                sums[j][0] += input[j] * input[j];
                sums[j][1] += model[j] * model[j];
            }
        }
    }
    // The median, because filters leave some of the friction that was added near a turn.
    let moving = sums.into_iter().filter(|[_, needed]| *needed > 0.0);
    let mut times: Vec<f64> = moving.map(|[input, needed]| (input / needed).sqrt()).collect();
    times.sort_by(f64::total_cmp);
    let times = *times.get(times.len() / 2)?;
    let side = if times > MOST_TIMES {
        Ordering::Greater
    } else if times < MOST_TIMES.recip() {
        Ordering::Less
    } else {
        return None;
    };
    let (times, unit) = (number(times), unit_words(side, true));
    Some(format!(
        "the compensated inputs are {times} times the inputs that the description needs for these \
         motions (median of the joints): {unit}"
    ))
}
