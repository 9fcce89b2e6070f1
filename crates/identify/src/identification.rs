use crate::error::Result;
use crate::fitted::{Fitted, Plausibility};
use crate::friction::falling::FallingFriction;
use crate::friction::fit::FrictionFit;
use crate::gravity::fit::GravityFit;
use crate::inertia::description::friction_errors;
use crate::inertia::fit::InertiaFit;
use crate::inertia::saturation::SaturatingFriction;
use crate::inputs::Inputs;
use crate::plausibility::gain::Gain;
use crate::plausibility::implausible::Implausible;
use crate::plausibility::offset::PositionOffset;
use crate::plausibility::validation::{
    costly_links, poor_prediction, still_recordings, useless_simulation,
};
use crate::settings::{IdentifySettings, ModelSettings};
use crate::stiction::unknown_sides;
use crate::validate::simulation::{WindowErrors, simulate};
use crate::validate::torque::{LogValidation, TorqueTrace, predict_torque};
use crate::variant::with_gravity_of_links;
use reachtube_robot::{FrictionDescription, Parameter, ParameterKind, Robot, RobotDescription};
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
    /// The joints whose friction saturates.
    pub saturating: Vec<SaturatingFriction>,
    /// Gains of the joints' torques relative to each other.
    pub gains: Vec<Gain>,
    /// Offsets of the joints' positions that explain the torque best; empty for too few samples.
    pub offsets: Vec<PositionOffset>,
    /// Errors of the predicted torque in the validation recordings.
    ///
    /// Without validation recordings they are the errors in the exciting motions.
    pub validation: Vec<LogValidation>,
    /// Whether there were validation recordings, to which nothing was fitted.
    pub held_out: bool,
    /// Errors of forward simulations over the same recordings, one entry per duration.
    pub windows: Vec<WindowErrors>,
    /// Torque over time of the same recordings, for figures.
    pub traces: Vec<TorqueTrace>,
    /// Warnings about implausible results and steps that were not possible.
    pub warnings: Vec<String>,
    /// The warnings by which the recordings contradict the dynamics of rigid bodies: columns that
    /// are exchanged or have the wrong sign, units, gains, friction that drives, and torque that
    /// stays unexplained.
    pub implausible: Vec<Implausible>,
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
    let (given, model) = (robot.description(), &settings.model);
    let (robot, mut inputs, fitted) = fitted(robot, settings, folder, progress)?;
    let robot = &robot;
    let Plausibility { gains, offsets, warnings: implausible } = fitted.check(robot, &inputs);
    let sides = fitted.first.gravity.as_ref().map_or(&[][..], |gravity| &gravity.poses.sides);
    inputs.changes.extend(unknown_sides(sides, robot.joint_count()));
    let Fitted { first, friction, known, inertia, saturating, mut description, found } = fitted;
    add_friction(&mut description, &inputs, &friction, &first.friction, &inertia);
    progress(3, STEPS);
    let (held_out, tried) = inputs.validation();
    let (validation, traces) = predict_torque(&found, &known, tried, &inputs.sampling, &inertia);
    let windows = simulate(&found, tried, &model.windows);
    let mut warnings = [inputs.warnings, first.warnings].concat();
    warnings.extend(implausible.iter().map(|result| result.text.clone()));
    warnings.extend(inertia_warnings(&first.friction, (&inertia, &saturating), robot));
    let links = inertia.physical.is_some() && !model.separate_gravity;
    warnings.extend(validation_warnings(robot, &validation, &windows, held_out, links));
    keep_motors(&mut description, given, model);
    progress(STEPS, STEPS);
    Ok(Identification {
        description,
        slow: inputs.sampling.slow,
        changes: inputs.changes,
        gravity: first.gravity,
        friction: first.friction,
        inertia,
        saturating,
        gains,
        offsets,
        validation,
        held_out,
        windows,
        traces,
        warnings,
        implausible,
    })
}

/// Reads the recordings and fits gravity and friction in turn, then the inertial parameters. The
/// robot that is returned first has the gravity of its links.
fn fitted(
    robot: &Robot,
    settings: &IdentifySettings,
    folder: &Path,
    progress: &dyn Fn(usize, usize),
) -> Result<(Robot, Inputs, Fitted)> {
    settings.validate(robot.joint_count())?;
    let inputs = Inputs::read(robot, settings, folder)?;
    let robot = with_gravity_of_links(robot, settings.model.motor_inertia)?;
    progress(1, STEPS);
    let fitted = Fitted::new(&robot, &inputs, &settings.model)?;
    progress(2, STEPS);
    Ok((robot, inputs, fitted))
}

