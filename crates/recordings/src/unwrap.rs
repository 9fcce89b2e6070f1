//! Positions that jump by whole turns.

use std::f64::consts::PI;

use crate::run::Run;

/// Relative deviation of a jump from whole turns.
const TOLERANCE: f64 = 0.1;

/// A jump is this many times as long as the steps about it.
const SUDDEN: f64 = 5.0;

/// Returns whether the step to sample `k` is one of whole turns, where steps about it are short.
pub(crate) fn is_wrap(q: &[f64], k: usize, turn: f64) -> bool {
    let step = (q[k] - q[k - 1]).abs();
    let turns = (step / turn).round();
    let about = |k: usize| match k.checked_sub(1) {
        Some(before) if k < q.len() => (q[k] - q[before]).abs(),
        _ => 0.0,
    };
    turns >= 1.0
        && (step - turns * turn).abs() < TOLERANCE * turn
        && step > SUDDEN * about(k - 1)
        && step > SUDDEN * about(k + 1)
}

/// Returns the samples to which the positions of a joint, rad, jump by whole turns.
fn jumps(q: &[f64]) -> Vec<usize> {
    let turn = 2.0 * PI;
    // A joint near half a turn may jump to and fro with the noise of its sensor, so the steps about
    // a jump count without their turns.
    let off = |step: f64| (step - (step / turn).round() * turn).abs();
    let steps: Vec<f64> = q.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let is_jump = |at: usize| {
        let about = [at.wrapping_sub(1), at + 1].map(|at| steps.get(at).map_or(0.0, |s| off(*s)));
        let step = steps[at];
        step.abs() > 0.5 * turn
            && off(step) < TOLERANCE * turn
            && about.iter().all(|other| step.abs() > SUDDEN * other)
    };
    (0..steps.len()).filter(|at| is_jump(*at)).map(|at| at + 1).collect()
}

/// Takes jumps by whole turns out of the positions of a revolute joint (from 0), as where a log
/// counts turns from sensor to sensor. Returns the samples to which it jumped.
pub(crate) fn take_out_turns(run: &mut Run, joint: usize) -> Vec<usize> {
    let q = |k: usize| run.q(k)[joint];
    if (1..run.len()).all(|k| (q(k) - q(k - 1)).abs() <= PI) {
        return vec![];
    }
    let mut positions: Vec<f64> = (0..run.len()).map(q).collect();
    let jumps = unwrap(&mut positions);
    let rows = run.states.chunks_exact_mut(2 * run.joints).zip(positions);
    rows.for_each(|(row, position)| row[joint] = position);
    jumps
}

/// Takes the jumps out of positions, rad, and returns the samples to which they jumped.
pub(crate) fn unwrap(q: &mut [f64]) -> Vec<usize> {
    let turn = 2.0 * PI;
    let jumps = jumps(q);
    let mut shifts = Vec::with_capacity(jumps.len());
    let mut shift = 0.0;
    for at in &jumps {
        shift -= ((q[*at] - q[at - 1]) / turn).round();
        shifts.push(shift);
    }
    let ends = jumps.iter().skip(1).copied().chain([q.len()]);
    for ((from, to), shift) in jumps.iter().zip(ends).zip(shifts) {
        if shift != 0.0 {
            q[*from..to].iter_mut().for_each(|q| *q += shift * turn);
        }
    }
    jumps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jumps_by_a_turn_are_taken_out() {
        let smooth: Vec<f64> = (0..100).map(|k| 0.1 * k as f64).collect();
        let wrap = |q: &f64| (q + PI).rem_euclid(2.0 * PI) - PI;
        let mut wrapped: Vec<f64> = smooth.iter().map(wrap).collect();
        assert_eq!(unwrap(&mut wrapped), [32, 95]);
        assert!(smooth.iter().zip(&wrapped).all(|(a, b)| (a - b).abs() < 1e-12));
        let mut noisy = vec![3.1, -3.1, 3.1, 3.09, -3.1];
        assert_eq!(unwrap(&mut noisy), [1, 2, 4]);
        assert!(noisy.iter().all(|q| (q - 3.1).abs() < 0.1), "{noisy:?}");
        // A step that is not a whole turn is no jump, and neither is a fast motion.
        let mut fast: Vec<f64> = (0..10).map(|k| 2.0 * k as f64).collect();
        assert_eq!(unwrap(&mut fast), [0; 0]);
        let mut step = vec![0.0, 0.0, 0.0, 3.0, 3.0];
        assert_eq!(unwrap(&mut step), [0; 0]);
    }
}
