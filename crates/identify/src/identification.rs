use crate::error::Result;
use std::path::Path;

use reachtube_robot::{Robot, RobotDescription};

use crate::friction::FrictionFit;
use crate::gravity::GravityFit;
use crate::inertia::InertiaFit;
use crate::prepare::{self, Log, LogEntry, RawLog};
use crate::samples::{Known, Samples, Sampling};
use crate::settings::IdentifySettings;
use crate::suspect::Gain;
use crate::validate::{LogValidation, TorqueTrace, WindowErrors};
use crate::{gravity, inertia, suspect, validate};

/// Samples are taken at this many times the cut-off: more would only repeat what the filter let
/// pass.
const SAMPLES_PER_CUT_OFF: f64 = 6.0;

/// Slow is below this part of a joint's high speeds.
const SLOW_SHARE: f64 = 0.02;

/// A joint's high speeds: this quantile.
const HIGH_SPEED: f64 = 0.99;

/// A robot identified from recordings, and what is known of how good it is.
#[derive(Debug, Clone)]
pub struct Identification {
    /// The robot that was found.
    pub description: RobotDescription,
    /// How the recordings were changed before the fits, a sentence each.
    pub changes: Vec<String>,
    /// Speeds below which torque was not used \[rad/s\], joint by joint.
    pub slow: Vec<f64>,
    /// Gravity; none without poses at rest and slow motions.
    pub gravity: Option<GravityFit>,
    /// Friction of the joints that slow motions show.
    pub friction: Vec<FrictionFit>,
    /// Inertial parameters.
    pub inertia: InertiaFit,
    /// Gains of the joints' torque against each other.
    pub gains: Vec<Gain>,
    /// The robot on the recordings that were kept back, or, without any, on those it was fitted to.
    pub validation: Vec<LogValidation>,
    /// Whether these were kept back.
    pub kept_back: bool,
    /// Forward simulations over the same recordings.
    pub windows: Vec<WindowErrors>,
    /// Torque over time for figures.
    pub traces: Vec<TorqueTrace>,
    /// What looks wrong or could not be done.
    pub warnings: Vec<String>,
}

/// The recordings of a job, prepared.
struct Logs {
    rest: Vec<Log>,
    friction: Vec<Log>,
    dynamic: Vec<Log>,
    validate: Vec<Log>,
}

/// Identifies a robot from recordings; their paths are taken from `folder` on. `progress` is told
/// how many of four steps are done.
///
/// # Errors
///
/// Defects of the recordings, settings that do not fit, a fit that is not possible.
pub fn identify(
    robot: &Robot,
    settings: &IdentifySettings,
    folder: &Path,
    progress: &dyn Fn(usize, usize),
) -> Result<Identification> {
    settings.validate(robot.joint_count())?;
    let robot = &own_gravity(robot, settings.model.motor_inertia)?;
    let (logs, cut_off, mut changes) = read(robot, settings, folder)?;
    progress(1, 4);
    let model = &settings.model;
    let slow = slow_speeds(&logs, robot.joint_count(), model.slow);
    let sampling =
        Sampling { rate: SAMPLES_PER_CUT_OFF * cut_off, slow: slow.clone(), margin: 0.5 / cut_off };
    changes.push(format!(
        "logs were thinned to {:.1} samples a second, and a joint's torque was left out where, within {:.0} ms, it is slower than {} rad/s",
        sampling.rate,
        1e3 * sampling.margin,
        slow.iter().map(|slow| format!("{slow:.3}")).collect::<Vec<_>>().join(", ")
    ));
    let first =
        gravity::fit(robot, &logs.rest, &logs.friction, &sampling, model.rest_speed, model.robust)?;
    progress(2, 4);
    let coefficients = gravity::coefficients(&first.friction, robot);
    let load = first.gravity.as_ref().map_or(robot, |gravity| &gravity.robot);
    let known = gravity::with_friction(load, &coefficients)?;
    let friction = inertia::Friction {
        refit: model.refit_friction || first.friction.len() < robot.joint_count(),
        cubic: model.cubic.unwrap_or(!first.friction.is_empty()),
    };
    let rests: &[Log] = if model.separate_gravity { &[] } else { &logs.rest };
    let inertia = inertia::fit(robot, &known, [&logs.dynamic, rests], &sampling, model, friction)?;
    let mut description = inertia::description(robot, &inertia, &coefficients)?;
    if model.separate_gravity
        && let Some(gravity) = &first.gravity
    {
        gravity::separate(&mut description, &gravity.robot);
    }
    let found = Robot::from_description(&description)?;
    progress(3, 4);
    let kept_back = !logs.validate.is_empty();
    let tried = if kept_back { &logs.validate } else { &logs.dynamic };
    let (validation, traces) = validate::predict(&found, &known, tried, &sampling, &inertia);
    let windows = validate::simulate(&found, tried, &model.windows);
    let moving =
        Samples::of(robot, &inertia.columns, &logs.dynamic, &sampling, &Known::Friction(&known));
    let consistency = suspect::Consistency::of(&moving, &inertia.joints);
    let gains = suspect::gains(robot, &moving, &consistency);
    let mut warnings = first.notes;
    warnings.extend(inertia.not_shown());
    warnings.extend(suspect::words(
        robot,
        &inertia,
        &coefficients,
        (&consistency, &gains),
        &logs.dynamic,
        &moving,
        &sampling,
    ));
    warnings.extend(kept_back.then(|| validate::poor(robot, &validation)).into_iter().flatten());
    progress(4, 4);
    let (gravity, friction) = (first.gravity, first.friction);
    Ok(Identification {
        description,
        changes,
        slow,
        gravity,
        friction,
        inertia,
        gains,
        validation,
        kept_back,
        windows,
        traces,
        warnings,
    })
}

