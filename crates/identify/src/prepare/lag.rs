//! Velocities that lag the positions they belong to, for example because the robot filters them.

use crate::prepare::derivative::derivative;

/// A lag must explain this part of what the two velocities differ by.
const LEAST_EXPLAINED: f64 = 0.3;

/// How much later a velocity is than the slope of its position.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lag {
    /// The lag \[s\]; negative for a velocity that comes earlier.
    time: f64,
    /// The part of the squared difference that it explains.
    explained: f64,
}

impl Lag {
    /// Returns the lag of the velocity `qd` behind the slope of the position `q`, both filtered and
    /// sampled every `step` \[s\], by least squares: the slope is qd + lag · q̈. The result is
    /// `None` for a joint at rest.
    pub(super) fn of_joint(q: &[f64], qd: &[f64], step: f64) -> Option<Self> {
        let (slope, acceleration) = (derivative(q, step), derivative(qd, step));
        let [mut product, mut square, mut difference] = [0.0; 3];
        for ((slope, qd), acceleration) in slope.iter().zip(qd).zip(&acceleration) {
            product += (slope - qd) * acceleration;
            square += acceleration * acceleration;
            difference += (slope - qd).powi(2);
        }
        let explained = product * product / (square * difference);
        explained.is_finite().then_some(Self { time: product / square, explained })
    }

    /// Returns whether velocities of these lags contradict their positions: half of the joints lag
    /// by more than a sample time, which explains the differences.
    pub(super) fn contradict(lags: &[Self], step: f64) -> bool {
        let lags_behind = |lag: &&Self| lag.time.abs() > step && lag.explained > LEAST_EXPLAINED;
        let count = lags.iter().filter(lags_behind).count();
        count > 0 && 2 * count >= lags.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lag(late: f64) -> Lag {
        let times = (0..4000).map(|k| 1e-3 * f64::from(k));
        let (q, qd): (Vec<f64>, Vec<f64>) =
            times.map(|t| ((2.0 * t).sin(), 2.0 * (2.0 * (t - late)).cos())).unzip();
        Lag::of_joint(&q, &qd, 1e-3).unwrap()
    }

    #[test]
    fn a_filtered_velocity_lags_and_another_does_not() {
        let late = lag(0.005);
        assert!((late.time - 0.005).abs() < 1e-4 && late.explained > 0.9, "{late:?}");
        assert!(Lag::contradict(&[late, late], 1e-3));
        assert!(!Lag::contradict(&[late, late], 0.01));
        assert!(!Lag::contradict(&[lag(0.0005), lag(0.0)], 1e-3));
        assert!(Lag::of_joint(&[1.0; 50], &[0.0; 50], 1e-3).is_none());
    }
}
