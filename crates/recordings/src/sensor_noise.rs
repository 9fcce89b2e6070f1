//! The noise of the sensors, estimated from what a recording holds at the highest frequencies.

use crate::run::Run;

/// Fewest samples from which the noise is estimated.
const FEWEST: usize = 20;

/// The median of |x| of a normal variable, in its standard deviations.
const NORMAL_MEDIAN: f64 = 0.674_489_75;

/// Returns the standard deviation of the noise in each state of `run`, 2n, rad and rad/s; nothing
/// for a run of fewer than 20 samples.
///
/// Each sample is compared with the cubic through the two samples before and the two after it. A
/// motion is nearly cubic over so few samples, so the difference is noise. Samples that equal
/// the cubic exactly do not count: a joint at rest behind a coarse encoder shows no noise. The
/// median makes the estimate robust. Noise that a filter has taken away is not seen, nor is noise
/// that changes slowly.
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
    let weights: Vec<[f64; 4]> = (2..run.len() - 2).map(|k| cubic_weights(&run.times, k)).collect();
    let deviation = |i: usize| {
        let value = |k: usize| run.state(k)[i];
        let difference = |(at, w): (usize, &[f64; 4])| {
            let predicted = w[0] * value(at)
                + w[1] * value(at + 1)
                + w[2] * value(at + 3)
                + w[3] * value(at + 4);
            let gain = (1.0 + w.iter().map(|w| w * w).sum::<f64>()).sqrt();
            (value(at + 2) - predicted).abs() / gain
        };
        let smallest = 1e-14 * (0..run.len()).map(|k| value(k).abs()).fold(0.0, f64::max);
        let mut differences: Vec<f64> =
            weights.iter().enumerate().map(difference).filter(|x| *x > smallest).collect();
        if differences.is_empty() {
            return 0.0;
        }
        let middle = differences.len() / 2;
        *differences.select_nth_unstable_by(middle, f64::total_cmp).1 / NORMAL_MEDIAN
    };
    Some((0..2 * run.joints).map(deviation).collect())
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

    #[test]
    fn a_coarse_encoder_shows_about_its_step() {
        let step = 1e-3;
        let coarse = run(|t, _| ((0.05 * t).sin() / step).round() * step);
        let deviation = noise_deviations(&coarse).unwrap()[0];
        assert!((0.1 * step..step).contains(&deviation), "{deviation}");
        assert!(noise_deviations(&run(|_, _| 0.7)).unwrap()[0] == 0.0);
    }
}
