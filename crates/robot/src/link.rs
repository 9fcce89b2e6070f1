//! Links in the working frames of the algorithms.

use crate::algebra::{Sym3, Vec3, mul};
use crate::inertia::LinkInertia;
use crate::joint::Joint;
use crate::joint_geometry::JointGeometry;
use crate::joint_kind::JointKind;
use crate::placement::{Placement, rotation_from_z, rotation_z};
use crate::pose::Pose;
use nalgebra::Matrix3;
use reachtube_scalar::Scalar;

/// The constants of one link in its working frame.
///
/// The working frame has its origin on the joint's axis and +z along it. Its rotation about z is
/// chosen so that the next axis differs by a twist about x alone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Link {
    /// Kind of the joint that moves the link along or about z.
    pub kind: JointKind,
    /// Sine of the twist about the parent's x axis.
    pub sin_twist: f64,
    /// Cosine of the twist about the parent's x axis.
    pub cos_twist: f64,
    /// Sine of the angle about z that is added to q, or that a prismatic joint keeps.
    pub sin_offset: f64,
    /// Cosine of that angle.
    pub cos_offset: f64,
    /// Origin in the parent's working frame \[m\], at q = 0 for a prismatic joint.
    pub origin: [f64; 3],
    /// Mass \[kg\].
    pub mass: f64,
    /// First moment \[kg m\].
    pub first_moment: [f64; 3],
    /// Second moments Σ: xx, xy, xz, yy, yz, zz \[kg m²\].
    pub second_moments: [f64; 6],
    /// Motor inertia on the link side \[kg m²; kg for a prismatic joint\].
    pub armature: f64,
    /// Mass that gravity acts on \[kg\].
    pub gravity_mass: f64,
    /// First moment that gravity acts on \[kg m\].
    pub gravity_first_moment: [f64; 3],
    /// Mass of this and all later links \[kg\].
    pub composite_mass: f64,
    /// Half the first moment \[kg m\] that the mass of this and all later links would have at
    /// `origin`, in the parent's working frame.
    pub half_shift: [f64; 3],
    /// Placement of the link's original frame in its working frame.
    pub original: Placement,
}

impl Link {
    /// Returns the pose in the parent for sin q and cos q, or for q of a prismatic joint.
    #[inline(always)]
    pub(crate) fn pose<S: Scalar>(&self, sin: &S, cos: &S) -> Pose<S> {
        self.pose_among::<S, true>(sin, cos)
    }

    /// Returns the pose in the parent in a robot that has prismatic joints only if `SLIDES`.
    #[inline(always)]
    pub(crate) fn pose_among<S: Scalar, const SLIDES: bool>(&self, sin: &S, cos: &S) -> Pose<S> {
        if SLIDES && self.kind == JointKind::Prismatic {
            return self.pose_of_slide(sin);
        }
        let (s0, c0) = (S::from(self.sin_offset), S::from(self.cos_offset));
        Pose {
            sin: sin.clone() * c0.clone() + cos.clone() * s0.clone(),
            cos: cos.clone() * c0 - sin.clone() * s0,
            sin_twist: S::from(self.sin_twist),
            cos_twist: S::from(self.cos_twist),
            origin: Vec3::constant(self.origin),
        }
    }

    /// Returns the pose in the parent for the position q of a prismatic joint.
    ///
    /// The paths of prismatic joints are functions of their own, so that the paths of revolute
    /// joints stay as short as without them.
    #[cold]
    #[inline(never)]
    fn pose_of_slide<S: Scalar>(&self, q: &S) -> Pose<S> {
        let (sin_twist, cos_twist) = (S::from(self.sin_twist), S::from(self.cos_twist));
        let mut origin = Vec3::constant(self.origin);
        // The axis is (0, -sin twist, cos twist) in the parent.
        origin.y -= mul(&sin_twist, q);
        origin.z += mul(&cos_twist, q);
        let (sin, cos) = (S::from(self.sin_offset), S::from(self.cos_offset));
        Pose { sin, cos, sin_twist, cos_twist, origin }
    }

    /// Returns the component of a wrench that acts on the joint: the moment about its axis, or the
    /// force along it.
    #[inline(always)]
    pub(crate) fn axis_component<S: Scalar>(&self, force: &Vec3<S>, moment: &Vec3<S>) -> S {
        self.axis_component_among::<S, true>(force, moment)
    }

