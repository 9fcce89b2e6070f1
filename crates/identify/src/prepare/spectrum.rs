use crate::prepare::derivative::derivative;
use realfft::RealFftPlanner;
use std::f64::consts::PI;

/// Share of a signal's power that its bandwidth holds.
const POWER_SHARE: f64 = 0.999;

/// Parts of the upper half of a spectrum, in the quietest of which noise is measured.
const NOISE_BANDS: usize = 4;

/// Number of neighbours on each side over which a spectrum is smoothed before it is compared with
/// its noise.
const NEIGHBOURS: usize = 32;

/// Least part of the power that must be beyond the noise: less may be noise by chance.
const LEAST_SIGNAL: f64 = 0.01;

/// Returns the bandwidth of one joint's motion \[Hz\]: 99.9 % of the power of its velocity lies
/// below it, where only frequencies count at which the motion is stronger than the noise.
///
/// `q` and `qd` are evenly spaced positions and velocities. The noise of each is taken to be white,
/// and measured in the upper half of its spectrum, where the noise of a position that is
/// differentiated grows with the frequency. The bandwidth is the lower one of the recorded velocity
/// and the differentiated position, because noise affects one of them more than the other. It is 0
/// if neither shows a motion.
#[must_use]
pub(crate) fn motion_bandwidth(q: &[f64], qd: &[f64], step: f64) -> f64 {
    let slope = power_spectrum(&derivative(q, step));
    let noise = white_noise(&power_spectrum(q));
    // The response of the derivative to a frequency, squared.
    let response = |k: usize| {
        let angle = PI * k as f64 / slope.len() as f64;
        ((8.0 * angle.sin() - (2.0 * angle).sin()) / (6.0 * step)).powi(2)
    };
    let of_slope = bandwidth(&slope, |k| noise * response(k), step);
    let recorded = power_spectrum(qd);
    let noise = white_noise(&recorded);
    let of_recorded = bandwidth(&recorded, |_| noise, step);
    of_slope.into_iter().chain(of_recorded).reduce(f64::min).unwrap_or(0.0)
}

/// Returns the frequency \[Hz\] below which a spectrum has 99.9 % of its power beyond the noise.
/// Frequencies at which the signal is weaker than the noise do not count. The result is `None` for
/// noise alone.
fn bandwidth(power: &[f64], noise: impl Fn(usize) -> f64, step: f64) -> Option<f64> {
    let smooth = smoothed(power);
    let signal = |k: usize| match smooth[k] > 2.0 * noise(k) {
        true => (power[k] - noise(k)).max(0.0),
        false => 0.0,
    };
    let whole: f64 = (0..power.len()).map(signal).sum();
    if whole <= LEAST_SIGNAL * power.iter().sum::<f64>() {
        return None;
    }
    let mut sum = 0.0;
    let index = (0..power.len()).position(|k| {
        sum += signal(k);
        sum >= POWER_SHARE * whole
    });
    index.map(|k| k as f64 / (2 * power.len()) as f64 / step)
}

/// Returns the power of white noise in a spectrum. It is measured by medians, which a few
/// vibrations do not move.
fn white_noise(power: &[f64]) -> f64 {
    let upper = &power[power.len() / 2..];
    let bands = upper.chunks_exact((upper.len() / NOISE_BANDS).max(1));
    let median = |band: &[f64]| {
        let mut band = band.to_vec();
        band.sort_by(f64::total_cmp);
        // The power of noise at a frequency is distributed exponentially.
        band[band.len() / 2] / 2f64.ln()
    };
    bands.map(median).fold(f64::INFINITY, f64::min).min(f64::MAX)
}

/// Returns the mean of each value and its neighbours.
fn smoothed(power: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0];
    power.iter().for_each(|p| sums.push(sums[sums.len() - 1] + p));
    let mean = |k: usize| {
        let (first, last) = (k.saturating_sub(NEIGHBOURS), (k + NEIGHBOURS + 1).min(power.len()));
        (sums[last] - sums[first]) / (last - first) as f64
    };
    (0..power.len()).map(mean).collect()
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
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn the_bandwidth_reaches_to_the_fastest_part_with_power() {
        let step = 0.005;
        let wave = |f: f64, k: usize| (2.0 * PI * f * k as f64 * step).sin();
        let qd: Vec<f64> =
            (0..4000).map(|k| wave(0.5, k) + 0.3 * wave(2.0, k) + 0.01 * wave(40.0, k)).collect();
        let found = whole_bandwidth(&qd, step);
        assert!((found - 2.0).abs() < 0.15, "{found}");
    }

    #[test]
    fn noise_in_one_channel_does_not_widen_the_band() {
        let step = 0.001;
        let wave = |k: usize| (2.0 * PI * k as f64 * step).sin();
        let noise = |k: usize| ((k * 7919) % 1009) as f64 / 1009.0 - 0.5;
        let q: Vec<f64> =
            (0..8000).map(|k| -(2.0 * PI * k as f64 * step).cos() / (2.0 * PI)).collect();
        let qd: Vec<f64> = (0..8000).map(|k| wave(k) + noise(k)).collect();
        assert!(whole_bandwidth(&qd, step) > 100.0);
        assert!(motion_bandwidth(&q, &qd, step) < 1.5);
    }

    #[test]
    fn noise_in_both_channels_does_not_widen_the_band() {
        // As in logs of motor currents at 1 kHz: positions of an encoder with 4,096 steps per turn,
        // and velocities with noise of 0.05 rad/s.
        let step = 0.001;
        let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
        let mut noise = |size: f64| {
            let sum: f64 = (0..12).map(|_| random.random_range(-0.5..0.5)).sum();
            size * sum
        };
        let wave = |f: f64, k: usize| (2.0 * PI * f * k as f64 * step).sin();
        let speed = |k: usize| 0.6 * wave(0.3, k) + 0.4 * wave(1.1, k) + 0.2 * wave(4.0, k);
        let angle = |k: usize| {
            let part =
                |size: f64, f: f64| -size * (2.0 * PI * f * k as f64 * step).cos() / (2.0 * PI * f);
            part(0.6, 0.3) + part(0.4, 1.1) + part(0.2, 4.0)
        };
        let encoder = |angle: f64| (angle * 4096.0 / (2.0 * PI)).round() * 2.0 * PI / 4096.0;
        let q: Vec<f64> = (0..20_000).map(|k| encoder(angle(k))).collect();
        let qd: Vec<f64> = (0..20_000).map(|k| speed(k) + noise(0.05)).collect();
        assert!(whole_bandwidth(&qd, step) > 300.0, "{}", whole_bandwidth(&qd, step));
        assert!(whole_bandwidth(&derivative(&q, step), step) > 300.0);
        let found = motion_bandwidth(&q, &qd, step);
        assert!((found - 4.0).abs() < 0.2, "{found}");
        // A joint at rest has noise alone.
        let rest: Vec<f64> = (0..20_000).map(|_| noise(0.05)).collect();
        assert_eq!(motion_bandwidth(&rest, &rest, step), 0.0);
    }

    /// The bandwidth of all power, noise included.
    fn whole_bandwidth(values: &[f64], step: f64) -> f64 {
        bandwidth(&power_spectrum(values), |_| 0.0, step).unwrap()
    }
}