/// Gives a description the motors of the given one if torque was measured behind the gear, which
/// does not show their inertia: it takes part in the motion.
fn keep_motors(
    description: &mut RobotDescription,
    given: &RobotDescription,
    model: &ModelSettings,
) {
    let pairs = description.joints.iter_mut().zip(&given.joints);
    for (joint, given) in pairs.filter(|_| !model.motor_inertia) {
        joint.armature = given.armature;
        joint.rotor_inertia = given.rotor_inertia;
    }
}

/// Writes the standard errors of friction, the velocities that it was fitted to, and the recordings
/// of all fits into the description.
fn add_friction(
    description: &mut RobotDescription,
    inputs: &Inputs,
    friction: &[FrictionDescription],
    slow: &[FrictionFit],
    inertia: &InertiaFit,
) {
    description.add_identified_from(inputs.seen.iter().cloned());
    for (j, joint) in description.joints.iter_mut().enumerate() {
        let is_own = |fit: &&FrictionFit| {
            fit.joint.joint == joint.name && fit.joint.coefficients == friction[j]
        };
        let known = slow.iter().find(is_own).map(|fit| &fit.joint.standard_errors);
        joint.friction.standard_errors = friction_errors(inertia, j, known);
        let logs = inputs.friction.iter().filter(|_| known.is_some());
        let is_fitted =
            inertia.columns.contains(&Parameter { joint: j, kind: ParameterKind::Viscous1 });
        let logs = logs.chain(inputs.excitation.iter().filter(|_| is_fitted));
        let all = logs.flat_map(|log| log.qd.iter().skip(j).step_by(log.joints));
        let range = all.fold([0.0f64; 2], |[low, high], qd| [low.min(*qd), high.max(*qd)]);
        joint.friction.fitted_velocities = (range != [0.0; 2]).then_some(range);
    }
}

/// Identifies a robot as [`identify`] does, digit for digit, without judging it: for robots that
/// are compared with one that was judged, such as those without one of its recordings.
///
/// # Errors
///
/// As [`identify`].
pub fn identify_unjudged(
    robot: &Robot,
    settings: &IdentifySettings,
    folder: &Path,
) -> Result<RobotDescription> {
    let (_, inputs, fitted) = fitted(robot, settings, folder, &|_, _| ())?;
    let Fitted { first, friction, inertia, mut description, .. } = fitted;
    add_friction(&mut description, &inputs, &friction, &first.friction, &inertia);
    keep_motors(&mut description, robot.description(), &settings.model);
    Ok(description)
}

/// Returns warnings about the inertial parameters, and one for each joint whose viscous friction by
/// least squares falls with speed: in the exciting motions, or else in the slow ones.
fn inertia_warnings(
    slow: &[FrictionFit],
    (inertia, saturating): (&InertiaFit, &[SaturatingFriction]),
    robot: &Robot,
) -> Vec<String> {
    let of_slow = slow.iter().filter_map(|fit| fit.joint.falling.as_ref());
    let is_new = |slow: &&FallingFriction| {
        inertia.falling.iter().all(|falling| falling.joint != slow.joint)
            && saturating.iter().all(|law| law.joint != slow.joint)
    };
    let falling = of_slow.filter(is_new).chain(&inertia.falling).map(|of| of.warning(robot));
    let open = inertia.undetermined_warning().into_iter();
    open.chain(inertia.body_warnings(robot)).chain(falling).collect()
}

/// Returns warnings about the validation. Only held-out recordings show how well torque is
/// predicted, and what physical links cost.
fn validation_warnings(
    robot: &Robot,
    validation: &[LogValidation],
    windows: &[WindowErrors],
    held_out: bool,
    links: bool,
) -> Vec<String> {
    let tried = if held_out { validation } else { &[] };
    let costly = if held_out && links { costly_links(robot, validation) } else { None };
    costly
        .into_iter()
        .chain(still_recordings(tried))
        .chain(poor_prediction(robot, tried))
        .chain(useless_simulation(robot, windows))
        .collect()
}
