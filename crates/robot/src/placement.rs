//! Poses of frames, and rotations with exact entries.

use nalgebra::{Matrix3, Vector3};

/// The pose of an inner frame in an outer one: x_outer = rotation · x_inner + translation.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// Rotation matrix; its columns are the inner frame's axes in outer coordinates.
    pub rotation: Matrix3<f64>,
    /// Origin of the inner frame in outer coordinates \[m\].
    pub translation: Vector3<f64>,
}

impl Placement {
    /// Returns the placement of a frame in itself.
    pub fn identity() -> Self {
        Self { rotation: Matrix3::identity(), translation: Vector3::zeros() }
    }

    /// Makes a placement without translation.
    pub fn rotation(rotation: Matrix3<f64>) -> Self {
        Self { rotation, translation: Vector3::zeros() }
    }

    /// Makes a placement without rotation from a translation \[m\].
    pub(crate) fn translation(x: f64, y: f64, z: f64) -> Self {
        Self { rotation: Matrix3::identity(), translation: Vector3::new(x, y, z) }
    }

    /// Returns the placement in the outer frame of a frame that is placed in the inner one.
    pub fn then(&self, inner: &Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            translation: self.rotation * inner.translation + self.translation,
        }
    }
}

/// Returns sine and cosine of an angle \[rad\], exact if it is within 1e-12 rad of a multiple of
/// pi/2.
///
/// Rounding to the multiple keeps the zeros of a robot with right angles exact. Its dynamics then
/// has the fewest terms as polynomials and the narrowest enclosures as intervals.
pub fn snapped_sin_cos(angle: f64) -> (f64, f64) {
    let quarter = (angle / core::f64::consts::FRAC_PI_2).round();
    if (angle - quarter * core::f64::consts::FRAC_PI_2).abs() > 1e-12 {
        return angle.sin_cos();
    }
    match quarter.rem_euclid(4.0) as u8 {
        0 => (0.0, 1.0),
        1 => (1.0, 0.0),
        2 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

/// Returns the rotation about x by an angle given as (sine, cosine).
pub(crate) fn rotation_x((s, c): (f64, f64)) -> Matrix3<f64> {
    Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c)
}

/// Returns the rotation about z by an angle given as (sine, cosine).
pub(crate) fn rotation_z((s, c): (f64, f64)) -> Matrix3<f64> {
    Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
}

/// Returns a rotation that takes +z to a unit vector, with exact entries if the vector lies on an
/// axis of coordinates.
pub(crate) fn rotation_from_z(axis: &Vector3<f64>) -> Matrix3<f64> {
    let (x, y, z) = (axis.x, axis.y, axis.z);
    let sin_tilt = x.hypot(y);
    if sin_tilt == 0.0 {
        return rotation_x((0.0, z.signum()));
    }
    // A tilt about x takes z to (0, -sin, cos); a rotation about z takes that to the axis.
    rotation_z((x / sin_tilt, -y / sin_tilt)) * rotation_x((sin_tilt, z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quarter_turns_are_exact() {
        for k in -8..8 {
            let (s, c) = snapped_sin_cos(k as f64 * core::f64::consts::FRAC_PI_2);
            assert_eq!((s.abs() + c.abs(), s * c), (1.0, 0.0));
        }
        assert_ne!(snapped_sin_cos(core::f64::consts::FRAC_PI_2 + 5e-12).1, 0.0);
    }

    proptest! {
        #[test]
        fn rotation_from_z_is_a_rotation_onto_the_axis(
            x in -1.0..1.0f64,
            y in -1.0..1.0f64,
            z in -1.0..1.0f64,
        ) {
            let v = Vector3::new(x, y, z);
            prop_assume!(v.norm() > 1e-3);
            let axis = v.normalize();
            let r = rotation_from_z(&axis);
            prop_assert!((r * Vector3::z() - axis).norm() < 1e-14);
            prop_assert!((r * r.transpose() - Matrix3::identity()).norm() < 1e-14);
            prop_assert!((r.determinant() - 1.0).abs() < 1e-14);
        }
    }
}
