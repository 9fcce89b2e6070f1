use nalgebra::DMatrix;

/// Samples that an estimate needs at least.
const FEWEST: usize = 5;

/// Estimates the position, the velocity and the acceleration of a joint at its last sample from the
/// samples before it, and nothing later: a curve is fitted to them by least squares.
///
/// Velocities that were recorded follow a parabola, and the positions are its integral. Where there
/// are none, positions follow a cubic.
#[derive(Debug)]
pub(super) struct Past {
    /// For each of the three, the weights of the positions and of the velocities, the oldest first.
    weights: [[Vec<f64>; 2]; 3],
}

impl Past {
    /// Makes the estimates from `span` \[s\] of samples that are `step` \[s\] apart.
    pub(super) fn new(span: f64, step: f64, has_velocities: bool) -> Self {
        let count = ((span / step).round() as usize + 1).max(FEWEST);
        let times: Vec<f64> = (0..count).map(|k| (k + 1) as f64 - count as f64).collect();
        let degree = if has_velocities { 2 } else { 3 };
        let powers = DMatrix::from_fn(count, degree + 1, |k, power| times[k].powi(power as i32));
        let inverse = powers.svd(true, true).pseudo_inverse(0.0);
        let inverse = inverse.expect("both factors were computed");
        let row = |power: usize, factor: f64| -> Vec<f64> {
            inverse.row(power).iter().map(|weight| factor * weight).collect()
        };
        let none = || vec![0.0; count];
        let weights = match has_velocities {
            false => [
                [row(0, 1.0), none()],
                [row(1, step.recip()), none()],
                [row(2, 2.0 * step.powi(-2)), none()],
            ],
            true => {
                // The position is the mean of what each sample says of it.
                let mean = |power: i32| {
                    let integrals = times.iter().map(|time| time.powi(power) / f64::from(power));
                    step * integrals.sum::<f64>() / count as f64
                };
                let [a, b, c] = [(0, mean(1)), (1, mean(2)), (2, mean(3))].map(|(p, m)| row(p, -m));
                let moved = a.iter().zip(&b).zip(&c).map(|((a, b), c)| a + b + c).collect();
                [
                    [vec![(count as f64).recip(); count], moved],
                    [none(), row(0, 1.0)],
                    [none(), row(1, step.recip())],
                ]
            }
        };
        Self { weights }
    }

    /// Returns the position, velocity and acceleration at the last sample. Too few samples tell the
    /// last ones, and no acceleration.
    pub(super) fn estimate(&self, q: &[f64], qd: &[f64]) -> [f64; 3] {
        let count = self.weights[0][0].len();
        if q.len() < count {
            let last = |values: &[f64]| values.last().copied().unwrap_or_default();
            return [last(q), last(qd), 0.0];
        }
        let sum = |weights: &[f64], values: &[f64]| -> f64 {
            let recent = &values[values.len() - count..];
            weights.iter().zip(recent).map(|(weight, value)| weight * value).sum()
        };
        self.weights.each_ref().map(|[of_q, of_qd]| sum(of_q, q) + sum(of_qd, qd))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_known_from_its_past() {
        let step = 0.01;
        let at = |k: usize| 0.3 + step * k as f64;
        let position = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t + 3.0 * t.powi(3);
        let velocity = |t: f64| -2.0 + t + 9.0 * t * t;
        let q: Vec<f64> = (0..30).map(|k| position(at(k))).collect();
        let qd: Vec<f64> = (0..30).map(|k| velocity(at(k))).collect();
        let last = at(29);
        let expected = [position(last), velocity(last), 1.0 + 18.0 * last];
        let close = |found: [f64; 3]| {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
        };
        close(Past::new(0.17, step, true).estimate(&q, &qd));
        let past = Past::new(0.17, step, false);
        close(past.estimate(&q, &[0.0; 30]));
        assert_eq!(past.estimate(&q[..3], &qd[..3]), [q[2], qd[2], 0.0]);
    }
}
