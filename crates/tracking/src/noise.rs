use crate::recording::TrackedRun;

/// A joint rests where its command moves by less than this from sample to sample, rad or m.
const REST: f64 = 1e-5;

/// A set at rest is at least this many robust standard deviations wide.
const DEVIATIONS: f64 = 3.0;

/// No set is narrower at rest than this, far below what any encoder resolves, rad or m.
const LEAST: f64 = 1e-9;

/// Fewest samples at rest that tell a noise.
const FEWEST: usize = 100;

/// Standard deviations of a normal distribution per median absolute deviation.
const PER_MEDIAN: f64 = 1.4826;

/// Returns three robust standard deviations of the noise of the actual position of a joint at rest,
/// from second differences, whose variance is 6 times the noise's; 1e-9 if it hardly rests.
pub(crate) fn at_rest(recordings: &[TrackedRun], joint: usize) -> f64 {
    let mut differences = Vec::new();
    for of in recordings {
        let n = of.joint_count();
        let command = |k: usize| of.command[k * n + joint];
        let error = |k: usize| of.error(k, joint);
        for k in 1..of.times.len() - 1 {
            if [k - 1, k].into_iter().all(|k| (command(k + 1) - command(k)).abs() < REST) {
                differences.push((error(k + 1) - 2.0 * error(k) + error(k - 1)).abs());
            }
        }
    }
    if differences.len() < FEWEST {
        return LEAST;
    }
    let middle = differences.len() / 2;
    let median = *differences.select_nth_unstable_by(middle, f64::total_cmp).1;
    (DEVIATIONS * PER_MEDIAN * median / 6f64.sqrt()).max(LEAST)
}
