//! Velocities that do not integrate to the positions.

use crate::prepare::survey::Survey;
use reachtube_robot::Robot;

/// Difference of a position and the integral of its velocity that is not worth a warning \[rad\].
const MIN_GAP: f64 = 0.05;

/// The same difference relative to the range of the joint's motion.
const MIN_SHARE: f64 = 0.03;

/// Returns a warning for each joint whose velocity does not integrate to its position.
///
/// The warning names the recording in which the two differ most.
pub(crate) fn velocity_warnings(robot: &Robot, logs: &[&Survey]) -> Vec<String> {
    let worst = |joint: usize| {
        let gap = |log: &&Survey| {
            let [gap, range] = log.gaps[joint];
            (log.name.clone(), gap, range)
        };
        logs.iter()
            .map(gap)
            .filter(|(_, gap, range)| *gap > MIN_GAP.max(MIN_SHARE * range))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let warning = |(joint, name): (usize, &String)| {
        worst(joint).map(|(log, gap, range)| {
            format!(
                "{log}: the velocity of {name} does not integrate to its position: the two differ \
                 by up to {gap:.3} rad, where the joint moves over {range:.3} rad; check the \
                 columns qd{number}, q{number} and t, or set prepare.velocity = \"differentiated\"",
                number = joint + 1
            )
        })
    };
    let names = robot.joints().iter().map(|joint| &joint.name);
    names.enumerate().filter_map(warning).collect()
}
