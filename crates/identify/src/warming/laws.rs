use crate::error::{Error, Result};
use crate::fitted::Fitted;
use crate::inputs::Inputs;
use crate::prepare::log::PreparedLog;
use crate::settings::{ModelSettings, WarmingChoice};
use crate::warming::choice::WarmingFit;
use crate::warming::rows::FrictionRows;
use reachtube_robot::friction::WarmingBy;
use reachtube_robot::{FrictionDescription, Robot};

/// Fits of everything else with the laws. The rates change little after the first, since warmth
/// varies about its reference.
const ROUNDS: usize = 3;

/// Chooses laws by which friction falls while the joints warm up, and fits the robot with them.
///
/// On return the sampling of `inputs` has the laws that `fitted` was fitted with.
///
/// # Errors
///
/// [`Error::UnknownWarmth`] where a law was asked for that the recordings cannot show, and errors
/// of the fits.
pub(crate) fn fit_warming(
    robot: &Robot,
    inputs: &mut Inputs,
    model: &ModelSettings,
    fitted: &mut Fitted,
) -> Result<Option<WarmingFit>> {
    let quantities = model.warming.quantities();
    if quantities.is_empty() {
        return Ok(None);
    }
    if model.warming != WarmingChoice::Compare {
        rows(inputs, &fitted.found, quantities[0])
            .map_err(|log| Error::UnknownWarmth { log, quantity: named(quantities[0]) })?;
    }
    let names: Vec<&str> = robot.joints().iter().map(|joint| joint.name.as_str()).collect();
    let tried = |by: WarmingBy| {
        rows(inputs, &fitted.found, by).map_err(|log| {
            format!(
                "friction by {} was not tried: {log} does not know it; {}",
                named(by),
                remedy(by)
            )
        })
    };
    let mut warming = WarmingFit::choose(&names, quantities, &tried);
    for round in 1..=ROUNDS {
        let laws = warming.laws();
        let Some(by) = laws.iter().flatten().next().map(|law| law.by) else { break };
        inputs.sampling.laws = laws;
        *fitted = Fitted::new(robot, inputs, model)?;
        let rows = rows(inputs, &fitted.found, by).expect("the rows of the choice");
        if round == ROUNDS || !warming.refit(&rows) {
            break;
        }
    }
    for (joint, law) in warming.joints.iter_mut().zip(&inputs.sampling.laws) {
        joint.law = *law;
    }
    Ok(Some(warming))
}

/// Returns the rows of all motions, or the name of a recording that does not know its warmth.
fn rows(inputs: &Inputs, found: &Robot, by: WarmingBy) -> Result<FrictionRows, String> {
    let logs: Vec<&PreparedLog> = inputs.friction.iter().chain(&inputs.dynamic).collect();
    FrictionRows::new(found, &logs, &inputs.sampling, by)
}

/// Returns the name of a quantity.
fn named(by: WarmingBy) -> &'static str {
    match by {
        WarmingBy::Temperature => "temperature",
        WarmingBy::Runs | WarmingBy::Thermal => "the number of runs",
    }
}

/// Returns what a recording needs to know a quantity.
fn remedy(by: WarmingBy) -> &'static str {
    match by {
        WarmingBy::Temperature => "add the columns temp1..tempn",
        WarmingBy::Runs | WarmingBy::Thermal => {
            "give it as { path = .., order = 3 } with its number since the robot's start"
        }
    }
}

/// Returns warnings about laws that were asked for and not tried, or found and not used.
pub(crate) fn law_warnings(
    model: &ModelSettings,
    inputs: &Inputs,
    fitted: &Fitted,
    warming: Option<&WarmingFit>,
) -> Vec<String> {
    let mut warnings: Vec<String> = warming.map_or(vec![], |warming| warming.reasons.clone());
    if model.stribeck && inputs.friction.is_empty() {
        warnings.push(
            "the Stribeck effect was not tried: no slow motions of single joints are given; name \
             some with --friction"
                .into(),
        );
    }
    let dropped = fitted.first.friction.iter().filter(|fit| {
        let joints = fitted.description.joints.iter().zip(&fitted.friction);
        let is_dropped = |(joint, friction): (_, &FrictionDescription)| {
            let joint: &reachtube_robot::JointDescription = joint;
            joint.name == fit.joint.joint && *friction == FrictionDescription::default()
        };
        fit.joint.coefficients.stribeck.is_some() && joints.into_iter().any(is_dropped)
    });
    warnings.extend(dropped.map(|fit| {
        format!(
            "{}: the Stribeck effect of the slow motions is not used, because friction fitted to \
             the exciting motions alone explains them better",
            fit.joint.joint
        )
    }));
    warnings
}
