//! The drawing of a robot: its links and joint axes at home, from the side and from a corner.

use super::canvas::{Canvas, DrawResult, svg_document};
use super::error::Error;
use super::layout::units;
use super::style::{GRID, centred, font, starting};
use super::text::clean;
use nalgebra::Vector3;
use plotters::prelude::*;
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
const CHARACTER: f64 = 6.2;
const LINE: f64 = 13.0;

/// Grey.
const LINK: RGBColor = RGBColor(160, 168, 178);
/// Blue.
const AXIS_COLOUR: RGBColor = RGBColor(18, 70, 200);

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
///
/// # Errors
///
/// Fails where the drawing library fails.
pub(super) fn arm_svgs(robot: &Robot) -> Result<String, Error> {
    let axes = axes(robot);
    let (turn, tilt) = (-50f64.to_radians(), 22f64.to_radians());
    let corner = [
        Vector3::new(-turn.sin(), turn.cos(), 0.0),
        Vector3::new(-tilt.sin() * turn.cos(), -tilt.sin() * turn.sin(), tilt.cos()),
    ];
    let side = [Vector3::x(), Vector3::z()];
    [(side, "From the side (x to the right, z up)"), (corner, "From a corner")]
        .into_iter()
        .map(|(view, title)| {
            svg_document(VIEW, title, |canvas| draw_view(canvas, &axes, view, title)).map_err(
                |cause| Error::Draw {
                    figure: format!("robot {}", robot.name()),
                    cause: cause.to_string(),
                },
            )
        })
        .collect()
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

/// Draws one view of the robot on the canvas.
fn draw_view(canvas: &Canvas, axes: &[Axis], view: View, title: &str) -> DrawResult {
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
    let at = |point: &Vector3<f64>| scale.pixel(point);
    let line = |points: Vec<(i32, i32)>, colour: RGBColor, width: f64| {
        canvas.draw(&PathElement::new(points, colour.stroke_width(units(width) as u32)))
    };
    line(ground.iter().map(at).collect(), GRID, 1.5)?;
    line(chain.iter().map(at).collect(), LINK, 9.0)?;
    for axis in axes {
        line(ends(axis).iter().map(at).collect(), AXIS_COLOUR, 3.0)?;
        canvas.draw(&Circle::new(at(&axis.point), units(3.5), WHITE.filled()))?;
        canvas.draw(&Circle::new(at(&axis.point), units(3.5), AXIS_COLOUR.stroke_width(15)))?;
    }
    names(canvas, axes, &scale)?;
    let middle = (units(0.5 * VIEW[0]), units(12.0));
    canvas.draw_text(title, &centred(font(12.0, FontStyle::Bold)), middle)
}

/// Writes the names of the joints beside their axes; joints at one place share a line.
fn names(canvas: &Canvas, axes: &[Axis], scale: &Scale) -> DrawResult {
    let mut lines: Vec<((i32, i32), Vec<&str>)> = Vec::new();
    for axis in axes {
        let (x, y) = scale.pixel(&axis.point);
        let same = lines.iter_mut().find(|((_, other), _)| (other - y).abs() < units(9.0));
        match same {
            Some((place, names)) => {
                place.0 = place.0.max(x);
                names.push(&axis.joint.name);
            }
            None => lines.push(((x, y), vec![&axis.joint.name])),
        }
    }
    let style = starting(font(11.0, FontStyle::Normal));
    let end = units(VIEW[0] - 4.0);
    for ((x, y), names) in lines {
        let rows = rows(&names);
        let width = |row: &str| units(CHARACTER * row.chars().count() as f64);
        let beside = x + units(16.0);
        // Names that do not fit beside the axis are written above it.
        let are_above = rows.len() > 1 || rows.iter().any(|row| beside + width(row) > end);
        for (k, row) in rows.iter().rev().enumerate() {
            let up = if are_above { units(24.0 + LINE * k as f64) } else { 0 };
            let left = beside.min(end - width(row));
            canvas.draw_text(&clean(row), &style, (left, y - up))?;
        }
    }
    Ok(())
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
    /// Drawing units per metre.
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
        let room = |pixels: f64, [low, high]: [f64; 2]| {
            f64::from(units(pixels - 2.0 * MARGIN)) / (high - low).max(1e-6)
        };
        let zoom = room(VIEW[0], x).min(room(VIEW[1], y));
        Self { view, zoom, middle: [x, y].map(|[low, high]| 0.5 * (low + high)) }
    }

    fn pixel(&self, point: &Vector3<f64>) -> (i32, i32) {
        let [x, y] = [0, 1].map(|k| self.zoom * (point.dot(&self.view[k]) - self.middle[k]));
        (units(0.5 * VIEW[0]) + x as i32, units(0.5 * VIEW[1]) - y as i32)
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
        let svgs = format!("<all>{}</all>", arm_svgs(&robot).unwrap());
        assert!(roxmltree::Document::parse(&svgs).is_ok() && svgs.matches("joint3").count() == 2);
    }
}
