//! The fixed geometry between two joints.

use crate::placement::{Placement, rotation_x, rotation_z, snapped_sin_cos};
use nalgebra::Vector3;

/// The pose of a link relative to the previous link:
/// x_previous = before · Rot(axis, q) · after · x_link, with Trans(axis, q) in place of Rot for a
/// prismatic joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointGeometry {
    /// Placement of the joint frame in the original frame of the previous link (for the first
    /// joint: in the base).
    pub before: Placement,
    /// Unit vector of the joint's axis in the joint frame.
    pub axis: Vector3<f64>,
    /// Placement of the link's original frame in the joint frame at q = 0.
    pub after: Placement,
}

impl JointGeometry {
    /// Makes a joint from standard Denavit-Hartenberg parameters:
    /// Rz(q + theta) Tz(d) Tx(a) Rx(alpha), with a and d in m and angles in rad.
    ///
    /// For a prismatic joint, q adds to d in place of theta. Angles within 1e-12 rad of a multiple
    /// of pi/2 are taken as exactly that multiple.
    pub(crate) fn standard_dh(a: f64, alpha: f64, theta: f64, d: f64) -> Self {
        let after = Placement::rotation(rotation_z(snapped_sin_cos(theta)))
            .then(&Placement::translation(a, 0.0, d))
            .then(&Placement::rotation(rotation_x(snapped_sin_cos(alpha))));
        Self { before: Placement::identity(), axis: Vector3::z(), after }
    }

    /// Makes a joint from modified (Craig) Denavit-Hartenberg parameters:
    /// Rx(alpha) Tx(a) Rz(q + theta) Tz(d), with a and d in m and angles in rad.
    ///
    /// For a prismatic joint, q adds to d in place of theta. Angles within 1e-12 rad of a multiple
    /// of pi/2 are taken as exactly that multiple.
    pub(crate) fn modified_dh(a: f64, alpha: f64, theta: f64, d: f64) -> Self {
        let before = Placement::rotation(rotation_x(snapped_sin_cos(alpha)))
            .then(&Placement::translation(a, 0.0, 0.0));
        let after = Placement::rotation(rotation_z(snapped_sin_cos(theta)))
            .then(&Placement::translation(0.0, 0.0, d));
        Self { before, axis: Vector3::z(), after }
    }

    /// Makes a joint from the placement of its frame in the original frame of the previous link,
    /// and from a unit axis. The link's frame is the joint frame moved by q.
    pub(crate) fn explicit(placement: Placement, axis: Vector3<f64>) -> Self {
        Self { before: placement, axis, after: Placement::identity() }
    }
}
