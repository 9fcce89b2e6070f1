//! The settings of `conform` from its arguments.

use reachtube::abstraction::{Abstraction, ExpansionPoint, PolynomialModel};
use reachtube::conform::settings::{Tolerance, Weights};
use reachtube::conform::{Basis, Noise, Settings};

use super::arguments::Arguments;
use crate::data_arguments::gap_limit;
use crate::error::{Error, Result};

/// Returns the robot, or the model in the file that `--abstraction` names.
pub(super) fn basis(args: &Arguments) -> Result<Basis> {
    Ok(match &args.abstraction {
        None => args.lock.load(args.robot.as_deref().unwrap_or_default())?.into(),
        Some(path) => PolynomialModel::load(path)?.into(),
    })
}

/// Returns the tolerance of `--explain`, where it is given.
pub(super) fn explain(args: &Arguments) -> Result<Option<Option<Tolerance>>> {
    Ok(match args.explain.as_deref() {
        Some("none") => Some(None),
        Some(list) => {
            let wrong = || Error::ExplainTolerance { given: list.into() };
            let (position, velocity) = list.split_once(',').ok_or_else(wrong)?;
            let parse = |text: &str| text.trim().parse().map_err(|_| wrong());
            Some(Some(Tolerance { position: parse(position)?, velocity: parse(velocity)? }))
        }
        None => None,
    })
}

pub(super) fn settings(args: &Arguments, joints: usize) -> Result<Settings> {
    let settings = Settings {
        abstraction: Abstraction { model: args.paper_model, order: args.order },
        expansion_point: ExpansionPoint::from_values(&args.expansion, joints)?,
        method: args.method,
        disturbance: args.disturbance,
        centre: args.centre,
        notion: args.notion,
        states: args.states,
        initial_limit: args.initial_limit,
        weights: match args.weights.as_str() {
            "unit" => Weights::Unit,
            "spread" => Weights::Spread,
            list => Weights::Given(numbers("--weights", "unit, spread, ", list, joints)?),
        },
        noise: match args.noise.as_str() {
            "none" => Noise::None,
            "fitted" => Noise::Fitted,
            list => Noise::Fixed(numbers("--noise", "none, fitted, ", list, joints)?),
        },
        sensor_noise: match &args.sensor_noise {
            Some(list) => Some(numbers("--sensor-noise", "", list, joints)?),
            None => None,
        },
        nominal: args.nominal,
        equations: args.equations,
        calibrate: args.calibrate.clone(),
        until: args.data.until,
        gap_limit: gap_limit(args.data.max_gap),
        ..Settings::new(args.data.torque.ok_or(Error::NoTorque)?, joints)
    };
    settings.validate(joints)?;
    Ok(settings)
}

/// Parses one number per state: 2n numbers, or 2 that stand for all positions and all velocities.
/// `words` names the other values of the option, for the error.
fn numbers(
    option: &'static str,
    words: &'static str,
    list: &str,
    joints: usize,
) -> Result<Vec<f64>> {
    let states = 2 * joints;
    let wrong = |problem: String| Error::StateValues { option, problem, words, states };
    let parse = |text: &str| {
        text.trim().parse::<f64>().map_err(|_| wrong(format!("\"{text}\" is not a number")))
    };
    let values = list.split(',').map(parse).collect::<Result<Vec<_>>>()?;
    match values[..] {
        [position, velocity] => Ok([vec![position; joints], vec![velocity; joints]].concat()),
        _ if values.len() == states => Ok(values),
        _ => Err(wrong(format!("{} values given", values.len()))),
    }
}
