//! The noise of the sensors, estimated from what a recording holds at the highest frequencies, and
//! from velocities that contradict positions.

use crate::run::Run;
use crate::units::largest_magnitudes;

/// Fewest samples from which the noise is estimated.
const FEWEST: usize = 20;

/// The median of |x| of a normal variable, in its standard deviations.
const NORMAL_MEDIAN: f64 = 0.674_489_75;

/// Time over which velocities are compared with positions, s, at most a quarter of the run.
const SPAN: f64 = 0.1;

/// Velocities that contradict positions by more than this part of their root mean square are in
/// another unit, or of another joint.
const LARGEST_CONTRADICTION: f64 = 0.02;

/// The part of normal numbers that lie within one standard deviation.
const WITHIN_ONE_DEVIATION: f64 = 0.682_689_49;

/// Returns the standard deviation of the noise in each state of `run`, 2n, rad and rad/s; `None`
/// for a run of fewer than 20 samples.
///
/// Each sample is compared with the cubic through the two samples before and the two after it. A
/// motion is nearly cubic over so few samples, so the difference is noise. Samples that equal
/// the cubic exactly do not count: a joint at rest behind a coarse encoder shows no noise. The
/// median makes the estimate robust. Noise that a filter has taken away is not seen, nor is noise
/// that changes slowly.
///
/// A velocity that does not integrate to the positions is wrong by noise too, however smooth it is,
/// because no force can separate the two. The change of each position over 0.1 s is compared with
/// the integral of the velocity. The noise of a velocity is at least what differs beyond the noise
/// of the positions, and at most a fiftieth of the velocity: more is no noise.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::{Run, noise_deviations};
///
/// let times: Vec<f64> = (0..200).map(|k| 0.01 * f64::from(k)).collect();
/// let noise = |k: i32| if k % 2 == 0 { 1e-3 } else { -1e-3 };
/// let states = (0..200).flat_map(|k| [(0.02 * f64::from(k)).sin() + noise(k), 0.0]).collect();
/// let run = Run::new(1, times, states, vec![0.0; 200])?;
/// let deviations = noise_deviations(&run).unwrap();
/// assert!((1e-3..4e-3).contains(&deviations[0]) && deviations[1] == 0.0);
/// # Ok::<(), reachtube_recordings::RunError>(())
/// ```
#[must_use]
pub fn noise_deviations(run: &Run) -> Option<Vec<f64>> {
    if run.len() < FEWEST {
        return None;
    }
    let mut deviations = differences_from_cubics(run);
    let (positions, velocities) = deviations.split_at_mut(run.joints);
    for (own, contradiction) in velocities.iter_mut().zip(contradictions(run, positions)) {
        *own = own.max(contradiction);
    }
    Some(deviations)
}

/// Returns the standard deviation of the difference of each state, 2n, from the cubic through its
/// neighbours.
fn differences_from_cubics(run: &Run) -> Vec<f64> {
    let (states, inner) = (run.dimension(), run.len() - 4);
    // States x inner samples.
    let mut differences = vec![0.0; states * inner];
    for at in 0..inner {
        // The weights of the neighbours, and the gain from the standard deviation of the noise to
        // the difference.
        let w = cubic_weights(&run.times, at + 2);
        let gain = (1.0 + w.iter().map(|w| w * w).sum::<f64>()).sqrt();
        let near: [&[f64]; 5] = std::array::from_fn(|row| run.state(at + row));
        for i in 0..states {
            let predicted =
                w[0] * near[0][i] + w[1] * near[1][i] + w[2] * near[3][i] + w[3] * near[4][i];
            differences[i * inner + at] = (near[2][i] - predicted).abs() / gain;
        }
    }
    let largest = largest_magnitudes(&run.states, states);
    let mut counted = Vec::with_capacity(inner);
    let deviation = |(of_state, largest): (&[f64], &f64)| {
        counted.clear();
        counted.extend(of_state.iter().filter(|x| **x > 1e-14 * largest).map(|x| x.to_bits()));
        let middle = counted.len() / 2;
        if counted.is_empty() { 0.0 } else { nth(&mut counted, middle) / NORMAL_MEDIAN }
    };
    differences.chunks_exact(inner).zip(&largest).map(deviation).collect()
}

/// Returns number `n` (from 0) in the order of numbers of at least 0, given as their bits, whose
/// order is the same.
fn nth(numbers: &mut [u64], n: usize) -> f64 {
    f64::from_bits(*numbers.select_nth_unstable(n).1)
}

