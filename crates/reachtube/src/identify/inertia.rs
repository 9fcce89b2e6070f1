//! The inertial parameters by linear regression, and the nearest that are physically possible.

use super::feasible::{Feasible, PER_LINK, pseudo_inertia};
use super::fit::{Fit, JointFit};
use super::gravity::with_parameters;
use super::prepare::Log;
use super::samples::{Known, Samples, Sampling};
use super::settings::{ModelSettings, Prior};
use crate::error::{Error, Result};
use nalgebra::{Cholesky, DVector, Matrix4, Vector4};
use reachtube_robot::{
    Column, ColumnKind, FrictionDescription, Parameters, Robot, RobotDescription, RobotError,
};
use serde::Serialize;

/// Radius of the balls that stand in for links of which nothing is known \[m\].
const BALL_RADIUS: f64 = 0.1;

/// The regression on exciting motions.
#[derive(Debug, Clone)]
pub struct InertiaFit {
    /// The columns of the regression.
    pub columns: Vec<Column>,
    /// Plain or robust least squares: of smallest norm where the rows leave some of it open.
    pub fit: Fit,
    /// The parameters that are used: those of the nearest bodies, or the above.
    pub values: DVector<f64>,
    /// What physical links cost; none where they were not asked for.
    pub physical: Option<PhysicalFit>,
    /// How well each joint's torque was fitted.
    pub joints: Vec<JointFit>,
}

/// What it costs that every link is a body.
#[derive(Debug, Clone, Serialize)]
pub struct PhysicalFit {
    /// Why plain least squares gives no robot; none where its mass matrix is positive definite.
    pub plain_impossible: Option<String>,
    /// Growth of the sum of squared residuals, in standard deviations squared: up to about the number of parameters it is noise.
    pub cost: f64,
    /// How far the program's objective is above its least value, at most.
    pub gap: f64,
    /// Root mean squares of the residuals before and after, joint by joint \[N m\].
    pub residuals: Vec<[f64; 2]>,
    /// Links whose prior is a ball, because the description's is no body.
    pub balls: Vec<String>,
}

/// The columns that are fitted to exciting motions.
pub fn columns(joints: usize, model: &ModelSettings, refit_friction: bool) -> Vec<Column> {
    let mut columns = Column::of_joints(joints, &ColumnKind::INERTIAL);
    if model.motor_inertia {
        columns.extend(Column::of_joints(joints, &[ColumnKind::MotorInertia]));
    }
    if refit_friction {
        let kinds = [ColumnKind::Coulomb, ColumnKind::Offset, ColumnKind::Viscous1, ColumnKind::Viscous3];
        columns.extend(Column::of_joints(joints, &kinds[..if model.cubic { 4 } else { 3 }]));
    }
    columns
}

/// Fits the inertial parameters to exciting motions and poses at rest; the friction of `known` is known, its gravity the load.
///
/// # Errors
///
/// [`Error::Setting`] where no motion is left, or no bodies are found near the data.
pub fn fit(
    robot: &Robot,
    known: &Robot,
    [dynamic, rests]: [&[Log]; 2],
    sampling: &Sampling,
    model: &ModelSettings,
    refit_friction: bool,
) -> Result<InertiaFit> {
    let columns = columns(robot.joint_count(), model, refit_friction);
    let moving = Samples::of(robot, &columns, dynamic, sampling, &Known::Friction(known));
    if !moving.used.contains(&true) {
        return Err(Error::Setting("no joint moves in the recordings for the inertial parameters; name recordings of motions with --dynamic".into()));
    }
    let still = Samples::of_rests(robot, &columns, rests, model.rest_speed);
    let groups: Vec<&Samples> = [&moving, &still].into_iter().filter(|samples| !samples.is_empty()).collect();
    let fit = Fit::of(&groups, !model.robust);
    let physical =
        model.physical.then(|| nearest_bodies(robot, &columns, &fit, &moving, model)).transpose()?;
    let (values, physical) = match physical {
        Some((values, physical)) => (values, Some(physical)),
        None => (fit.solution.x.clone(), None),
    };
    Ok(InertiaFit { columns, joints: fit.joints[0].clone(), fit, values, physical })
}

