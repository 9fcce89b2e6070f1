//! The drawing of a robot: its links and joint axes at home, from the side and from a corner.

use super::svg::{Anchor, BLUE, Colour, Place, Svg, WHITE};
use nalgebra::Vector3;
use reachtube_robot::{Joint, JointKind, Robot};

/// Width and height of a view \[px\].
const VIEW: [f64; 2] = [380.0, 420.0];
/// Free room around the robot \[px\].
const MARGIN: f64 = 52.0;
/// Half the length of a joint's axis in the drawing, over the size of the robot.
const AXIS: f64 = 0.07;
/// Radius of the circle on the ground, over the size of the robot.
const GROUND: f64 = 0.16;
/// Change of a joint's position that shows its axis \[rad, m\].
const SMALL: f64 = 1e-6;
/// Part of the robot's size below which two points are one.
const SAME: f64 = 1e-3;

/// Width of a character and distance of two lines of names \[px\].
const CHARACTER: f64 = 5.8;
const LINE: f64 = 13.0;

/// Grey, and light grey.
const LINK: Colour = [160, 168, 178];
const FLOOR: Colour = [226, 230, 235];

/// The direction to the right and the direction upward of a view.
type View = [Vector3<f64>; 2];

/// A joint at home.
struct Axis<'a> {
    joint: &'a Joint,
    /// The point of the axis nearest to the link's frame \[m\].
    point: Vector3<f64>,
    direction: Vector3<f64>,
    /// Origin of the link's frame \[m\].
    origin: Vector3<f64>,
}

/// Draws a robot at q = 0 as two complete SVG documents: from the side and from a corner.
pub(super) fn arm_svgs(robot: &Robot) -> String {
    let axes = axes(robot);
    let (turn, tilt) = (-50f64.to_radians(), 22f64.to_radians());
    let corner = [
        Vector3::new(-turn.sin(), turn.cos(), 0.0),
        Vector3::new(-tilt.sin() * turn.cos(), -tilt.sin() * turn.sin(), tilt.cos()),
    ];
    let side = [Vector3::x(), Vector3::z()];
    [(side, "From the side (x to the right, z up)"), (corner, "From a corner")]
        .map(|(view, title)| drawn(&axes, view, title).document(VIEW, title))
        .concat()
}

/// Returns the axes of all joints at home. They are those about which, or along which, the links
/// move, so that they do not depend on the convention of the description.
fn axes(robot: &Robot) -> Vec<Axis<'_>> {
    let home = vec![0.0; robot.joint_count()];
    let frames = robot.link_placements(&home);
    let of_joint = |(j, joint): (usize, &'_ Joint)| {
        let mut moved = home.clone();
        moved[j] = SMALL;
        let (here, there) = (&frames[j], &robot.link_placements(&moved)[j]);
        let velocity = (there.translation - here.translation) / SMALL;
        let turn = there.rotation * here.rotation.transpose() / (2.0 * SMALL);
        let turn = Vector3::new(
            turn[(2, 1)] - turn[(1, 2)],
            turn[(0, 2)] - turn[(2, 0)],
            turn[(1, 0)] - turn[(0, 1)],
        );
        let turns = joint.kind == JointKind::Revolute;
        let direction = if turns { turn } else { velocity };
        let aside = if turns { turn.cross(&velocity) } else { Vector3::zeros() };
        (j, here.translation, direction, here.translation + aside)
    };
    let found = robot.joints().iter().enumerate().map(of_joint);
    found
        .map(|(j, origin, direction, point)| Axis {
            joint: &robot.joints()[j],
            point,
            direction,
            origin,
        })
        .collect()
}

fn drawn(axes: &[Axis], view: View, title: &str) -> Svg {
    let mut chain = vec![Vector3::zeros()];
    for axis in axes {
        chain.extend([axis.point, axis.origin]);
    }
    let size = chain.iter().map(|point| point.norm()).fold(0.0, f64::max).max(1e-3);
    chain.dedup_by(|a, b| (*a - *b).norm() < SAME * size);
    let ground: Vec<Vector3<f64>> = (0..=48)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 48.0)
        .map(|angle| GROUND * size * Vector3::new(angle.cos(), angle.sin(), 0.0))
        .collect();
    let ends = |axis: &Axis| [-1.0, 1.0].map(|end| axis.point + end * AXIS * size * axis.direction);
    let all: Vec<_> =
        chain.iter().chain(&ground).copied().chain(axes.iter().flat_map(ends)).collect();
    let scale = Scale::new(&all, view);
    let places = |points: &[Vector3<f64>]| -> Vec<Place> {
        points.iter().map(|point| scale.pixel(point)).collect()
    };
    let mut svg = Svg::default();
    svg.line(&places(&ground), FLOOR, 1.5);
    svg.line(&places(&chain), LINK, 9.0);
    for axis in axes {
        svg.line(&places(&ends(axis)), BLUE, 3.0);
        svg.dot(scale.pixel(&axis.point), 3.5, WHITE);
        svg.ring(scale.pixel(&axis.point), 3.5, BLUE, 1.9);
    }
    names(&mut svg, axes, &scale);
    svg.bold((0.5 * VIEW[0], 12.0), title, &Anchor::Middle, 12.0);
    svg
}

