use crate::Robot;
use crate::algebra::{Pose, Sym3, Vec3};
use reachtube_scalar::Scalar;

/// Scratch memory of the algorithms for one robot and one scalar: made once, reused, so that no
/// call allocates.
///
/// A workspace belongs to the number of joints it was made for; the algorithms panic with another.
#[derive(Clone, Debug)]
pub struct Workspace<S> {
    pub(crate) links: Vec<LinkScratch<S>>,
    pub(crate) articulated: Vec<ArticulatedScratch<S>>,
    /// n zeros: an acceleration of rest.
    pub(crate) rest: Vec<S>,
    pub(crate) torque: Vec<S>,
    /// n x n, row by row.
    pub(crate) mass_matrix: Vec<S>,
}

/// What Newton-Euler and the composite bodies keep of a link between their passes.
#[derive(Clone, Debug)]
pub(crate) struct LinkScratch<S> {
    pub pose: Pose<S>,
    pub force: Vec3<S>,
    pub moment: Vec3<S>,
}

/// What the articulated-body algorithm keeps of a link between its passes.
#[derive(Clone, Debug)]
pub(crate) struct ArticulatedScratch<S> {
    pub pose: Pose<S>,
    /// Velocity-dependent acceleration (angular, linear) relative to the parent's.
    pub bias_angular: Vec3<S>,
    pub bias_linear: Vec3<S>,
    pub body: ArticulatedBody<S>,
    /// Column of the articulated inertia on the joint's axis: (moment, force).
    pub axis_moment: Vec3<S>,
    pub axis_force: Vec3<S>,
    pub inverse_pivot: S,
    pub drive: S,
}

/// An articulated body: (moment, force) = [[I, H], [Hᵀ, M]] (angular, linear acceleration) +
/// (moment, force) at rest.
#[derive(Clone, Debug)]
pub(crate) struct ArticulatedBody<S> {
    pub inertia: Sym3<S>,
    /// Rows of H.
    pub coupling: [Vec3<S>; 3],
    pub mass: Sym3<S>,
    pub moment: Vec3<S>,
    pub force: Vec3<S>,
}

impl<S: Scalar> Workspace<S> {
    /// Scratch memory for a robot.
    pub fn new(robot: &Robot) -> Self {
        let n = robot.joint_count();
        Self {
            links: vec![LinkScratch::blank(); n],
            articulated: vec![ArticulatedScratch::blank(); n],
            rest: vec![S::zero(); n],
            torque: vec![S::zero(); n],
            mass_matrix: vec![S::zero(); n * n],
        }
    }
}

impl<S: Scalar> Pose<S> {
    fn blank() -> Self {
        let (zero, one) = (S::zero, S::one);
        Self { sin: zero(), cos: one(), sin_twist: zero(), cos_twist: one(), origin: Vec3::zero() }
    }
}

impl<S: Scalar> LinkScratch<S> {
    fn blank() -> Self {
        Self { pose: Pose::blank(), force: Vec3::zero(), moment: Vec3::zero() }
    }
}

impl<S: Scalar> ArticulatedScratch<S> {
    fn blank() -> Self {
        let zero = Vec3::zero;
        let symmetric = || Sym3::constant([0.0; 6]);
        let body = ArticulatedBody {
            inertia: symmetric(),
            coupling: [zero(), zero(), zero()],
            mass: symmetric(),
            moment: zero(),
            force: zero(),
        };
        Self {
            pose: Pose::blank(),
            bias_angular: zero(),
            bias_linear: zero(),
            body,
            axis_moment: zero(),
            axis_force: zero(),
            inverse_pivot: S::zero(),
            drive: S::zero(),
        }
    }
}
