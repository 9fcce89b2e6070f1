//! Signs that a recording is not in rad and rad/s, or in m and m/s for a prismatic joint: wrong
//! units are far more likely than a robot that is several times faster than its limits.

use std::f64::consts::PI;
use std::path::Path;

use crate::axis::Axis;
use crate::defect::{Defect, DefectKind};
use crate::gap_limit::GapLimit;
use crate::run::Run;

/// Motion of a joint below which q and the integral of q̇ are not compared, rad or m.
const MIN_MOTION: f64 = 0.05;

/// A position or velocity beyond this multiple of the joint's limit is in another unit.
const LIMIT_FACTOR: f64 = 5.0;

/// Ratios of motion to integrated velocity that are plausible.
const PLAUSIBLE_RATIO: std::ops::RangeInclusive<f64> = 0.5..=2.0;

/// Units that times may have by mistake, with the ratio of motion to integrated velocity that they
/// cause.
const TIME_UNITS: [(&str, f64); 3] =
    [("milliseconds", 1e-3), ("microseconds", 1e-6), ("nanoseconds", 1e-9)];

const OPPOSITE: &str = "qd is the slope of q with the opposite sign";

/// Revolutions per minute in 1 rad/s.
const RPM: f64 = 30.0 / PI;

/// Relative deviation from a ratio up to which its unit is recognised.
const UNIT_TOLERANCE: f64 = 0.3;

/// Returns each joint (from 0) whose q does not follow ∫q̇ dt, with the slope of q over ∫q̇ dt
/// where this is implausible. Joints that hardly move are skipped.
pub(crate) fn velocity_mismatch(run: &Run) -> Vec<(usize, f64)> {
    let slopes = (0..).zip(positions_per_integrals(run));
    let slopes = slopes.filter_map(|(joint, slope)| Some((joint, slope?)));
    slopes.filter(|(_, slope)| !PLAUSIBLE_RATIO.contains(slope)).collect()
}

/// Returns the largest difference of q and ∫q̇ dt (trapezoidal rule) of `joint` (from 0) over a
/// run, rad or m.
#[must_use]
pub fn integral_gap(run: &Run, joint: usize) -> f64 {
    let (mut integral, mut largest) = (run.q(0)[joint], 0.0f64);
    for k in 1..run.len() {
        integral +=
            0.5 * (run.times[k] - run.times[k - 1]) * (run.qd(k)[joint] + run.qd(k - 1)[joint]);
        largest = largest.max((run.q(k)[joint] - integral).abs());
    }
    largest
}

/// Sums over the samples of a joint.
#[derive(Debug, Clone, Copy, Default)]
struct MotionSums {
    integral: f64,
    cross: f64,
    square: f64,
    largest: f64,
    in_gaps: f64,
}

/// Returns, for each joint, the least-squares slope of q over ∫q̇ dt, both from the first sample;
/// `None` for a joint that hardly moves. Unrecorded motion in a gap counts on neither side.
fn positions_per_integrals(run: &Run) -> Vec<Option<f64>> {
    let steps = || run.times.windows(2).map(|pair| pair[1] - pair[0]);
    let longest = GapLimit::Usual.longest_step(steps().collect());
    let mut sums = vec![MotionSums::default(); run.joints];
    for (k, dt) in (1..).zip(steps()) {
        let (before, after) = (run.state(k - 1), run.state(k));
        for (j, sums) in sums.iter_mut().enumerate() {
            if dt > longest {
                sums.in_gaps += after[j] - before[j];
            } else {
                sums.integral += 0.5 * dt * (after[run.joints + j] + before[run.joints + j]);
            }
            let moved = after[j] - run.states[j] - sums.in_gaps;
            sums.cross += moved * sums.integral;
            sums.square += sums.integral * sums.integral;
            sums.largest = sums.largest.max(sums.integral.abs()).max(moved.abs());
        }
    }
    let slope = |MotionSums { cross, square, largest, .. }| {
        (largest > MIN_MOTION && square > 0.0).then(|| cross / square)
    };
    sums.into_iter().map(slope).collect()
}

/// No joint of a robot has a torque or force beyond this, N m or N.
const LARGEST_TORQUE: f64 = 1e6;

