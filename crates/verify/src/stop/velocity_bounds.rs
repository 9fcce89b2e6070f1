//! Bounds of one velocity over a step of a differential inclusion (Müller).

use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

/// Returns an upper bound of a velocity after a step of `duration` s that begins at `upper`.
///
/// `rate` returns an upper bound of the acceleration for velocities in an interval of one sign, and
/// `range` encloses all accelerations. A line whose slope is at least the rate along itself is a
/// bound (Müller 1927). At standstill the inclusion is a set; a velocity does not rise above 0
/// while the rate at velocities just above 0 is not positive.
///
/// # Guarantee
///
/// Outer, directed rounding.
pub(super) fn upper_after(
    upper: f64,
    duration: f64,
    range: Interval,
    mut rate: impl FnMut(Interval) -> f64,
) -> f64 {
    let mut rate = |velocities| rate(velocities).min(range.hi());
    let along =
        |from: f64| Interval::point(from) + Interval::ZERO.hull(Interval::point(duration)) * range;
    let positive = Interval::new(f64::MIN_POSITIVE, f64::MAX).expect("an interval");
    let negative = Interval::new(-f64::MAX, -f64::MIN_POSITIVE).expect("an interval");
    // From above 0: along the line, and at 0 if the line gets there.
    if upper > 0.0 {
        let line = along(upper).intersection(positive).unwrap_or(positive);
        let slope = rate(line);
        let end = add_up(upper, mul_up(duration, slope));
        return if slope <= 0.0 { end.max(0.0) } else { end };
    }
    // From below 0: along the line up to 0.
    if let Some(line) = along(upper).intersection(negative).filter(|_| upper < 0.0) {
        let end = add_up(upper, mul_up(duration, rate(line)));
        if end <= 0.0 {
            return end;
        }
    }
    // At 0: below it if every torque of standstill leads there.
    if upper == 0.0 {
        let below = Interval::point(0.0).hull(Interval::point(along(0.0).lo().min(0.0)));
        let slope = rate(below).max(range.lo());
        if slope < 0.0 {
            return mul_up(duration, slope);
        }
    }
    // Where the line crosses 0, or at 0: what a positive velocity would do from there.
    let line = along(0.0).intersection(positive).unwrap_or(positive);
    mul_up(duration, rate(line)).max(0.0)
}

/// Returns a lower bound of a velocity after a step, as [`upper_after`] does; `rate` returns a
/// lower bound of the acceleration.
pub(super) fn lower_after(
    lower: f64,
    duration: f64,
    range: Interval,
    mut rate: impl FnMut(Interval) -> f64,
) -> f64 {
    -upper_after(-lower, duration, -range, |velocities| -rate(-velocities))
}

/// Returns an upper bound of the way in a step between two upper bounds of the velocity, before
/// and after. A bound that falls to 0 and stays there lies below its chord.
pub(super) fn upper_way(before: f64, after: f64, duration: f64) -> f64 {
    let mean = if before > 0.0 { mul_up(0.5, add_up(before, after)) } else { before.max(after) };
    mul_up(duration, mean)
}

/// Returns a lower bound of the way, as [`upper_way`].
pub(super) fn lower_way(before: f64, after: f64, duration: f64) -> f64 {
    -upper_way(-before, -after, duration)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brake_stops_a_mass_and_does_not_push_it_back() {
        // v̇ = -sgn(v) [2, 3] + [-0.5, 0.5].
        let range = Interval::new(-3.5, 3.5).unwrap();
        let rate = |v: Interval| if v.lo() > 0.0 { -1.5 } else { 3.5 };
        let after = |v: f64, h: f64| upper_after(v, h, range, rate);
        assert!((after(1.0, 0.1) - 0.85).abs() < 1e-12);
        assert_eq!((after(0.1, 0.1), after(0.0, 0.1)), (0.0, 0.0));
        assert_eq!(after(-0.1, 0.1), 0.0);
        assert!((after(-1.0, 0.1) + 0.65).abs() < 1e-12);
        let lowest = |v: Interval| if v.lo() > 0.0 { -3.5 } else { 1.5 };
        assert_eq!(lower_after(0.1, 0.1, range, lowest), 0.0);
        assert!((lower_after(1.0, 0.1, range, lowest) - 0.65).abs() < 1e-12);
    }

    #[test]
    fn a_push_moves_a_bound_away_from_standstill() {
        let range = Interval::new(-4.0, -1.0).unwrap();
        assert!((upper_after(0.0, 0.1, range, |_| -1.0) + 0.1).abs() < 1e-12);
        // Friction that may hold the mass keeps the bound.
        let held = |v: Interval| if v.contains(0.0) { 1.0 } else { -1.0 };
        let range = Interval::new(-4.0, 1.0).unwrap();
        assert_eq!(upper_after(0.0, 0.1, range, held), 0.0);
    }

    #[test]
    fn a_load_above_the_brake_torque_moves_the_mass() {
        let range = Interval::new(-4.0, 4.0).unwrap();
        assert!((upper_after(0.0, 0.1, range, |_| 1.0) - 0.1).abs() < 1e-12);
        assert!(
            (upper_after(-0.1, 0.1, range, |v| if v.hi() < 0.0 { 4.0 } else { 1.0 }) - 0.1).abs()
                < 1e-12
        );
    }
}
