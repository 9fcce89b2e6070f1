//! URDF.

use std::fmt::Write;

use reachtube_files::{MARK, TOOL};
use reachtube_robot::{JointKind, Placement, Robot, Urdf, UrdfOptions};

use super::attributes::{LEFT_OUT, attribute, friction};
use super::bodies::{Body, bodies};
use crate::export::ExportError;
use crate::export::text::{comment, harmless, number, numbers};

/// Velocity limit \[rad/s; m/s\] and effort limit \[N m; N\] where the robot has none, because URDF
/// asks for numbers.
const NO_LIMIT: f64 = 1000.0;

/// A robot as URDF, and what URDF cannot say.
#[derive(Debug, Clone)]
pub struct UrdfFiles {
    /// The URDF.
    pub urdf: String,
    /// Its companion, TOML: motors, friction and gravity. reachtube reads it with the URDF; a
    /// simulator must be given its `armature`.
    pub companion: String,
}

/// Returns the robot as URDF text, with its companion.
///
/// # Errors
///
/// [`ExportError::SeparateGravity`] where gravity acts on masses of its own, and
/// [`ExportError::NotPhysical`] where no bodies have its torques.
pub fn urdf(robot: &Robot) -> Result<UrdfFiles, ExportError> {
    let bodies = bodies(robot)?;
    let urdf = text(robot, &bodies);
    let mut description = robot.description().clone();
    for (joint, body) in description.joints.iter_mut().zip(&bodies) {
        // The companion has the motor of the body, which need not be the description's.
        joint.rotor_inertia = None;
        joint.armature = Some(body.armature);
    }
    let driven = Robot::from_description(&description);
    let read = Urdf::parse(&urdf, "robot.urdf", &UrdfOptions::default());
    let companion = match (read, driven) {
        (Ok(read), Ok(driven)) => read.companion(&driven),
        _ => return Err(ExportError::Unreadable { robot: robot.name().into() }),
    };
    let mark =
        format!("# {MARK} ({TOOL}): what robot.urdf cannot say of {}.\n", harmless(robot.name()));
    Ok(UrdfFiles { urdf, companion: mark + &companion })
}

fn text(robot: &Robot, bodies: &[Body]) -> String {
    let lines = [
        format!("{MARK} ({TOOL}): {}.", harmless(robot.name())),
        LEFT_OUT.into(),
        "URDF has no motor inertia and no gravity: a simulator needs the values of robot.toml \
         (armature, gravity)."
            .into(),
    ];
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<!--\n{}-->\n<robot name=\"{}\">\n  <link name=\"base\"/>\n",
        comment(" ", &lines).replace("--", "- -"),
        attribute(robot.name()),
    );
    for (j, body) in bodies.iter().enumerate() {
        write_joint(&mut text, robot, j, body);
    }
    text + "</robot>\n"
}

fn write_joint(text: &mut String, robot: &Robot, j: usize, body: &Body) {
    let joint = &robot.joints()[j];
    let [damping, loss] = friction(robot, j);
    let kind = match joint.kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
    };
    let parent = if j == 0 { "base".into() } else { format!("link{j}") };
    let [low, high] = joint.position_limits.map(number);
    let (mass, com, [xx, xy, xz, yy, yz, zz]) = body.inertia.about_own_com();
    let [xx, xy, xz, yy, yz, zz] = [xx, xy, xz, yy, yz, zz].map(number);
    let _ = write!(
        text,
        "  <joint name=\"{}\" type=\"{kind}\">\n    <parent link=\"{parent}\"/>\n    \
         <child link=\"link{}\"/>\n    <origin {}/>\n    <axis xyz=\"{}\"/>\n    \
         <limit lower=\"{low}\" upper=\"{high}\" velocity=\"{}\" effort=\"{}\"/>\n    \
         <dynamics damping=\"{}\" friction=\"{}\"/>\n  </joint>\n  <link name=\"link{}\">\n    \
         <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      <mass value=\"{}\"/>\n      \
         <inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" iyy=\"{yy}\" iyz=\"{yz}\" \
         izz=\"{zz}\"/>\n    </inertial>\n  </link>\n",
        attribute(&joint.name),
        j + 1,
        origin(&body.placement),
        numbers(body.axis, " "),
        number(joint.velocity_limit.unwrap_or(NO_LIMIT)),
        number(NO_LIMIT),
        number(damping),
        number(loss),
        j + 1,
        numbers(com, " "),
        number(mass),
    );
}

/// Returns a placement as translation and roll, pitch, yaw: Rz(yaw) Ry(pitch) Rx(roll).
fn origin(placement: &Placement) -> String {
    let r = &placement.rotation;
    // The pitch by atan2 keeps its digits near a right angle, where the other two share one turn.
    let cosine = r[(0, 0)].hypot(r[(1, 0)]);
    let pitch = (-r[(2, 0)]).atan2(cosine);
    let (roll, yaw) = match cosine > 1e-15 {
        true => (r[(2, 1)].atan2(r[(2, 2)]), r[(1, 0)].atan2(r[(0, 0)])),
        false => (0.0, (-r[(0, 1)]).atan2(r[(1, 1)])),
    };
    format!(
        "xyz=\"{}\" rpy=\"{}\"",
        numbers(placement.translation.iter().copied(), " "),
        numbers([roll, pitch, yaw], " ")
    )
}
