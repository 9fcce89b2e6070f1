use rayon::prelude::*;

use crate::data::problem::Problem;
use crate::data::setup::{Asked, Parameters, Setup};
use crate::error::{Error, Result};
use crate::fit::data::{Data, EQUALLY_WARM};
use crate::fit::evaluation::{FitTask, Smallest};
use crate::fit::group::{FitSettings, Group};
use crate::fit::pull::{PullChoice, choose};
use crate::fit::record::{FitRecord, GroupCost, TorquePrediction};
use crate::fit::search::{FoundNumbers, SearchEffort, Wanted, size};
use crate::next_motion::calibration::{calibrate, without_held_out};
use crate::next_motion::left_out::LeftOutMotions;
use crate::nominal::input_error::InputError;
use crate::program::layout::Limits;
use crate::program::program::Program;
use crate::progress::{Progress, Silent};

/// The result of a fit.
#[derive(Debug)]
pub struct Fitted {
    /// The problem with the fitted model, ready for [`conform`](crate::conform).
    pub problem: Problem,
    /// How the model was fitted.
    pub record: FitRecord,
    /// The motions that were left out of the fit and of the sets of the linear model, if the fit
    /// was taken.
    pub(crate) left_out: Option<LeftOutMotions>,
}

/// Finds the parameters of the nominal model for which its sets cost least.
///
/// Motions that calibrate the sets are held out from this fit too.
///
/// Without a given pull, groups without which fits carry over better to motions that are left out
/// are dropped, and the problem keeps the identified model if that carries over better still.
///
/// The answer is a model, not a claim: [`conform`](crate::conform) finds and proves its sets as it
/// does for any other. A model that is not linear is given the parameters that suit the linear
/// model of the same robot about the same point; the costs of the record belong to the linear
/// model.
///
/// # Errors
///
/// As [`FitSettings::check`]; [`Error::Fit`] with fewer than two motions, without any parameter,
/// with points that other processes hold, and where the fitted robot is not physical;
/// [`Error::Fold`] for warm-up where a fold has not kept the recordings; as [`Problem::run`] and
/// [`conform`](crate::conform).
pub fn fit(problem: &Problem, settings: &FitSettings, progress: &dyn Progress) -> Result<Fitted> {
    let basis = Basis::new(problem, settings)?;
    let steering = basis.steering();
    let parameters = basis.parameters(steering.setup())?;
    let fit = basis.task(&*parameters, progress)?;
    let choice = choose(&fit, &steering.limits_without_each(&basis.data), settings.pull)?;
    if settings.pull.is_none() && !choice.carries_over() {
        let (record, setup) = (not_taken(&fit, choice, steering)?, problem.setup().clone());
        return Ok(Fitted { problem: problem.with_setup(setup), record, left_out: None });
    }
    let found = search(&fit, choice.pull, &choice.dropped)?;
    let steps = if found.steps == 1 { "step" } else { "steps" };
    progress.finished(&format!("the fit took {} {steps}", found.steps));
    let fitted = basis.with_numbers(steering, &found.numbers)?;
    let costs = [smallest(steering)?, smallest(&fitted)?];
    let left_out = Some(LeftOutMotions::from(&choice));
    let mut record = record(&fit, choice, Some(&found.numbers), costs)?;
    record.identified_calibrated_cost = calibrated_cost(problem);
    // The numbers go to the model that was requested, with all motions.
    let problem = match basis.other {
        None => fitted,
        Some(_) => basis.with_numbers(problem, &found.numbers)?,
    };
    Ok(Fitted { problem, record, left_out })
}

/// Returns the setup that [`fit`] finds. With a given pull it leaves no motion out, and makes no
/// record.
pub(crate) fn fitted_setup(
    problem: &Problem,
    settings: &FitSettings,
    progress: &dyn Progress,
) -> Result<Setup> {
    let Some(pull) = settings.pull else {
        return Ok(fit(problem, settings, progress)?.problem.setup().clone());
    };
    let basis = Basis::new(problem, settings)?;
    let parameters = basis.parameters(basis.steering().setup())?;
    let fit = basis.task(&*parameters, progress)?;
    let found = search(&fit, pull, &[])?;
    Ok(basis.with_numbers(problem, &found.numbers)?.setup().clone())
}

/// What a fit of a problem is based on.
struct Basis<'a> {
    given: &'a Problem,
    groups: &'a [Group],
    /// The problem that steers, if it is another: the linear model of the same robot, without the
    /// motions that calibrate.
    other: Option<Problem>,
    data: Data,
    /// The lowest and the highest recorded value of each state, N.
    bounds: Vec<[f64; 2]>,
}

