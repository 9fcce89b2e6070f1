use crate::envelope::Envelope;
use crate::error::{Error, Result};
use crate::fitting::data::Data;
use crate::fitting::evaluation::Fit;
use crate::fitting::group::{FitSettings, Group};
use crate::fitting::parameters::{Parameter, Parameters, Quantity};
use crate::fitting::pull::choose;
use crate::fitting::record::{FitRecord, FittedParameter, GroupCost, TorquePrediction};
use crate::fitting::search::Search;
use crate::fitting::torque;
use crate::nominal::correction::WarmthLaw;
use crate::problem::problem::{Problem, Setup};
use crate::progress::Progress;
use crate::settings::Weights;
use crate::weights::state_weights;

/// What a fit found.
#[derive(Debug)]
pub struct Fitted {
    /// The problem with the fitted model, ready for [`conform`](crate::conform).
    pub problem: Problem,
    /// How the model was fitted.
    pub record: FitRecord,
}

/// Finds the parameters of the nominal model for which the sets of a linear model cost least.
///
/// The answer is a model, not a claim: [`conform`](crate::conform) finds and proves its sets as it
/// does for any other.
///
/// # Errors
///
/// [`Error::Fit`] with fewer than two motions, without any parameter, and for a model that is not
/// linear; as [`Problem::run`] and [`conform`](crate::conform).
pub fn fit(problem: &Problem, settings: &FitSettings, progress: &dyn Progress) -> Result<Fitted> {
    let refused = |why: &str| Err(Error::Fit(why.into()));
    if problem.dynamics().linear_system().is_none() {
        return refused("only linear models can be fitted yet; give --order 1");
    }
    let by_run = settings.groups.contains(&Group::WarmUp);
    let data = Data::new(problem, by_run)?;
    if data.motions.len() < 2 {
        return refused(
            "there is only one motion, and a model that is chosen for one motion holds for no \
             other; record a second motion, or name the motions in the column motion of runs.csv",
        );
    }
    let (setup, joints) = (problem.setup(), problem.joints());
    let law = by_run.then_some(WarmthLaw::Runs);
    let parameters = Parameters::new(setup, &settings.groups, law);
    if parameters.len() == 0 {
        return refused("the robot has none of the parameters of these groups");
    }
    let envelopes: Vec<&Envelope> = problem.deviations()?.iter().map(|d| &d.envelope).collect();
    let weights = state_weights(&problem.settings().weights, &envelopes, joints);
    let fit =
        Fit { parameters, data, weights, settings: problem.settings(), limits: problem.limits() };
    let choice = choose(&fit, settings.pull)?;
    progress.finished(&format!("the pull toward the identified values: {}", choice.pull));
    let all = fit.tracks(None);
    let start = vec![0.0; fit.parameters.len()];
    let identified = fit.smallest(&fit.model(&start, None)?, &all)?.cost;
    let pull = choice.pull * identified;
    let found = Search { fit: &fit, tracks: all.clone(), pull }.run(&start)?;
    progress.finished(&format!("{} steps of the fit", found.steps));
    let groups = settings
        .groups
        .iter()
        .map(|group| {
            Ok(GroupCost {
                group: *group,
                cost_without: without(&fit, *group, &found.numbers, &all)?,
            })
        })
        .collect::<Result<_>>()?;
    let mut fitted = fit.parameters.apply(&found.numbers)?;
    if fitted.settings.weights == Weights::Spread {
        fitted.settings.weights = Weights::Given(fit.weights.clone());
    }
    let before = torque::residual(setup, &fit.data.tracks)?;
    let after = torque::residual(&fitted, &fit.data.tracks)?;
    let torque = before.into_iter().zip(after).enumerate();
    let record = FitRecord {
        pull: choice.pull,
        identified_cost: identified,
        cost: found.cost,
        groups,
        leave_one_out: choice.left_out,
        pulls: choice.tried,
        parameters: parameters_of(&fit, &found.numbers, setup),
        torque: torque
            .map(|(j, (identified, fitted))| TorquePrediction { joint: j + 1, identified, fitted })
            .collect(),
    };
    Ok(Fitted { problem: problem.with_setup(fitted), record })
}

/// The cost of the sets with one group at its identified values.
fn without(fit: &Fit, group: Group, numbers: &[f64], tracks: &[usize]) -> Result<f64> {
    let pairs = numbers.iter().zip(&fit.parameters.list);
    let kept: Vec<f64> = pairs
        .map(|(x, parameter)| if parameter.quantity.group() == group { 0.0 } else { *x })
        .collect();
    Ok(fit.smallest(&fit.model(&kept, None)?, tracks)?.cost)
}

fn coulomb_name(quadrants: [bool; 4]) -> &'static str {
    match quadrants {
        [true, false, false, false] => "Coulomb friction, driving forward",
        [false, true, false, false] => "Coulomb friction, driving backward",
        [false, false, true, false] => "Coulomb friction, braking backward",
        [false, false, false, true] => "Coulomb friction, braking forward",
        _ => "Coulomb friction",
    }
}

fn parameters_of(fit: &Fit, numbers: &[f64], setup: &Setup) -> Vec<FittedParameter> {
    let of = |p: usize| {
        let Parameter { quantity, joint, .. } = fit.parameters.list[p];
        let kind = setup.robot.joints()[joint].kind;
        let (identified, fitted, factor) = fit.parameters.values(p, numbers[p]);
        let of_velocity =
            |power| format!("{}/({}){power}", kind.force_unit(), kind.velocity_unit());
        let (name, unit) = match quantity {
            Quantity::MotorInertia => ("inertia at the motor", kind.inertia_unit().into()),
            Quantity::Density => ("mass of the link", "kg".into()),
            Quantity::Viscous => ("viscous friction", of_velocity("")),
            Quantity::Cubic => ("cubic friction", of_velocity("³")),
            Quantity::Coulomb(quadrants) => (coulomb_name(quadrants), kind.force_unit().into()),
            Quantity::WarmUp => ("viscous friction per unit of warmth", of_velocity("")),
            Quantity::Payload => ("payload", "kg".into()),
        };
        let (group, joint) = (quantity.group(), joint + 1);
        FittedParameter { group, name: name.into(), joint, unit, identified, fitted, factor }
    };
    (0..numbers.len()).map(of).collect()
}
