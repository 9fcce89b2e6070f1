use nalgebra::Matrix4;

/// Number of inertial parameters of a link.
///
/// They are m, m c (3), Ixx, Ixy, Iyy, Ixz, Iyz and Izz, with the inertia about the link's origin.
pub const PER_LINK: usize = 10;

/// Returns the pseudo-inertia [[Σ, h], [hᵀ, m]] of a link's ten parameters.
///
/// Σ is the second moment of the mass \[kg m²\], h = m c its first moment \[kg m\] and m the mass
/// \[kg\]. The matrix is linear in the parameters.
///
/// # Panics
///
/// Panics if `link` has fewer than ten entries.
#[must_use]
pub fn pseudo_inertia(link: &[f64]) -> Matrix4<f64> {
    let [m, hx, hy, hz, xx, xy, yy, xz, yz, zz] =
        *link.first_chunk().expect("a link has ten parameters");
    let half = 0.5 * (xx + yy + zz);
    #[rustfmt::skip]
    let rows = Matrix4::new(
        half - xx, -xy, -xz, hx,
        -xy, half - yy, -yz, hy,
        -xz, -yz, half - zz, hz,
        hx, hy, hz, m,
    );
    rows
}

#[must_use]
pub(crate) fn link_parameters(p: &Matrix4<f64>) -> [f64; PER_LINK] {
    let trace = p[(0, 0)] + p[(1, 1)] + p[(2, 2)];
    let [xx, yy, zz] = [0, 1, 2].map(|i| trace - p[(i, i)]);
    [p[(3, 3)], p[(0, 3)], p[(1, 3)], p[(2, 3)], xx, -p[(0, 1)], yy, -p[(0, 2)], -p[(1, 2)], zz]
}

/// Returns the derivative of the pseudo-inertia with respect to each of the ten parameters.
pub(super) fn parameter_basis() -> [Matrix4<f64>; PER_LINK] {
    std::array::from_fn(|k| {
        let mut unit = [0.0; PER_LINK];
        unit[k] = 1.0;
        pseudo_inertia(&unit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_survive_the_pseudo_inertia() {
        let link = [2.0, 0.1, -0.2, 0.3, 0.5, 0.01, 0.6, -0.02, 0.03, 0.7];
        let back = link_parameters(&pseudo_inertia(&link));
        assert!(back.iter().zip(&link).all(|(a, b)| (a - b).abs() < 1e-15));
    }
}
