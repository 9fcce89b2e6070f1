use crate::error::Result;
use crate::friction::fit::FrictionFit;
use crate::friction::joints::coefficients;
use crate::gravity::alternation::fit_gravity_and_friction;
use crate::gravity::fit::GravityFit;
use crate::inertia::columns::FrictionColumns;
use crate::inertia::description::description;
use crate::inertia::fit::{InertiaFit, fit_inertia};
use crate::inputs::Inputs;
use crate::plausibility::gain::{Gain, GainLikelihood, gains};
use crate::plausibility::warnings::{Checked, poor_prediction};
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
    let friction = coefficients(&first.friction, robot);
    let load = first.gravity.as_ref().map_or(robot, |gravity| &gravity.robot);
    let known = with_friction(load, &friction)?;
    let inertia = fit_links([robot, &known], &inputs, model, first.friction.len())?;
    let mut description = description(robot, &inertia, &friction)?;
    if let Some(gravity) = first.gravity.as_ref().filter(|_| model.separate_gravity) {
        set_gravity_moments(&mut description, &gravity.robot);
    }
    let found = Robot::from_description(&description)?;
    progress(3, STEPS);

    // Validation and plausibility.
    let (kept_back, tried) = inputs.validation();
    let (validation, traces) = predict_torque(&found, &known, tried, sampling, &inertia);
    let windows = simulate(&found, tried, &model.windows);
    let (gains, implausible) = check([robot, &known], &inertia, &friction, &inputs);
    let mut warnings = first.warnings;
    warnings.extend(inertia.undetermined_warning());
    warnings.extend(implausible);
    if kept_back {
        warnings.extend(poor_prediction(robot, &validation));
    }
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

/// Fits the inertial parameters; `friction_fits` is the number of joints with a friction fit.
///
/// The poses at rest take part unless gravity keeps its own mass moments.
fn fit_links(
    [robot, known]: [&Robot; 2],
    inputs: &Inputs,
    model: &ModelSettings,
    friction_fits: usize,
) -> Result<InertiaFit> {
    let friction = FrictionColumns {
        fitted: model.refit_friction || friction_fits < robot.joint_count(),
        cubic: model.cubic.unwrap_or(friction_fits > 0),
    };
    let rest: &[Log] = if model.separate_gravity { &[] } else { &inputs.rest };
    let logs = [&inputs.dynamic[..], rest];
    fit_inertia(robot, known, logs, &inputs.sampling, model, friction)
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
