//! MuJoCo's format.

use std::fmt::Write;

use nalgebra::{Rotation3, UnitQuaternion};
use reachtube_files::{MARK, TOOL};
use reachtube_robot::{JointKind, LinkInertia, Placement, Robot};

use super::attributes::{LEFT_OUT, SimulatedFriction, about_lines, attribute};
use super::bodies::{Body, bodies};
use crate::export::ExportError;
use crate::export::text::{comment, harmless, number, numbers};

/// Form of viscous friction that is not linear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Damping {
    /// v1 and v3 exactly, as MuJoCo reads them since version 4.
    Polynomial,
    /// The best line, which every reader takes.
    Line,
}

/// The terms that polynomial damping omits.
const NO_EVEN_TERM: &str = "Viscous friction is v1 qd + v3 qd^3, which MuJoCo reads since version \
4; v2, whose torque has one sign for both directions, is left out, as are the dependence on the \
load and the Stribeck effect. Drake and Pinocchio read robot_linear.xml.";

/// Returns the robot as MJCF text. Each joint has a motor, without which Drake drops its inertia.
pub(super) fn mjcf(robot: &Robot, damping: Damping) -> Result<String, ExportError> {
    let bodies = bodies(robot)?;
    let about = match damping {
        Damping::Polynomial if is_curved(robot) => vec![NO_EVEN_TERM.into()],
        _ => [vec![LEFT_OUT.into()], about_lines(robot)].concat(),
    };
    let lines = [vec![format!("{MARK} ({TOOL}): {}.", harmless(robot.name()))], about].concat();
    let mut text = format!(
        "<!--\n{}-->\n<mujoco model=\"{}\">\n  <compiler angle=\"radian\" autolimits=\"true\"/>\n  \
         <option gravity=\"{}\"/>\n  <worldbody>\n",
        comment(" ", &lines).replace("--", "- -"),
        attribute(robot.name()),
        numbers(robot.gravity_acceleration(), " "),
    );
    for (j, body) in bodies.iter().enumerate() {
        write_body(&mut text, robot, (j, body), damping);
    }
    for j in (0..bodies.len()).rev() {
        let _ = writeln!(text, "{}</body>", indent(j));
    }
    text += "  </worldbody>\n  <actuator>\n";
    for joint in robot.joints() {
        let name = attribute(&joint.name);
        let _ = writeln!(text, "    <motor name=\"{name}\" joint=\"{name}\"/>");
    }
    Ok(text + "  </actuator>\n</mujoco>\n")
}

/// Returns whether a joint's viscous friction is no line.
pub(super) fn is_curved(robot: &Robot) -> bool {
    (0..robot.joint_count()).any(|j| SimulatedFriction::new(robot, j).is_curved())
}

fn indent(j: usize) -> String {
    " ".repeat(4 + 2 * j)
}

/// Writes the start of body `j`, in which the next one is nested.
fn write_body(text: &mut String, robot: &Robot, (j, body): (usize, &Body), damping: Damping) {
    let (joint, space) = (&robot.joints()[j], indent(j));
    let friction = SimulatedFriction::new(robot, j);
    let damping = match (damping, friction.viscous) {
        (Damping::Polynomial, [v1, _, v3]) if v3 != 0.0 => numbers([v1, 0.0, v3], " "),
        (Damping::Polynomial, [v1, ..]) => number(v1.max(0.0)),
        (Damping::Line, _) => number(friction.line()),
    };
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
        damping,
        number(friction.loss),
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
