//! The base parameters of a robot or of a stacked regressor.

use super::combination::format_combination;
use super::independent::{IndependentColumns, scaled_triangle};
use crate::parameter::Parameter;
use crate::random_states::{Random, random_rest_states, random_states};
use crate::regressor::Regressor;
use crate::robot::Robot;
use crate::singular_values::singular_values;
use nalgebra::{DMatrix, DVector};

/// Number of random states for the numerical base, which gives several times as many equations as
/// an arm has parameters.
const STATES: usize = 200;

/// A column is dependent if its part that is independent of earlier columns is shorter than this,
/// relative to the column. The value is far above rounding errors and far below the independent
/// parts in a regressor over random states.
const TOLERANCE: f64 = 1e-9;

/// The base parameters β = K θ of a regressor Y (Gautier 1991), for which Y θ = Y_b β with the
/// independent columns Y_b of Y.
///
/// Columns are scaled to unit length and processed in their given order. A column that is
/// independent of the earlier ones is a column of Y_b; any other column is a combination of such
/// columns. [`Parameter::of_joints`] has the order that is common in the literature, joint by joint
/// from the base. Parameters that are identifiable only together with parameters of earlier links
/// are then grouped with these.
///
/// # Examples
///
/// ```
/// use reachtube_robot::{BaseParameters, Parameter, ParameterKind, Robot};
///
/// let robot = Robot::lwa4p();
/// let parameters = Parameter::of_joints(6, &ParameterKind::INERTIAL);
/// let base = BaseParameters::of_robot(&robot, &parameters);
/// assert_eq!(base.count(), 36);
/// assert_eq!(base.names().last().unwrap(), "Izz6");
/// ```
#[derive(Clone, Debug)]
pub struct BaseParameters {
    parameters: Vec<Parameter>,
    /// Indices of the columns of Y_b.
    independent: Vec<usize>,
    /// K, base parameters x parameters.
    combinations: DMatrix<f64>,
    singular_values: Vec<f64>,
}

impl BaseParameters {
    /// Computes the base parameters of a robot in motion.
    ///
    /// The regressor has 200 reproducible random states within the limits. Accelerations are up to
    /// 5 rad/s², and speeds up to the limit, which is 2 rad/s for joints without one. For a robot
    /// without gravity or on a tilted base, pass the robot from [`Robot::with_gravity`].
    pub fn of_robot(robot: &Robot, parameters: &[Parameter]) -> Self {
        Self::over(robot, parameters, &random_states(robot, STATES, &mut Random::new(1)))
    }

    /// Computes the base parameters of a robot at rest at 200 random positions: the parameters that
    /// gravity alone identifies.
    pub fn at_rest(robot: &Robot, parameters: &[Parameter]) -> Self {
        Self::over(robot, parameters, &random_rest_states(robot, STATES, &mut Random::new(1)))
    }

    fn over(robot: &Robot, parameters: &[Parameter], states: &[[Vec<f64>; 3]]) -> Self {
        let stacked = Regressor::new(robot, parameters).stacked(states);
        Self::of_regressor(parameters, &stacked, TOLERANCE)
    }

    /// Computes the base parameters of a stacked regressor \[equations x parameters\].
    ///
    /// A column is independent if more than `tolerance` of its length is independent of the earlier
    /// columns. A column shorter than `tolerance` times the longest column counts as 0. For
    /// recorded motions, the base parameters are the parameters that the motions excite, if
    /// `tolerance` is above the noise.
    ///
    /// # Panics
    ///
    /// Panics if the regressor does not have one column per parameter.
    pub(crate) fn of_regressor(
        parameters: &[Parameter],
        stacked: &DMatrix<f64>,
        tolerance: f64,
    ) -> Self {
        assert_eq!(stacked.ncols(), parameters.len(), "one column per parameter");
        let (r, norms) = scaled_triangle(stacked, tolerance);
        let singular_values = singular_values(&r);
        let IndependentColumns { indices, combinations } =
            IndependentColumns::of(&r, &norms, tolerance);
        Self {
            parameters: parameters.to_vec(),
            independent: indices,
            combinations,
            singular_values,
        }
    }

    /// Returns the number of base parameters.
    pub fn count(&self) -> usize {
        self.independent.len()
    }

    /// Returns all parameters θ, in the order of the columns.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Returns the indices of the columns that form the base regressor Y_b, ascending.
    pub fn independent(&self) -> &[usize] {
        &self.independent
    }

    /// Returns K \[base parameters x parameters\] of β = K θ. It is exact to rounding, and the
    /// identity on the independent columns.
    pub fn combinations(&self) -> &DMatrix<f64> {
        &self.combinations
    }

    /// Returns the singular values of the regressor with columns of unit length, in descending
    /// order, relative to the largest.
    pub(crate) fn singular_values(&self) -> Vec<f64> {
        let largest = self.singular_values.first().copied().unwrap_or(0.0);
        self.singular_values
            .iter()
            .map(|s| if largest == 0.0 { 0.0 } else { s / largest })
            .collect()
    }

    /// Returns the relative singular values on both sides of the rank: the smallest that counts and
    /// the largest that does not (0 if all count).
    ///
    /// The number of base parameters is certain only if these two are far apart.
    pub fn gap(&self) -> [f64; 2] {
        let s = self.singular_values();
        [self.count().checked_sub(1), Some(self.count())]
            .map(|k| k.and_then(|k| s.get(k)).copied().unwrap_or(0.0))
    }

    /// Returns the base parameters β = K θ of parameter values θ, each in its SI unit.
    ///
    /// # Panics
    ///
    /// Panics if there is not one value per parameter.
    pub fn reduce(&self, theta: &[f64]) -> DVector<f64> {
        &self.combinations * DVector::from_column_slice(theta)
    }

    /// Returns the parameters θ with the base parameters β that are nearest to a prior in the
    /// Euclidean norm of the SI values.
    ///
    /// # Panics
    ///
    /// Panics if `beta` does not have one value per base parameter, or `prior` one per parameter.
    pub fn lift_near(&self, beta: &[f64], prior: &[f64]) -> DVector<f64> {
        let prior = DVector::from_column_slice(prior);
        let difference = DVector::from_column_slice(beta) - &self.combinations * &prior;
        let gram = &self.combinations * self.combinations.transpose();
        let weights = gram
            .cholesky()
            .expect("K contains the identity, so K Kᵀ is at least 1")
            .solve(&difference);
        prior + self.combinations.tr_mul(&weights)
    }

    /// Returns the columns of Y_b of a stacked regressor \[equations x parameters\].
    pub fn select(&self, stacked: &DMatrix<f64>) -> DMatrix<f64> {
        stacked.select_columns(&self.independent)
    }

    /// Returns the combinations as formulas, such as `Ixx2 - Iyy2 + Izz2 + J2` or
    /// `mx2 + (Izz2 + J2)/0.35`.
    ///
    /// A coefficient within 1e-9 of a short decimal, its square, or the inverse of these is printed
    /// in that form, and any other coefficient with 6 decimal places.
    /// [`BaseParameters::combinations`] has the full precision.
    pub fn names(&self) -> Vec<String> {
        let transposed = self.combinations.transpose();
        let rows = transposed.as_slice().chunks(self.parameters.len().max(1));
        rows.zip(&self.independent)
            .map(|(row, k)| format_combination(&self.parameters, *k, row))
            .collect()
    }
}
