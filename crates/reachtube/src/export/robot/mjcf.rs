//! MuJoCo's format.

use std::fmt::Write;

use nalgebra::{Rotation3, UnitQuaternion};
use reachtube_files::{MARK, TOOL};
use reachtube_robot::{JointKind, LinkInertia, Placement, Robot};

use super::attributes::{LEFT_OUT, attribute, friction};
use super::bodies::{Body, bodies};
use crate::export::ExportError;
use crate::export::text::{comment, harmless, number, numbers};

/// Returns the robot as MJCF text.
///
/// # Errors
///
/// [`ExportError::SeparateGravity`] where gravity acts on masses of its own, and
/// [`ExportError::NotPhysical`] where no bodies have its torques: MuJoCo refuses both.
pub fn mjcf(robot: &Robot) -> Result<String, ExportError> {
    let bodies = bodies(robot)?;
    let lines = [format!("{MARK} ({TOOL}): {}.", harmless(robot.name())), LEFT_OUT.into()];
    let mut text = format!(
        "<!--\n{}-->\n<mujoco model=\"{}\">\n  <compiler angle=\"radian\" autolimits=\"true\"/>\n  \
         <option gravity=\"{}\"/>\n  <worldbody>\n",
        comment(" ", &lines).replace("--", "- -"),
        attribute(robot.name()),
        numbers(robot.gravity_acceleration(), " "),
    );
    for (j, body) in bodies.iter().enumerate() {
        write_body(&mut text, robot, j, body);
    }
    for j in (0..bodies.len()).rev() {
        let _ = writeln!(text, "{}</body>", indent(j));
    }
    text += "  </worldbody>\n</mujoco>\n";
    Ok(text)
}

fn indent(j: usize) -> String {
    " ".repeat(4 + 2 * j)
}

/// Writes the start of body `j`, in which the next one is nested.
fn write_body(text: &mut String, robot: &Robot, j: usize, body: &Body) {
    let (joint, space) = (&robot.joints()[j], indent(j));
    let [damping, loss] = friction(robot, j);
    let kind = match joint.kind {
        JointKind::Revolute => "hinge",
        JointKind::Prismatic => "slide",
    };
    let _ = write!(
        text,
        "{space}<body name=\"link{}\" {}>\n{space}  <joint name=\"{}\" type=\"{kind}\" \
         axis=\"{}\" range=\"{}\" armature=\"{}\" damping=\"{}\" frictionloss=\"{}\"/>\n{}",
        j + 1,
        pose(&body.placement),
        attribute(&joint.name),
        numbers(body.axis, " "),
        numbers(joint.position_limits, " "),
        number(body.armature),
        number(damping),
        number(loss),
        inertial(&body.inertia, &space),
    );
}

fn pose(placement: &Placement) -> String {
    let rotation = Rotation3::from_matrix_unchecked(placement.rotation);
    let q = UnitQuaternion::from_rotation_matrix(&rotation);
    let q = [q.w, q.i, q.j, q.k];
    format!(
        "pos=\"{}\" quat=\"{}\"",
        numbers(placement.translation.iter().copied(), " "),
        numbers(q, " ")
    )
}

fn inertial(inertia: &LinkInertia, space: &str) -> String {
    let (mass, com, [xx, xy, xz, yy, yz, zz]) = inertia.about_own_com();
    format!(
        "{space}  <inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{}\"/>\n",
        numbers(com, " "),
        number(mass),
        numbers([xx, yy, zz, xy, xz, yz], " "),
    )
}
