use crate::error::{Error, Result};
use crate::fit::{Fit, JointFit};
use crate::inertia::base::BaseParameter;
use crate::prepare::log::PreparedLog;
use crate::samples::{KnownTorque, SHORTEST_REST, Samples, Sampling};
use crate::settings::ModelSettings;
use crate::stiction::{KnownFriction, Rests};
use crate::variant::with_parameters;
use nalgebra::DMatrix;
use reachtube_robot::{BaseParameters, Parameter, ParameterKind, Regressor, Robot};
use schemars::JsonSchema;
use serde::Serialize;

/// Poses per combination of gravity parameters that make slow motions unnecessary for gravity.
const POSES_PER_PARAMETER: usize = 2;

/// Columns that are fitted together with gravity to slow motions.
const MOTION_COLUMNS: [ParameterKind; 5] = [
    ParameterKind::MotorInertia,
    ParameterKind::Coulomb,
    ParameterKind::Offset,
    ParameterKind::Viscous1,
    ParameterKind::Viscous3,
];

/// Gravity as fitted to poses at rest and to slow motions.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct GravityFit {
    /// Number of poses at rest.
    pub rests: usize,
    /// Number of samples of slow motions.
    pub slow_samples: usize,
    /// Quality of the fit at rest, one entry per joint; empty without poses.
    pub at_rest: Vec<JointFit>,
    /// Quality of the fit in slow motion, one entry per joint; empty without slow motions.
    pub in_motion: Vec<JointFit>,
    /// The combinations of parameters that gravity shows, as the mass moments of Table III.
    pub parameters: Vec<BaseParameter>,
    /// A robot with the fitted gravity; only its gravity torque is meaningful.
    #[serde(skip)]
    pub robot: Robot,
    /// Standard deviation of the torque of each joint at rest \[N m\]; empty without poses.
    #[serde(skip)]
    pub(crate) rest_deviations: Vec<f64>,
    /// Standard error of the gravity torque of each joint at the poses over that torque, as root
    /// mean squares \[-\]; empty without poses.
    #[serde(skip)]
    pub(crate) load_errors: Vec<f64>,
    /// The poses.
    #[serde(skip)]
    pub(crate) poses: Rests,
}

/// Fits gravity to poses at rest and, if there are too few of them, to slow motions.
///
/// Friction slopes that differ between driving and braking look like gravity in motion. Only poses
/// separate the two, so that enough poses are used alone.
///
/// # Errors
///
/// [`Error::NoPose`] if the recordings of rests have no pose.
pub(super) fn fit_gravity(
    robot: &Robot,
    rests: &[PreparedLog],
    slow: &[PreparedLog],
    sampling: &Sampling,
    model: &ModelSettings,
    known: Option<KnownFriction>,
) -> Result<GravityFit> {
    let n = robot.joint_count();
    let inertial = Parameter::of_joints(n, &ParameterKind::INERTIAL);
    // Without slow motions nothing determines friction or inertia.
    let columns = if slow.is_empty() {
        inertial.clone()
    } else {
        [inertial.clone(), Parameter::of_joints(n, &MOTION_COLUMNS)].concat()
    };
    let recorded = !rests.is_empty();
    let quiet = [model.rest_speed, sampling.margin];
    let (at_rest, rests) = Samples::at_rest(robot, &columns, rests, quiet, known);
    let poses = at_rest.len() / n;
    if poses == 0 && recorded {
        return Err(Error::NoPose { rest_speed: model.rest_speed, shortest: SHORTEST_REST });
    }
    let base = BaseParameters::at_rest(robot, &inertial);
    let enough = poses >= POSES_PER_PARAMETER * base.count();
    let slow = if enough { &[] } else { slow };
    let known = known.map_or(KnownTorque::None, |known| KnownTorque::Friction(known.robot));
    let in_motion = Samples::in_motion(robot, &columns, slow, sampling, &known);
    let groups: Vec<&Samples> =
        [&at_rest, &in_motion].into_iter().filter(|samples| !samples.is_empty()).collect();
    let fit = Fit::of_groups(&groups, !model.robust);
    let values = fit.solution.x.rows(0, inertial.len()).into_owned();
    let (parameters, covariance) = combinations(robot, &base, &fit);
    let mut joints = fit.joints.into_iter();
    let mut quality = |samples: &Samples| {
        if samples.is_empty() { Vec::new() } else { joints.next().unwrap_or_default() }
    };
    let at_rest = quality(&at_rest);
    Ok(GravityFit {
        rests: poses,
        slow_samples: in_motion.used.iter().filter(|used| **used).count(),
        rest_deviations: at_rest.iter().map(|joint| joint.residual).collect(),
        at_rest,
        in_motion: quality(&in_motion),
        load_errors: load_errors(robot, &base, &covariance, &rests),
        parameters,
        poses: rests,
        robot: with_parameters(robot, &inertial, &values)?,
    })
}

/// Returns the combinations of parameters that gravity shows with their covariance, fitted with the
/// other columns of the fit.
fn combinations(
    robot: &Robot,
    base: &BaseParameters,
    fit: &Fit,
) -> (Vec<BaseParameter>, DMatrix<f64>) {
    let all = fit.whitened.r.ncols();
    let others = base.parameters().len()..all;
    let kept: Vec<usize> = base.independent().iter().copied().chain(others).collect();
    let selection = DMatrix::from_fn(all, kept.len(), |i, k| f64::from(u8::from(kept[k] == i)));
    let solution = fit.whitened.with_mapped_columns(&selection).solve();
    let errors = solution.standard_errors();
    let described = base.reduce(&robot.parameter_values(base.parameters()));
    let parameter = |(k, name)| BaseParameter {
        name,
        value: solution.x[k],
        least_squares: solution.x[k],
        standard_error: errors[k],
        described: described[k],
    };
    let parameters = base.names().into_iter().enumerate().map(parameter).collect();
    (parameters, solution.covariance.view((0, 0), (base.count(), base.count())).into_owned())
}

/// Returns the standard error of the gravity torque of each joint over that torque, as root mean
/// squares over the rests; nothing without rests.
fn load_errors(
    robot: &Robot,
    base: &BaseParameters,
    covariance: &DMatrix<f64>,
    rests: &Rests,
) -> Vec<f64> {
    let n = rests.joints;
    if rests.len() == 0 {
        return Vec::new();
    }
    let still = vec![0.0; n];
    let states: Vec<[Vec<f64>; 3]> =
        (0..rests.len()).map(|k| [rests.q(k).to_vec(), still.clone(), still.clone()]).collect();
    let rows = base.select(&Regressor::new(robot, base.parameters()).stacked(&states));
    let variance = |r: usize| (rows.row(r) * covariance * rows.row(r).transpose())[0];
    let of_joint = |joint: usize| {
        let own = || (joint..rows.nrows()).step_by(n);
        let errors: f64 = own().map(variance).sum();
        let torques: f64 = own().map(|r| rests.tau[r].powi(2)).sum();
        if torques > 0.0 { (errors / torques).sqrt() } else { 0.0 }
    };
    (0..n).map(of_joint).collect()
}
