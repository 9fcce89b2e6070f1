use nalgebra::{DMatrix, DVector, Matrix2};

/// The condition that the viscous friction of a joint rises with speed up to a limit L, in both
/// directions. It then never drives.
///
/// The slope v1 + 2 v2 s + 3 v3 s² is at least 0 for all |s| <= L if and only if some λ >= 0 makes
/// the matrix [[v1 - λ L², v2], [v2, 3 v3 + λ]] positive semidefinite: the slope minus λ (L² - s²)
/// is then a square form in (1, s). The S-procedure is exact for one quadratic condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RisingFriction {
    /// The columns of v1, v2 and v3; `None` for a coefficient that is not fitted.
    pub columns: [Option<usize>; 3],
    /// What is added to the values of the columns.
    pub known: [f64; 3],
    /// The limit L \[rad/s\].
    pub limit: f64,
    /// Viscous friction that counts as usual, above 0 \[N m s/rad\]. It scales the matrix.
    pub size: f64,
}

impl RisingFriction {
    /// Returns v1, v2 and v3 for parameters `x`.
    #[must_use]
    pub(crate) fn viscous(&self, x: &[f64]) -> [f64; 3] {
        let value = |k: usize| self.known[k] + self.columns[k].map_or(0.0, |column| x[column]);
        [value(0), value(1), value(2)]
    }

    /// Returns the matrix, scaled to be about 1, for parameters `x` and a scaled λ.
    fn matrix(&self, x: &[f64], lambda: f64) -> Matrix2<f64> {
        let [v1, v2, v3] = self.viscous(x);
        let Self { limit, size, .. } = self;
        let (a, b, c) = (v1 / size, v2 * limit / size, 3.0 * v3 * limit * limit / size);
        Matrix2::new(a - lambda, b, b, c + lambda)
    }

    /// Returns the derivatives of the matrix by its columns and by λ, at index `lambda`.
    fn derivatives(&self, lambda: usize) -> impl Iterator<Item = (usize, Matrix2<f64>)> {
        let Self { columns, limit, size, .. } = *self;
        let entries = [
            Matrix2::new(1.0 / size, 0.0, 0.0, 0.0),
            Matrix2::new(0.0, limit / size, limit / size, 0.0),
            Matrix2::new(0.0, 0.0, 0.0, 3.0 * limit * limit / size),
        ];
        let of_columns = columns.into_iter().zip(entries);
        let of_columns = of_columns.filter_map(|(column, entry)| Some((column?, entry)));
        of_columns.chain([(lambda, Matrix2::new(-1.0, 0.0, 0.0, 1.0))])
    }

    /// Moves `x` to friction that rises, with λ at index `lambda`.
    pub(super) fn start(&self, x: &mut DVector<f64>, lambda: usize) {
        for k in [1, 2] {
            self.columns[k].iter().for_each(|column| x[*column] = -self.known[k]);
        }
        let [_, v2, v3] = self.viscous(x.as_slice());
        let cubic = 3.0 * v3 * self.limit * self.limit;
        let v1 = self.size + (-cubic).max(0.0) + 2.0 * v2.abs() * self.limit;
        self.columns[0].iter().for_each(|column| x[*column] = v1 - self.known[0]);
        x[lambda] = 0.5 * (v1 + (-cubic).max(0.0)) / self.size;
    }

    /// Returns weight · trace - (weight + barrier) · log det of the matrix and of λ, infinite if
    /// one is not positive definite.
    pub(super) fn value(&self, x: &[f64], lambda: usize, [weight, barrier]: [f64; 2]) -> f64 {
        let matrix = self.matrix(x, x[lambda]);
        let det = matrix.determinant();
        if matrix[(0, 0)] <= 0.0 || det <= 0.0 || x[lambda] <= 0.0 {
            return f64::INFINITY;
        }
        weight * (matrix.trace() + x[lambda]) - (weight + barrier) * (det * x[lambda]).ln()
    }

    pub(super) fn add_derivatives(
        &self,
        x: &[f64],
        lambda: usize,
        [weight, barrier]: [f64; 2],
        (gradient, hessian): (&mut DVector<f64>, &mut DMatrix<f64>),
    ) -> Option<()> {
        let inverse = self.matrix(x, x[lambda]).try_inverse()?;
        let all: Vec<(usize, Matrix2<f64>)> = self.derivatives(lambda).collect();
        for (i, by_i) in &all {
            let relative = inverse * by_i;
            gradient[*i] += weight * by_i.trace() - (weight + barrier) * relative.trace();
            for (j, by_j) in &all {
                hessian[(*i, *j)] += (weight + barrier) * (relative * inverse * by_j).trace();
            }
        }
        gradient[lambda] += weight - (weight + barrier) / x[lambda];
        hessian[(lambda, lambda)] += (weight + barrier) / x[lambda].powi(2);
        Some(())
    }
}
