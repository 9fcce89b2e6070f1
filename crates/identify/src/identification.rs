use crate::error::{Error, Result};
use crate::friction::fit::FrictionFit;
use crate::friction::joints::coefficients;
use crate::gravity::alternation::fit_gravity_and_friction;
use crate::gravity::fit::GravityFit;
use crate::inertia::columns::FrictionColumns;
use crate::inertia::description::description;
use crate::inertia::fit::{InertiaFit, fit_inertia};
use crate::inputs::Inputs;
use crate::plausibility::gain::{Gain, GainLikelihood, gains};
use crate::plausibility::validation::{poor_prediction, still_recordings, useless_simulation};
use crate::plausibility::warnings::Checked;
use crate::prepare::log::Log;
use crate::samples::{KnownTorque, Samples};
use crate::settings::{IdentifySettings, ModelSettings};
use crate::validate::simulation::{WindowErrors, simulate};
use crate::validate::torque::{LogValidation, TorqueTrace, predict_torque};
use crate::variant::{set_gravity_moments, with_friction, with_gravity_of_links};
use reachtube_robot::{FrictionDescription, Robot, RobotDescription};
use std::path::Path;

/// Number of steps that progress reports.
const STEPS: usize = 4;

/// A robot identified from recordings, with the quality of its fits and its validation.
#[derive(Debug, Clone)]
pub struct Identification {
    /// Description of the identified robot.
    pub description: RobotDescription,
    /// Changes to the recordings before the fits, one sentence each.
    pub changes: Vec<String>,
    /// Speeds below which torque was not used \[rad/s\], one entry per joint.
    pub slow: Vec<f64>,
    /// The gravity fit; `None` without poses at rest and slow motions.
    pub gravity: Option<GravityFit>,
    /// The friction fits of the joints that move alone in the friction recordings.
    pub friction: Vec<FrictionFit>,
    /// The fit of the inertial parameters.
    pub inertia: InertiaFit,
    /// Gains of the joints' torques relative to each other.
    pub gains: Vec<Gain>,
    /// Errors of the predicted torque in the validation recordings.
    ///
    /// Without validation recordings they are the errors in the exciting motions.
    pub validation: Vec<LogValidation>,
    /// Whether there were validation recordings, to which nothing was fitted.
    pub kept_back: bool,
    /// Errors of forward simulations over the same recordings, one entry per duration.
    pub windows: Vec<WindowErrors>,
    /// Torque over time of the same recordings, for figures.
    pub traces: Vec<TorqueTrace>,
    /// Warnings about implausible results and steps that were not possible.
    pub warnings: Vec<String>,
}

/// Identifies a robot from recordings.
///
/// `robot` gives the geometry and the prior of the links. Relative paths in `settings` start at
/// `folder`. `progress` receives the number of finished steps and the number of all steps.
///
/// # Errors
///
/// - [`Error::Recordings`](crate::Error::Recordings) and [`Error::File`](crate::Error::File) report
///   recordings with defects and files that cannot be read.
/// - The other variants of [`Error`](crate::Error) report settings that do not suit the robot or
///   the recordings, and fits that are not possible.
pub fn identify(
    robot: &Robot,
    settings: &IdentifySettings,
    folder: &Path,
    progress: &dyn Fn(usize, usize),
) -> Result<Identification> {
    settings.validate(robot.joint_count())?;
    let model = &settings.model;
    let robot = &with_gravity_of_links(robot, model.motor_inertia)?;

    // Recordings, filtered and downsampled.
    let inputs = Inputs::read(robot, settings, folder)?;
    progress(1, STEPS);

    // Gravity and friction in alternation.
    let (rest, slow, sampling) = (&inputs.rest, &inputs.friction, &inputs.sampling);
    let first = fit_gravity_and_friction(robot, rest, slow, sampling, model)?;
    progress(2, STEPS);

    // Inertial parameters, with the friction and its load subtracted.
    let load = first.gravity.as_ref().map_or(robot, |gravity| &gravity.robot);
    let friction = coefficients(&first.friction, robot);
    let (friction, known, inertia) = fit_links([robot, load], friction, &inputs, model)?;
    let (gains, implausible) = check([robot, &known], &inertia, &friction, &inputs);
    let mut description =
        description(robot, &inertia, &friction).map_err(|error| impossible(error, &implausible))?;
    if let Some(gravity) = first.gravity.as_ref().filter(|_| model.separate_gravity) {
        set_gravity_moments(&mut description, &gravity.robot);
    }
    let found = Robot::from_description(&description)?;
    progress(3, STEPS);

    // Validation and plausibility.
    let (kept_back, tried) = inputs.validation();
    let (validation, traces) = predict_torque(&found, &known, tried, sampling, &inertia);
    let windows = simulate(&found, tried, &model.windows);
    let mut warnings = inputs.warnings;
    warnings.extend(first.warnings);
    warnings.extend(implausible);
    warnings.extend(inertia.undetermined_warning());
    warnings.extend(inertia.body_warnings(robot));
    warnings.extend(validation_warnings(robot, &validation, &windows, kept_back));
    progress(STEPS, STEPS);
    Ok(Identification {
        description,
        slow: inputs.sampling.slow,
        changes: inputs.changes,
        gravity: first.gravity,
        friction: first.friction,
        inertia,
        gains,
        validation,
        kept_back,
        windows,
        traces,
        warnings,
    })
}

