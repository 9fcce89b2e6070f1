//! A robot fitted to recordings.

use crate::error::{Error, Result};
use crate::friction::joints::coefficients;
use crate::gravity::alternation::{GravityAndFriction, fit_gravity_and_friction};
use crate::inertia::SaturatingFriction;
use crate::inertia::columns::FrictionColumns;
use crate::inertia::description::description;
use crate::inertia::fit::{InertiaFit, fit_inertia};
use crate::inertia::saturation::saturating;
use crate::inputs::Inputs;
use crate::plausibility::compensated::input_unit_warning;
use crate::plausibility::gain::{Gain, GainLikelihood, gains};
use crate::plausibility::implausible::Implausible;
use crate::plausibility::offset::{OffsetSearch, PositionOffset};
use crate::plausibility::warnings::Checked;
use crate::prepare::log::PreparedLog;
use crate::samples::{KnownTorque, Samples};
use crate::settings::ModelSettings;
use crate::stiction::KnownFriction;
use crate::variant::{set_gravity_moments, with_friction};
use reachtube_robot::{FrictionDescription, Robot, RobotDescription};

/// A fitted robot.
pub(crate) struct Fitted {
    /// Gravity and friction of slow motions.
    pub first: GravityAndFriction,
    /// The known friction of each joint, which the fit to exciting motions corrects.
    pub friction: Vec<FrictionDescription>,
    /// The robot with the known friction.
    pub known: Robot,
    /// The fit of the inertial parameters.
    pub inertia: InertiaFit,
    /// The joints whose friction saturates.
    pub saturating: Vec<SaturatingFriction>,
    /// Description of the fitted robot.
    pub description: RobotDescription,
    /// The fitted robot.
    pub found: Robot,
}

/// Faults of the columns that the recordings show.
pub(crate) struct Plausibility {
    /// Gains of the joints' torques relative to each other.
    pub gains: Vec<Gain>,
    /// Offsets of the joints' positions.
    pub offsets: Vec<PositionOffset>,
    /// Implausible results.
    pub warnings: Vec<Implausible>,
}

impl Fitted {
    /// Fits gravity and friction in alternation, then the inertial parameters.
    pub(crate) fn new(robot: &Robot, inputs: &Inputs, model: &ModelSettings) -> Result<Self> {
        let (rest, slow, sampling) = (&inputs.rest, &inputs.friction, &inputs.sampling);
        let first = fit_gravity_and_friction(robot, rest, slow, sampling, model)?;
        // Inertial parameters, with the friction and its load subtracted.
        let load = first.gravity.as_ref().map_or(robot, |gravity| &gravity.robot);
        let friction = coefficients(&first.friction, robot);
        let slow = with_friction(load, &friction)?;
        let kept = first.gravity.as_ref().filter(|gravity| gravity.rests > 0);
        let kept = kept
            .map(|gravity| KnownFriction { robot: &slow, deviations: &gravity.rest_deviations });
        let fitted = fit_links([robot, load], friction, kept, inputs, model)?;
        let FittedLinks { friction, known, inertia, saturating } = fitted;
        let mut description = description(robot, &inertia, &friction).map_err(|error| {
            impossible(error, &check([robot, &known], &inertia, &friction, inputs).warnings)
        })?;
        if let Some(gravity) = first.gravity.as_ref().filter(|_| model.separate_gravity) {
            set_gravity_moments(&mut description, &gravity.robot);
        }
        let found = Robot::from_description(&description)?;
        Ok(Self { first, friction, known, inertia, saturating, description, found })
    }

    pub(crate) fn check(&self, robot: &Robot, inputs: &Inputs) -> Plausibility {
        check([robot, &self.known], &self.inertia, &self.friction, inputs)
    }
}

/// Returns the error for values of least squares that no robot has, with the probable cause.
fn impossible(error: Error, implausible: &[Implausible]) -> Error {
    match error {
        Error::Robot(error) => {
            let causes = implausible.iter().map(|result| result.text.clone()).collect();
            Error::ImpossibleRobot { problem: error.to_string(), causes }
        }
        other => other,
    }
}

/// Returns the error with a wrong unit of compensated inputs as its cause, if they have one.
fn with_cause(error: Error, robot: &Robot, inputs: &Inputs) -> Error {
    match error {
        Error::NoPhysicalLinks { .. } if inputs.compensated => {
            let cause = input_unit_warning(robot, &inputs.excitation, &inputs.sampling);
            Error::NoPhysicalLinks { cause: cause.map(|cause| cause.text) }
        }
        other => other,
    }
}

