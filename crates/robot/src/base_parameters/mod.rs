//! Base parameters: the combinations of parameters that torque can show.

mod combination;
mod independent;

use crate::singular::singular_values;
use crate::states::{Random, rest, states};
use crate::{Column, Regressor, Robot};
use independent::{Independent, triangle};
use nalgebra::{DMatrix, DVector};

/// Random states for the numerical base: several times as many equations as any arm has parameters.
const STATES: usize = 200;

/// Columns count as dependent where less than this part of them is new: far above rounding, far
/// below what a regressor over random states leaves.
const TOLERANCE: f64 = 1e-9;

/// A numerical base of a regressor (Gautier 1991): independent columns, and the combinations β = K
/// θ that stand in for all parameters, Y θ = Y_b β.
///
/// Columns are scaled to unit length and taken in their given order: each that is independent of
/// those before is one of the base, others are expressed by those. With the columns joint by joint
/// from the base, as [`Column::of_joints`] makes them, parameters of a link that are only seen
/// through earlier links are grouped with those, as is common in the literature.
///
/// # Examples
///
/// ```
/// use reachtube_robot::{BaseParameters, Column, ColumnKind, Robot};
///
/// let robot = Robot::lwa4p();
/// let columns = Column::of_joints(6, &ColumnKind::INERTIAL);
/// let base = BaseParameters::of_robot(&robot, &columns);
/// assert_eq!(base.count(), 36);
/// assert_eq!(base.names().last().unwrap(), "Izz6");
/// ```
#[derive(Clone, Debug)]
pub struct BaseParameters {
    columns: Vec<Column>,
    independent: Vec<usize>,
    /// K, base parameters x columns.
    combinations: DMatrix<f64>,
    singular_values: Vec<f64>,
}

impl BaseParameters {
    /// The base of a robot in motion: 200 reproducible random states within its limits,
    /// accelerations to 5 rad/s², speeds to the limit or 2 rad/s.
    ///
    /// For gravity left out or tilted, take the base of [`Robot::with_gravity`].
    pub fn of_robot(robot: &Robot, columns: &[Column]) -> Self {
        Self::over(robot, columns, &states(robot, STATES, &mut Random::new(1)))
    }

    /// The base of a robot at rest at 200 random positions: what gravity alone shows.
    pub fn at_rest(robot: &Robot, columns: &[Column]) -> Self {
        Self::over(robot, columns, &rest(robot, STATES, &mut Random::new(1)))
    }

    fn over(robot: &Robot, columns: &[Column], states: &[[Vec<f64>; 3]]) -> Self {
        Self::of_regressor(columns, &Regressor::new(robot, columns).stacked(states), TOLERANCE)
    }

    /// The base of a stacked regressor \[equations x columns\]; a column is new where more than
    /// `tolerance` of its length is independent of those before, and counts as 0 below that part of
    /// the longest column.
    ///
    /// For recorded motions this says what they excite, if `tolerance` is above their noise.
    ///
    /// # Panics
    ///
    /// When the regressor has another number of columns.
    pub fn of_regressor(columns: &[Column], stacked: &DMatrix<f64>, tolerance: f64) -> Self {
        assert_eq!(stacked.ncols(), columns.len(), "one column a parameter");
        let (r, norms) = triangle(stacked, tolerance);
        let singular_values = singular_values(&r);
        let Independent { indices, combinations } = Independent::of(&r, &norms, tolerance);
        Self { columns: columns.to_vec(), independent: indices, combinations, singular_values }
    }

    /// Number of base parameters.
    pub fn count(&self) -> usize {
        self.independent.len()
    }

    /// All columns that were asked about.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Indices of the columns that make the base regressor Y_b, ascending.
    pub fn independent(&self) -> &[usize] {
        &self.independent
    }

    /// K \[base parameters x columns\] of β = K θ, to rounding; the identity on the independent
    /// columns.
    pub fn combinations(&self) -> &DMatrix<f64> {
        &self.combinations
    }

    /// Singular values of the regressor with columns of unit length, descending, relative to the
    /// largest.
    pub fn singular_values(&self) -> Vec<f64> {
        let largest = self.singular_values.first().copied().unwrap_or(0.0);
        self.singular_values
            .iter()
            .map(|s| if largest == 0.0 { 0.0 } else { s / largest })
            .collect()
    }

    /// The relative singular values either side of the cut: the smallest that counts and the
    /// largest that does not (0 where all count). Only where they are far apart is the number of
    /// base parameters beyond doubt.
    pub fn gap(&self) -> [f64; 2] {
        let s = self.singular_values();
        [self.count().checked_sub(1), Some(self.count())]
            .map(|k| k.and_then(|k| s.get(k)).copied().unwrap_or(0.0))
    }

    /// Columns that torque does not show at all, alone or in combination.
    pub fn invisible(&self) -> Vec<Column> {
        let shown = |k: &usize| self.combinations.column(*k).amax() > TOLERANCE;
        (0..self.columns.len()).filter(|k| !shown(k)).map(|k| self.columns[k]).collect()
    }

    /// The base parameters β = K θ of parameter values θ, each in its column's unit.
    ///
    /// # Panics
    ///
    /// When there is not one value a column.
    pub fn reduce(&self, theta: &[f64]) -> DVector<f64> {
        &self.combinations * DVector::from_column_slice(theta)
    }

    /// The simplest parameters θ that have the base parameters β: dependent columns 0.
    ///
    /// # Panics
    ///
    /// When there is not one value a base parameter.
    pub fn lift(&self, beta: &[f64]) -> DVector<f64> {
        assert_eq!(beta.len(), self.count(), "one value a base parameter");
        let mut theta = DVector::zeros(self.columns.len());
        self.independent.iter().zip(beta).for_each(|(k, b)| theta[*k] = *b);
        theta
    }

    /// The parameters θ with the base parameters β that are nearest to given ones, in the plain
    /// Euclidean sense.
    ///
    /// # Panics
    ///
    /// When there is not one value a base parameter, and one a column.
    pub fn lift_near(&self, beta: &[f64], prior: &[f64]) -> DVector<f64> {
        let prior = DVector::from_column_slice(prior);
        let lacking = DVector::from_column_slice(beta) - &self.combinations * &prior;
        let gram = &self.combinations * self.combinations.transpose();
        let weights =
            gram.cholesky().expect("K holds the identity, so K Kᵀ is at least 1").solve(&lacking);
        prior + self.combinations.tr_mul(&weights)
    }

    /// The columns of Y_b of a stacked regressor with this base's columns.
    pub fn select(&self, stacked: &DMatrix<f64>) -> DMatrix<f64> {
        stacked.select_columns(&self.independent)
    }

    /// The combinations in words, as `Ixx2 - Iyy2 + Izz2 + J2` or `mx2 + (Izz2 + J2)/0.35`.
    ///
    /// Coefficients within 1e-9 of a short decimal, its square, or the inverse of these are printed
    /// so; others with 6 digits. [`BaseParameters::combinations`] has them in full.
    pub fn names(&self) -> Vec<String> {
        let transposed = self.combinations.transpose();
        let rows = transposed.as_slice().chunks(self.columns.len().max(1));
        rows.zip(&self.independent)
            .map(|(row, k)| combination::words(&self.columns, *k, row))
            .collect()
    }
}
