use super::even::derivative;
use nalgebra::Complex;
use std::f64::consts::PI;

/// Part of the power of the joints' velocity that the motion's band holds.
const SHARE: f64 = 0.999;

/// How far above that band the cut-off is.
const ROOM: f64 = 1.5;

/// The lowest cut-off that is chosen \[Hz\]: below it Coulomb friction no longer steps where a
/// joint turns.
const LOWEST: f64 = 3.0;

/// The highest, as a part of the sample rate.
const HIGHEST: f64 = 0.2;

/// The highest frequency of a motion \[Hz\]: that below which 99.9 % of the power of the velocity
/// lies.
///
/// `q` and `qd` are one joint's evenly spaced positions and velocities. The power is taken from the
/// recorded velocity and from the differentiated position, and the lower frequency counts: noise is
/// in one of them more than in the other.
pub fn motion_band(q: &[f64], qd: &[f64], step: f64) -> f64 {
    let slope = derivative(q, step);
    band(&slope, step).min(band(qd, step))
}

/// The cut-off \[Hz\] for the bands of joints in logs, each with the weight of its motion: 1.5
/// times their weighted median, at least 3 Hz and at most a fifth of the sample rate.
pub fn chosen(mut bands: Vec<(f64, f64)>, rate: f64) -> f64 {
    bands.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * bands.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut sum = 0.0;
    let median = bands.iter().find(|(_, weight)| {
        sum += weight;
        sum >= half
    });
    (ROOM * median.map_or(0.0, |(band, _)| *band)).max(LOWEST).min(HIGHEST * rate)
}

fn band(values: &[f64], step: f64) -> f64 {
    let power = power(values);
    let whole: f64 = power.iter().sum();
    let mut sum = 0.0;
    let index = power.iter().position(|p| {
        sum += p;
        sum >= SHARE * whole
    });
    index.map_or(0.0, |k| k as f64 / (2 * power.len()) as f64 / step)
}

/// The power spectrum of evenly spaced values under a Hann window, padded to a power of two; half
/// as many entries, up to half the sample rate.
fn power(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n.max(1) as f64;
    let window = |k: usize| 0.5 - 0.5 * (2.0 * PI * (k as f64 + 0.5) / n as f64).cos();
    let mut bins: Vec<Complex<f64>> =
        values.iter().enumerate().map(|(k, v)| Complex::new((v - mean) * window(k), 0.0)).collect();
    bins.resize(n.next_power_of_two().max(2), Complex::default());
    transform(&mut bins);
    bins[..bins.len() / 2].iter().map(Complex::norm_sqr).collect()
}

/// The discrete Fourier transform in place, by halving (Cooley and Tukey 1965); the length is a
/// power of two.
fn transform(bins: &mut [Complex<f64>]) {
    let n = bins.len();
    if n < 2 {
        return;
    }
    let (mut even, mut odd): (Vec<_>, Vec<_>) =
        bins.chunks_exact(2).map(|pair| (pair[0], pair[1])).unzip();
    transform(&mut even);
    transform(&mut odd);
    for k in 0..n / 2 {
        let turned = Complex::from_polar(1.0, -2.0 * PI * k as f64 / n as f64) * odd[k];
        bins[k] = even[k] + turned;
        bins[k + n / 2] = even[k] - turned;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_band_is_that_of_the_fastest_part_that_counts() {
        let step = 0.005;
        let wave = |f: f64, k: usize| (2.0 * PI * f * k as f64 * step).sin();
        let qd: Vec<f64> =
            (0..4000).map(|k| wave(0.5, k) + 0.3 * wave(2.0, k) + 0.01 * wave(40.0, k)).collect();
        assert!((band(&qd, step) - 2.0).abs() < 0.15, "{}", band(&qd, step));
    }

    #[test]
    fn noise_in_one_channel_does_not_widen_the_band() {
        let step = 0.001;
        let wave = |k: usize| (2.0 * PI * k as f64 * step).sin();
        let noise = |k: usize| ((k * 7919) % 1009) as f64 / 1009.0 - 0.5;
        let q: Vec<f64> =
            (0..8000).map(|k| -(2.0 * PI * k as f64 * step).cos() / (2.0 * PI)).collect();
        let qd: Vec<f64> = (0..8000).map(|k| wave(k) + noise(k)).collect();
        assert!(band(&qd, step) > 100.0);
        assert!(motion_band(&q, &qd, step) < 1.5);
    }

    #[test]
    fn the_choice_has_its_limits() {
        assert_eq!(chosen(vec![(0.4, 1.0), (0.5, 1.0), (0.6, 1.0)], 1000.0), 3.0);
        assert_eq!(chosen(vec![(4.0, 1.0), (6.0, 1.0), (60.0, 0.5)], 1000.0), 9.0);
        assert_eq!(chosen(vec![(4.0, 1.0)], 20.0), 4.0);
    }
}