/// Returns, for each joint, one standard deviation of the difference between its velocity, averaged
/// over [`SPAN`], and the change of its position, whose noise is in `position_noise` (n).
fn contradictions(run: &Run, position_noise: &[f64]) -> Vec<f64> {
    let (n, times, last) = (run.joints, &run.times, run.len() - 1);
    // What the positions have moved beyond the integrals of the velocities, n x samples: the
    // trapezoidal rule with its first correction (Euler and Maclaurin).
    let mut all = vec![0.0; n * run.len()];
    let accelerations = |k: usize, to: &mut [f64]| {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
        let (slow, fast, duration) = (run.qd(before), run.qd(after), times[after] - times[before]);
        to.iter_mut().zip(fast.iter().zip(slow)).for_each(|(a, (v, w))| *a = (v - w) / duration);
    };
    let (mut own, mut next, mut squares) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    accelerations(0, &mut own);
    for k in 0..last {
        accelerations(k + 1, &mut next);
        let (h, before, after) = (times[k + 1] - times[k], run.state(k), run.state(k + 1));
        for j in 0..n {
            let bend = h / 6.0 * (next[j] - own[j]);
            let mean = 0.5 * (before[n + j] + after[n + j] - bend);
            let at = j * run.len() + k;
            all[at + 1] = all[at] + (after[j] - before[j] - h * mean);
            squares[j] += before[n + j].powi(2);
        }
        std::mem::swap(&mut own, &mut next);
    }
    let duration = times[last] - times[0];
    let span = SPAN.min(0.25 * duration);
    let steps = ((span / duration * last as f64).round() as usize).max(1);
    let mut differences = Vec::with_capacity(run.len());
    let contradiction = |(j, beyond): (usize, &[f64])| {
        differences.clear();
        differences.extend((steps..=last).map(|k| {
            ((beyond[k] - beyond[k - steps]) / (times[k] - times[k - steps])).abs().to_bits()
        }));
        let at = (WITHIN_ONE_DEVIATION * differences.len() as f64) as usize;
        let difference = nth(&mut differences, at);
        let squares: f64 = squares[j] + run.qd(last)[j].powi(2);
        let largest = LARGEST_CONTRADICTION * (squares / run.len() as f64).sqrt();
        // Twice the variance that the noise of two positions gives: the estimates vary themselves.
        let of_positions = 4.0 * (position_noise[j] / span).powi(2);
        (difference.powi(2) - of_positions).max(0.0).sqrt().min(largest)
    };
    all.chunks_exact(run.len()).enumerate().map(contradiction).collect()
}

/// Returns the weights with which the cubic through the samples k-2, k-1, k+1, k+2 predicts sample
/// k (Lagrange).
fn cubic_weights(times: &[f64], k: usize) -> [f64; 4] {
    let nodes = [k - 2, k - 1, k + 1, k + 2].map(|at| times[at] - times[k]);
    std::array::from_fn(|i| {
        let others = nodes.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, node)| node / (node - nodes[i])).product()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a run of one joint whose position is `position(t, k)`, at jittered times.
    fn run(position: impl Fn(f64, usize) -> f64) -> Run {
        let jitter = |k: usize| [0.0, 2e-3, -1e-3, 1e-3][k % 4];
        let times: Vec<f64> = (0..400).map(|k| 0.01 * k as f64 + jitter(k)).collect();
        let states = times.iter().enumerate().flat_map(|(k, t)| [position(*t, k), 0.0]).collect();
        Run::new(1, times, states, vec![0.0; 400]).unwrap()
    }

    #[test]
    fn a_smooth_motion_at_jittered_times_has_nearly_no_noise() {
        let deviations = noise_deviations(&run(|t, _| (3.0 * t).sin())).unwrap();
        assert!(deviations[0] < 1e-5, "{deviations:?}");
    }

    #[test]
    fn noise_and_a_glitch_give_the_deviation_of_the_noise() {
        // Uniform noise in [-a, a] has the standard deviation a / √3.
        let mut state = 1u64;
        let noise: Vec<f64> = (0..400)
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                1e-3 * ((state >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
            })
            .collect();
        let glitch = |k: usize| if k == 200 { 1.0 } else { 0.0 };
        let noisy = run(|t, k| (3.0 * t).sin() + noise[k] + glitch(k));
        let deviation = noise_deviations(&noisy).unwrap()[0];
        assert!((deviation / (1e-3 / 3f64.sqrt()) - 1.0).abs() < 0.25, "{deviation}");
    }

    /// Returns a run that moves smoothly, whose velocity is `velocity` of the true one.
    fn moving(velocity: impl Fn(f64, f64) -> f64) -> Run {
        let times: Vec<f64> = (0..300).map(|k| 0.01 * f64::from(k)).collect();
        let states = |t: &f64| [(3.0 * t).sin(), velocity(*t, 3.0 * (3.0 * t).cos())];
        let states = times.iter().flat_map(states).collect();
        Run::new(1, times, states, vec![0.0; 300]).unwrap()
    }

    #[test]
    fn velocities_that_contradict_positions_are_noisy() {
        let noise = |velocity: fn(f64, f64) -> f64| noise_deviations(&moving(velocity)).unwrap()[1];
        let (exact, offset) = (noise(|_, v| v), noise(|_, v| v + 0.01));
        assert!(exact < 1e-5, "{exact}");
        assert!((offset / 0.01 - 1.0).abs() < 1e-3, "{offset}");
        // A velocity in another unit is no noise.
        let in_degrees = noise(|_, v| v.to_degrees());
        let velocity = (3.0 / 2f64.sqrt()).to_degrees();
        assert!((in_degrees / velocity - LARGEST_CONTRADICTION).abs() < 1e-3, "{in_degrees}");
    }

    #[test]
    fn a_coarse_encoder_shows_about_its_step() {
        let step = 1e-3;
        let coarse = run(|t, _| ((0.05 * t).sin() / step).round() * step);
        let deviation = noise_deviations(&coarse).unwrap()[0];
        assert!((0.1 * step..step).contains(&deviation), "{deviation}");
        assert!(noise_deviations(&run(|_, _| 0.7)).unwrap()[0] == 0.0);
    }
}
