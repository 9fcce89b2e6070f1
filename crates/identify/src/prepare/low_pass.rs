use std::f64::consts::PI;

/// Length of the transients at both ends that a user of the filter should cut, in periods of the
/// cut-off.
pub(super) const TRANSIENT_PERIODS: f64 = 2.5;

/// A Butterworth low-pass of order 4 that runs forward and backward, so that it has zero phase.
///
/// After both passes the gain is 1/2 at the cut-off f_c, and about (1 + (f / f_c)⁸)⁻¹ at other
/// frequencies f. The signal is extended point-symmetrically at its ends (Gustafsson 1996 discusses
/// the choices). Each pass starts in the steady state of its first sample.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LowPass {
    sections: [SecondOrderSection; 2],
    /// Number of samples in a period of the cut-off.
    period: usize,
}

/// A section of second order, y = (b0 + b1 z⁻¹ + b2 z⁻²) / (1 + a1 z⁻¹ + a2 z⁻²) x.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SecondOrderSection {
    b: [f64; 3],
    a: [f64; 2],
}

impl LowPass {
    /// Returns a filter for a cut-off and a sample rate \[Hz\].
    ///
    /// The result is `None` if the cut-off is not between 0 and half the rate.
    #[must_use]
    pub(crate) fn new(cut_off: f64, rate: f64) -> Option<Self> {
        let between = cut_off > 0.0 && cut_off < 0.5 * rate && rate.is_finite();
        let period = (rate / cut_off).ceil() as usize;
        // The pole pairs of order 4 lie at angles of 22.5° and 67.5° from the real axis.
        let damping = [PI / 8.0, 3.0 * PI / 8.0].map(f64::cos);
        between.then(|| Self {
            sections: damping.map(|d| SecondOrderSection::new(cut_off / rate, d)),
            period,
        })
    }

    /// Returns the filter as weights of the samples around each, those after it included, over
    /// `periods` periods of the cut-off to both sides. They are symmetric and their sum is 1.
    pub(crate) fn weights(&self, periods: f64) -> Vec<f64> {
        let half = (periods * self.period as f64).ceil() as usize;
        let middle = half + 3 * self.period + 1;
        let mut weights = vec![0.0; 2 * middle + 1];
        weights[middle] = 1.0;
        self.zero_phase(&mut weights);
        let mut weights = weights[middle - half..=middle + half].to_vec();
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        weights
    }

    /// Filters evenly spaced samples in place, forward and backward.
    pub(crate) fn zero_phase(&self, signal: &mut [f64]) {
        let Some(last) = signal.len().checked_sub(1) else { return };
        let pad = (3 * self.period).min(last);
        let (start, end) = (signal[0], signal[last]);
        let mut padded = Vec::with_capacity(signal.len() + 2 * pad);
        // Point-symmetric extension of both ends.
        padded.extend((1..=pad).rev().map(|k| 2.0 * start - signal[k]));
        padded.extend_from_slice(signal);
        padded.extend((1..=pad).map(|k| 2.0 * end - signal[last - k]));
        // One pass forward, one backward.
        for _ in 0..2 {
            self.sections.iter().for_each(|section| section.run(&mut padded));
            padded.reverse();
        }
        signal.copy_from_slice(&padded[pad..pad + signal.len()]);
    }
}

impl SecondOrderSection {
    /// Designs a section by the bilinear transform, prewarped at the cut-off.
    ///
    /// `cut_off` is a share of the sample rate.
    fn new(cut_off: f64, damping: f64) -> Self {
        let w = (PI * cut_off).tan();
        let scale = 1.0 / (1.0 + 2.0 * damping * w + w * w);
        let gain = w * w * scale;
        let a = [2.0 * (w * w - 1.0) * scale, (1.0 - 2.0 * damping * w + w * w) * scale];
        Self { b: [gain, 2.0 * gain, gain], a }
    }

    /// Filters a signal in place (transposed direct form II).
    fn run(&self, signal: &mut [f64]) {
        let ([b0, b1, b2], [a1, a2]) = (self.b, self.a);
        let steady = signal.first().copied().unwrap_or(0.0);
        let mut delayed = (b2 - a2) * steady;
        let mut next = (b1 - a1) * steady + delayed;
        for x in signal {
            let y = b0 * *x + next;
            next = b1 * *x - a1 * y + delayed;
            delayed = b2 * *x - a2 * y;
            *x = y;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn amplitude(frequency: f64) -> f64 {
        let rate = 200.0;
        let filter = LowPass::new(10.0, rate).unwrap();
        let wave = |k: usize| (2.0 * PI * frequency * k as f64 / rate).sin();
        let mut signal: Vec<f64> = (0..4000).map(wave).collect();
        filter.zero_phase(&mut signal);
        let middle = 1000..3000;
        // Correlation with the input: a phase shift would reduce it.
        2.0 * middle.clone().map(|k| signal[k] * wave(k)).sum::<f64>() / middle.len() as f64
    }

    #[test]
    fn the_gain_equals_that_of_two_passes() {
        assert!((amplitude(10.0) - 0.5).abs() < 1e-3, "{}", amplitude(10.0));
        assert!((amplitude(1.0) - 1.0).abs() < 1e-6);
        // The bilinear transform warps frequencies: 20 Hz at a rate of 200 Hz corresponds to
        // tan(0.1 π) / tan(0.05 π) times the cut-off.
        let warped = (0.1 * PI).tan() / (0.05 * PI).tan();
        assert!((amplitude(20.0) - 1.0 / (1.0 + warped.powi(8))).abs() < 1e-4);
    }

    #[test]
    fn a_symmetric_pulse_stays_symmetric() {
        let filter = LowPass::new(5.0, 100.0).unwrap();
        let mut signal: Vec<f64> =
            (0..401).map(|k| (-((k as f64 - 200.0) / 12.0).powi(2)).exp()).collect();
        filter.zero_phase(&mut signal);
        let peak = (0..401).max_by(|a, b| signal[*a].total_cmp(&signal[*b])).unwrap();
        assert_eq!(peak, 200);
        // Only the transients from the ends, 200 samples away, break the symmetry.
        let skew = (0..200).map(|k| (signal[k] - signal[400 - k]).abs());
        let skew = skew.max_by(f64::total_cmp).unwrap();
        assert!(skew < 1e-6, "{skew}");
    }

    #[test]
    fn a_cut_off_above_half_the_sample_rate_is_none() {
        assert!(LowPass::new(50.0, 100.0).is_none() && LowPass::new(0.0, 100.0).is_none());
        let short = &mut [1.0, 2.0];
        LowPass::new(1.0, 100.0).unwrap().zero_phase(short);
        assert!(short.iter().all(|x| x.is_finite()));
    }

    #[test]
    fn a_line_passes_unchanged() {
        let filter = LowPass::new(5.0, 100.0).unwrap();
        let mut line: Vec<f64> = (0..200).map(|k| 3.0 + 0.1 * k as f64).collect();
        let before = line.clone();
        filter.zero_phase(&mut line);
        let change = |k: usize| (line[k] - before[k]).abs();
        assert!((0..200).all(|k| change(k) < 1e-3)); // transients at the ends
        assert!((60..140).all(|k| change(k) < 1e-6)); // three periods away from the ends
    }
}