/// Writes the names of the joints beside their axes; joints at one place share a line.
fn names(svg: &mut Svg, axes: &[Axis], scale: &Scale) {
    let mut lines: Vec<(Place, Vec<&str>)> = Vec::new();
    for axis in axes {
        let (x, y) = scale.pixel(&axis.point);
        let same = lines.iter_mut().find(|((_, other), _)| (other - y).abs() < 9.0);
        match same {
            Some((place, names)) => {
                place.0 = place.0.max(x);
                names.push(&axis.joint.name);
            }
            None => lines.push(((x, y), vec![&axis.joint.name])),
        }
    }
    let [middle, end] = [0.5 * VIEW[1], VIEW[0] - 4.0];
    let lowest = lines.iter().map(|((_, y), _)| *y).fold(0.0, f64::max);
    lines.sort_by(|((_, a), _), ((_, b), _)| a.total_cmp(b));
    let mut below = 0;
    for ((x, y), names) in lines {
        let rows = rows(&names);
        let width = |row: &str| CHARACTER * row.chars().count() as f64;
        let beside = x + 16.0;
        let fits = rows.len() == 1 && rows.iter().all(|row| beside + width(row) <= end);
        for (k, row) in rows.iter().enumerate() {
            // Names that do not fit beside the axis are written above it, or below the robot.
            let line = match (fits, y < middle) {
                (true, _) => y,
                (false, true) => y - 24.0 - LINE * (rows.len() - 1 - k) as f64,
                (false, false) => {
                    below += 1;
                    lowest + 8.0 + LINE * f64::from(below)
                }
            };
            svg.text((beside.min(end - width(row)), line), row, &Anchor::Start, 11.0);
        }
    }
}

/// Writes names as rows that are no wider than a view.
fn rows(names: &[&str]) -> Vec<String> {
    let most = ((VIEW[0] - 8.0) / CHARACTER) as usize;
    let mut rows: Vec<String> = Vec::new();
    for name in names {
        match rows.last_mut() {
            Some(row) if row.chars().count() + name.chars().count() + 2 <= most => {
                *row += &format!(", {name}");
            }
            _ => rows.push((*name).to_string()),
        }
    }
    rows
}

/// The map from the base's frame to a view.
struct Scale {
    view: View,
    /// Pixels per metre.
    zoom: f64,
    /// Middle of the robot in the view \[m\].
    middle: [f64; 2],
}

impl Scale {
    /// Fits points into a view.
    fn new(points: &[Vector3<f64>], view: View) -> Self {
        let range = |direction: Vector3<f64>| {
            let values = points.iter().map(|point| point.dot(&direction));
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            })
        };
        let [x, y] = view.map(range);
        let room =
            |pixels: f64, [low, high]: [f64; 2]| (pixels - 2.0 * MARGIN) / (high - low).max(1e-6);
        let zoom = room(VIEW[0], x).min(room(VIEW[1], y));
        Self { view, zoom, middle: [x, y].map(|[low, high]| 0.5 * (low + high)) }
    }

    fn pixel(&self, point: &Vector3<f64>) -> Place {
        let [x, y] = [0, 1].map(|k| self.zoom * (point.dot(&self.view[k]) - self.middle[k]));
        (0.5 * VIEW[0] + x, 0.5 * VIEW[1] - y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_share_a_place_fit_into_the_view() {
        let names = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint"];
        let rows = rows(&names);
        assert_eq!(rows.concat().matches("_joint").count(), 4);
        assert!(rows.len() == 2 && rows.iter().all(|row| row.len() <= 60), "{rows:?}");
        assert_eq!(super::rows(&["a", "b"]), ["a, b"]);
    }

    #[test]
    fn the_axes_are_those_of_the_lwa_4p() {
        let robot = Robot::lwa4p();
        let axes = axes(&robot);
        let heights: Vec<f64> = axes.iter().map(|axis| axis.point.z).collect();
        let expected = [0.0, 0.0, 0.35, 0.35 + 0.3012, 0.35 + 0.3012, 0.35 + 0.3012];
        for (j, (height, expected)) in heights.iter().zip(expected).enumerate() {
            let upright = axes[j].direction.z.abs() > 0.9;
            assert!(upright || (height - expected).abs() < 1e-3, "joint {j}: {heights:?}");
            assert!((axes[j].direction.norm() - 1.0).abs() < 1e-3);
            assert_eq!(upright, [0, 3, 5].contains(&j), "{:?}", axes[j].direction);
        }
        let svgs = format!("<all>{}</all>", arm_svgs(&robot));
        assert!(roxmltree::Document::parse(&svgs).is_ok() && svgs.matches("joint3").count() == 2);
    }
}