fn nearest_bodies(
    robot: &Robot,
    columns: &[Column],
    fit: &Fit,
    moving: &Samples,
    model: &ModelSettings,
) -> Result<(DVector<f64>, PhysicalFit)> {
    let (prior, balls) = prior(robot, model.prior);
    let positive: Vec<usize> =
        (0..columns.len()).filter(|c| columns[*c].kind == ColumnKind::MotorInertia).collect();
    let strength = model.prior_strength;
    let program = Feasible { data: &fit.whitened, prior: &prior, strength, positive: &positive };
    let point = program.solve().ok_or_else(|| {
        Error::Setting("no possible bodies were found near the data: check gains and signs, or set model.physical = false to see the plain fit".into())
    })?;
    let plain = with_parameters(robot, &body_columns(columns), &body_values(columns, &fit.solution.x));
    let residuals = |x| {
        let residuals = moving.residuals(x);
        let size = |joint| {
            super::regression::root_mean_square(moving.of_joint(&residuals, joint).concat().into_iter())
        };
        (0..moving.joints).map(size).collect::<Vec<f64>>()
    };
    let (before, after) = (residuals(&fit.solution.x), residuals(&point.x));
    let physical = PhysicalFit {
        plain_impossible: impossible(plain)?,
        cost: fit.whitened.squares(&point.x) - fit.whitened.squares(&fit.solution.x),
        gap: point.gap,
        residuals: before.into_iter().zip(after).map(<[f64; 2]>::from).collect(),
        balls,
    };
    Ok((point.x, physical))
}

/// Why a robot is none: a negative motor inertia, or a mass matrix that is not positive definite.
fn impossible(robot: Result<Robot>) -> Result<Option<String>> {
    let checked = robot.and_then(|robot| Ok(robot.check_physical().map(drop)?));
    match checked {
        Ok(()) => Ok(None),
        Err(Error::Robot(error @ (RobotError::NotPhysical { .. } | RobotError::Invalid { .. }))) => {
            Ok(Some(error.to_string()))
        }
        Err(other) => Err(other),
    }
}

/// Pseudo-inertias of the description's links, or balls of the robot's mean mass where asked for or where a link is no body; and the names of the latter.
fn prior(robot: &Robot, prior: Prior) -> (Vec<Matrix4<f64>>, Vec<String>) {
    let parameters = robot.inertial_parameters();
    let links: Vec<Matrix4<f64>> = parameters.chunks_exact(PER_LINK).map(pseudo_inertia).collect();
    let body = |p: &Matrix4<f64>| prior == Prior::Description && Cholesky::new(*p).is_some();
    let masses: Vec<f64> = links.iter().filter(|p| body(p)).map(|p| p[(3, 3)]).collect();
    let mean = if masses.is_empty() { 1.0 } else { masses.iter().sum::<f64>() / masses.len() as f64 };
    let second = 0.2 * mean * BALL_RADIUS * BALL_RADIUS;
    let ball = Matrix4::from_diagonal(&Vector4::new(second, second, second, mean));
    let replaced = robot
        .joints()
        .iter()
        .zip(&links)
        .filter(|(_, p)| !body(p))
        .map(|(joint, _)| joint.name.clone())
        .collect();
    (links.iter().map(|p| if body(p) { *p } else { ball }).collect(), replaced)
}

fn is_body(column: &Column) -> bool {
    column.kind.is_inertial() || column.kind == ColumnKind::MotorInertia
}

fn body_columns(columns: &[Column]) -> Vec<Column> {
    columns.iter().copied().filter(is_body).collect()
}

fn body_values(columns: &[Column], values: &DVector<f64>) -> DVector<f64> {
    let body: Vec<f64> =
        columns.iter().zip(values.iter()).filter(|(c, _)| is_body(c)).map(|(_, v)| *v).collect();
    DVector::from_vec(body)
}

/// The description of the robot that was found: `friction` of its own fit plus what was fitted with the inertial parameters.
///
/// # Errors
///
/// As [`Robot::from_description`].
pub fn description(
    robot: &Robot,
    found: &InertiaFit,
    friction: &[FrictionDescription],
) -> Result<RobotDescription> {
    let (bodies, values) = (body_columns(&found.columns), body_values(&found.columns, &found.values));
    let mut out = with_parameters(robot, &bodies, &values)?.description().clone();
    out.parameters = if found.physical.is_some() { Parameters::Physical } else { Parameters::Base };
    for (joint, friction) in out.joints.iter_mut().zip(friction) {
        joint.friction = *friction;
    }
    for (column, value) in found.columns.iter().zip(found.values.iter()) {
        let FrictionDescription { coulomb, viscous } = &mut out.joints[column.joint].friction;
        // Offsets of driving forward, driving backward, braking backward, braking forward.
        let mut add = |signs: [f64; 4]| (0..4).for_each(|q| coulomb[2 * q] += signs[q] * value);
        match column.kind {
            ColumnKind::Coulomb => add([1.0, -1.0, -1.0, 1.0]),
            ColumnKind::Offset => add([1.0; 4]),
            ColumnKind::Viscous1 => viscous[0] += value,
            ColumnKind::Viscous3 => viscous[2] += value,
            _ => {}
        }
    }
    Ok(out)
}
