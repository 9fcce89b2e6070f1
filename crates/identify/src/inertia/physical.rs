use crate::bodies::RisingFriction;
use crate::bodies::program::{BodyProgram, PositiveColumn};
use crate::error::{Error, Result};
use crate::fit::{Fit, JointFit};
use crate::friction::falling::{FallingFriction, ViscousColumns};
use crate::inertia::columns::inertia_part;
use crate::inertia::prior::LinkPrior;
use crate::regression::residuals::root_mean_square;
use crate::regression::solution::Solution;
use crate::regression::triangular_factor::TriangularFactor;
use crate::samples::Samples;
use crate::settings::{ModelSettings, Prior};
use crate::variant::with_parameters;
use nalgebra::DVector;
use reachtube_robot::{FrictionDescription, Parameter, ParameterKind, Robot, RobotError};
use schemars::JsonSchema;
use serde::Serialize;

/// Limit of the rounds in which the size of the balls is adapted.
const SIZE_ROUNDS: usize = 30;

/// Least standard deviation of a joint's torque relative to its size that the program counts with.
const SHARPEST: f64 = 1e-4;

/// Prior of a positive parameter relative to the mean torque, if no joint determines one.
const FIRST_SHARE: f64 = 0.1;

/// Growth of a joint's residual by physical links beyond which a warning names the joint.
const MAX_GROWTH: f64 = 1.3;

/// Effect of the constraint that every link is physically consistent.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PhysicalFit {
    /// Reason why least squares gives no physical robot.
    ///
    /// It is `None` if the mass matrix of least squares is positive definite.
    pub plain_impossible: Option<String>,
    /// Growth of the sum of squared residuals, in squared standard deviations.
    ///
    /// Growth up to about the number of parameters is explained by noise.
    pub cost: f64,
    /// Duality gap: the objective exceeds its minimum by at most this value.
    pub gap: f64,
    /// Root mean squares of the residuals before and after, one pair per joint \[N m\].
    pub residuals: Vec<[f64; 2]>,
    /// Names of the links whose prior is a solid ball, because the description's link is not
    /// physically consistent or is not to be used.
    pub balls: Vec<String>,
}

impl PhysicalFit {
    /// Returns a warning for each joint whose residual grows too much by the physical constraint
    /// and its prior, in a fit of this quality.
    ///
    /// Residuals below [`SHARPEST`] of the torque count as that.
    pub(crate) fn growth_warnings(&self, robot: &Robot, fits: &[JointFit]) -> Vec<String> {
        let joints = robot.joints().iter().zip(&self.residuals).zip(fits);
        let grown = joints.filter(|((_, [plain, physical]), fit)| {
            *physical > MAX_GROWTH * plain.max(SHARPEST * fit.torque)
        });
        grown
            .map(|((joint, [plain, physical]), _)| {
                format!(
                    "{}: physical links raise the residual from {plain:.4} to {physical:.4} {}; \
                     give masses in the description, lower model.prior_strength, or set parameters \
                     = \"base\" in the description to keep the parameters of least squares",
                    joint.name,
                    joint.kind.force_unit()
                )
            })
            .collect()
    }
}

/// Finds the physically consistent links nearest to the data.
///
/// Returns the values of all columns of `moving`, the effect of the constraint, and viscous
/// friction that fell with speed. `known` is the robot whose friction was subtracted.
///
/// # Errors
///
/// [`Error::NoPhysicalLinks`] if the program has no solution.
pub(super) fn nearest_bodies(
    [robot, known]: [&Robot; 2],
    viscous: &ViscousColumns,
    fit: &Fit,
    moving: &Samples,
    model: &ModelSettings,
) -> Result<(DVector<f64>, PhysicalFit, Vec<FallingFriction>)> {
    let columns = &moving.columns;
    let data = &no_sharper(&fit.whitened, &fit.joints[0]);
    let positive = positive_columns([robot, known], columns, fit, model.prior);
    let solve = |prior: &LinkPrior, rising: &[RisingFriction]| {
        let (prior, strength) = (prior.inertias(), model.prior_strength);
        BodyProgram { data, prior: &prior, strength, positive: &positive, rising }
            .solve()
            .ok_or(Error::NoPhysicalLinks { cause: None })
    };
    // The data decide the size of the balls.
    let mut prior = LinkPrior::new(robot, model.prior);
    let mut solution = solve(&prior, &[])?;
    for _ in 0..SIZE_ROUNDS {
        if !prior.adapt(solution.x.as_slice()) {
            break;
        }
        solution = solve(&prior, &[])?;
    }
    let sizes = |x: &DVector<f64>| residual_sizes(moving, x);
    let again = |rising: &[RisingFriction]| Ok::<_, Error>(solve(&prior, rising)?.x);
    let falling = viscous.rise(&mut solution.x, again, sizes)?;
    let before = residual_sizes(moving, &fit.solution.x);
    let after = residual_sizes(moving, &solution.x);
    let physical = PhysicalFit {
        plain_impossible: why_impossible(robot, columns, &fit.solution.x)?,
        cost: fit.whitened.sum_of_squares(&solution.x)
            - fit.whitened.sum_of_squares(&fit.solution.x),
        gap: solution.gap,
        residuals: before.into_iter().zip(after).map(<[f64; 2]>::from).collect(),
        balls: prior.balls(robot),
    };
    Ok((solution.x, physical, falling))
}