/// Returns warnings about the validation; only held-out recordings show how well torque is
/// predicted.
fn validation_warnings(
    robot: &Robot,
    validation: &[LogValidation],
    windows: &[WindowErrors],
    kept_back: bool,
) -> Vec<String> {
    let held_out = if kept_back { validation } else { &[] };
    let still = still_recordings(held_out).into_iter();
    still
        .chain(poor_prediction(robot, held_out))
        .chain(useless_simulation(robot, windows))
        .collect()
}

/// Returns the error for values of least squares that no robot has, with the probable cause.
fn impossible(error: Error, implausible: &[String]) -> Error {
    match error {
        Error::Robot(error) => {
            Error::ImpossibleRobot { problem: error.to_string(), causes: implausible.to_vec() }
        }
        other => other,
    }
}

/// Fits the inertial parameters to motions with the friction of slow motions subtracted.
///
/// A joint whose torque is explained better by friction that only the exciting motions determine
/// gets that friction: slow motions do not show all of it. Returns the known friction, one entry
/// per joint, the robot with it, and the fit.
///
/// The poses at rest take part unless gravity keeps its own mass moments.
fn fit_links(
    [robot, load]: [&Robot; 2],
    slow: Vec<FrictionDescription>,
    inputs: &Inputs,
    model: &ModelSettings,
) -> Result<(Vec<FrictionDescription>, Robot, InertiaFit)> {
    let none = FrictionDescription::default();
    let known_count = slow.iter().filter(|friction| **friction != none).count();
    let columns = FrictionColumns {
        fitted: model.refit_friction || known_count < slow.len(),
        cubic: model.cubic.unwrap_or(known_count > 0),
    };
    let rest: &[Log] = if model.separate_gravity { &[] } else { &inputs.rest };
    let logs = [&inputs.dynamic[..], rest];
    let fit = |friction: Vec<FrictionDescription>| {
        let known = with_friction(load, &friction)?;
        let fit = fit_inertia(robot, &known, logs, &inputs.sampling, model, columns)?;
        Ok((friction, known, fit))
    };
    let first = fit(slow)?;
    if known_count == 0 || !model.refit_friction {
        return Ok(first);
    }
    let free = fit(vec![none; robot.joint_count()])?;
    let better = |j: usize| free.2.joints[j].residual < first.2.joints[j].residual;
    let chosen = first.0.iter().enumerate().map(|(j, slow)| if better(j) { none } else { *slow });
    fit(chosen.collect())
}

/// Returns the gains of the joints and warnings about implausible results.
fn check(
    [robot, known]: [&Robot; 2],
    fit: &InertiaFit,
    friction: &[FrictionDescription],
    inputs: &Inputs,
) -> (Vec<Gain>, Vec<String>) {
    let (logs, sampling) = (&inputs.dynamic, &inputs.sampling);
    let known = KnownTorque::Friction(known);
    let samples = &Samples::in_motion(robot, &fit.columns, logs, sampling, &known);
    let likelihood = GainLikelihood::new(samples, &fit.joints);
    let gains = gains(robot, samples, &likelihood);
    let checked = Checked { robot, fit, friction, logs, samples, sampling };
    let warnings = checked.warnings(&likelihood, &gains);
    (gains, warnings)
}
