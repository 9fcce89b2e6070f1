//! Capsules around the shapes of a URDF.

use std::path::Path;

use reachtube_robot::{CollisionShape, Shape};
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::add_up;

use crate::body::capsule::Capsule;
use crate::body::fit_mesh::capsule_around;
use crate::error::{Error, Result};
use crate::kinematics::chain::Frame;
use crate::kinematics::vector::{Vector, norm, norm_of_bounds, point};
use crate::mesh::{sought, vertices};

/// Returns a capsule around a shape: the axis of a box is its longest side. Meshes are sought from
/// `folder` upwards.
///
/// # Guarantee
///
/// Outer, directed rounding: the capsule contains the shape. A box lies within the half diagonal of
/// its cross-section of its axis, a cylinder within its radius.
pub(super) fn enclosing_capsule(shape: &CollisionShape, folder: &Path) -> Result<Capsule> {
    let (axis, half, radius) = match &shape.shape {
        Shape::Sphere { radius } => (0, 0.0, *radius),
        Shape::Cylinder { radius, length } => (2, 0.5 * length, *radius),
        Shape::Box { size } => {
            let axis = (0..3).max_by(|i, j| size[*i].total_cmp(&size[*j])).unwrap_or(0);
            let mut half = size.map(|side| 0.5 * side);
            let along = std::mem::replace(&mut half[axis], 0.0);
            (axis, along, norm_of_bounds(half))
        }
        Shape::Mesh { file, scale } => {
            let (from, to, radius) = capsule_around(&placed(shape, (file, *scale), folder)?);
            return Ok(Capsule { joint: shape.joint, from, to, radius });
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

/// Encloses the vertices of a mesh in the link's frame.
///
/// # Guarantee
///
/// Outer, directed rounding, for the vertices as loaded.
fn placed(
    shape: &CollisionShape,
    (file, scale): (&str, [f64; 3]),
    folder: &Path,
) -> Result<Vec<Vector>> {
    let error = |(problem, remedy): (String, &str)| Error::Mesh {
        link: shape.link.clone(),
        mesh: file.into(),
        problem,
        remedy: remedy.into(),
    };
    let path = sought(file, folder).ok_or_else(|| {
        let place = folder.display();
        error((format!("is not found from the folder `{place}` upwards"), "put it there"))
    })?;
    let all = vertices(&path).map_err(error)?;
    let frame = Frame::constant(&shape.placement);
    let place = |vertex: [f64; 3]| {
        let scaled = |i: usize| Interval::point(vertex[i]) * Interval::point(scale[i]);
        frame.place(&core::array::from_fn(scaled))
    };
    Ok(all.into_iter().map(place).collect())
}