/// Returns the data with errors of at least [`SHARPEST`] of the torque.
///
/// Exact data of a link on the boundary of the physical ones, such as a flat plate, would leave no
/// room inside for the program, beyond the rounding of the data.
fn no_sharper(data: &TriangularFactor, joints: &[JointFit]) -> TriangularFactor {
    let sharpness = |joint: &JointFit| joint.deviation / (SHARPEST * joint.torque);
    let sharpest = joints.iter().filter(|joint| joint.rows > 0).map(sharpness);
    let scale = sharpest.fold(1.0, f64::min).max(f64::EPSILON);
    TriangularFactor { r: scale * &data.r, z: scale * &data.z, residual: scale * data.residual }
}

/// Returns the columns that must be positive, with their priors: motor inertias, and friction that
/// only this fit determines, because it must dissipate.
///
/// A correction of known friction may have either sign. The prior is the value of the description,
/// or else the mean over the joints with a determined value of the same kind. Where there is none
/// it is a tenth of the mean torque, per 1 rad/s or 1 rad/s².
fn positive_columns(
    [robot, known]: [&Robot; 2],
    columns: &[Parameter],
    fit: &Fit,
    prior: Prior,
) -> Vec<PositiveColumn> {
    let frictionless =
        |joint: usize| known.description().joints[joint].friction == FrictionDescription::default();
    let is_positive = |column: &Parameter| match column.kind {
        ParameterKind::MotorInertia => true,
        ParameterKind::Coulomb | ParameterKind::Viscous1 => frictionless(column.joint),
        _ => false,
    };
    let described = robot.parameter_values(columns);
    let Solution { x, undetermined, .. } = &fit.solution;
    let of_kind = |kind: ParameterKind| {
        let usable = |c: &usize| columns[*c].kind == kind && x[*c] > 0.0;
        let values = (0..columns.len()).filter(|c| usable(c) && !undetermined.contains(c));
        let values: Vec<f64> = values.map(|c| x[c]).collect();
        let torques = fit.joints[0].iter().map(|joint| joint.torque).collect();
        let [own, torque] = [values, torques].map(|v| v.iter().sum::<f64>() / v.len() as f64);
        if own.is_finite() { own } else { FIRST_SHARE * torque }
    };
    let column = |index: usize| {
        let given = (prior == Prior::Description).then_some(described[index]);
        let given = given.filter(|given| *given > 0.0);
        let prior = given.unwrap_or_else(|| of_kind(columns[index].kind));
        PositiveColumn { index, prior: prior.max(f64::MIN_POSITIVE) }
    };
    (0..columns.len()).filter(|c| is_positive(&columns[*c])).map(column).collect()
}

/// Returns the root mean square of each joint's residuals \[N m\].
pub(super) fn residual_sizes(moving: &Samples, x: &DVector<f64>) -> Vec<f64> {
    let residuals = moving.residuals(x);
    let size =
        |joint| root_mean_square(moving.joint_values(&residuals, joint).concat().into_iter());
    (0..moving.joints).map(size).collect()
}

/// Returns why no physical robot has the given values: a negative motor inertia, or a mass matrix
/// that is not positive definite.
pub(crate) fn why_impossible(
    robot: &Robot,
    columns: &[Parameter],
    x: &DVector<f64>,
) -> Result<Option<String>> {
    let (columns, values) = inertia_part(columns, x);
    let checked = with_parameters(robot, &columns, &values)
        .and_then(|robot| Ok(robot.check_physical().map(drop)?));
    match checked {
        Ok(()) => Ok(None),
        Err(Error::Robot(
            error @ (RobotError::NotPhysical { .. } | RobotError::Invalid { .. }),
        )) => Ok(Some(error.to_string())),
        Err(other) => Err(other),
    }
}
