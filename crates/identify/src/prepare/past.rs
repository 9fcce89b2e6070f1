use nalgebra::DMatrix;

/// Periods of the cut-off over which samples tell the state at the last of them. Over fewer, noise
/// decides, and over more, what a parabola does not follow.
const PERIODS: f64 = 0.5;

/// Samples that an estimate needs at least.
const FEWEST: usize = 5;

/// Estimates position, velocity and acceleration of a joint at its last sample from that sample and
/// the ones before it, and nothing later: by least squares, recorded velocities follow a parabola,
/// and positions its integral; where there are no velocities, positions follow a cubic.
#[derive(Debug, Clone)]
pub(super) struct Past {
    /// The weights of the velocities, or of the positions, in the coefficients of the polynomial,
    /// the oldest sample first.
    weights: DMatrix<f64>,
    has_velocities: bool,
    step: f64,
}

impl Past {
    /// Makes the estimate for a low-pass of cut-off `cut_off` \[Hz\], of samples that are `step`
    /// \[s\] apart.
    pub(super) fn new(cut_off: f64, step: f64, has_velocities: bool) -> Self {
        let count = ((PERIODS / (cut_off * step)).round() as usize + 1).max(FEWEST);
        let degree = if has_velocities { 2 } else { 3 };
        let time = |k: usize| (k + 1) as f64 - count as f64;
        let powers = DMatrix::from_fn(count, degree + 1, |k, power| time(k).powi(power as i32));
        let inverse = powers.svd(true, true).pseudo_inverse(0.0);
        Self { weights: inverse.expect("both factors were computed"), has_velocities, step }
    }

    pub(super) fn samples(&self) -> usize {
        self.weights.ncols()
    }

    /// Returns position, velocity and acceleration at the last of as many samples as an estimate
    /// has, whose positions and velocities are given, the oldest first. Without velocities, the
    /// positions alone tell.
    pub(super) fn at_last(&self, q: impl Fn(usize) -> f64, qd: impl Fn(usize) -> f64) -> [f64; 3] {
        let (count, step) = (self.samples(), self.step);
        let coefficient = |power: usize| -> f64 {
            let value = |k: usize| if self.has_velocities { qd(k) } else { q(k) };
            let weights = self.weights.row(power);
            weights.iter().enumerate().map(|(k, weight)| weight * value(k)).sum()
        };
        if !self.has_velocities {
            let [q, qd, half] = [0, 1, 2].map(coefficient);
            return [q, qd / step, 2.0 * half * step.powi(-2)];
        }
        let [qd, slope, curve] = [0, 1, 2].map(coefficient);
        // How far the joint has moved, from the integral of the velocity, at each sample.
        let moved = |k: usize| {
            let time = (k + 1) as f64 - count as f64;
            step * time * (qd + time * (0.5 * slope + time * curve / 3.0))
        };
        let start = (0..count).map(|k| q(k) - moved(k)).sum::<f64>();
        [start / count as f64, qd, slope / step]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_state_and_acceleration_of_a_cubic_are_known_from_its_past() {
        let step = 0.01;
        let at = |k: usize| 0.3 + step * k as f64;
        let position = |k: usize| 1.0 - 2.0 * at(k) + 0.5 * at(k).powi(2) + 3.0 * at(k).powi(3);
        let velocity = |k: usize| -2.0 + at(k) + 9.0 * at(k).powi(2);
        let q: Vec<f64> = (0..30).map(position).collect();
        let qd: Vec<f64> = (0..30).map(velocity).collect();
        for has_velocities in [false, true] {
            let past = Past::new(3.0, step, has_velocities);
            let first = q.len() - past.samples();
            let found = past.at_last(|k| q[first + k], |k| qd[first + k]);
            for (found, known) in found.iter().zip([q[29], qd[29], 1.0 + 18.0 * at(29)]) {
                assert!((found - known).abs() < 1e-8, "{found} {known}");
            }
        }
    }
}