/// Returns the defect of a run whose times are not in seconds: another unit scales the integrals of
/// all velocities by one factor. Most joints that move must show it.
pub(crate) fn time_defect(path: &Path, run: &Run) -> Option<Defect> {
    let slopes: Vec<f64> = positions_per_integrals(run).into_iter().flatten().collect();
    let (unit, slope) = TIME_UNITS.iter().find_map(|(unit, expected)| {
        let agrees = |slope: &&f64| (*slope / expected - 1.0).abs() < UNIT_TOLERANCE;
        let mut agreeing = slopes.iter().filter(agrees);
        let (first, more) = (agreeing.next()?, agreeing.count());
        (2 * (more + 1) > slopes.len()).then_some((unit, first))
    })?;
    let problem = format!(
        "the times look like {unit}, because the positions move {slope:.1e} times as far as the \
         integrals of the velocities"
    );
    Some(Defect::new(path, None, problem, "give times in s").of_kind(DefectKind::Units))
}

/// Returns the defects of a run whose values cannot be in the robot's units: the unit of the times,
/// q against ∫q̇ dt, positions and velocities far beyond the joints' limits, velocities of 0 of a
/// joint that moves, and torques beyond a million N m. `path` names the run.
///
/// # Panics
///
/// Panics if there are fewer axes than joints of the run.
#[must_use]
pub fn check_limits(path: &Path, run: &Run, axes: &[Axis]) -> Vec<Defect> {
    let furthest = largest_magnitudes(&run.states, run.dimension());
    let beyond = beyond_limits(path, &furthest, axes);
    let mut defects = ratio_defects(path, run, axes);
    if defects.is_empty() {
        defects.extend(time_defect(path, run));
    }
    // Positions in another unit jump by whole turns, whose slope has no sign.
    defects.retain(|defect| beyond.is_empty() || !defect.problem.contains(OPPOSITE));
    defects.extend(beyond);
    defects.extend(torque_defects(path, run, axes));
    defects.extend(dead_velocities(path, run, &furthest[run.joints..]));
    defects
}

fn moves(run: &Run, joint: usize) -> bool {
    (0..run.len()).any(|k| (run.q(k)[joint] - run.q(0)[joint]).abs() > MIN_MOTION)
}

/// Returns the joints (from 0) that move while their torque is one value in all samples of all
/// runs: it was not measured.
#[must_use]
pub fn dead_torques(runs: &[&Run]) -> Vec<usize> {
    let samples = || runs.iter().flat_map(|run| (0..run.len()).map(|k| run.torque(k)));
    let Some(first) = samples().next() else { return Vec::new() };
    let is_dead = |joint: &usize| samples().all(|torque| torque[*joint] == first[*joint]);
    let moving = (0..first.len()).filter(|joint| runs.iter().any(|run| moves(run, *joint)));
    moving.filter(is_dead).collect()
}

/// Returns a defect for each joint that moves while its velocity is 0 in all samples; `fastest` has
/// the largest |q̇| of each joint.
fn dead_velocities(path: &Path, run: &Run, fastest: &[f64]) -> Vec<Defect> {
    let dead = (0..run.joints).filter(|joint| fastest[*joint] == 0.0 && moves(run, *joint));
    let defect = |joint: usize| {
        let problem = "qd is 0 in every sample, although the joint moves".to_string();
        let remedy = "record the velocity, or delete the columns of qd; `model` derives them";
        joint_defect(path, joint, problem, remedy)
    };
    dead.map(defect).collect()
}

/// Returns the largest magnitude in each column of `rows`, row-major with `width` columns.
pub(crate) fn largest_magnitudes(rows: &[f64], width: usize) -> Vec<f64> {
    let mut largest = vec![0.0f64; width];
    for row in rows.chunks_exact(width) {
        largest.iter_mut().zip(row).for_each(|(largest, x)| *largest = largest.max(x.abs()));
    }
    largest
}

