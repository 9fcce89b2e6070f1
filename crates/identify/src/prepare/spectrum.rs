use crate::prepare::derivative::derivative;
use realfft::RealFftPlanner;
use std::f64::consts::PI;

/// Share of a signal's power that its bandwidth holds.
const POWER_SHARE: f64 = 0.999;

/// Returns the bandwidth of one joint's motion \[Hz\]: 99.9 % of the power of its velocity lies
/// below it.
///
/// `q` and `qd` are evenly spaced positions and velocities. The bandwidth is the lower one of the
/// recorded velocity and the differentiated position, because noise affects one of them more than
/// the other.
#[must_use]
pub(crate) fn motion_bandwidth(q: &[f64], qd: &[f64], step: f64) -> f64 {
    let slope = derivative(q, step);
    bandwidth(&slope, step).min(bandwidth(qd, step))
}

fn bandwidth(values: &[f64], step: f64) -> f64 {
    let power = power_spectrum(values);
    let whole: f64 = power.iter().sum();
    let mut sum = 0.0;
    let index = power.iter().position(|p| {
        sum += p;
        sum >= POWER_SHARE * whole
    });
    index.map_or(0.0, |k| k as f64 / (2 * power.len()) as f64 / step)
}

/// Returns the power spectrum of evenly spaced values under a Hann window, from 0 to half the
/// sample rate.
///
/// The values are padded with zeros to N samples, a power of two, and the result has N / 2 entries.
/// Only the index of an entry is used further, so that the rounding of the transform, which depends
/// on the processor, does not reach the results.
fn power_spectrum(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n.max(1) as f64;
    let window = |k: usize| 0.5 - 0.5 * (2.0 * PI * (k as f64 + 0.5) / n as f64).cos();
    let mut signal: Vec<f64> =
        values.iter().enumerate().map(|(k, v)| (v - mean) * window(k)).collect();
    let padded = n.next_power_of_two().max(2);
    signal.resize(padded, 0.0);
    let transform = RealFftPlanner::new().plan_fft_forward(padded);
    let mut bins = transform.make_output_vec();
    transform.process(&mut signal, &mut bins).expect("the buffers have the planned lengths");
    bins[..padded / 2].iter().map(|bin| bin.norm_sqr()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bandwidth_reaches_to_the_fastest_part_with_power() {
        let step = 0.005;
        let wave = |f: f64, k: usize| (2.0 * PI * f * k as f64 * step).sin();
        let qd: Vec<f64> =
            (0..4000).map(|k| wave(0.5, k) + 0.3 * wave(2.0, k) + 0.01 * wave(40.0, k)).collect();
        assert!((bandwidth(&qd, step) - 2.0).abs() < 0.15, "{}", bandwidth(&qd, step));
    }

    #[test]
    fn noise_in_one_channel_does_not_widen_the_band() {
        let step = 0.001;
        let wave = |k: usize| (2.0 * PI * k as f64 * step).sin();
        let noise = |k: usize| ((k * 7919) % 1009) as f64 / 1009.0 - 0.5;
        let q: Vec<f64> =
            (0..8000).map(|k| -(2.0 * PI * k as f64 * step).cos() / (2.0 * PI)).collect();
        let qd: Vec<f64> = (0..8000).map(|k| wave(k) + noise(k)).collect();
        assert!(bandwidth(&qd, step) > 100.0);
        assert!(motion_bandwidth(&q, &qd, step) < 1.5);
    }
}