impl<'a> Basis<'a> {
    fn new(given: &'a Problem, settings: &'a FitSettings) -> Result<Self> {
        settings.check(given.setup())?;
        let groups = &*settings.groups;
        let mut other = without_held_out(given)?;
        let is_held_out = other.is_some();
        if given.dynamics().linear_system().is_none() {
            let linear = given.setup().fits()?.linear(given.setup())?;
            other = Some(other.as_ref().unwrap_or(given).with_setup(linear));
        }
        let steering = other.as_ref().unwrap_or(given);
        let data = Data::new(steering, groups.contains(&Group::WarmUp))?;
        if data.motions.len() < 2 {
            return Err(Error::Fit(one_motion(is_held_out)));
        }
        if groups.contains(&Group::WarmUp) && data.are_equally_warm() {
            return Err(Error::Fit(EQUALLY_WARM.into()));
        }
        let states = 0..steering.shape().states;
        let bounds = states.map(|i| steering.recorded_bounds(i)).collect();
        Ok(Self { given, groups, other, data, bounds })
    }

    fn steering(&self) -> &Problem {
        self.other.as_ref().unwrap_or(self.given)
    }

    fn parameters(&self, setup: &Setup) -> Result<Box<dyn Parameters>> {
        let asked = Asked {
            groups: self.groups,
            bounds: self.bounds.clone(),
            is_nonlinear: self.given.dynamics().linear_system().is_none(),
            temperatures: self.data.mean_temperatures(),
        };
        let parameters = setup.fits()?.parameters(setup, &asked);
        if parameters.len() == 0 {
            return Err(Error::Fit("the robot has none of the parameters of these groups".into()));
        }
        Ok(parameters)
    }

    fn task<'b>(
        &'b self,
        parameters: &'b dyn Parameters,
        progress: &'b dyn Progress,
    ) -> Result<FitTask<'b>> {
        let (steering, data) = (self.steering(), &self.data);
        let settings = steering.settings();
        Ok(FitTask {
            parameters,
            data,
            stride: data.stride(),
            weights: settings.weights.of_states(steering.shape().states),
            settings,
            limits: steering.limits(),
            progress,
        })
    }

    /// Returns a problem whose model has the numbers that were found.
    fn with_numbers(&self, problem: &Problem, numbers: &[f64]) -> Result<Problem> {
        let parameters = self.parameters(problem.setup())?;
        let setup = parameters.apply(numbers)?;
        let refused = |error| Error::Fit(format!("{error}; give a larger weight to the pull"));
        parameters.check(&setup).map_err(refused)?;
        Ok(problem.with_setup(setup))
    }
}

