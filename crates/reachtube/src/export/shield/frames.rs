//! Frames and capsules as the files of the shield have them: each frame turns about its z
//! axis.

use std::fmt::Write;

use nalgebra::{Matrix3, Vector3};
use reachtube_robot::{JointKind, Placement, Robot};
use reachtube_verify::{Capsule, Capsules};

use crate::export::ExportError;
use crate::export::robot::{Body, bodies};
use crate::export::text::{harmless, number, numbers};

/// Growth of a capsule around several others \[m\], for rounding.
const ROUNDING: f64 = 1e-9;

/// The links of a robot in frames that turn about z.
pub(super) struct Frames {
    /// The turn from each frame to the joint's: its z is the axis.
    turns: Vec<Matrix3<f64>>,
    /// Each frame in the one before, at q = 0.
    pub placements: Vec<Placement>,
    /// One capsule per link, in its frame.
    pub capsules: Vec<Capsule>,
}

/// A link in such a frame.
struct FramedBody {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: [f64; 3],
    /// Inertia about the centre of mass \[kg m²\].
    pub inertia: Matrix3<f64>,
}

impl Frames {
    /// Takes the frames of a robot whose joints all turn, and one capsule per link.
    pub(super) fn new(robot: &Robot, capsules: &Capsules) -> Result<Self, ExportError> {
        let refused = |joint: usize, problem: &str, remedy: &str| ExportError::Refused {
            place: format!("{}: joint {}", robot.name(), robot.joints()[joint].name),
            problem: problem.into(),
            remedy: remedy.into(),
        };
        let geometry = robot.geometry();
        let turns: Vec<Matrix3<f64>> = geometry.iter().map(|joint| turn_of(&joint.axis)).collect();
        let mut frames = Self { turns, placements: Vec::new(), capsules: Vec::new() };
        let mut before = Placement::identity();
        for (j, joint) in geometry.iter().enumerate() {
            if robot.joints()[j].kind == JointKind::Prismatic {
                return Err(refused(j, "it slides, and the tool's joints all turn", "lock it"));
            }
            let back = match j {
                0 => Matrix3::identity(),
                _ => frames.turns[j - 1].transpose(),
            };
            let own = Placement::rotation(back).then(&before.then(&joint.before));
            frames.placements.push(own.then(&Placement::rotation(frames.turns[j])));
            before = joint.after.clone();
            let of_link: Vec<Capsule> =
                capsules.as_slice().iter().filter(|capsule| capsule.joint == j).copied().collect();
            let capsule = enclosing(&of_link).ok_or_else(|| {
                refused(j, "its link has no capsule, and the tool needs one", "add one")
            })?;
            frames.capsules.push(frames.moved(j, &capsule, &joint.after));
        }
        Ok(frames)
    }

    /// Returns the capsule of link `j` in the shield's frame.
    fn moved(&self, j: usize, capsule: &Capsule, after: &Placement) -> Capsule {
        let back = self.turns[j].transpose();
        let place =
            |p: [f64; 3]| (back * (after.rotation * Vector3::from(p) + after.translation)).into();
        Capsule { from: place(capsule.from), to: place(capsule.to), ..*capsule }
    }

    /// Returns the links as bodies with the robot's torques.
    ///
    /// # Errors
    ///
    /// As [`bodies`].
    fn bodies(&self, robot: &Robot) -> Result<Vec<FramedBody>, ExportError> {
        let framed = |(body, turn): (&Body, &Matrix3<f64>)| {
            let (mass, com, [xx, xy, xz, yy, yz, zz]) = body.inertia.about_own_com();
            let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            let com = (turn.transpose() * Vector3::from(com)).into();
            let inertia = turn.transpose() * tensor * turn;
            FramedBody { mass, com, inertia }
        };
        Ok(bodies(robot)?.iter().zip(&self.turns).map(framed).collect())
    }

