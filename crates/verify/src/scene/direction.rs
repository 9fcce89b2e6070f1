//! The direction from a solid to a segment, in floating point. Any direction gives a proved bound;
//! the one between the closest points gives the best.

use nalgebra::Vector3;

use crate::scene::obstacle::Solid;

type Point = Vector3<f64>;

/// Bisections of the position of the closest point on a segment.
const BISECTIONS: usize = 50;

/// Returns the vector from the point of a solid (a capsule without its radius) to the point of a
/// segment that are closest, or some vector if they touch.
pub(crate) fn direction(segment: [[f64; 3]; 2], solid: &Solid) -> [f64; 3] {
    let [a, b] = segment.map(Point::from);
    let (between, centre) = match solid {
        Solid::HalfSpace { normal, .. } => return *normal,
        Solid::Box { centre, axes, half } => (from_box([a, b], *centre, *axes, *half), *centre),
        Solid::Capsule { from, to, .. } => {
            let ends = [*from, *to].map(Point::from);
            (between_segments([a, b], ends), (0.5 * (ends[0] + ends[1])).into())
        }
    };
    let middle = 0.5 * (a + b) - Point::from(centre);
    let candidates = [between, middle, Point::z()];
    let found = candidates.into_iter().find(|v| v.norm() > 1e-9).unwrap_or(Point::z());
    found.into()
}

/// Returns the vector from the closest point of a box to the closest point of a segment. The
/// distance is convex along the segment, so the sign of its slope bisects.
fn from_box([a, b]: [Point; 2], centre: [f64; 3], axes: [[f64; 3]; 3], half: [f64; 3]) -> Point {
    let (centre, axes) = (Point::from(centre), axes.map(Point::from));
    let beyond = |p: Point| {
        let outside = |i: usize| {
            let along = (p - centre).dot(&axes[i]);
            (along - along.clamp(-half[i], half[i])) * axes[i]
        };
        outside(0) + outside(1) + outside(2)
    };
    let at = |t: f64| a + t * (b - a);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if beyond(at(middle)).dot(&(b - a)) > 0.0 { high = middle } else { low = middle }
    }
    let ends = [low, high, 0.0, 1.0].map(|t| beyond(at(t)));
    ends.into_iter().min_by(|v, w| v.norm().total_cmp(&w.norm())).unwrap_or_default()
}

/// Returns the vector between the closest points of two segments, from `c` to `s` (Ericson,
/// Real-Time Collision Detection, section 5.1.9).
fn between_segments(s: [Point; 2], c: [Point; 2]) -> Point {
    let (d, e, r) = (s[1] - s[0], c[1] - c[0], s[0] - c[0]);
    let (dd, ee, de) = (d.norm_squared(), e.norm_squared(), d.dot(&e));
    let (dr, er) = (d.dot(&r), e.dot(&r));
    let denominator = dd * ee - de * de;
    let part = |numerator: f64, length: f64| {
        if length > 0.0 { (numerator / length).clamp(0.0, 1.0) } else { 0.0 }
    };
    let first =
        if denominator > 1e-12 * dd * ee { part(de * er - dr * ee, denominator) } else { 0.0 };
    let along_c = part(de * first + er, ee);
    let along_s = part(de * along_c - dr, dd);
    r + along_s * d - along_c * e
}