/// Searches with a pull, in parts of the identified model's cost, and without the groups that were
/// dropped.
///
/// The cost has more than one local optimum. One search moves all parameters from the beginning,
/// and one for each kind of them first the others. The best answer counts, with every sample.
fn search(fit: &FitTask, pull: f64, dropped: &[Group]) -> Result<FoundNumbers> {
    let all = fit.parameters.except(dropped);
    let kind = |p: usize| fit.parameters.list()[p].kind;
    let mut kinds: Vec<u8> = Vec::new();
    for kind in all.iter().map(|p| kind(*p)) {
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let start = fit.parameters.start();
    let every_sample = FitTask { stride: 1, ..fit.clone() };
    let [pull, whole_pull] = [pull * fit.cost(&start)?, pull * every_sample.cost(&start)?];
    let wanted = |free, effort| Wanted { left_out: None, pull, free, effort };
    let of_held = |held: Option<u8>| {
        let first = match held {
            Some(held) => {
                let others = all.iter().copied().filter(|p| held != kind(*p)).collect();
                fit.search(&wanted(others, SearchEffort::START), &start)?.numbers
            }
            None => start.clone(),
        };
        let mut found = fit.search(&wanted(all.clone(), SearchEffort::WHOLE), &first)?;
        found.value = every_sample.cost(&found.numbers)? + whole_pull * size(&found.numbers);
        Ok(found)
    };
    let held = kinds.iter().map(|kind| Some(*kind)).filter(|_| kinds.len() > 1);
    let starts: Vec<Option<u8>> = std::iter::once(None).chain(held).collect();
    let answers: Vec<Result<FoundNumbers>> = starts.into_par_iter().map(of_held).collect();
    fit.progress.go_on()?;
    let value = |answer: &Result<FoundNumbers>| answer.as_ref().map_or(f64::INFINITY, |a| a.value);
    let best = answers.into_iter().min_by(|a, b| value(a).total_cmp(&value(b)));
    best.expect("a search that holds nothing")
}

fn one_motion(others_are_held_out: bool) -> String {
    let remedy = if others_are_held_out {
        "hold fewer motions out for the calibration"
    } else {
        "record a second motion, or name the motions in the column motion of runs.csv"
    };
    format!(
        "there is only one motion to fit to, and a model that is chosen for one motion holds for \
         no other; {remedy}"
    )
}

impl Problem {
    fn limits_without_each(&self, data: &Data) -> Vec<Limits> {
        let of = |motion: usize| {
            let is_own = |suite| {
                data.tracks.iter().any(|track| track.motion == motion && track.case.suite == suite)
            };
            self.with_suites(|suite| !is_own(suite)).limits()
        };
        (0..data.motions.len()).map(of).collect()
    }
}

/// The smallest sets of a linear model, as [`conform`](crate::conform) finds them.
fn smallest(problem: &Problem) -> Result<Smallest> {
    let program = Program::of_problem(problem)?;
    let sets = program.repaired(&program.solve()?.sets);
    let (cost, cost_by_time) = (program.cost_in_steps(&sets), program.cost(&sets));
    Ok(Smallest { sets, cost, cost_by_time, deciding: Vec::new() })
}

/// The cost of a linear model's calibrated sets, where they are to be calibrated and can be.
fn calibrated_cost(problem: &Problem) -> Option<f64> {
    let is_calibrated = !problem.settings().calibrate.is_empty();
    let is_linear = problem.dynamics().linear_system().is_some();
    let found = (is_calibrated && is_linear).then(|| {
        let known = Some(LeftOutMotions::default());
        calibrate(problem, known, (&Silent, None))
    });
    found?.ok().map(|(found, _)| found.costs.cost)
}

fn not_taken(fit: &FitTask, choice: PullChoice, steering: &Problem) -> Result<FitRecord> {
    let identified = smallest(steering)?;
    record(fit, choice, None, [identified.clone(), identified])
}

fn record(
    fit: &FitTask,
    choice: PullChoice,
    found: Option<&[f64]>,
    [identified, best]: [Smallest; 2],
) -> Result<FitRecord> {
    let setup = fit.parameters.setup();
    let groups = found.map_or_else(Vec::new, |_| choice.groups(fit.parameters));
    let numbers = found.map_or_else(|| vec![0.0; fit.parameters.len()], <[f64]>::to_vec);
    let pull = match groups.is_empty() {
        true => 0.0,
        false => choice.pull * fit.cost(&fit.parameters.start())?,
    };
    let cost_without = |group: &Group| {
        let wanted = Wanted {
            left_out: None,
            pull,
            free: fit.parameters.except(&[&choice.dropped[..], &[*group]].concat()),
            effort: SearchEffort::QUICK,
        };
        let (start, without) = (fit.parameters.start(), fit.without(*group, &numbers));
        if groups.len() == 1 {
            return Ok(GroupCost { group: *group, cost_without: fit.whole_cost(&start)? });
        }
        // Without a group a nominal motion may diverge until the others are fitted again.
        let again = fit.search(&wanted, &without);
        let again = again.or_else(|_| fit.search(&wanted, &start));
        let cost_without = match again {
            Err(Error::RunsAway { .. }) => None,
            again => fit.whole_cost(&again?.numbers)?,
        };
        Ok(GroupCost { group: *group, cost_without })
    };
    let cases = || fit.data.tracks.iter().map(|track| &track.case);
    let before = InputError::of_cases(setup, cases())?;
    let after = match found {
        Some(numbers) => InputError::of_cases(&fit.parameters.apply(numbers)?, cases())?,
        None => before.clone(),
    };
    let torque = before.into_iter().zip(after).enumerate();
    Ok(FitRecord {
        pull: choice.pull,
        identified_cost: identified.cost_by_time,
        cost: best.cost_by_time,
        groups: groups.par_iter().map(cost_without).collect::<Result<_>>()?,
        dropped: choice.dropped,
        taken: found.is_some(),
        leave_one_out: choice.left_out,
        identified_left_out: choice.identified,
        identified_calibrated_cost: None,
        pulls: choice.tried,
        parameters: fit.parameters.describe(&numbers),
        torque: torque
            .map(|(j, (identified, fitted))| TorquePrediction { part: j + 1, identified, fitted })
            .collect(),
    })
}

impl FitSettings {
    /// Refuses what cannot be fitted, whatever the recordings are.
    ///
    /// # Errors
    ///
    /// [`Error::Fit`] for a weight of the pull that is no part, and for groups of parameters that
    /// the setup cannot fit.
    pub fn check(&self, setup: &Setup) -> Result<()> {
        if let Some(pull) = self.pull.filter(|pull| !(0.0..=1.0).contains(pull)) {
            let why = format!("the weight of the pull is {pull}; give a number from 0 to 1");
            return Err(Error::Fit(why));
        }
        setup.fits()?.check(&self.groups)
    }
}

impl FitTask<'_> {
    /// Returns `numbers`, in which a group has the numbers that a fit starts from.
    pub(crate) fn without(&self, group: Group, numbers: &[f64]) -> Vec<f64> {
        let start = self.parameters.start();
        let parameters = self.parameters.list().iter().zip(numbers.iter().zip(&start));
        let kept = parameters.map(
            |(parameter, (x, start))| {
                if parameter.group == group { *start } else { *x }
            },
        );
        kept.collect()
    }
}