    pub(super) fn text(&self, robot: &Robot, secure_radius: f64) -> Result<String, ExportError> {
        let mut text = format!(
            "robot_name: \"{}\"\n\nnb_joints: {}\n\n# m\nsecure_radius: {}\n\n",
            harmless(robot.name()),
            self.placements.len(),
            number(secure_radius)
        );
        text += "# Each frame in the one before, row by row; it turns about its z axis\n";
        let rows = self.placements.iter().map(|placement| {
            let (r, p) = (&placement.rotation, &placement.translation);
            let row = |i: usize| clean([r[(i, 0)], r[(i, 1)], r[(i, 2)], p[i]]);
            [row(0), row(1), row(2), clean([0.0, 0.0, 0.0, 1.0])].join(",\n  ")
        });
        list(&mut text, "transformation_matrices", rows);
        text += "# Capsules: two ends and a radius, m\n";
        let capsules = self.capsules.iter().map(|capsule| {
            [clean(capsule.from), clean(capsule.to), number(capsule.radius)].join(",\n  ")
        });
        list(&mut text, "enclosures", capsules);
        let own = self.bodies(robot).map_err(|_| ExportError::Refused {
            place: robot.name().into(),
            problem:
                "the shield needs masses of the links, and simulators accept none of these links"
                    .into(),
            remedy: "name the shield's own robot file with --update, or identify the robot with \
                     physical links (model.physical = true in the settings of identify)"
                .into(),
        })?;
        text += "# kg\n";
        list(&mut text, "link_masses", own.iter().map(|body| number(body.mass)));
        text += "# About the centre of mass, kg m^2: ixx, ixy, ixz, iyy, iyz, izz\n";
        let inertias = own.iter().map(|FramedBody { inertia: i, .. }| {
            clean([i[(0, 0)], i[(0, 1)], i[(0, 2)], i[(1, 1)], i[(1, 2)], i[(2, 2)]])
        });
        list(&mut text, "link_inertias", inertias);
        text += "# m and rad: x, y, z, roll, pitch, yaw\n";
        let centres =
            own.iter().map(|FramedBody { com: [x, y, z], .. }| clean([*x, *y, *z, 0.0, 0.0, 0.0]));
        list(&mut text, "link_centers_of_mass", centres);
        Ok(text)
    }
}

fn list(text: &mut String, key: &str, entries: impl Iterator<Item = String>) {
    let entries: Vec<String> = entries.collect();
    let _ = writeln!(text, "{key}: [\n  {}]\n", entries.join(",\n\n  "));
}

/// Returns numbers as a row; -0 is written as 0.
fn clean<const N: usize>(values: [f64; N]) -> String {
    numbers(values.map(|x| x + 0.0), ", ")
}

/// Returns a rotation that takes z to a unit vector, exact where that lies along a coordinate.
fn turn_of(axis: &Vector3<f64>) -> Matrix3<f64> {
    let across = Vector3::new(-axis.y, axis.x, 0.0);
    if across.norm() == 0.0 {
        return Matrix3::from_diagonal(&Vector3::new(1.0, axis.z.signum(), axis.z.signum()));
    }
    let across = across.normalize();
    Matrix3::from_columns(&[across.cross(axis), across, *axis])
}

/// Returns a capsule that contains some others: its axis joins the two ends that are furthest
/// apart. A single one stays as it is.
fn enclosing(capsules: &[Capsule]) -> Option<Capsule> {
    let (first, rest) = capsules.split_first()?;
    if rest.is_empty() {
        return Some(*first);
    }
    let balls: Vec<(Vector3<f64>, f64)> = capsules
        .iter()
        .flat_map(|capsule| [capsule.from, capsule.to].map(|end| (end.into(), capsule.radius)))
        .collect();
    let pairs = balls.iter().flat_map(|(a, _)| balls.iter().map(move |(b, _)| [*a, *b]));
    let length = |[a, b]: &[Vector3<f64>; 2]| (a - b).norm();
    let axis = pairs.max_by(|a, b| length(a).total_cmp(&length(b)))?;
    // A capsule that contains the balls at both ends of another contains the other.
    let reach = |(centre, radius): &(Vector3<f64>, f64)| distance(centre, &axis) + radius;
    let radius = balls.iter().map(reach).fold(0.0, f64::max) + ROUNDING;
    Some(Capsule { joint: first.joint, from: axis[0].into(), to: axis[1].into(), radius })
}

fn distance(p: &Vector3<f64>, [a, b]: &[Vector3<f64>; 2]) -> f64 {
    let along = b - a;
    let s = ((p - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (p - a - s * along).norm()
}