/// The same robot with gravity from its links; without motors where the torque does not drive them.
fn own_gravity(robot: &Robot, motor_inertia: bool) -> Result<Robot> {
    let mut description = robot.description().clone();
    for joint in &mut description.joints {
        joint.gravity_moments = None;
        if !motor_inertia {
            (joint.armature, joint.rotor_inertia) = (None, None);
        }
    }
    Ok(Robot::from_description(&description)?)
}

/// Reads and prepares all recordings; the cut-off; what was changed.
fn read(
    robot: &Robot,
    settings: &IdentifySettings,
    folder: &Path,
) -> Result<(Logs, f64, Vec<String>)> {
    let own = |entries: &[LogEntry]| prepare::read(entries, folder, robot, &settings.prepare);
    let groups = [
        own(&settings.rest)?,
        own(&settings.friction)?,
        own(&settings.dynamic)?,
        own(&settings.validate)?,
    ];
    let exciting: Vec<&RawLog> = groups[2].iter().collect();
    let cut_off = prepare::cut_off(&exciting, &settings.prepare)?;
    let counts = groups.each_ref().map(Vec::len);
    let prepared = prepare::prepare(&groups.concat(), &settings.prepare, cut_off)?;
    let mut logs = prepared.logs.into_iter();
    let [rest, friction, dynamic, validate] =
        counts.map(|count| logs.by_ref().take(count).collect());
    Ok((Logs { rest, friction, dynamic, validate }, cut_off, prepared.changes))
}

/// For each joint 2 % of the speed that it exceeds 1 % of the time it moves at all, or the speed
/// given.
fn slow_speeds(logs: &Logs, joints: usize, given: Option<f64>) -> Vec<f64> {
    let own = |joint: usize| {
        let of = |log: &Log| {
            log.qd.iter().skip(joint).step_by(joints).map(|v| v.abs()).collect::<Vec<_>>()
        };
        let mut speeds: Vec<f64> = logs.friction.iter().chain(&logs.dynamic).flat_map(of).collect();
        speeds.sort_by(f64::total_cmp);
        let high = speeds.get((HIGH_SPEED * speeds.len() as f64) as usize).copied().unwrap_or(0.0);
        (SLOW_SHARE * high).max(1e-4)
    };
    (0..joints).map(|joint| given.unwrap_or_else(|| own(joint))).collect()
}
