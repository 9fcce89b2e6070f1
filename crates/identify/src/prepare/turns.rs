//! Recordings of one robot whose joints count whole turns differently.

use reachtube_recordings::Run;
use reachtube_robot::{JointDescription, JointKind, Robot};
use std::f64::consts::TAU;

/// Difference of first positions up to which recordings start at one position \[rad\].
const SAME_START: f64 = 0.1;

/// Distance beyond a joint's limits that no recording has \[rad\].
const BEYOND: f64 = 0.2;

/// The first, the lowest and the highest position of a joint in a recording \[rad\].
pub(crate) type Extent = [f64; 3];

pub(crate) fn extents(run: &Run) -> Vec<Extent> {
    let of = |joint: usize| {
        let q = || (0..run.len()).map(|k| run.q(k)[joint]);
        [q().next().unwrap_or(0.0), q().fold(f64::MAX, f64::min), q().fold(f64::MIN, f64::max)]
    };
    (0..run.joints).map(of).collect()
}

/// Returns for each recording the turns that each joint lacks, and for each such joint a sentence.
///
/// The joints of most recordings are right. A joint of another is turns away from them if it starts
/// at the same position but for whole turns, or if only the turns bring it within its limits.
pub(crate) fn missing_turns(
    robot: &Robot,
    names: &[String],
    recordings: &[Vec<Extent>],
) -> (Vec<Vec<f64>>, Vec<String>) {
    let mut turns = vec![vec![0.0; robot.joint_count()]; recordings.len()];
    let mut notes = Vec::new();
    let joints = robot.description().joints.iter().enumerate();
    for (joint, description) in joints.filter(|(_, joint)| joint.kind == JointKind::Revolute) {
        let extents: Vec<Extent> = recordings.iter().map(|joints| joints[joint]).collect();
        for (at, lacking) in of_joint(description, &extents) {
            turns[at][joint] = lacking;
            notes.push(format!(
                "{}: {} is {} away from other recordings from the first sample on, at 0 s: \
                 {:.3} rad counts as {:.3} rad; check how the log counts turns",
                names[at],
                description.name,
                if lacking.abs() == 1.0 {
                    "a turn".into()
                } else {
                    format!("{} turns", lacking.abs())
                },
                extents[at][0],
                extents[at][0] + lacking * TAU,
            ));
        }
    }
    (turns, notes)
}

/// Returns the recordings that lack turns of a joint, and how many.
fn of_joint(joint: &JointDescription, extents: &[Extent]) -> Vec<(usize, f64)> {
    let Some(first) = extents.first() else { return Vec::new() };
    let middle = |extent: &Extent| 0.5 * (extent[1] + extent[2]);
    let turn = |extent: &Extent| ((middle(extent) - middle(first)) / TAU).round();
    let members = |usual: f64| extents.iter().filter(|extent| turn(extent) == usual).count();
    let most = extents.iter().map(turn).max_by_key(|usual| members(*usual)).unwrap_or(0.0);
    if 2 * members(most) <= extents.len() {
        return Vec::new();
    }
    let usual = || extents.iter().filter(|extent| turn(extent) == most);
    let lacking = |(at, extent): (usize, &Extent)| {
        let lacking = most - turn(extent);
        let moved = extent.map(|position| position + lacking * TAU);
        let starts = usual().any(|other| (other[0] - moved[0]).abs() < SAME_START);
        let needed = fits(joint, &moved) && (starts || !fits(joint, extent));
        (lacking != 0.0 && needed).then_some((at, lacking))
    };
    extents.iter().enumerate().filter_map(lacking).collect()
}

fn fits(joint: &JointDescription, [_, low, high]: &Extent) -> bool {
    joint.position_limits.is_none_or(|[a, b]| a - BEYOND <= *low && *high <= b + BEYOND)
}

pub(crate) fn add_turns(run: &mut Run, turns: &[f64]) {
    let n = run.joints;
    for (joint, turns) in turns.iter().enumerate().filter(|(_, turns)| **turns != 0.0) {
        run.states.iter_mut().skip(joint).step_by(2 * n).for_each(|q| *q += turns * TAU);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lacking(limits: Option<[f64; 2]>, extents: &[Extent]) -> Vec<(usize, f64)> {
        let mut joint = Robot::lwa4p().description().joints[0].clone();
        joint.position_limits = limits;
        of_joint(&joint, extents)
    }

    #[test]
    fn a_recording_that_is_a_turn_away_is_found() {
        let usual = [0.5, -1.0, 1.0];
        let away = usual.map(|position| position - TAU);
        assert_eq!(lacking(None, &[usual, usual, away]), [(2, 1.0)]);
        assert_eq!(lacking(None, &[away, usual, usual]), [(0, 1.0)]);
        // Half of the recordings decide nothing.
        assert_eq!(lacking(None, &[away, usual]), []);
        // Neither does a motion that starts elsewhere, except beyond the limits.
        let elsewhere = [-5.0, -5.5, -4.5];
        assert_eq!(lacking(None, &[usual, usual, elsewhere]), []);
        assert_eq!(lacking(Some([-3.1, 3.1]), &[usual, usual, elsewhere]), [(2, 1.0)]);
        // Turns lead nowhere that the joint cannot be.
        let edge = [[3.0, 2.9, 3.1], [3.0, 2.5, 3.1], [-3.28, -3.3, -2.5]];
        assert_eq!(lacking(Some([-3.4, 3.2]), &edge), []);
    }

    #[test]
    fn turns_are_added_to_positions_only() {
        let run = Run::new(2, vec![0.0, 1.0], (0..8).map(f64::from).collect(), vec![0.0; 4]);
        let mut run = run.unwrap();
        add_turns(&mut run, &[0.0, 1.0]);
        assert_eq!(run.states, [0.0, 1.0 + TAU, 2.0, 3.0, 4.0, 5.0 + TAU, 6.0, 7.0]);
    }
}
