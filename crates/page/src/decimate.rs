//! Thinning of a line to what a plot can show, without losing an excursion.

/// A point (time \[s\], value).
pub(super) type Point = (f64, f64);

/// Thins a line to the samples that a plot can show.
///
/// From every column of width `column` (in time) it takes the lowest and the highest sample. Then
/// it drops the samples that a straight line already passes within `tolerance` (in value). Times
/// must strictly increase.
///
/// # Guarantee
///
/// Every point kept is a sample. In every column the line reaches the lowest and the highest sample
/// within `tolerance`, plus the rounding of one linear interpolation.
pub(super) fn decimate(points: &[Point], column: f64, tolerance: f64) -> Vec<Point> {
    straighten(&extremes(points, column), tolerance)
}

/// Returns the lowest and the highest sample of every column, in the order of time, and both ends.
fn extremes(points: &[Point], column: f64) -> Vec<Point> {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let index = |point: &Point| ((point.0 - first.0) / column).floor();
    let mut kept = vec![first];
    let mut keep = |point: Point| {
        if kept.last().is_none_or(|end| end.0 < point.0) {
            kept.push(point);
        }
    };
    for group in points.chunk_by(|a, b| index(a) == index(b)) {
        let (low, high) = low_and_high(group);
        keep(if low.0 < high.0 { low } else { high });
        keep(if low.0 < high.0 { high } else { low });
    }
    keep(last);
    kept
}

fn low_and_high(group: &[Point]) -> (Point, Point) {
    group.iter().fold((group[0], group[0]), |(low, high), &point| {
        (if point.1 < low.1 { point } else { low }, if point.1 > high.1 { point } else { high })
    })
}

/// Drops the points that the line between their kept neighbours passes within `tolerance`.
///
/// Every point passed narrows the slopes that a line from the last kept point may have. A point
/// outside these slopes ends the line, and the next line starts at the point before it.
fn straighten(points: &[Point], tolerance: f64) -> Vec<Point> {
    let Some((&first, rest)) = points.split_first() else {
        return Vec::new();
    };
    let mut kept = vec![first];
    let (mut anchor, mut end) = (first, first);
    let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
    for &point in rest {
        let slope = (point.1 - anchor.1) / (point.0 - anchor.0);
        if !(least..=most).contains(&slope) {
            kept.push(end);
            anchor = end;
            (least, most) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        let (dt, dy) = (point.0 - anchor.0, point.1 - anchor.1);
        least = least.max((dy - tolerance) / dt);
        most = most.min((dy + tolerance) / dt);
        end = point;
    }
    if !rest.is_empty() {
        kept.push(end);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn drawn(line: &[Point], time: f64) -> f64 {
        let after = line.partition_point(|point| point.0 < time).clamp(1, line.len() - 1);
        let (a, b) = (line[after - 1], line[after]);
        a.1 + (b.1 - a.1) * ((time - a.0) / (b.0 - a.0))
    }

    fn walk() -> impl Strategy<Value = Vec<Point>> {
        let step = (1e-4..0.1_f64, prop_oneof![8 => -0.01..0.01_f64, 1 => -5.0..5.0_f64]);
        prop::collection::vec(step, 2..400).prop_map(|steps| {
            let mut at = (0.0, 0.0);
            let mut next = |(dt, value): (f64, f64)| {
                at = (at.0 + dt, value);
                at
            };
            steps.into_iter().map(&mut next).collect()
        })
    }

    proptest! {
        #[test]
        fn every_excursion_is_kept(
            points in walk(),
            column in 1e-3..1.0_f64,
            tolerance in 0.0..0.1_f64,
        ) {
            let line = decimate(&points, column, tolerance);
            let slack = tolerance + 1e-12;
            for group in points.chunk_by(|a, b| {
                let index = |p: &Point| ((p.0 - points[0].0) / column).floor();
                index(a) == index(b)
            }) {
                let (low, high) = low_and_high(group);
                prop_assert!(drawn(&line, low.0) <= low.1 + slack);
                prop_assert!(drawn(&line, high.0) >= high.1 - slack);
            }
        }

        #[test]
        fn kept_points_are_samples_in_order(
            points in walk(),
            column in 1e-3..1.0_f64,
            tolerance in 0.0..0.1_f64,
        ) {
            let line = decimate(&points, column, tolerance);
            prop_assert!(line.iter().all(|point| points.contains(point)));
            prop_assert!(line.windows(2).all(|pair| pair[0].0 < pair[1].0));
            let ends = |line: &[Point]| (line[0], line[line.len() - 1]);
            prop_assert_eq!(ends(&line), ends(&points));
        }

        #[test]
        fn the_size_is_bounded_by_the_columns(points in walk(), column in 1e-2..1.0_f64) {
            let span = points[points.len() - 1].0 - points[0].0;
            let columns = (span / column).floor() as usize + 1;
            prop_assert!(decimate(&points, column, 0.0).len() <= 2 * columns + 2);
        }
    }

    #[test]
    fn a_straight_line_needs_its_ends_only() {
        let points: Vec<Point> =
            (0..1000).map(|k| (f64::from(k) * 0.004, f64::from(k) * 0.1)).collect();
        assert_eq!(decimate(&points, 0.001, 1e-6), [points[0], points[999]]);
    }

    #[test]
    fn one_spike_among_thousands_is_kept() {
        let mut points: Vec<Point> = (0..10_000).map(|k| (f64::from(k) * 1e-3, 0.0)).collect();
        points[4321].1 = 1.0;
        assert!(decimate(&points, 0.1, 1e-3).contains(&points[4321]));
    }

    #[test]
    fn a_single_sample_stays_single() {
        assert_eq!(decimate(&[(0.0, 1.0)], 0.1, 0.1), [(0.0, 1.0)]);
        assert!(decimate(&[], 0.1, 0.1).is_empty());
    }
}
