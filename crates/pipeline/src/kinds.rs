//! Kinds of recordings: poses at rest, motions of one joint at a time, or motions of several.

use reachtube_identify::prepare::RawLog;
use reachtube_recordings::Run;

use crate::one_motion::Join;

/// A joint whose position stays within this range rests, rad or m.
const REST: f64 = 0.01;

/// In a recording in which one joint at a time moves, that joint has more than this part of the
/// motion.
const SHARE_OF_ONE: f64 = 0.97;

/// Recordings of one motion differ by less than this part of the motion.
const DIFFERENCE_OF_REPEATS: f64 = 0.1;

/// Number of samples that are compared.
const COMPARED: usize = 400;

/// The kind of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MotionType {
    /// The robot rests.
    Rest,
    /// One joint moves.
    OneJoint,
    /// Several joints move.
    Motion,
}

impl MotionType {
    pub(crate) fn of(run: &Run) -> Self {
        let n = run.joints;
        let path = |joint: usize| -> f64 {
            let steps = (1..run.len()).map(|k| (run.q(k)[joint] - run.q(k - 1)[joint]).powi(2));
            steps.sum::<f64>()
        };
        let range = |joint: usize| {
            let positions = (0..run.len()).map(|k| run.q(k)[joint]);
            positions.clone().fold(f64::MIN, f64::max) - positions.fold(f64::MAX, f64::min)
        };
        let moving: Vec<usize> = (0..n).filter(|joint| range(*joint) > REST).collect();
        let paths: Vec<f64> = moving.iter().map(|joint| path(*joint)).collect();
        let longest = paths.iter().copied().fold(0.0, f64::max);
        let is_one = longest > SHARE_OF_ONE * paths.iter().sum::<f64>();
        match moving.len() {
            0 => Self::Rest,
            _ if is_one && n > 1 => Self::OneJoint,
            _ => Self::Motion,
        }
    }
}

/// Returns the name of the motion of each recording, if the recording has none: recordings of the
/// same motion have the name of the first, and so have all motions of which `links` joins two
/// recordings.
pub(crate) fn motions(logs: &[&RawLog], links: &[Join]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (index, log) in logs.iter().enumerate() {
        let same = || (0..index).find(|other| is_repeat(&logs[*other].run, &log.run));
        let unnamed = || same().map_or(&log.name, |other| &names[other]);
        names.push(log.motion.as_ref().unwrap_or_else(unnamed).clone());
    }
    for Join { first, later, .. } in links {
        let [first, later] = [*first, *later].map(|index| names[index].clone());
        let place = |name: &String| names.iter().position(|other| other == name);
        let [kept, joined] =
            if place(&first) <= place(&later) { [first, later] } else { [later, first] };
        names.iter_mut().filter(|name| **name == joined).for_each(|name| name.clone_from(&kept));
    }
    names
}

/// Returns whether two recordings show the same motion from the same start.
fn is_repeat(a: &Run, b: &Run) -> bool {
    let duration = a.duration().min(b.duration());
    let is_as_long = duration > 0.8 * a.duration().max(b.duration());
    if !is_as_long || duration <= 0.0 {
        return false;
    }
    let at = |run: &Run, t: f64| run.times.partition_point(|time| *time < t).min(run.len() - 1);
    let (mut difference, mut motion) = (0.0, 0.0);
    for step in 0..COMPARED {
        let t = duration * step as f64 / COMPARED as f64;
        let (x, y) = (a.q(at(a, t)), b.q(at(b, t)));
        for joint in 0..a.joints {
            difference += (x[joint] - y[joint]).powi(2);
            motion += (x[joint] - a.q(0)[joint]).powi(2);
        }
    }
    difference < DIFFERENCE_OF_REPEATS.powi(2) * motion
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a run of two joints that move by `amplitudes`.
    fn run(amplitudes: [f64; 2], phase: f64) -> Run {
        let times: Vec<f64> = (0..200).map(|k| 0.01 * f64::from(k)).collect();
        let state = |t: &f64| {
            let [a, b] = amplitudes.map(|amplitude| amplitude * (3.0 * t + phase).sin());
            let [va, vb] = amplitudes.map(|amplitude| 3.0 * amplitude * (3.0 * t + phase).cos());
            [a, b, va, vb]
        };
        let states = times.iter().flat_map(state).collect();
        Run::new(2, times, states, vec![0.0; 400]).unwrap()
    }

    fn log(name: &str, run: Run) -> RawLog {
        RawLog::new(name, name, run)
    }

    #[test]
    fn recordings_are_sorted_by_what_moves() {
        assert_eq!(MotionType::of(&run([1e-3, 1e-3], 0.0)), MotionType::Rest);
        assert_eq!(MotionType::of(&run([0.5, 0.02], 0.0)), MotionType::OneJoint);
        assert_eq!(MotionType::of(&run([0.5, 0.3], 0.0)), MotionType::Motion);
    }

    #[test]
    fn repeats_of_a_motion_share_its_name() {
        let mut logs = [
            log("a", run([0.5, 0.3], 0.0)),
            log("b", run([0.5, 0.31], 0.01)),
            log("c", run([0.5, 0.3], 1.5)),
            log("d", run([0.5, 0.3], 0.0)),
        ];
        logs[3].motion = Some("D".into());
        let logs: Vec<&RawLog> = logs.iter().collect();
        assert_eq!(motions(&logs, &[]), ["a", "a", "c", "D"]);
        // Motions are joined in any order, with all their recordings.
        let link = |first, later| Join { first, later, equal: None };
        assert_eq!(motions(&logs, &[link(2, 3)]), ["a", "a", "c", "c"]);
        assert_eq!(motions(&logs, &[link(2, 3), link(1, 3)]), ["a"; 4]);
    }
}
