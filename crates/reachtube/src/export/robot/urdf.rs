//! URDF.

use std::fmt::Write;
use std::path::Path;

use reachtube_files::{MARK, TOOL};
use reachtube_robot::{JointKind, Lock, Placement, Robot, Urdf, UrdfOptions};

use super::attributes::{LEFT_OUT, SimulatedFriction, about_lines, attribute};
use super::bodies::{Body, bodies, own_links};
use crate::export::ExportError;
use crate::export::draws::Draws;
use crate::export::text::{comment, harmless, number, numbers};

/// Velocity limit \[rad/s; m/s\] and effort limit \[N m; N\] if the robot has none, because URDF
/// asks for numbers.
const NO_LIMIT: f64 = 1000.0;

/// Number of random states at which a URDF that was updated must have the robot's torques.
const COMPARED: usize = 50;

/// Largest difference of torques, relative to the largest, that rounding explains.
const SAME_TORQUES: f64 = 1e-9;

/// A robot as URDF, and the parts that URDF lacks.
#[derive(Debug, Clone)]
pub(super) struct UrdfFiles {
    /// The URDF.
    pub urdf: String,
    /// Its companion, TOML: motors, friction and gravity. reachtube reads it with the URDF; a
    /// simulator must be given its `armature`.
    pub companion: String,
}

pub(super) fn urdf(robot: &Robot) -> Result<UrdfFiles, ExportError> {
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
    Ok(UrdfFiles { urdf, companion: mark(robot) + &companion })
}

/// Writes the inertia and friction of a robot into a URDF file; all other text stays.
pub(super) fn updated_urdf(
    robot: &Robot,
    path: &Path,
    locks: &[Lock],
) -> Result<UrdfFiles, ExportError> {
    own_links(robot)?;
    let options = UrdfOptions { locks: locks.to_vec(), any_inertia: true, ..Default::default() };
    let old = Urdf::load(path, &options)?;
    let urdf = old.updated(&with_lines(robot)?)?;
    let companion = old.companion(robot);
    let origin = path.display().to_string();
    let read = Urdf::parse_with(&urdf, &origin, &companion, &options)?.into_robot();
    let error = largest_difference(robot, &read);
    if error > SAME_TORQUES {
        return Err(ExportError::OtherGeometry { robot: robot.name().into(), path: origin, error });
    }
    Ok(UrdfFiles { urdf, companion: mark(robot) + &companion })
}

/// Returns the robot with the best line as its viscous friction, which is all that URDF expresses.
fn with_lines(robot: &Robot) -> Result<Robot, ExportError> {
    let mut description = robot.description().clone();
    for (j, joint) in description.joints.iter_mut().enumerate() {
        joint.friction.viscous = [SimulatedFriction::new(robot, j).line(), 0.0, 0.0];
    }
    Ok(Robot::from_description(&description)?)
}

/// Returns the largest difference of the torques of two robots at random states, relative to the
/// largest torque.
fn largest_difference(robot: &Robot, other: &Robot) -> f64 {
    let n = robot.joint_count();
    let mut draws = Draws::seeded(4);
    let mut draw = |radius: f64| draws.vector(n, radius);
    let (mut worst, mut largest) = (0.0_f64, 1.0_f64);
    for _ in 0..COMPARED {
        let (q, qd, qdd) = (draw(3.0), draw(2.0), draw(5.0));
        let torques = robot.inverse_dynamics(&q, &qd, &qdd);
        worst = worst.max((other.inverse_dynamics(&q, &qd, &qdd) - &torques).amax());
        largest = largest.max(torques.amax());
    }
    worst / largest
}

fn mark(robot: &Robot) -> String {
    format!("# {MARK} ({TOOL}): parts of {} that URDF lacks.\n", harmless(robot.name()))
}

fn text(robot: &Robot, bodies: &[Body]) -> String {
    let own = [
        format!("{MARK} ({TOOL}): {}.", harmless(robot.name())),
        LEFT_OUT.into(),
        "URDF has no motor inertia and no gravity: a simulator needs the values of robot.toml \
         (armature, gravity)."
            .into(),
    ];
    let lines = [own.to_vec(), about_lines(robot)].concat();
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
    let friction = SimulatedFriction::new(robot, j);
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
        number(friction.line()),
        number(friction.loss),
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
