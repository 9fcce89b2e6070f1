//! The size of compensated inputs, which shows a wrong unit.

use crate::plausibility::implausible::Implausible;
use crate::plausibility::scale::{number, wrong_unit};
use crate::prepare::log::{PreparedLog, spread};
use crate::samples::Sampling;
use reachtube_diagnose::{Agreement, median};
use reachtube_robot::Robot;

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
) -> Option<Implausible> {
    let n = robot.joint_count();
    let mut joints = vec![Agreement::default(); n];
    for log in spread(logs, LOGS) {
        let moves = log.moving_mask(&sampling.slow, sampling.margin);
        for k in (0..log.len()).step_by(log.len().div_ceil(SAMPLES).max(1)) {
            let (q, qd) = (log.q(k), log.qd(k));
            let input = robot.input_from_motor_torque(q, qd, log.tau(k));
            let rigid = robot.inverse_dynamics(q, qd, log.qdd(k)) - robot.gravity_torque(q);
            let needed = &rigid + robot.viscous_torque(qd);
            let moving = (0..n).filter(|j| moves[k * n + j] && rigid[*j] != 0.0);
            moving.for_each(|j| joints[j].add(needed[j], input[j]));
        }
    }
    // The median, because filters leave some of the friction that was added near a turn.
    let times = median(joints.iter().filter_map(Agreement::ratio))?;
    let clause = format!(
        "the compensated inputs are {} times the inputs that the description needs for these \
         motions (median of the joints)",
        number(times)
    );
    let side = [MOST_TIMES.recip(), MOST_TIMES].map(|limit| times.total_cmp(&limit));
    (side[0] == side[1]).then(|| wrong_unit(robot, &clause, side[0], true))
}