/// Returns a defect for each joint with a torque that no joint has.
fn torque_defects(path: &Path, run: &Run, axes: &[Axis]) -> Vec<Defect> {
    let largest = largest_magnitudes(&run.torques, run.joints);
    let defect = |joint: usize| {
        let sample = (0..run.len()).find(|&k| run.torque(k)[joint].abs() > LARGEST_TORQUE)?;
        let (torque, time) = (run.torque(sample)[joint], run.times[sample]);
        let [_, _, unit] = axes[joint].units;
        let problem = format!(
            "tau is {torque:e} {unit} at {time} s after the first sample, which no joint has"
        );
        let remedy = format!("give tau in {unit}, or omit that sample");
        Some(joint_defect(path, joint, problem, &remedy))
    };
    (0..run.joints).filter(|joint| largest[*joint] > LARGEST_TORQUE).filter_map(defect).collect()
}

/// Returns a defect for each joint of which q or q̇, but not both, looks like degrees, or like mm
/// for a prismatic joint.
fn ratio_defects(path: &Path, run: &Run, axes: &[Axis]) -> Vec<Defect> {
    let defect = |(joint, slope): (usize, f64)| {
        let ratio = if axes[joint].is_revolute { PI.recip() * 180.0 } else { 1000.0 };
        let (other, [unit, speed, _]) = (axes[joint].other_unit(), axes[joint].units);
        let guess = if (slope / ratio - 1.0).abs() < UNIT_TOLERANCE {
            format!("q looks like {other} and qd like {speed}")
        } else if (slope * ratio - 1.0).abs() < UNIT_TOLERANCE {
            format!("q looks like {unit} and qd like {other}/s")
        } else if axes[joint].is_revolute && (slope * RPM - 1.0).abs() < UNIT_TOLERANCE {
            format!("q looks like {unit} and qd like revolutions per minute")
        } else if (slope + 1.0).abs() < UNIT_TOLERANCE {
            let remedy = "multiply the column of qd by -1";
            return Some(joint_defect(path, joint, OPPOSITE.to_string(), remedy));
        } else {
            return None;
        };
        let problem = format!("q moves {slope:.3} times as far as the integral of qd: {guess}");
        Some(joint_defect(path, joint, problem, &format!("give q in {unit} and qd in {speed}")))
    };
    velocity_mismatch(run).into_iter().filter_map(defect).collect()
}

/// Returns a number with three decimals, or a huge one with its power of ten.
fn size(value: f64) -> String {
    if value < 1e6 { format!("{value:.3}") } else { format!("{value:.1e}") }
}

/// Returns a defect for each joint whose positions are far beyond its limits, and one for each
/// whose velocities are; `furthest` has the largest |q| and |q̇| of each joint.
fn beyond_limits(path: &Path, furthest: &[f64], axes: &[Axis]) -> Vec<Defect> {
    let (positions, velocities) = furthest.split_at(furthest.len() / 2);
    let far = |furthest: f64, limit: f64| furthest > LIMIT_FACTOR * limit;
    let position = |(joint, (axis, furthest)): (usize, (&Axis, &f64))| {
        let [low, high] = axis.position_limits?;
        let [unit, ..] = axis.units;
        let problem = format!(
            "|q| reaches {}, but the joint's limits are {low} and {high} {unit}",
            size(*furthest)
        );
        let remedy = format!(
            "it may be in {}: give q in {unit}{}, or correct the limits in the robot's description",
            axis.other_unit(),
            if axis.is_revolute {
                " (`model` and `prepare` take `--columns angle=deg`)"
            } else {
                ""
            }
        );
        let is_far = far(*furthest, low.abs().max(high.abs()));
        is_far.then(|| joint_defect(path, joint, problem, &remedy))
    };
    let velocity = |(joint, (axis, fastest)): (usize, (&Axis, &f64))| {
        let limit = axis.velocity_limit?;
        let [_, unit, _] = axis.units;
        let problem =
            format!("qd reaches {}, but the joint's limit is {limit} {unit}", size(*fastest));
        let remedy = format!("give qd in {unit}, or correct the limit in the robot's description");
        far(*fastest, limit).then(|| joint_defect(path, joint, problem, &remedy))
    };
    let first = axes.iter().zip(positions).enumerate().filter_map(position);
    first.chain(axes.iter().zip(velocities).enumerate().filter_map(velocity)).collect()
}