    /// Returns the component of a wrench that acts on the joint, in a robot that has prismatic
    /// joints only if `SLIDES`.
    #[inline(always)]
    pub(crate) fn axis_component_among<S: Scalar, const SLIDES: bool>(
        &self,
        force: &Vec3<S>,
        moment: &Vec3<S>,
    ) -> S {
        let along = SLIDES && self.kind == JointKind::Prismatic;
        if along { force.z.clone() } else { moment.z.clone() }
    }

    #[inline(always)]
    pub(crate) fn moments<S: Scalar>(&self) -> (Vec3<S>, Sym3<S>) {
        (Vec3::constant(self.first_moment), Sym3::constant(self.second_moments))
    }
}

/// The Euler angles of R = Rz(lead) Rx(twist) Rz(lag), each as (sine, cosine).
struct Zxz {
    lead: (f64, f64),
    twist: (f64, f64),
    lag: (f64, f64),
}

impl Zxz {
    fn of(r: &Matrix3<f64>) -> Self {
        let tilt = r[(0, 2)].hypot(r[(1, 2)]);
        let lead = if tilt == 0.0 { (0.0, 1.0) } else { (r[(0, 2)] / tilt, -r[(1, 2)] / tilt) };
        // The first row of Rz(-lead) R is (cos lag, -sin lag, 0). It is well conditioned for
        // parallel axes too.
        let rest = rotation_z(lead).transpose() * r;
        Self { lead, twist: (tilt, r[(2, 2)]), lag: (-rest[(0, 1)], rest[(0, 0)]) }
    }
}

/// Returns sine and cosine of the sum of two angles.
fn sum_of_angles((sa, ca): (f64, f64), (sb, cb): (f64, f64)) -> (f64, f64) {
    (sa * cb + ca * sb, ca * cb - sa * sb)
}

/// Returns the links in their working frames, and the rotation R of the working base frame:
/// x_base = R x_working.
pub(crate) fn working_links(
    drives: &[Joint],
    joints: &[JointGeometry],
    inertias: &[LinkInertia],
    gravity_inertias: &[LinkInertia],
) -> (Vec<Link>, Matrix3<f64>) {
    // Frames with +z along each axis, and the constant placements between them.
    let axes: Vec<_> =
        joints.iter().map(|j| Placement::rotation(rotation_from_z(&j.axis))).collect();
    let mut before = Placement::identity();
    let mut constants = Vec::with_capacity(joints.len());
    let mut originals = Vec::with_capacity(joints.len());
    for (joint, axis) in joints.iter().zip(&axes) {
        constants.push(before.then(&joint.before).then(axis));
        before = Placement::rotation(axis.rotation.transpose()).then(&joint.after);
        originals.push(before.clone());
    }
    // Each rotation about z belongs to the joint before or after it, because it commutes with the
    // motion of both kinds of joint; what is left is a twist.
    let angles: Vec<_> = constants.iter().map(|c| Zxz::of(&c.rotation)).collect();
    let links = (0..joints.len())
        .map(|i| {
            let next_lead = angles.get(i + 1).map_or((0.0, 1.0), |t| t.lead);
            let offset = sum_of_angles(angles[i].lag, next_lead);
            let original =
                Placement::rotation(rotation_z(next_lead).transpose()).then(&originals[i]);
            let inertia = inertias[i].moved(&original);
            let gravity_inertia = gravity_inertias[i].moved(&original);
            let composite_mass: f64 = inertias[i..].iter().map(|l| l.mass).sum();
            let origin = rotation_z(angles[i].lead).transpose() * constants[i].translation;
            let m = &inertia.second_moments;
            Link {
                kind: drives[i].kind,
                sin_twist: angles[i].twist.0,
                cos_twist: angles[i].twist.1,
                sin_offset: offset.0,
                cos_offset: offset.1,
                origin: origin.into(),
                mass: inertia.mass,
                first_moment: inertia.first_moment.into(),
                second_moments: [m[(0, 0)], m[(0, 1)], m[(0, 2)], m[(1, 1)], m[(1, 2)], m[(2, 2)]],
                armature: drives[i].armature,
                gravity_mass: gravity_inertia.mass,
                gravity_first_moment: gravity_inertia.first_moment.into(),
                composite_mass,
                half_shift: (0.5 * composite_mass * origin).into(),
                original,
            }
        })
        .collect();
    let base = angles.first().map_or_else(Matrix3::identity, |t| rotation_z(t.lead));
    (links, base)
}
