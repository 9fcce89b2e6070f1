//! The arm as the header has it, and as its formulas read it back.

use nalgebra::{Matrix3, Rotation3, Vector3};
use reachtube_robot::{InertiaPoint, PlacementDescription, Robot};
use reachtube_verify::{Capsule, Capsules};

use crate::export::ExportError;
use crate::export::shield::frames::{FramedBody, Frames};

/// Angles of ARMOUR's rotations, R = Rx(roll) Ry(pitch) Rz(yaw), and the origin of a frame.
pub(super) struct Frame {
    /// Roll, pitch and yaw \[rad\].
    pub angles: [f64; 3],
    /// Origin in the previous frame \[m\].
    pub origin: [f64; 3],
}

/// The frames, links and shapes of an arm.
pub(super) struct Arm {
    pub frames: Vec<Frame>,
    pub links: Vec<FramedBody>,
    /// Centre and half widths \[m\] of a box around each link, in its frame.
    pub boxes: Vec<[[f64; 3]; 2]>,
    /// The arm as it is read back.
    pub robot: Robot,
}

impl Arm {
    pub(super) fn new(robot: &Robot, capsules: &Capsules) -> Result<Self, ExportError> {
        let placed = Frames::new(robot, capsules)?;
        let links = placed.bodies(robot)?;
        let frames: Vec<Frame> = placed
            .placements
            .iter()
            .map(|p| Frame { angles: angles(&p.rotation), origin: p.translation.into() })
            .collect();
        let boxes = placed.capsules.iter().map(around).collect();
        let robot = read_back(robot, &frames, &links)?;
        Ok(Self { frames, links, boxes, robot })
    }
}

/// Returns the angles of a rotation Rx(roll) Ry(pitch) Rz(yaw).
fn angles(r: &Matrix3<f64>) -> [f64; 3] {
    let pitch = r[(0, 2)].atan2(r[(0, 0)].hypot(r[(0, 1)]));
    // At a pitch of a right angle roll and yaw turn about one axis: all of it is roll.
    let locked = r[(0, 0)].hypot(r[(0, 1)]) < 1e-12;
    let yaw = if locked { 0.0 } else { (-r[(0, 1)]).atan2(r[(0, 0)]) };
    let roll = match locked {
        true => r[(2, 1)].atan2(r[(1, 1)]),
        false => (-r[(1, 2)]).atan2(r[(2, 2)]),
    };
    [roll, pitch, yaw]
}

/// Returns the rotation of three angles.
pub(super) fn rotation([roll, pitch, yaw]: [f64; 3]) -> Matrix3<f64> {
    let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
    (about(Vector3::x_axis(), roll)
        * about(Vector3::y_axis(), pitch)
        * about(Vector3::z_axis(), yaw))
    .into_inner()
}

/// Returns centre and half widths of the box around a capsule.
fn around(capsule: &Capsule) -> [[f64; 3]; 2] {
    let part = |k: usize| {
        let [a, b] = [capsule.from[k], capsule.to[k]];
        let centre = 0.5 * (a + b);
        let half = (a - centre).abs().max((b - centre).abs()) + capsule.radius;
        // Room for the rounding of the sums.
        (centre, half * (1.0 + 1e-12))
    };
    let parts = [part(0), part(1), part(2)];
    [parts.map(|part| part.0), parts.map(|part| part.1)]
}

/// Returns the robot that the header describes, without its friction.
fn read_back(robot: &Robot, frames: &[Frame], links: &[FramedBody]) -> Result<Robot, ExportError> {
    let mut description = robot.description().clone();
    let joints = description.joints.iter_mut();
    for ((joint, frame), link) in joints.zip(frames).zip(links) {
        let r = rotation(frame.angles);
        joint.dh = None;
        joint.placement = Some(PlacementDescription {
            rotation: Some([0, 1, 2].map(|i| [r[(i, 0)], r[(i, 1)], r[(i, 2)]])),
            rpy: None,
            translation: frame.origin,
        });
        joint.axis = None;
        joint.mass = link.mass;
        joint.com = Some(link.com);
        joint.first_moment = None;
        let i = &link.inertia;
        joint.inertia = [i[(0, 0)], i[(0, 1)], i[(0, 2)], i[(1, 1)], i[(1, 2)], i[(2, 2)]];
        joint.about = InertiaPoint::Com;
        joint.gear_ratio = None;
        joint.rotor_inertia = None;
        joint.armature = Some(link.armature);
        joint.friction = Default::default();
    }
    description.parameters = Default::default();
    Ok(Robot::from_description(&description)?)
}
