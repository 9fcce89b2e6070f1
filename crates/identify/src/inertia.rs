//! The inertial parameters by linear regression, and the nearest that are physically possible.

use super::feasible::{Feasible, PER_LINK, pseudo_inertia};
use super::fit::{Fit, JointFit};
use super::gravity::with_parameters;
use super::prepare::Log;
use super::samples::{Known, Samples, Sampling};
use super::settings::{ModelSettings, Prior};
use crate::error::{Error, Result};
use nalgebra::{Cholesky, DMatrix, DVector, Matrix4, Vector4};
use reachtube_robot::{
    BaseParameters, Column, ColumnKind, FrictionDescription, Parameters, Robot, RobotDescription,
    RobotError,
};
use serde::Serialize;

/// Condition beyond which a combination counts as not shown: one part in ten thousand of a column
/// is below what a rigid robot's torque is known to.
pub const ILL_CONDITIONED: f64 = 1e4;

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
    /// The combinations that torque shows.
    pub parameters: Vec<BaseParameter>,
    /// Condition number of the base regressor, columns scaled to unit length; infinite where the
    /// recordings leave a combination open.
    pub condition: f64,
    /// Relative singular values of the structural base, either side of the cut.
    pub gap: [f64; 2],
}

/// A combination of parameters that torque shows, with its value in SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BaseParameter {
    /// The combination, such as `Ixx2 - Iyy2 + Izz2 + J2`.
    pub name: String,
    /// Its value in the robot that was found.
    pub value: f64,
    /// Its value by least squares.
    pub least_squares: f64,
    /// Standard error of the latter; infinite where the recordings do not show it.
    pub standard_error: f64,
    /// Its value in the description that was given.
    pub described: f64,
}

/// What it costs that every link is a body.
#[derive(Debug, Clone, Serialize)]
pub struct PhysicalFit {
    /// Why plain least squares gives no robot; none where its mass matrix is positive definite.
    pub plain_impossible: Option<String>,
    /// Growth of the sum of squared residuals, in standard deviations squared: up to about the
    /// number of parameters it is noise.
    pub cost: f64,
    /// How far the program's objective is above its least value, at most.
    pub gap: f64,
    /// Root mean squares of the residuals before and after, joint by joint \[N m\].
    pub residuals: Vec<[f64; 2]>,
    /// Links whose prior is a ball, because the description's is no body.
    pub balls: Vec<String>,
}

/// What is fitted of friction with the inertial parameters.
#[derive(Debug, Clone, Copy)]
pub struct Friction {
    /// Whether it is fitted at all: as a change where it is known.
    pub refit: bool,
    /// Whether it has a cubic term.
    pub cubic: bool,
}

/// The columns that are fitted to exciting motions.
pub fn columns(joints: usize, model: &ModelSettings, friction: Friction) -> Vec<Column> {
    let mut columns = Column::of_joints(joints, &ColumnKind::INERTIAL);
    if model.motor_inertia {
        columns.extend(Column::of_joints(joints, &[ColumnKind::MotorInertia]));
    }
    if friction.refit {
        let kinds =
            [ColumnKind::Coulomb, ColumnKind::Offset, ColumnKind::Viscous1, ColumnKind::Viscous3];
        columns.extend(Column::of_joints(joints, &kinds[..if friction.cubic { 4 } else { 3 }]));
    }
    columns
}

/// Fits the inertial parameters to exciting motions and poses at rest; the friction of `known` is
/// known, its gravity the load.
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
    friction: Friction,
) -> Result<InertiaFit> {
    let columns = columns(robot.joint_count(), model, friction);
    let moving = Samples::of(robot, &columns, dynamic, sampling, &Known::Friction(known));
    if !moving.used.contains(&true) {
        return Err(Error::Setting("no joint moves in the recordings for the inertial parameters; name recordings of motions with --dynamic".into()));
    }
    let still = Samples::of_rests(robot, &columns, rests, model.rest_speed);
    let groups: Vec<&Samples> =
        [&moving, &still].into_iter().filter(|samples| !samples.is_empty()).collect();
    let fit = Fit::of(&groups, !model.robust);
    let physical = model
        .physical
        .then(|| nearest_bodies([robot, known], &columns, &fit, &moving, model))
        .transpose()?;
    let (values, physical) = match physical {
        Some((values, physical)) => (values, Some(physical)),
        None => (fit.solution.x.clone(), None),
    };
    let base = BaseParameters::of_robot(robot, &columns);
    let (parameters, condition) = base_parameters(robot, &base, &fit, &values, model.physical)?;
    Ok(InertiaFit {
        joints: fit.joints[0].clone(),
        gap: base.gap(),
        columns,
        fit,
        values,
        physical,
        parameters,
        condition,
    })
}

