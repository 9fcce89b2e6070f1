//! A linear system with the structure of a robot arm.

use nalgebra::{Cholesky, DMatrix, DVector};
use reachtube_reach::LinearSystem;

/// Inertia of each joint, kg m².
const INERTIA: [f64; 6] = [2.1, 1.8, 0.9, 0.35, 0.2, 0.12];

/// Viscous friction of each joint, N m s/rad.
const FRICTION: [f64; 6] = [8.0, 9.0, 5.0, 2.0, 1.2, 0.9];

/// Builds ẋ = [0 I; 0 -M⁻¹D] x + [0; M⁻¹] u with 12 states and 6 inputs.
///
/// M is symmetric and positive definite, since the diagonal dominates its scaled rows. Its
/// couplings have both signs, so that e^{Aτ} and e^{Aτ} B have entries that are negative or change
/// sign.
pub(crate) fn arm() -> LinearSystem {
    let n = INERTIA.len();
    let sign = |i: usize, j: usize| if (i + j).is_multiple_of(3) { -1.0 } else { 1.0 };
    let coupling = |i: usize, j: usize| {
        if i == j { 1.0 } else { sign(i, j) * 0.45 / (1.0 + i.abs_diff(j) as f64) }
    };
    let mass = DMatrix::from_fn(n, n, |i, j| coupling(i, j) * (INERTIA[i] * INERTIA[j]).sqrt());
    let inverse = Cholesky::new(mass).expect("positive definite").inverse();
    let damping = &inverse * DMatrix::from_diagonal(&DVector::from_row_slice(&FRICTION));
    let mut a = DMatrix::zeros(2 * n, 2 * n);
    a.view_mut((0, n), (n, n)).fill_with_identity();
    a.view_mut((n, n), (n, n)).copy_from(&-damping);
    let mut b = DMatrix::zeros(2 * n, n);
    b.view_mut((n, 0), (n, n)).copy_from(&inverse);
    LinearSystem::new(a, b, DVector::zeros(2 * n)).expect("finite")
}
