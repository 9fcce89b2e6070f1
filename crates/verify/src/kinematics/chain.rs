//! Enclosed forward kinematics of a serial robot.

use reachtube_robot::{JointKind, Placement, Robot};
use reachtube_scalar::Interval;

use super::vector::{Matrix, Vector, add, image, point, product, scaled, times};

/// Largest error of an entry of a robot's constant rotations, which are products of rotations in
/// double precision. An entry of a rotation by quarter turns has none.
const ROTATION_ERROR: f64 = 1e-14;

/// The pose of a frame in an outer one, enclosed.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub rotation: Matrix,
    pub origin: Vector,
}

/// The constants of a robot's kinematics.
///
/// The robot is the one whose constant rotations are exact and differ from the loaded ones by
/// rounding only; translations are as loaded.
#[derive(Debug, Clone)]
pub(crate) struct Chain {
    joints: Vec<ChainJoint>,
}

#[derive(Debug, Clone)]
struct ChainJoint {
    kind: JointKind,
    /// The joint frame in the frame of the joint before it, after that one's motion.
    before: Frame,
    /// The axis in the joint frame, of length 1.
    axis: Vector,
    /// The link's frame in the joint frame, after the motion.
    after: Frame,
}

/// Frames of the joints at one position of the robot, in memory that is reused.
#[derive(Debug, Clone, Default)]
pub(crate) struct Posture {
    /// The joint frames after their motions, in the base frame.
    pub frames: Vec<Frame>,
    /// The axes, in the base frame.
    pub axes: Vec<Vector>,
}

impl Frame {
    fn identity() -> Self {
        let (i, o) = (Interval::ONE, Interval::ZERO);
        Self { rotation: [[i, o, o], [o, i, o], [o, o, i]], origin: [o; 3] }
    }

    pub(crate) fn constant(placement: &Placement) -> Self {
        let is_whole = placement.rotation.iter().all(|x| *x == 0.0 || x.abs() == 1.0);
        let entry = |x: f64| match is_whole {
            true => Interval::point(x),
            false => Interval::centred(x, ROTATION_ERROR),
        };
        let row = |i: usize| core::array::from_fn(|j| entry(placement.rotation[(i, j)]));
        Self { rotation: core::array::from_fn(row), origin: point(placement.translation.into()) }
    }

    /// Returns the pose in the outer frame of a frame in this one.
    fn then(&self, inner: &Self) -> Self {
        let rotation = product(&self.rotation, &inner.rotation);
        Self { rotation, origin: self.place(&inner.origin) }
    }

    pub(crate) fn place(&self, p: &Vector) -> Vector {
        add(&image(&self.rotation, p), &self.origin)
    }
}

impl Chain {
    pub(crate) fn new(robot: &Robot) -> Self {
        let mut link_before = Frame::identity();
        let mut joints = Vec::new();
        for (geometry, joint) in robot.geometry().iter().zip(robot.joints()) {
            let before = link_before.then(&Frame::constant(&geometry.before));
            let after = Frame::constant(&geometry.after);
            link_before = after.clone();
            let axis = unit(geometry.axis.into());
            joints.push(ChainJoint { kind: joint.kind, before, axis, after });
        }
        Self { joints }
    }

    pub(crate) fn joint_count(&self) -> usize {
        self.joints.len()
    }

    pub(crate) fn turns(&self, index: usize) -> bool {
        self.joints[index].kind == JointKind::Revolute
    }

    /// Returns a point of the frame of link `index` in the frame of its joint.
    pub(crate) fn in_joint_frame(&self, index: usize, p: [f64; 3]) -> Vector {
        self.joints[index].after.place(&point(p))
    }

    /// Encloses the joint frames and axes at the position `q` (rad; m), n numbers.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn pose(&self, q: &[f64], posture: &mut Posture) {
        posture.frames.clear();
        posture.axes.clear();
        for (k, (joint, q)) in self.joints.iter().zip(q).enumerate() {
            let fixed = match k {
                0 => joint.before.clone(),
                _ => posture.frames[k - 1].then(&joint.before),
            };
            let axis = image(&fixed.rotation, &joint.axis);
            let frame = match joint.kind {
                JointKind::Revolute => {
                    let turn = rotation(&joint.axis, Interval::point(*q));
                    Frame { rotation: product(&fixed.rotation, &turn), origin: fixed.origin }
                }
                JointKind::Prismatic => {
                    let origin = add(&fixed.origin, &scaled(&axis, Interval::point(*q)));
                    Frame { rotation: fixed.rotation, origin }
                }
            };
            posture.frames.push(frame);
            posture.axes.push(axis);
        }
    }
}

/// Encloses the unit vector that a loaded axis stands for.
fn unit(axis: [f64; 3]) -> Vector {
    let is_whole = axis.iter().all(|x| *x == 0.0 || x.abs() == 1.0);
    if is_whole { point(axis) } else { axis.map(|x| Interval::centred(x, ROTATION_ERROR)) }
}

/// Encloses the rotation about a unit axis a by an angle q: cos q I + sin q \[a\]× + (1 - cos q)
/// a aᵀ (Rodrigues).
fn rotation(a: &Vector, q: Interval) -> Matrix {
    let (sin, cos) = q.sin_cos();
    let rest = Interval::ONE - cos;
    let skew = |i: usize, j: usize| match (i, j) {
        (0, 1) => -a[2],
        (0, 2) => a[1],
        (1, 0) => a[2],
        (1, 2) => -a[0],
        (2, 0) => -a[1],
        _ => a[0],
    };
    let entry = |i: usize, j: usize| {
        if i != j {
            return times(sin, skew(i, j)) + times(rest, times(a[i], a[j]));
        }
        // A rotation about an axis of coordinates keeps its coordinate.
        let square = a[i].sqr();
        if square == Interval::ONE { square } else { cos + times(rest, square) }
    };
    core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)))
}
