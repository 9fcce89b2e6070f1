use nalgebra::{Cholesky, DMatrix, DVector};

/// Ridges that are tried, relative to the unit diagonal of the scaled Hessian.
///
/// Near the boundary the Hessian's eigenvalues span more than the range of doubles. A ridge then
/// gives a shorter step that still descends.
const RIDGES: [f64; 3] = [1e-14, 1e-11, 1e-8];

/// A Newton step of p parameters.
pub(super) struct NewtonStep {
    /// The direction, p entries.
    pub direction: DVector<f64>,
    /// The square of the Newton decrement.
    pub squared_decrement: f64,
}

impl NewtonStep {
    /// Solves for the step by Cholesky of the Hessian scaled to a unit diagonal.
    ///
    /// Parameters with a zero row in the Hessian stay where they are.
    pub(super) fn new(hessian: &DMatrix<f64>, gradient: &DVector<f64>) -> Option<Self> {
        let n = gradient.len();
        let scale = DVector::from_fn(n, |i, _| {
            if hessian[(i, i)] > 0.0 { hessian[(i, i)].sqrt().recip() } else { 1.0 }
        });
        let scaled = DMatrix::from_fn(n, n, |i, j| hessian[(i, j)] * scale[i] * scale[j]);
        let factor = RIDGES
            .into_iter()
            .filter_map(|ridge| Cholesky::new(&scaled + ridge * DMatrix::identity(n, n)))
            .next()?;
        let direction = -factor.solve(&gradient.component_mul(&scale)).component_mul(&scale);
        let squared_decrement = -direction.dot(gradient);
        squared_decrement.is_finite().then_some(Self { direction, squared_decrement })
    }
}
