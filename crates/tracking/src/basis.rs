//! What a controller's error may depend on: the command's speed and acceleration.

use std::ops::{Add, Div, Mul, Sub};

use reachtube_scalar::Interval;

/// The terms that a nominal error may have: 1, ṙ, r̈ and the direction of the command.
pub(crate) const TERMS: usize = 4;

/// A command has a direction if it is faster than this part of the joint's highest speed. Below it,
/// the direction grows in proportion to the speed.
const SLOW: f64 = 0.02;

/// Returns ṙ and r̈ of a command at sample `k` of 3 or more: of the parabola through the sample and
/// its neighbours, of which the nearer counts more. At an end, ṙ is the mean speed of the step, and
/// r̈ is the neighbour's.
pub(crate) fn rates<T>(k: usize, times: &[f64], command: impl Fn(usize) -> T) -> [T; 2]
where
    T: Copy + From<f64> + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T>,
{
    let middle = k.clamp(1, times.len() - 2);
    let at = |k: usize| (T::from(times[k]), command(k));
    let [(t0, r0), (t1, r1), (t2, r2)] = [middle - 1, middle, middle + 1].map(at);
    let [before, after] = [(r1 - r0) / (t1 - t0), (r2 - r1) / (t2 - t1)];
    let acceleration = T::from(2.0) * (after - before) / (t2 - t0);
    let speed = match k {
        0 => before,
        _ if k == times.len() - 1 => after,
        _ => (before * (t2 - t1) + after * (t1 - t0)) / (t2 - t0),
    };
    [speed, acceleration]
}

/// Returns the direction of a command: -1 to 1.
pub(crate) fn direction(speed: f64, largest_speed: f64) -> f64 {
    if largest_speed > 0.0 { (speed / (SLOW * largest_speed)).clamp(-1.0, 1.0) } else { 0.0 }
}

/// Encloses the direction of a command.
///
/// # Guarantee
///
/// Outer, directed rounding: the quotient is enclosed, and the limits are exact.
pub(crate) fn enclosed_direction(speed: Interval, largest_speed: f64) -> Interval {
    if largest_speed <= 0.0 {
        return Interval::ZERO;
    }
    let quotient = speed / (Interval::point(SLOW) * largest_speed);
    let [lo, hi] = [quotient.lo(), quotient.hi()].map(|end| end.clamp(-1.0, 1.0));
    Interval::new(lo, hi).unwrap_or(Interval::ENTIRE)
}

/// Returns the command of a delay before \[s\], row-major K x n: straight between samples, and at
/// rest before the first one. It is defined as it is computed, in double precision.
pub(crate) fn delayed(times: &[f64], command: &[f64], delay: f64) -> Vec<f64> {
    if delay == 0.0 {
        return command.to_vec();
    }
    let n = command.len() / times.len();
    let late = |k: usize| {
        let place = before(times, delay, k);
        (0..n).map(move |joint| at_place(command, n, place, joint))
    };
    (0..times.len()).flat_map(late).collect()
}

/// Returns where a delay before sample `k` lies: a sample, and the part of the way to the next one.
pub(crate) fn before(times: &[f64], delay: f64, k: usize) -> (usize, f64) {
    let at = (times[k] - delay).max(times[0]);
    let sample = times[..=k].partition_point(|time| *time <= at).max(1) - 1;
    let sample = sample.min(times.len() - 2);
    (sample, ((at - times[sample]) / (times[sample + 1] - times[sample])).clamp(0.0, 1.0))
}

/// Returns the command of a joint at a place that [`before`] returned.
pub(crate) fn at_place(
    command: &[f64],
    n: usize,
    (sample, part): (usize, f64),
    joint: usize,
) -> f64 {
    let [here, next] = [sample, sample + 1].map(|k| command[k * n + joint]);
    between(here, next, part)
}

/// Returns the command at a part of the way from one sample to the next.
pub(crate) fn between(here: f64, next: f64, part: f64) -> f64 {
    if part == 0.0 { here } else { here + part * (next - here) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_delayed_command_is_straight_between_samples() {
        let times = [0.0, 1.0, 2.0, 4.0];
        let command = [0.0, 5.0, 2.0, 5.0, 4.0, 5.0, 0.0, 5.0];
        assert_eq!(delayed(&times, &command, 0.0), command);
        assert_eq!(delayed(&times, &command, 0.5), [0.0, 5.0, 1.0, 5.0, 3.0, 5.0, 1.0, 5.0]);
        assert_eq!(delayed(&times, &command, 9.0), [0.0, 5.0].repeat(4));
    }

    #[test]
    fn rates_are_exact_for_parabolas_on_any_grid() {
        let times = [0.0, 0.1, 0.25, 0.3, 0.5, 0.55, 1.0, 1.05];
        let r = |t: f64| 1.0 - 2.0 * t + 3.0 * t * t;
        let slope = |a: usize, b: usize| (r(times[b]) - r(times[a])) / (times[b] - times[a]);
        for k in 0..8 {
            let [speed, acceleration] = rates(k, &times, |k| r(times[k]));
            let expected = match k {
                0 => slope(0, 1),
                7 => slope(6, 7),
                k => 6.0 * times[k] - 2.0,
            };
            assert!((speed - expected).abs() < 1e-12 && (acceleration - 6.0).abs() < 1e-12, "{k}");
            let enclosed = rates(k, &times, |k| Interval::point(r(times[k])));
            assert!(enclosed[0].contains(speed) && enclosed[1].contains(acceleration), "{k}");
            let directed = enclosed_direction(enclosed[0], 5.0);
            assert!(directed.contains(direction(speed, 5.0)) && directed.width() < 1e-12, "{k}");
        }
        let directions = [direction(-1.0, 5.0), direction(0.05, 5.0), direction(1.0, 0.0)];
        assert_eq!(directions, [-1.0, 0.5, 0.0]);
    }
}
