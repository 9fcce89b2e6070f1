use nalgebra::{DMatrix, DVector};
use reachtube_ode::VectorField;
use reachtube_scalar::{Interval, Scalar};

use crate::error::ReachError;
use crate::sets::interval_matrix::{IntervalVector, add_product, point};

/// The linear system ẋ = A x + B u + d with constant A (N x N), B (N x m) and drift d (N).
///
/// The floating-point entries are the exact numbers of the system: no conversion rounds them.
///
/// # Examples
///
/// ```
/// use nalgebra::{dmatrix, dvector};
/// use reachtube_reach::LinearSystem;
///
/// // A double integrator: states (position, velocity), input acceleration.
/// let (a, b) = (dmatrix![0.0, 1.0; 0.0, 0.0], dmatrix![0.0; 1.0]);
/// let system = LinearSystem::new(a, b, dvector![0.0, 0.0])?;
/// assert_eq!((system.states(), system.inputs()), (2, 1));
/// # Ok::<(), reachtube_reach::ReachError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LinearSystem {
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    drift: DVector<f64>,
}

impl LinearSystem {
    /// Builds the system from A (N x N), B (N x m) and the drift d (N).
    ///
    /// # Errors
    ///
    /// Returns [`ReachError::Shape`] when the shapes do not fit together, and
    /// [`ReachError::NotFinite`] for NaN or infinite entries.
    pub fn new(a: DMatrix<f64>, b: DMatrix<f64>, drift: DVector<f64>) -> Result<Self, ReachError> {
        let states = a.nrows();
        check_shape("A", &a, states, states)?;
        check_shape("B", &b, states, b.ncols())?;
        let drift_column = DMatrix::from_column_slice(drift.len(), 1, drift.as_slice());
        check_shape("the drift", &drift_column, states, 1)?;
        Ok(Self { a, b, drift })
    }

    /// Returns A, N x N.
    pub fn a(&self) -> &DMatrix<f64> {
        &self.a
    }

    /// Returns B, N x m.
    pub fn b(&self) -> &DMatrix<f64> {
        &self.b
    }

    /// Returns the constant drift d, N entries.
    pub fn drift(&self) -> &DVector<f64> {
        &self.drift
    }

    /// Returns the number of states N.
    pub fn states(&self) -> usize {
        self.a.nrows()
    }

    /// Returns the number of inputs m.
    pub fn inputs(&self) -> usize {
        self.b.ncols()
    }

    /// Encloses the derivative ẋ = A x + B u + d for every x (N) and u (m) in the vectors.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn derivative(&self, x: &[Interval], u: &[Interval]) -> IntervalVector {
        let mut sum = self.drift.map(Interval::point);
        add_product(sum.as_mut_slice(), &point(&self.a), x);
        add_product(sum.as_mut_slice(), &point(&self.b), u);
        sum
    }
}

/// Evaluates ẋ = A x + B u + d; x has N entries, u has m.
impl<S: Scalar> VectorField<S> for &LinearSystem {
    fn rate(&mut self, _: f64, x: &[S], u: &[S], dx: &mut [S]) {
        dx.iter_mut().zip(self.drift.iter()).for_each(|(dx, d)| *dx = S::from(*d));
        for (column, x) in self.a.column_iter().zip(x).chain(self.b.column_iter().zip(u)) {
            dx.iter_mut().zip(column.iter()).for_each(|(dx, a)| *dx += S::from(*a) * x.clone());
        }
    }
}

fn check_shape(
    what: &'static str,
    matrix: &DMatrix<f64>,
    rows: usize,
    columns: usize,
) -> Result<(), ReachError> {
    let (found_rows, found_columns) = matrix.shape();
    if (found_rows, found_columns) != (rows, columns) {
        return Err(ReachError::Shape { what, rows, columns, found_rows, found_columns });
    }
    for column in 0..columns {
        for row in 0..rows {
            let value = matrix[(row, column)];
            if !value.is_finite() {
                return Err(ReachError::NotFinite { what, row, column, value });
            }
        }
    }
    Ok(())
}
