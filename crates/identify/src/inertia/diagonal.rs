//! How well the recordings determine the inertia that each joint feels.

use crate::prepare::log::PreparedLog;
use crate::regression::singular::UnitSingular;
use crate::regression::triangular_factor::TriangularFactor;
use nalgebra::{DMatrix, DVector};
use reachtube_robot::{Parameter, Regressor, Robot};
use schemars::JsonSchema;
use serde::Serialize;

/// Positions at which the mass matrix is looked at, at most.
const POSITIONS: usize = 40;

/// Part of a combination in directions that are not determined which is rounding.
const NEGLIGIBLE: f64 = 1e-6;

/// A standard error above this part of the inertia produces a warning.
const LARGEST_ERROR: f64 = 0.5;

/// The inertia that a joint feels: its entry of the diagonal of the mass matrix, as mean over
/// recorded positions.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct JointInertia {
    /// Name of the joint.
    pub joint: String,
    /// The inertia by least squares \[kg m²; kg for a prismatic joint\].
    pub least_squares: f64,
    /// Its standard error; infinite if the recordings do not determine it.
    #[schemars(with = "Option<f64>")]
    pub standard_error: f64,
}

impl JointInertia {
    /// Returns the inertia of each joint by the least squares `x` of rows with the factor `fit`,
    /// whose errors have variance 1.
    pub(super) fn of_joints(
        robot: &Robot,
        columns: &[Parameter],
        logs: &[PreparedLog],
        (fit, x): (&TriangularFactor, &DVector<f64>),
    ) -> Vec<Self> {
        let n = robot.joint_count();
        let samples: usize = logs.iter().map(PreparedLog::len).sum();
        let positions = logs.iter().flat_map(|log| (0..log.len()).map(|k| log.q(k).to_vec()));
        let positions: Vec<Vec<f64>> =
            positions.step_by(samples.div_ceil(POSITIONS).max(1)).collect();
        let directions = Directions::new(fit);
        let mut regressor = Regressor::new(robot, columns);
        let of_joint = |joint: usize| {
            let mut unit = vec![0.0; n];
            unit[joint] = 1.0;
            let still = vec![0.0; n];
            // The torque of a unit acceleration, without gravity.
            let states: Vec<[Vec<f64>; 3]> = positions
                .iter()
                .flat_map(|q| [&unit, &still].map(|qdd| [q.clone(), still.clone(), qdd.clone()]))
                .collect();
            let rows = regressor.stacked(&states);
            let row = |k: usize| rows.row(2 * k * n + joint) - rows.row((2 * k + 1) * n + joint);
            let all = (0..positions.len()).map(|k| row(k).transpose());
            let mean = all.sum::<DVector<f64>>() / positions.len().max(1) as f64;
            Self {
                joint: robot.joints()[joint].name.clone(),
                least_squares: mean.dot(x),
                standard_error: directions.error(&mean),
            }
        };
        (0..n).map(of_joint).collect()
    }

    /// Returns a warning if the recordings do not determine the inertia.
    pub(super) fn warning(&self, robot: &Robot) -> Option<String> {
        let Self { joint, least_squares, standard_error } = self;
        let is_open = *standard_error > LARGEST_ERROR * least_squares.abs();
        let own = robot.joints().iter().find(|own| own.name == *joint)?;
        let unit = own.kind.inertia_unit();
        is_open.then(|| {
            let error = match standard_error.is_finite() {
                true => format!("{least_squares:.4} ± {standard_error:.4} {unit}"),
                false => "nothing shows it".to_string(),
            };
            format!(
                "the recordings do not determine the inertia that the motor of {joint} moves \
                    ({error}), so that \
                 its acceleration is not known; move it with more acceleration, or give its motor \
                 inertia in the description"
            )
        })
    }
}

/// The directions of the parameters that rows determine, with their errors.
struct Directions {
    /// Scale of each column.
    unit: DVector<f64>,
    /// One column per direction.
    v: DMatrix<f64>,
    /// Standard error along each direction; `None` if it is not determined.
    errors: Vec<Option<f64>>,
}

impl Directions {
    fn new(fit: &TriangularFactor) -> Self {
        let UnitSingular { unit, singular, cut } = UnitSingular::of(&fit.r);
        let error = |value: &f64| (*value > cut).then(|| 1.0 / value);
        Self { unit, errors: singular.values.iter().map(error).collect(), v: singular.v }
    }

    /// Returns the standard error of the combination `row` of the parameters.
    fn error(&self, row: &DVector<f64>) -> f64 {
        // A column that no row shows leaves its parameter open.
        let least = NEGLIGIBLE * row.amax();
        let hidden = row.iter().zip(&self.unit).any(|(x, unit)| *unit == 0.0 && x.abs() > least);
        let scaled = row.component_mul(&self.unit);
        let size = scaled.norm();
        let part = |(direction, error): (usize, &Option<f64>)| {
            let part = self.v.column(direction).dot(&scaled);
            match error {
                Some(error) => (part * error).powi(2),
                None if part.abs() > NEGLIGIBLE * size => f64::INFINITY,
                None => 0.0,
            }
        };
        if hidden {
            return f64::INFINITY;
        }
        self.errors.iter().enumerate().map(part).sum::<f64>().sqrt()
    }
}
