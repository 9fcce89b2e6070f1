use crate::bodies::program::BodyProgram;
use crate::bodies::pseudo_inertia::{PER_LINK, pseudo_inertia};
use crate::error::{Error, Result};
use crate::fit::Fit;
use crate::inertia::columns::inertia_part;
use crate::regression::residuals::root_mean_square;
use crate::samples::Samples;
use crate::settings::{ModelSettings, Prior};
use crate::variant::with_parameters;
use nalgebra::{Cholesky, DVector, Matrix4, Vector4};
use reachtube_robot::{FrictionDescription, Parameter, ParameterKind, Robot, RobotError};
use serde::Serialize;

/// Radius of the solid balls that are the prior of unknown links \[m\].
const BALL_RADIUS: f64 = 0.1;

/// Effect of the constraint that every link is physically consistent.
#[derive(Debug, Clone, Serialize)]
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

/// Finds the physically consistent links nearest to the data.
///
/// Returns all values of `columns` and the effect of the constraint. `known` is the robot whose
/// friction was subtracted.
///
/// # Errors
///
/// [`Error::NoPhysicalLinks`] if the program has no solution.
pub fn nearest_bodies(
    [robot, known]: [&Robot; 2],
    columns: &[Parameter],
    fit: &Fit,
    moving: &Samples,
    model: &ModelSettings,
) -> Result<(DVector<f64>, PhysicalFit)> {
    let (prior, balls) = prior(robot, model.prior);
    let positive = positive_columns(known, columns);
    let strength = model.prior_strength;
    let program = BodyProgram { data: &fit.whitened, prior: &prior, strength, positive: &positive };
    let solution = program.solve().ok_or(Error::NoPhysicalLinks)?;
    let (inertia_columns, values) = inertia_part(columns, &fit.solution.x);
    let least_squares = with_parameters(robot, &inertia_columns, &values);
    let before = residual_sizes(moving, &fit.solution.x);
    let after = residual_sizes(moving, &solution.x);
    let physical = PhysicalFit {
        plain_impossible: why_impossible(least_squares)?,
        cost: fit.whitened.sum_of_squares(&solution.x)
            - fit.whitened.sum_of_squares(&fit.solution.x),
        gap: solution.gap,
        residuals: before.into_iter().zip(after).map(<[f64; 2]>::from).collect(),
        balls,
    };
    Ok((solution.x, physical))
}

/// Returns the indices of columns that must be positive: motor inertias, and friction that only
/// this fit determines, because it must dissipate.
///
/// A correction of known friction may have either sign.
fn positive_columns(known: &Robot, columns: &[Parameter]) -> Vec<usize> {
    let frictionless =
        |joint: usize| known.description().joints[joint].friction == FrictionDescription::default();
    let positive = |column: &Parameter| match column.kind {
        ParameterKind::MotorInertia => true,
        ParameterKind::Coulomb | ParameterKind::Viscous1 => frictionless(column.joint),
        _ => false,
    };
    (0..columns.len()).filter(|c| positive(&columns[*c])).collect()
}

/// Returns the root mean square of each joint's residuals \[N m\].
fn residual_sizes(moving: &Samples, x: &DVector<f64>) -> Vec<f64> {
    let residuals = moving.residuals(x);
    let size =
        |joint| root_mean_square(moving.joint_values(&residuals, joint).concat().into_iter());
    (0..moving.joints).map(size).collect()
}

/// Returns why a robot is not physical: a negative motor inertia, or a mass matrix that is not
/// positive definite.
fn why_impossible(robot: Result<Robot>) -> Result<Option<String>> {
    let checked = robot.and_then(|robot| Ok(robot.check_physical().map(drop)?));
    match checked {
        Ok(()) => Ok(None),
        Err(Error::Robot(
            error @ (RobotError::NotPhysical { .. } | RobotError::Invalid { .. }),
        )) => Ok(Some(error.to_string())),
        Err(other) => Err(other),
    }
}

/// Returns the pseudo-inertia of each link's prior, and the names of the links that have a ball.
///
/// The prior is the link of the description, or a solid ball with the mean mass of the usable
/// links.
fn prior(robot: &Robot, prior: Prior) -> (Vec<Matrix4<f64>>, Vec<String>) {
    let parameters = robot.inertial_parameters();
    let links: Vec<Matrix4<f64>> = parameters.chunks_exact(PER_LINK).map(pseudo_inertia).collect();
    let usable = |p: &Matrix4<f64>| prior == Prior::Description && Cholesky::new(*p).is_some();
    let masses: Vec<f64> = links.iter().filter(|p| usable(p)).map(|p| p[(3, 3)]).collect();
    let mean =
        if masses.is_empty() { 1.0 } else { masses.iter().sum::<f64>() / masses.len() as f64 };
    // A solid ball has the second moment m r² / 5 along each axis.
    let second = 0.2 * mean * BALL_RADIUS * BALL_RADIUS;
    let ball = Matrix4::from_diagonal(&Vector4::new(second, second, second, mean));
    let replaced = robot
        .joints()
        .iter()
        .zip(&links)
        .filter(|(_, p)| !usable(p))
        .map(|(joint, _)| joint.name.clone())
        .collect();
    (links.iter().map(|p| if usable(p) { *p } else { ball }).collect(), replaced)
}