fn joint_defect(path: &Path, joint: usize, problem: String, remedy: &str) -> Defect {
    Defect::new(path, None, problem, remedy).of_joint(Some(joint + 1)).of_kind(DefectKind::Units)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::check_limits;
    use crate::axis::Axis;
    use crate::run::Run;

    fn axes() -> Vec<Axis> {
        let units = ["rad", "rad/s", "N m"];
        let (name, position_limits, velocity_limit) = (String::new(), None, Some(1.2));
        vec![Axis { name, is_revolute: true, units, position_limits, velocity_limit }; 6]
    }

    #[test]
    fn a_velocity_of_zero_of_a_joint_that_moves_is_a_defect() {
        let words = |velocity: f64| {
            let state = |k: usize| {
                let mut state = vec![0.0; 12];
                state[2] = 0.1 * k as f64;
                state[8] = velocity;
                state
            };
            let states = (0..3).flat_map(state).collect();
            let run = Run::new(6, vec![0.0, 0.1, 0.2], states, vec![1.0; 18]).unwrap();
            let defects = check_limits(Path::new("run.csv"), &run, &axes());
            defects.iter().map(ToString::to_string).collect::<String>()
        };
        assert_eq!(words(1.0), "");
        let dead = words(0.0);
        assert!(dead.contains("joint 3") && dead.contains("qd is 0 in every sample"), "{dead}");
    }

    #[test]
    fn velocities_of_another_sign_or_in_revolutions_per_minute_are_a_defect() {
        let words = |factor: f64| {
            let state = |k: usize| {
                let t = 0.1 * f64::from(k as u32);
                let (q, qd) = (vec![t.sin(); 6], vec![factor * t.cos(); 6]);
                [q, qd].concat()
            };
            let times = (0..40).map(|k| 0.1 * f64::from(k)).collect();
            let states = (0..40).flat_map(state).collect();
            let run = Run::new(6, times, states, vec![1.0; 240]).unwrap();
            let mut axes = axes();
            axes.iter_mut().for_each(|axis| axis.velocity_limit = None);
            let defects = check_limits(Path::new("run.csv"), &run, &axes);
            defects.first().map(ToString::to_string).unwrap_or_default()
        };
        assert_eq!(words(1.0), "");
        assert!(words(-1.0).contains("slope of q with the opposite sign"), "{}", words(-1.0));
        assert!(words(9.549).contains("like revolutions per minute"), "{}", words(9.549));
    }

    #[test]
    fn times_in_another_unit_are_a_defect() {
        // The second joint hardly moves, and its velocity has an offset.
        let words = |per_second: f64, moving: usize| {
            let state = |k: usize| {
                let q = (0..6).map(move |j| if j < moving { 0.1 * k as f64 } else { 0.0 });
                q.chain((0..6).map(move |j| if j < moving { 1.0 } else { 1e-4 }))
                    .collect::<Vec<_>>()
            };
            let times = (0..20).map(|k| 0.1 * k as f64 * per_second).collect();
            let states = (0..20).flat_map(state).collect();
            let run = Run::new(6, times, states, vec![1.0; 120]).unwrap();
            let defects = check_limits(Path::new("run.csv"), &run, &axes());
            defects.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        assert_eq!(words(1.0, 5), [""; 0]);
        for (per_second, unit, ratio) in
            [(1e3, "milliseconds", "1.0e-3"), (1e6, "microseconds", "1.0e-6")]
        {
            let found = words(per_second, 5);
            assert_eq!(found.len(), 1, "{found:?}");
            assert!(found[0].contains(&format!("look like {unit}")), "{found:?}");
            assert!(found[0].contains(ratio) && found[0].contains("give times in s"), "{found:?}");
        }
    }

    #[test]
    fn a_torque_that_no_joint_has_is_a_defect() {
        let mut torques = vec![1.0; 18];
        let run = |torques: &[f64]| {
            Run::new(6, vec![0.0, 0.1, 0.2], vec![0.0; 36], torques.to_vec()).unwrap()
        };
        assert_eq!(check_limits(Path::new("run.csv"), &run(&torques), &axes()), []);
        torques[8] = 1e300;
        let defects = check_limits(Path::new("run.csv"), &run(&torques), &axes());
        let words = defects.iter().map(ToString::to_string).collect::<String>();
        assert!(defects.len() == 1, "{words}");
        assert!(words.contains("joint 3") && words.contains("1e300 N m at 0.1 s"), "{words}");
    }
}
