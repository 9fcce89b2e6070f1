use nalgebra::DMatrix;

/// Samples that an estimate needs at least.
const FEWEST: usize = 5;

/// Estimates the acceleration of a joint at its last sample from the samples before it, and nothing
/// later: by least squares, recorded velocities follow a parabola; where there are none, positions
/// follow a cubic.
#[derive(Debug)]
pub(super) struct Past {
    /// The weights of the velocities, or of the positions, the oldest first.
    weights: Vec<f64>,
}

impl Past {
    /// Makes the estimate from `span` \[s\] of samples that are `step` \[s\] apart.
    pub(super) fn new(span: f64, step: f64, has_velocities: bool) -> Self {
        let count = ((span / step).round() as usize + 1).max(FEWEST);
        let time = |k: usize| (k + 1) as f64 - count as f64;
        let (degree, power, factor) =
            if has_velocities { (2, 1, step.recip()) } else { (3, 2, 2.0 * step.powi(-2)) };
        let powers = DMatrix::from_fn(count, degree + 1, |k, power| time(k).powi(power as i32));
        let inverse = powers.svd(true, true).pseudo_inverse(0.0);
        let inverse = inverse.expect("both factors were computed");
        Self { weights: inverse.row(power).iter().map(|weight| factor * weight).collect() }
    }

    /// Returns the acceleration at the last of some velocities or positions; 0 of too few.
    pub(super) fn acceleration(&self, values: &[f64]) -> f64 {
        let Some(first) = values.len().checked_sub(self.weights.len()) else { return 0.0 };
        self.weights.iter().zip(&values[first..]).map(|(weight, value)| weight * value).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_acceleration_of_a_cubic_is_known_from_its_past() {
        let step = 0.01;
        let at = |k: usize| 0.3 + step * k as f64;
        let position = |k: usize| 1.0 - 2.0 * at(k) + 0.5 * at(k).powi(2) + 3.0 * at(k).powi(3);
        let velocity = |k: usize| -2.0 + at(k) + 9.0 * at(k).powi(2);
        let q: Vec<f64> = (0..30).map(position).collect();
        let qd: Vec<f64> = (0..30).map(velocity).collect();
        for (values, has_velocities) in [(&q, false), (&qd, true)] {
            let past = Past::new(0.17, step, has_velocities);
            let error = past.acceleration(values) - (1.0 + 18.0 * at(29));
            assert!(error.abs() < 1e-8, "{error}");
            assert_eq!(past.acceleration(&values[..3]), 0.0);
        }
    }
}
