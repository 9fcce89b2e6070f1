//! Bounds of sin d and 1 - cos d over an interval of offsets d, and of their distance from a line.

use reachtube_scalar::Interval;

/// Encloses σ = sin d and κ = 1 - cos d for offsets d.
///
/// # Guarantee
///
/// Outer, directed rounding; the ends exceed [-1, 1] and [0, 2] by rounding at most.
pub(crate) fn sine_and_versine(d: Interval) -> (Interval, Interval) {
    (d.sin(), (d * 0.5).sin().sqr() * 2.0)
}

/// Returns the approximate middle of κ over |d| <= r.
pub(crate) fn versine_middle(r: f64) -> f64 {
    (0.5 * r.min(std::f64::consts::PI)).sin().powi(2)
}

/// Returns the approximate slope of the line that fits sin d best over |d| <= r.
///
/// It is the slope 2 J₁(r)/r of the first Chebyshev polynomial, or 0 where that is negative.
pub(crate) fn sine_slope(r: f64) -> f64 {
    let x = (0.5 * r).powi(2);
    if r < 3.8 {
        1.0 - x / 2.0 * (1.0 - x / 6.0 * (1.0 - x / 12.0 * (1.0 - x / 20.0)))
    } else {
        0.0
    }
    .max(0.0)
}

/// Encloses sin d - slope d for offsets d and a slope from 0 to 1.
///
/// # Guarantee
///
/// Outer, directed rounding.
pub(crate) fn sine_defect(d: Interval, slope: f64) -> Interval {
    let half = |lo: f64, hi: f64| {
        let side = Interval::new(lo.max(0.0), hi).filter(|_| hi >= 0.0)?;
        Some(if hi < 3.0 { concave_defect(side, slope) } else { side.sin() - side * slope })
    };
    let (above, below) = (half(d.lo(), d.hi()), half(-d.hi(), -d.lo()).map(|x| -x));
    above.into_iter().chain(below).reduce(Interval::hull).unwrap_or(Interval::ENTIRE)
}

/// Encloses sin d - slope d over a side in \[0, π\].
///
/// The function is concave there: it lies above the smaller value at the ends and below every
/// tangent.
fn concave_defect(side: Interval, slope: f64) -> Interval {
    let value = |d: f64| Interval::point(d).sin() - Interval::point(d) * slope;
    let top = slope.clamp(-1.0, 1.0).acos().clamp(side.lo(), side.hi());
    let tilt = Interval::point(top).cos() - slope;
    let highest = value(top) + tilt * (side - top);
    value(side.lo()).hull(value(side.hi())).hull(Interval::point(highest.hi()))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_defect_encloses_the_distance_from_the_line(
            lo in -4.0..4.0_f64, width in 0.0..4.0_f64, slope in 0.0..1.0_f64, at in 0.0..=1.0_f64,
        ) {
            let side = Interval::new(lo, lo + width).unwrap();
            let defect = sine_defect(side, slope);
            let d = (lo + at * width).clamp(lo, lo + width);
            let value = d.sin() - slope * d;
            prop_assert!(
                defect.lo() - 1e-15 <= value && value <= defect.hi() + 1e-15, "{defect:?} {value}"
            );
            if side.mag() < 3.0 {
                let points = (0..=1000).map(|k| lo + f64::from(k) * 1e-3 * width);
                let (low, high) = points
                    .map(|d| d.sin() - slope * d)
                    .fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
                prop_assert!(defect.width() <= high - low + 1e-5);
            }
        }
    }

    #[test]
    fn the_best_line_is_within_a_quarter_of_the_cubic_term() {
        for r in [1e-3, 0.1, 0.5, 1.0, 2.0] {
            let defect = sine_defect(Interval::new(-r, r).unwrap(), sine_slope(r));
            assert!(defect.mag() < 1.1 * r.powi(3) / 24.0, "{r}: {defect:?}");
        }
        assert_eq!(sine_slope(5.0), 0.0);
        let (sine, versine) = sine_and_versine(Interval::new(-9.0, 9.0).unwrap());
        assert!(
            (sine.mag(), versine.lo()) == (1.0, 0.0) && (2.0..2.0 + 1e-14).contains(&versine.hi())
        );
    }
}
