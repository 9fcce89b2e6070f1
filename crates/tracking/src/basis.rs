//! What a controller's error may depend on: the command's speed and acceleration.

use std::ops::{Add, Div, Mul, Sub};

/// The most terms that a nominal error has: an offset, a lag, and one of the acceleration.
pub(crate) const TERMS: usize = 3;

/// Returns 1, ṙ and r̈ of a command at sample `k` of 3 or more: of the parabola through the sample
/// and its neighbours, or through the three samples at an end.
pub(crate) fn terms<T>(k: usize, samples: usize, at: impl Fn(usize) -> (T, T)) -> [T; TERMS]
where
    T: Copy + From<f64> + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T>,
{
    let middle = k.clamp(1, samples - 2);
    let [(t0, r0), (t1, r1), (t2, r2)] = [middle - 1, middle, middle + 1].map(&at);
    let [before, after] = [(r1 - r0) / (t1 - t0), (r2 - r1) / (t2 - t1)];
    let acceleration = T::from(2.0) * (after - before) / (t2 - t0);
    let speed = match k {
        _ if k == middle => (before * (t2 - t1) + after * (t1 - t0)) / (t2 - t0),
        0 => before,
        _ => after,
    };
    [T::from(1.0), speed, acceleration]
}

#[cfg(test)]
mod tests {
    use reachtube_scalar::Interval;

    use super::terms;

    #[test]
    fn they_are_exact_for_parabolas_on_any_grid() {
        let times = [0.0, 0.1, 0.25, 0.3, 0.5];
        let r = |t: f64| 1.0 - 2.0 * t + 3.0 * t * t;
        for (k, t) in times.into_iter().enumerate() {
            let [one, speed, acceleration] = terms(k, 5, |k| (times[k], r(times[k])));
            assert_eq!(one, 1.0);
            assert!((speed - (6.0 * t - 2.0)).abs() < 1e-12, "{k}");
            assert!((acceleration - 6.0).abs() < 1e-12, "{k}");
            let enclosed =
                terms(k, 5, |k| (Interval::point(times[k]), Interval::point(r(times[k]))));
            assert!(enclosed[1].contains(speed) && enclosed[2].contains(acceleration), "{k}");
        }
    }
}