/// The base parameters with their errors, and the condition of their regression.
fn base_parameters(
    robot: &Robot,
    base: &BaseParameters,
    fit: &Fit,
    values: &DVector<f64>,
    physical: bool,
) -> Result<(Vec<BaseParameter>, f64)> {
    let chosen = DMatrix::from_fn(base.columns().len(), base.count(), |i, j| {
        f64::from(u8::from(base.independent()[j] == i))
    });
    let solution = fit.whitened.mapped(&chosen).solve_within(ILL_CONDITIONED.recip());
    let names = base.names();
    if !physical && !solution.open.is_empty() {
        let open: Vec<&str> = solution.open.iter().map(|k| names[*k].as_str()).collect();
        return Err(Error::Setting(format!(
            "the recordings do not show {} of {} combinations of parameters (condition above {ILL_CONDITIONED:.0e}): {}; move all joints through more positions and \
             faster, or set model.physical = true, where the description decides what they leave open",
            open.len(),
            names.len(),
            open.join("; ")
        )));
    }
    let (found, described) =
        (base.reduce(values.as_slice()), base.reduce(&robot.column_values(base.columns())));
    let errors = solution.standard_errors();
    let parameter = |(k, name)| BaseParameter {
        name,
        value: found[k],
        least_squares: solution.x[k],
        standard_error: errors[k],
        described: described[k],
    };
    Ok((names.into_iter().enumerate().map(parameter).collect(), solution.condition))
}

fn nearest_bodies(
    [robot, known]: [&Robot; 2],
    columns: &[Column],
    fit: &Fit,
    moving: &Samples,
    model: &ModelSettings,
) -> Result<(DVector<f64>, PhysicalFit)> {
    let (prior, balls) = prior(robot, model.prior);
    let frictionless =
        |joint: usize| known.description().joints[joint].friction == FrictionDescription::default();
    // Friction that is fitted here alone must dissipate; what is added to friction that is known
    // may have either sign.
    let positive = |column: &Column| match column.kind {
        ColumnKind::MotorInertia => true,
        ColumnKind::Coulomb | ColumnKind::Viscous1 => frictionless(column.joint),
        _ => false,
    };
    let positive: Vec<usize> = (0..columns.len()).filter(|c| positive(&columns[*c])).collect();
    let strength = model.prior_strength;
    let program = Feasible { data: &fit.whitened, prior: &prior, strength, positive: &positive };
    let point = program.solve().ok_or_else(|| {
        Error::Setting("no possible bodies were found near the data: check gains and signs, or set model.physical = false to see the plain fit".into())
    })?;
    let plain =
        with_parameters(robot, &body_columns(columns), &body_values(columns, &fit.solution.x));
    let residuals = |x| {
        let residuals = moving.residuals(x);
        let size = |joint| {
            super::regression::root_mean_square(
                moving.of_joint(&residuals, joint).concat().into_iter(),
            )
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
        Err(Error::Robot(
            error @ (RobotError::NotPhysical { .. } | RobotError::Invalid { .. }),
        )) => Ok(Some(error.to_string())),
        Err(other) => Err(other),
    }
}

/// Pseudo-inertias of the description's links, or balls of the robot's mean mass where asked for or
/// where a link is no body; and the names of the latter.
fn prior(robot: &Robot, prior: Prior) -> (Vec<Matrix4<f64>>, Vec<String>) {
    let parameters = robot.inertial_parameters();
    let links: Vec<Matrix4<f64>> = parameters.chunks_exact(PER_LINK).map(pseudo_inertia).collect();
    let body = |p: &Matrix4<f64>| prior == Prior::Description && Cholesky::new(*p).is_some();
    let masses: Vec<f64> = links.iter().filter(|p| body(p)).map(|p| p[(3, 3)]).collect();
    let mean =
        if masses.is_empty() { 1.0 } else { masses.iter().sum::<f64>() / masses.len() as f64 };
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

/// The description of the robot that was found: `friction` of its own fit plus what was fitted with
/// the inertial parameters.
///
/// # Errors
///
/// As [`Robot::from_description`].
pub fn description(
    robot: &Robot,
    found: &InertiaFit,
    friction: &[FrictionDescription],
) -> Result<RobotDescription> {
    let (bodies, values) =
        (body_columns(&found.columns), body_values(&found.columns, &found.values));
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

impl InertiaFit {
    /// Which combinations the recordings leave to the prior, in words; none where they show all.
    pub fn not_shown(&self) -> Option<String> {
        let open: Vec<&str> = self
            .parameters
            .iter()
            .filter(|p| p.standard_error.is_infinite())
            .map(|p| p.name.as_str())
            .collect();
        (!open.is_empty()).then(|| {
            format!(
                "the recordings do not show {} of {} combinations of parameters; the prior decides about: {}",
                open.len(),
                self.parameters.len(),
                open.join("; ")
            )
        })
    }
}
