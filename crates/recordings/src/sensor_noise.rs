//! The noise of the sensors, estimated from what a recording holds at the highest frequencies, and
//! from velocities that contradict positions.

use crate::run::Run;

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
    // The weights of the neighbours of each inner sample, and the gain from the standard deviation
    // of the noise to the difference.
    let weights: Vec<([f64; 4], f64)> = (2..run.len() - 2)
        .map(|k| {
            let w = cubic_weights(&run.times, k);
            (w, (1.0 + w.iter().map(|w| w * w).sum::<f64>()).sqrt())
        })
        .collect();
    let deviation = |i: usize| {
        let values: Vec<f64> = (0..run.len()).map(|k| run.state(k)[i]).collect();
        let difference = |(near, (w, gain)): (&[f64], &([f64; 4], f64))| {
            let predicted = w[0] * near[0] + w[1] * near[1] + w[2] * near[3] + w[3] * near[4];
            (near[2] - predicted).abs() / gain
        };
        let smallest = 1e-14 * values.iter().map(|value| value.abs()).fold(0.0, f64::max);
        let mut differences: Vec<f64> =
            values.windows(5).zip(&weights).map(difference).filter(|x| *x > smallest).collect();
        if differences.is_empty() {
            return 0.0;
        }
        let middle = differences.len() / 2;
        *differences.select_nth_unstable_by(middle, f64::total_cmp).1 / NORMAL_MEDIAN
    };
    let mut deviations: Vec<f64> = (0..2 * run.joints).map(deviation).collect();
    for j in 0..run.joints {
        let contradiction = contradiction(run, j, deviations[j]);
        let of_velocity = &mut deviations[run.joints + j];
        *of_velocity = of_velocity.max(contradiction);
    }
    Some(deviations)
}

/// Returns one standard deviation of the difference between the velocity of joint `j` (from 0),
/// averaged over [`SPAN`], and the change of its position, whose noise is `position_noise`.
fn contradiction(run: &Run, j: usize, position_noise: f64) -> f64 {
    let (times, last) = (&run.times, run.len() - 1);
    let velocity = |k: usize| run.qd(k)[j];
    let acceleration = |k: usize| {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
        (velocity(after) - velocity(before)) / (times[after] - times[before])
    };
    // What the position has moved beyond the integral of the velocity: the trapezoidal rule with
    // its first correction (Euler and Maclaurin).
    let (mut beyond, mut all) = (0.0, vec![0.0]);
    for k in 0..last {
        let h = times[k + 1] - times[k];
        let bend = h / 6.0 * (acceleration(k + 1) - acceleration(k));
        let mean = 0.5 * (velocity(k) + velocity(k + 1) - bend);
        beyond += run.q(k + 1)[j] - run.q(k)[j] - h * mean;
        all.push(beyond);
    }
    let duration = times[last] - times[0];
    let span = SPAN.min(0.25 * duration);
    let steps = ((span / duration * last as f64).round() as usize).max(1);
    let mut differences: Vec<f64> = (steps..=last)
        .map(|k| ((all[k] - all[k - steps]) / (times[k] - times[k - steps])).abs())
        .collect();
    let at = (WITHIN_ONE_DEVIATION * differences.len() as f64) as usize;
    let difference = *differences.select_nth_unstable_by(at, f64::total_cmp).1;
    let squares: f64 = (0..=last).map(|k| velocity(k).powi(2)).sum();
    let largest = LARGEST_CONTRADICTION * (squares / run.len() as f64).sqrt();
    // Twice the variance that the noise of two positions gives: the estimates vary themselves.
    let of_positions = 4.0 * (position_noise / span).powi(2);
    (difference.powi(2) - of_positions).max(0.0).sqrt().min(largest)
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
