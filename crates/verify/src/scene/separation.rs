//! Proved distances between a capsule and an obstacle.

use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up, sub_down};

use crate::kinematics::vector::{Vector, dot, point};
use crate::scene::direction::direction;
use crate::scene::obstacle::{Obstacle, Solid};

/// Returns a lower bound of the distance in m between the capsules of a link and an obstacle that
/// has grown until `time` (s); negative if a distance above 0 is not proved.
///
/// `lowest` returns a lower bound of n · p over all points p of the segments of the capsules, which
/// lie near `segment`; `radius` is the radius of the capsules. For any direction n, two convex sets
/// S and O are at least min n·S - max n·O apart in units of |n|. The bound is tight for the
/// direction between their closest points.
///
/// # Guarantee
///
/// A lower bound, directed rounding.
pub(crate) fn separation(
    lowest: impl Fn(&Vector) -> f64,
    (segment, radius): ([[f64; 3]; 2], f64),
    obstacle: &Obstacle,
    time: f64,
) -> f64 {
    let n = point(direction(segment, &obstacle.solid));
    let (highest, own_radius) = support(&obstacle.solid, &n);
    let length = dot(&n, &n).sqrt();
    let lowest = lowest(&n);
    if !lowest.is_finite() {
        return f64::NEG_INFINITY;
    }
    let between = (Interval::point(lowest) - highest) / length;
    let grown = add_up(own_radius, mul_up(obstacle.speed, time));
    let bound = sub_down(between.lo(), add_up(radius, grown));
    if bound.is_nan() { f64::NEG_INFINITY } else { bound }
}

/// Encloses max n·x over a solid without its radius, and returns the radius.
fn support(solid: &Solid, n: &Vector) -> (Interval, f64) {
    match solid {
        Solid::HalfSpace { offset, .. } => (Interval::point(*offset), 0.0),
        Solid::Box { centre, axes, half } => {
            let side = |(axis, half): (&[f64; 3], &f64)| {
                dot(n, &point(*axis)).abs() * Interval::point(*half)
            };
            let sides = axes.iter().zip(half).map(side);
            (sides.fold(dot(n, &point(*centre)), |sum, side| sum + side), 0.0)
        }
        Solid::Capsule { from, to, radius } => {
            (Interval::max(dot(n, &point(*from)), dot(n, &point(*to))), *radius)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn obstacle(solid: Solid, speed: f64) -> Obstacle {
        Obstacle { name: "o".into(), solid, speed, joints: None }
    }

    const BAR: [[f64; 3]; 2] = [[0.0, 0.0, 1.0], [2.0, 0.0, 1.0]];

    /// The distance of a bar of radius 0.25 m.
    fn of_bar(obstacle: &Obstacle, time: f64) -> f64 {
        let lowest = |n: &Vector| {
            BAR.map(|end| dot(n, &point(end)).lo()).into_iter().fold(f64::INFINITY, f64::min)
        };
        separation(lowest, (BAR, 0.25), obstacle, time)
    }

    const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    #[test]
    fn distances_are_close_to_the_exact_ones() {
        let sphere = |from, radius| Solid::Capsule { from, to: from, radius };
        let cases = [
            (obstacle(Solid::HalfSpace { normal: [0.0, 0.0, 2.0], offset: 1.0 }, 0.0), 0.25),
            (obstacle(sphere([1.0, 3.0, 1.0], 0.5), 0.0), 2.25),
            (obstacle(sphere([1.0, 3.0, 1.0], 0.5), 0.25), 1.75),
            (obstacle(sphere([5.0, 4.0, 1.0], 0.0), 0.0), 4.75),
            (
                obstacle(
                    Solid::Box { centre: [1.0, 0.0, 3.0], axes: IDENTITY, half: [0.5, 9.0, 1.0] },
                    0.0,
                ),
                0.75,
            ),
            (
                obstacle(
                    Solid::Box { centre: [4.0, 4.0, 1.0], axes: IDENTITY, half: [1.0; 3] },
                    0.0,
                ),
                10.0f64.sqrt() - 0.25,
            ),
            (
                obstacle(
                    Solid::Capsule { from: [1.0, -1.0, 3.0], to: [1.0, 9.0, 3.0], radius: 0.5 },
                    0.0,
                ),
                1.25,
            ),
        ];
        for (obstacle, exact) in cases {
            let found = of_bar(&obstacle, 2.0);
            assert!(found <= exact && found > exact - 1e-12, "{found} {exact} {obstacle:?}");
        }
    }

    #[test]
    fn bodies_that_touch_have_no_proved_distance() {
        for solid in [
            Solid::HalfSpace { normal: [0.0, 0.0, 1.0], offset: 0.9 },
            Solid::Box { centre: [1.0, 0.0, 1.0], axes: IDENTITY, half: [0.1; 3] },
            Solid::Capsule { from: [1.0, 0.0, 1.0], to: [1.0, 1.0, 1.0], radius: 0.1 },
        ] {
            assert!(of_bar(&obstacle(solid, 0.0), 0.0) < 0.0, "{solid:?}");
        }
        let ball = obstacle(Solid::Capsule { from: [9.0; 3], to: [9.0; 3], radius: 0.1 }, 0.0);
        let nowhere = separation(|_| f64::NEG_INFINITY, (BAR, 0.25), &ball, 0.0);
        assert_eq!(nowhere, f64::NEG_INFINITY);
    }
}
