//! Elementary functions with the same bits on every platform.
//!
//! The functions of `f64` come from the platform's mathematics library, and their last bits differ.
//! The functions of the crate `libm` are computed by IEEE operations alone.

use reachtube_robot::{Joint, JointKind};

pub(super) use libm::{exp, sin, tanh};

/// Writes the sines and cosines of the joints' positions: what
/// [`Robot::sin_cos`](reachtube_robot::Robot::sin_cos) returns.
pub(super) fn sin_cos(joints: &[Joint], q: &[f64], sin: &mut [f64], cos: &mut [f64]) {
    for (i, joint) in joints.iter().enumerate() {
        (sin[i], cos[i]) = match joint.kind {
            JointKind::Revolute => libm::sincos(q[i]),
            JointKind::Prismatic => (q[i], 1.0),
        };
    }
}
