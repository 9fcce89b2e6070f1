//! Capsules around the shapes of a URDF.

use reachtube_robot::{CollisionShape, Shape};
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::add_up;

use crate::body::capsule::Capsule;
use crate::error::{Error, Result};
use crate::kinematics::chain::Frame;
use crate::kinematics::vector::{norm, norm_of_bounds, point};

/// Returns a capsule around a shape: the axis of a box is its longest side.
///
/// # Guarantee
///
/// Outer, directed rounding: the capsule contains the shape. A box lies within the half diagonal of
/// its cross-section of its axis, a cylinder within its radius.
pub(super) fn enclosing_capsule(shape: &CollisionShape) -> Result<Capsule> {
    let (axis, half, radius) = match &shape.shape {
        Shape::Sphere { radius } => (0, 0.0, *radius),
        Shape::Cylinder { radius, length } => (2, 0.5 * length, *radius),
        Shape::Box { size } => {
            let axis = (0..3).max_by(|i, j| size[*i].total_cmp(&size[*j])).unwrap_or(0);
            let mut half = size.map(|side| 0.5 * side);
            let along = std::mem::replace(&mut half[axis], 0.0);
            (axis, along, norm_of_bounds(half))
        }
        Shape::Mesh { file, .. } => {
            return Err(Error::Mesh { link: shape.link.clone(), mesh: file.clone() });
        }
    };
    let frame = Frame::constant(&shape.placement);
    let end = |sign: f64| {
        let mut local = [0.0; 3];
        local[axis] = sign * half;
        let exact = frame.place(&point(local));
        let rounded = exact.map(Interval::mid);
        let error = norm(&core::array::from_fn(|i| exact[i] - rounded[i]));
        (rounded, error)
    };
    let ((from, error), (to, other)) = (end(-1.0), end(1.0));
    Ok(Capsule { joint: shape.joint, from, to, radius: add_up(radius, error.max(other)) })
}
