use crate::error::{Error, Result};
use crate::fit::{Fit, JointFit};
use crate::prepare::log::Log;
use crate::samples::{KnownTorque, SHORTEST_REST, Samples, Sampling};
use crate::settings::ModelSettings;
use crate::variant::with_parameters;
use reachtube_robot::{BaseParameters, Parameter, ParameterKind, Robot};
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
#[derive(Debug, Clone, Serialize)]
pub struct GravityFit {
    /// Number of poses at rest.
    pub rests: usize,
    /// Number of samples of slow motions.
    pub slow_samples: usize,
    /// Quality of the fit at rest, one entry per joint; empty without poses.
    pub at_rest: Vec<JointFit>,
    /// Quality of the fit in slow motion, one entry per joint; empty without slow motions.
    pub in_motion: Vec<JointFit>,
    /// A robot with the fitted gravity; only its gravity torque is meaningful.
    #[serde(skip)]
    pub robot: Robot,
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
    rests: &[Log],
    slow: &[Log],
    sampling: &Sampling,
    model: &ModelSettings,
    known: &KnownTorque,
) -> Result<GravityFit> {
    let n = robot.joint_count();
    let inertial = Parameter::of_joints(n, &ParameterKind::INERTIAL);
    // Without slow motions nothing determines friction or inertia.
    let columns = if slow.is_empty() {
        inertial.clone()
    } else {
        [inertial.clone(), Parameter::of_joints(n, &MOTION_COLUMNS)].concat()
    };
    let at_rest = Samples::at_rest(robot, &columns, rests, model.rest_speed);
    let poses = at_rest.len() / n;
    if poses == 0 && !rests.is_empty() {
        return Err(Error::NoPose { rest_speed: model.rest_speed, shortest: SHORTEST_REST });
    }
    let enough = poses >= POSES_PER_PARAMETER * BaseParameters::at_rest(robot, &inertial).count();
    let slow = if enough { &[] } else { slow };
    let in_motion = Samples::in_motion(robot, &columns, slow, sampling, known);
    let groups: Vec<&Samples> =
        [&at_rest, &in_motion].into_iter().filter(|samples| !samples.is_empty()).collect();
    let fit = Fit::of_groups(&groups, !model.robust);
    let values = fit.solution.x.rows(0, inertial.len()).into_owned();
    let mut joints = fit.joints.into_iter();
    let mut quality = |samples: &Samples| {
        if samples.is_empty() { Vec::new() } else { joints.next().unwrap_or_default() }
    };
    Ok(GravityFit {
        rests: poses,
        slow_samples: in_motion.used.iter().filter(|used| **used).count(),
        at_rest: quality(&at_rest),
        in_motion: quality(&in_motion),
        robot: with_parameters(robot, &inertial, &values)?,
    })
}
