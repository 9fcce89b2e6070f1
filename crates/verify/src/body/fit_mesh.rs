//! A capsule around the vertices of a mesh.

use core::f64::consts::PI;

use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use reachtube_scalar::Interval;

use crate::kinematics::vector::{Vector, add, norm, point, scaled, sub};

/// Rounds in which the centre of a circle around points is improved.
const ROUNDS: usize = 100;

/// A segment and its radius.
pub(super) type Fitted = ([f64; 3], [f64; 3], f64);

/// Returns ends and radius of a capsule that contains points: of those along the principal axes of
/// the points, the one with the smallest volume. The radius is about the smallest for its axis, and
/// the segment the shortest for its radius.
///
/// # Guarantee
///
/// Outer, directed rounding, for the points and, since a capsule is convex, for all triangles
/// between them.
pub(super) fn capsule_around(points: &[Vector]) -> Fitted {
    let middles: Vec<Vector3<f64>> =
        points.iter().map(|p| Vector3::from(p.map(Interval::mid))).collect();
    let mean = middles.iter().sum::<Vector3<f64>>() / middles.len() as f64;
    let spread = middles.iter().map(|p| (p - mean) * (p - mean).transpose()).sum::<Matrix3<f64>>();
    let axes = SymmetricEigen::new(spread).eigenvectors;
    let candidates = (0..3).map(|i| {
        let [from, to] = along(&middles, axes.column(i).into_owned());
        (from, to, radius(points, from, to))
    });
    let volume = |(from, to, r): &Fitted| {
        let length = (Vector3::from(*to) - Vector3::from(*from)).norm();
        PI * r * r * (length + 4.0 / 3.0 * r)
    };
    let smallest = candidates.min_by(|a, b| volume(a).total_cmp(&volume(b)));
    smallest.expect("there are three axes")
}

/// Returns the ends of a segment with a direction, in floating point.
fn along(points: &[Vector3<f64>], axis: Vector3<f64>) -> [[f64; 3]; 2] {
    let across = if axis.x.abs() < 0.8 { Vector3::x() } else { Vector3::y() };
    let u = axis.cross(&across).normalize();
    let v = axis.cross(&u);
    let flat: Vec<[f64; 2]> = points.iter().map(|p| [u.dot(p), v.dot(p)]).collect();
    let centre = centre_of(&flat);
    let away = |p: &[f64; 2]| (p[0] - centre[0]).hypot(p[1] - centre[1]);
    let radius = flat.iter().map(away).fold(0.0, f64::max);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (p, flat) in points.iter().zip(&flat) {
        // The end may be this far from the point's own place along the axis.
        let room = (radius * radius - away(flat).powi(2)).max(0.0).sqrt();
        high = high.max(axis.dot(p) - room);
        low = low.min(axis.dot(p) + room);
    }
    if low > high {
        (low, high) = (0.5 * (low + high), 0.5 * (low + high));
    }
    let middle = centre[0] * u + centre[1] * v;
    [low, high].map(|t| (middle + t * axis).into())
}

/// Returns the centre of a small circle around points: each round goes a part of the way to the
/// point that is furthest away (Badoiu and Clarkson 2003).
fn centre_of(points: &[[f64; 2]]) -> [f64; 2] {
    let mut centre = points[0];
    for round in 1..=ROUNDS {
        let away = |p: &&[f64; 2]| (p[0] - centre[0]).hypot(p[1] - centre[1]);
        let Some(far) = points.iter().max_by(|a, b| away(a).total_cmp(&away(b))) else { break };
        let part = 1.0 / (round as f64 + 1.0);
        centre = [0, 1].map(|i| centre[i] + part * (far[i] - centre[i]));
    }
    centre
}

/// Bounds the largest distance of points from a segment.
///
/// # Guarantee
///
/// An upper bound, directed rounding: the distance from any point of the segment is one.
fn radius(points: &[Vector], from: [f64; 3], to: [f64; 3]) -> f64 {
    let between = Vector3::from(to) - Vector3::from(from);
    let (start, exact) = (point(from), sub(&point(to), &point(from)));
    let away = |p: &Vector| {
        let lever = Vector3::from(p.map(Interval::mid)) - Vector3::from(from);
        let part = lever.dot(&between) / between.norm_squared();
        let part = if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) };
        norm(&sub(p, &add(&start, &scaled(&exact, Interval::point(part)))))
    };
    points.iter().map(away).fold(0.0, f64::max)
}
