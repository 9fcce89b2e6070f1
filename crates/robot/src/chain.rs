use crate::algebra::{Pose, Sym3, Vec3};
use crate::inertia::LinkInertia;
use crate::placement::{Placement, rotation_from_z, rotation_x, rotation_z};
use nalgebra::{Matrix3, Vector3};
use reachtube_scalar::Scalar;

/// How a joint and its link hang on the link before: x_before = before · Rot(axis, q) · after ·
/// x_link.
#[derive(Clone, Debug, PartialEq)]
pub struct JointGeometry {
    /// Placement of the joint frame in the original frame of the link before (the base for the
    /// first joint).
    pub before: Placement,
    /// Unit vector of the joint's axis in the joint frame.
    pub axis: Vector3<f64>,
    /// Placement of the link's original frame in the joint frame at q = 0.
    pub after: Placement,
}

impl JointGeometry {
    /// Standard Denavit-Hartenberg parameters: Rz(q + theta) Tz(d) Tx(a) Rx(alpha); a, d in m,
    /// angles in rad.
    ///
    /// Angles within 1e-12 of a multiple of pi/2 are taken as exactly that multiple.
    pub fn standard_dh(a: f64, alpha: f64, theta: f64, d: f64) -> Self {
        let after = Placement::rotation(rotation_z(crate::placement::snapped_sin_cos(theta)))
            .then(&Placement::translation(a, 0.0, d))
            .then(&Placement::rotation(rotation_x(crate::placement::snapped_sin_cos(alpha))));
        Self { before: Placement::identity(), axis: Vector3::z(), after }
    }

    /// Modified (Craig) Denavit-Hartenberg parameters: Rx(alpha) Tx(a) Rz(q + theta) Tz(d); a, d in
    /// m, angles in rad.
    ///
    /// Angles within 1e-12 of a multiple of pi/2 are taken as exactly that multiple.
    pub fn modified_dh(a: f64, alpha: f64, theta: f64, d: f64) -> Self {
        let before = Placement::rotation(rotation_x(crate::placement::snapped_sin_cos(alpha)))
            .then(&Placement::translation(a, 0.0, 0.0));
        let after = Placement::rotation(rotation_z(crate::placement::snapped_sin_cos(theta)))
            .then(&Placement::translation(0.0, 0.0, d));
        Self { before, axis: Vector3::z(), after }
    }

    /// A joint frame placed in the original frame of the link before; the link's frame is the
    /// turned joint frame.
    pub fn explicit(placement: Placement, axis: Vector3<f64>) -> Self {
        Self { before: placement, axis, after: Placement::identity() }
    }
}

/// One link in the frame that the algorithms use: origin on the joint's axis, +z along it, turned
/// about z so that the next axis differs by a twist about x alone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Link {
    pub sin_twist: f64,
    pub cos_twist: f64,
    pub sin_offset: f64,
    pub cos_offset: f64,
    pub origin: [f64; 3],
    pub mass: f64,
    pub first_moment: [f64; 3],
    /// xx, xy, xz, yy, yz, zz of the second moments Σ.
    pub second_moments: [f64; 6],
    pub armature: f64,
    pub gravity_mass: f64,
    pub gravity_first_moment: [f64; 3],
    /// Half the first moment of this and all later links' mass, were it at `origin` in the parent.
    pub half_shift: [f64; 3],
    /// Placement of the original link frame in this one.
    pub original: Placement,
}

impl Link {
    /// The pose in the parent for sin q and cos q.
    #[inline(always)]
    pub fn pose<S: Scalar>(&self, sin: &S, cos: &S) -> Pose<S> {
        let (s0, c0) = (S::from(self.sin_offset), S::from(self.cos_offset));
        Pose {
            sin: sin.clone() * c0.clone() + cos.clone() * s0.clone(),
            cos: cos.clone() * c0 - sin.clone() * s0,
            sin_twist: S::from(self.sin_twist),
            cos_twist: S::from(self.cos_twist),
            origin: Vec3::constant(self.origin),
        }
    }

    #[inline(always)]
    pub fn moments<S: Scalar>(&self) -> (Vec3<S>, Sym3<S>) {
        (Vec3::constant(self.first_moment), Sym3::constant(self.second_moments))
    }
}

/// R = Rz(lead) Rx(twist) Rz(lag), each as (sine, cosine).
struct Zxz {
    lead: (f64, f64),
    twist: (f64, f64),
    lag: (f64, f64),
}

impl Zxz {
    fn of(r: &Matrix3<f64>) -> Self {
        let tilt = r[(0, 2)].hypot(r[(1, 2)]);
        let lead = if tilt == 0.0 { (0.0, 1.0) } else { (r[(0, 2)] / tilt, -r[(1, 2)] / tilt) };
        // The first row of Rz(-lead) R is (cos lag, -sin lag, 0), well conditioned also for
        // parallel axes.
        let rest = rotation_z(lead).transpose() * r;
        Self { lead, twist: (tilt, r[(2, 2)]), lag: (-rest[(0, 1)], rest[(0, 0)]) }
    }
}

/// Sine and cosine of a sum of two angles.
fn turned((sa, ca): (f64, f64), (sb, cb): (f64, f64)) -> (f64, f64) {
    (sa * cb + ca * sb, ca * cb - sa * sb)
}

/// The links in their working frames, and the base frame's turn (the base's original axes are
/// R_base x_working).
pub(crate) fn reorient(
    joints: &[JointGeometry],
    inertias: &[LinkInertia],
    gravity_inertias: &[LinkInertia],
    armatures: &[f64],
) -> (Vec<Link>, Matrix3<f64>) {
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
    let turns: Vec<_> = constants.iter().map(|c| Zxz::of(&c.rotation)).collect();
    let links = (0..joints.len())
        .map(|i| {
            let next_lead = turns.get(i + 1).map_or((0.0, 1.0), |t| t.lead);
            let offset = turned(turns[i].lag, next_lead);
            let original =
                Placement::rotation(rotation_z(next_lead).transpose()).then(&originals[i]);
            let inertia = inertias[i].moved(&original);
            let heavy = gravity_inertias[i].moved(&original);
            let later_mass: f64 = inertias[i..].iter().map(|l| l.mass).sum();
            let origin = rotation_z(turns[i].lead).transpose() * constants[i].translation;
            let m = &inertia.second_moments;
            Link {
                sin_twist: turns[i].twist.0,
                cos_twist: turns[i].twist.1,
                sin_offset: offset.0,
                cos_offset: offset.1,
                origin: origin.into(),
                mass: inertia.mass,
                first_moment: inertia.first_moment.into(),
                second_moments: [m[(0, 0)], m[(0, 1)], m[(0, 2)], m[(1, 1)], m[(1, 2)], m[(2, 2)]],
                armature: armatures[i],
                gravity_mass: heavy.mass,
                gravity_first_moment: heavy.first_moment.into(),
                half_shift: (0.5 * later_mass * origin).into(),
                original,
            }
        })
        .collect();
    let base = turns.first().map_or_else(Matrix3::identity, |t| rotation_z(t.lead));
    (links, base)
}