/// The links, and friction that is known before they are fitted.
struct FittedLinks {
    friction: Vec<FrictionDescription>,
    known: Robot,
    inertia: InertiaFit,
    saturating: Vec<SaturatingFriction>,
}

/// Fits the inertial parameters to motions with the friction of slow motions subtracted.
///
/// A joint whose torque is explained better by friction that only the exciting motions determine
/// gets that friction: slow motions do not show all of it. Then friction that saturates is tried.
///
/// The poses at rest take part unless gravity keeps its own mass moments. The joints may keep a
/// part of the friction `kept` there.
fn fit_links(
    [robot, load]: [&Robot; 2],
    slow: Vec<FrictionDescription>,
    kept: Option<KnownFriction>,
    inputs: &Inputs,
    model: &ModelSettings,
) -> Result<FittedLinks> {
    let none = FrictionDescription::default();
    let known_count = slow.iter().filter(|friction| **friction != none).count();
    let columns = FrictionColumns {
        fitted: model.refit_friction || known_count < slow.len(),
        cubic: model.cubic.unwrap_or(known_count > 0),
    };
    let rest: &[PreparedLog] = if model.separate_gravity { &[] } else { &inputs.rest };
    let logs = [&inputs.excitation[..], rest];
    let fit = |friction: Vec<FrictionDescription>| -> Result<FittedLinks> {
        let known = with_friction(load, &friction)?;
        let fit = fit_inertia(robot, &known, logs, kept, &inputs.sampling, model, columns);
        let inertia = fit.map_err(|error| with_cause(error, robot, inputs))?;
        Ok(FittedLinks { friction, known, inertia, saturating: Vec::new() })
    };
    let mut found = fit(slow)?;
    if known_count > 0 && model.refit_friction {
        let free = fit(vec![none; robot.joint_count()])?;
        let size = |of: &FittedLinks, j: usize| of.inertia.joints[j].residual;
        let better = |j: usize| size(&free, j) < size(&found, j);
        let slow = found.friction.iter().enumerate();
        let chosen = slow.map(|(j, slow)| if better(j) { none } else { *slow });
        found = fit(chosen.collect())?;
    }
    let is_dry = model.motor_inertia && !inputs.compensated;
    if !(model.saturating && is_dry) {
        return Ok(found);
    }
    let mut tried = saturating([robot, &found.known], &found.inertia, inputs);
    // Friction that is fitted once more might drive the joint at standstill.
    while tried.iter().any(Option::is_some) {
        let own = found.friction.iter().zip(&tried);
        let own = own.map(|(own, tried)| tried.as_ref().map_or(*own, |tried| tried.friction));
        let again = fit(own.collect())?;
        let described = description(robot, &again.inertia, &again.friction)?;
        let before = tried.iter().flatten().count();
        for (tried, joint) in tried.iter_mut().zip(&described.joints) {
            tried.take_if(|_| !joint.friction.dissipates_at_standstill());
        }
        if tried.iter().flatten().count() == before {
            let saturating = tried.into_iter().flatten().map(|tried| tried.law).collect();
            return Ok(FittedLinks { saturating, ..again });
        }
    }
    Ok(found)
}

/// Returns the gains of the joints, the offsets of their positions, and warnings about implausible
/// results.
fn check(
    [robot, known]: [&Robot; 2],
    fit: &InertiaFit,
    friction: &[FrictionDescription],
    inputs: &Inputs,
) -> Plausibility {
    let (logs, sampling) = (&inputs.excitation, &inputs.sampling);
    let known = KnownTorque::Friction(known);
    let samples = &Samples::in_motion(robot, &fit.columns, logs, sampling, &known);
    let likelihood = GainLikelihood::new(samples, &fit.joints);
    let gains = gains(robot, samples, &likelihood);
    let search = OffsetSearch::new(robot, &fit.columns, logs, sampling, &known);
    let offsets = search.run();
    let compensated = inputs.compensated;
    let checked =
        Checked { robot, fit, friction, logs, samples, sampling, known: &known, compensated };
    let warnings = checked.warnings(&likelihood, &gains, || search.reported(&offsets));
    Plausibility { gains, offsets: offsets.joints, warnings }
}
