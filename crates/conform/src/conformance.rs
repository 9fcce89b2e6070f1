//! The whole of a conformance: from a problem to sets that were proved to enclose its recordings.

use std::path::Path;

use reachtube_scalar::rounding::add_down;

use crate::claim::notion::claim;
use crate::claim::verdict::Verdict;
use crate::data::problem::Problem;
use crate::data::settings::check_allowance;
use crate::error::Result;
use crate::next_motion::allowance::AllowanceNeeded;
use crate::next_motion::any_run::AnyRun;
use crate::next_motion::calibration::{Calibration, calibrate, not_smallest};
use crate::next_motion::left_out::LeftOutMotions;
use crate::next_motion::trends::{Trend, trends};
use crate::next_motion::trust::Trust;
use crate::next_motion::without_motion::LeftOut;
use crate::nominal::input_error::InputError;
use crate::plausibility::{NominalFit, Usefulness, warnings};
use crate::program::program::Program;
use crate::progress::Progress;
use crate::reach::reach;
use crate::search::found::{Found, SearchSummary};
use crate::search::optimality::LARGEST_GAP;
use crate::search::smallest_sets::smallest_sets;
use crate::sets::UncertaintySets;
use crate::stiction::{Stiction, stiction};
use crate::tube::tube::Tube;
use crate::tube::witness::Witness;
use reachtube_finding::Finding;

/// Largest number of times that U is widened for stiction, each time for the wider sets.
const MOST_WIDENINGS: usize = 8;

/// Factor by which U is widened beyond the friction that was found.
const WIDENING: f64 = 1.02;

/// The result of [`conform`].
#[derive(Debug)]
pub struct Conformance {
    /// X0, U, V.
    pub sets: UncertaintySets,
    /// Cost of the sets: the integral over time of Σ_i s_i width_i of the reachable set and the
    /// noise, by the time for which each sample stands; suites whose sets differ count by their
    /// mean. Infinite if a set was lost.
    pub cost: f64,
    /// The cost as the paper sums it: over distinct sample times, each of which counts 1.
    pub cost_of_samples: f64,
    /// The dual objective of the program of a linear model: no sets cost less, to the solver's
    /// tolerance.
    pub lower_bound: Option<f64>,
    /// Gap between cost and lower bound, relative to the lower bound. Above 1e-6 the sets are
    /// conformant, but not minimal.
    pub optimality_gap: Option<f64>,
    /// The paper's sum, eq. (21), which adds E where it should add |E|, for a linear model.
    pub paper_cost: Option<f64>,
    /// Σ_k Δt Π_i width_i(t_k), eq. (2).
    pub hull_volume: f64,
    /// The proof.
    pub verdict: Verdict,
    /// The statement about motions that were not recorded.
    pub trust: Trust,
    /// The calibration of the sets, if motions were held out for it.
    pub calibration: Option<Calibration>,
    /// The sets without each of the motions they were found on; none for one motion, for a
    /// bisection, and for other notions than the hull.
    pub left_out: Vec<LeftOut>,
    /// The growth of the sets for each of these motions. `None` without such motions, if the
    /// program of some could not be solved, and for a model that is not linear.
    pub allowance_needed: Option<AllowanceNeeded>,
    /// The radii that were added to the smallest X0 and U, 3n; empty if none were.
    pub allowance: Vec<f64>,
    /// The dry friction that U was widened for, part by part; empty without the setting.
    pub stiction: Vec<Stiction>,
    /// The parts whose motion follows the order of the runs.
    pub trends: Vec<Trend>,
    /// The search for the sets of a model that is not linear.
    pub search: Option<SearchSummary>,
    /// The recorded values that touch the reachable set, the closest first; the linearised set if
    /// the model is not linear.
    pub tight: Vec<Witness>,
    /// Implausible results, and the most likely cause.
    pub warnings: Vec<Finding>,
    /// Width of the sets beside the motion of each part.
    pub usefulness: Usefulness,
    /// The part of the variance of each state that the nominal motions explain, 2n; negative if
    /// they are further away than the mean, `None` if the state hardly moves.
    pub nominal_explains: Vec<Option<f64>>,
    /// The sets that hold for every run, for a linear model whose friction depends on it; none for
    /// calibrated sets.
    pub any_run: Option<AnyRun>,
    /// The root mean square of the input minus what the robot needs for the recorded motions, n,
    /// N m, to lay beside U.
    pub input_error: Vec<f64>,
    /// The reachable sets.
    pub tube: Tube,
}

/// Finds the smallest uncertainty sets for which the problem's model is reachset conformant with
/// its recordings, and proves the result with directed rounding. A linear model's sets solve one
/// linear program; for others see [`Method`](crate::settings::Method). A search for the sets of a
/// model that is not linear keeps what is finished in the file `resume`, continues from it, and
/// removes it at the end.
///
/// # Guarantee
///
/// As [`Verdict::new`], if `verdict.conformant`. Nothing is claimed between samples.
///
/// # Errors
///
/// A model that diverges without any disturbance, a program that the solver gives up on, a `resume`
/// file of another job or that cannot be written; as [`Problem::run`]. A model that could not be
/// proved conformant is no error.
pub fn conform(
    problem: &Problem,
    progress: &dyn Progress,
    resume: Option<&Path>,
) -> Result<Conformance> {
    conform_fitted(problem, None, progress, resume)
}

/// Does what [`conform`] does for the problem of a fit, which left motions out of both the nominal
/// model and the sets.
///
/// # Guarantee
///
/// As [`conform`].
pub(crate) fn conform_fitted(
    problem: &Problem,
    left_out: Option<LeftOutMotions>,
    progress: &dyn Progress,
    resume: Option<&Path>,
) -> Result<Conformance> {
    let how = (progress, resume);
    let (found, calibration) = if problem.settings().calibrate.is_empty() {
        (smallest_sets(problem, &*claim(problem)?, left_out, how)?, None)
    } else {
        let (found, calibration) = calibrate(problem, left_out, how)?;
        (found, Some(calibration))
    };
    judged(problem, found, calibration, Vec::new())?.with_stiction(problem)
}

fn judged(
    problem: &Problem,
    found: Found,
    calibration: Option<Calibration>,
    allowance: Vec<f64>,
) -> Result<Conformance> {
    let Found { tube, costs, lower_bound, optimality_gap, search, left_out, deciding, .. } = found;
    let LeftOutMotions { each: left_out, missing } = left_out;
    let mut tight = found.touching;
    let mut radii = vec![0.0f64; problem.states()];
    let verdict = Verdict::visiting(problem, &tube, |row| {
        radii[row.state] = radii[row.state].max(row.radius);
        let decide = row.edges.iter().filter(|edge| deciding.contains(row, edge));
        tight.extend(decide.map(|edge| Witness::new(problem, row, edge)));
    })?;
    tight.sort_by(|a, b| b.excess.total_cmp(&a.excess));
    let fit = NominalFit::new(problem)?;
    let input_error = InputError::of_problem(problem)?;
    let allowance_needed =
        missing.map(|all| AllowanceNeeded::new(problem, &tube.sets, &input_error, &all));
    let warnings = warnings(problem, &tube.sets, &radii, &fit, &input_error, calibration.as_ref())?;
    let trust = match allowance.is_empty() {
        true => trust(problem, calibration.as_ref(), optimality_gap, &tight, verdict.conformant),
        false => Trust::with_allowance(problem.recordings()),
    };
    let is_as_found = calibration.is_none() && allowance.is_empty();
    Ok(Conformance {
        sets: tube.sets.clone(),
        warnings,
        usefulness: Usefulness::new(problem, &tube, &fit),
        nominal_explains: fit.explained,
        cost: costs.cost,
        cost_of_samples: costs.of_samples,
        lower_bound,
        optimality_gap,
        paper_cost: costs.paper,
        hull_volume: costs.volume,
        trust,
        verdict,
        trends: trends(problem),
        calibration,
        left_out,
        allowance_needed,
        allowance,
        stiction: Vec::new(),
        search,
        tight,
        input_error,
        any_run: if is_as_found { AnyRun::new(problem)? } else { None },
        tube,
    })
}

impl Conformance {
    /// Adds radii to X0 and U, 3n, and proves the wider sets. They are not the smallest.
    ///
    /// # Guarantee
    ///
    /// As [`conform`].
    pub(crate) fn widened(self, problem: &Problem, allowance: Vec<f64>) -> Result<Self> {
        check_allowance(&allowance, problem.inputs())?;
        let sets = self.sets.widened(&allowance);
        let allowance = match self.allowance.is_empty() {
            true => allowance,
            false => self.allowance.iter().zip(&allowance).map(|(a, b)| add_down(*a, *b)).collect(),
        };
        let left_out = LeftOutMotions { each: self.left_out, missing: None };
        let linear = problem.dynamics().linear_system();
        let program = linear.map(|_| Program::of_problem(problem)).transpose()?;
        let scale = program.as_ref().map(Program::scale);
        let found = Found { left_out, search: self.search, ..not_smallest(problem, &sets, scale)? };
        let Self { allowance_needed, stiction, .. } = self;
        let judged = judged(problem, found, self.calibration, allowance)?;
        Ok(Self { allowance_needed, stiction, ..judged })
    }

    /// Widens U by the dry friction that is possible where parts may come to rest, if the settings
    /// select it, and proves the wider sets. They reach further, so that more parts may come to
    /// rest, and U is widened again until it covers these too. Wider sets hold every motion that
    /// the smallest ones hold, so that bounds for the next motion remain.
    ///
    /// # Guarantee
    ///
    /// As [`stiction`](crate::stiction()).
    fn with_stiction(self, problem: &Problem) -> Result<Self> {
        if !problem.settings().stiction {
            return Ok(self);
        }
        let (n, trust) = (problem.inputs(), self.trust.clone());
        let mut found = self;
        for round in 0..=MOST_WIDENINGS {
            let reached = reach(problem, &found.tube)?;
            found.stiction = stiction(problem, &found.sets, &found.allowance, &reached);
            let allowed = |part: usize| found.allowance.get(2 * n + part).copied().unwrap_or(0.0);
            let mut more = vec![0.0; 3 * n];
            for rest in &found.stiction {
                let part = rest.part - 1;
                // A little more than is needed, since wider sets need a little more.
                more[2 * n + part] = match allowed(part) {
                    allowed if rest.torque <= allowed => 0.0,
                    allowed => (WIDENING * rest.torque - allowed).max(0.0),
                };
            }
            let is_open = more.iter().any(|more| *more > 0.0);
            if !is_open || round == MOST_WIDENINGS || !more.iter().all(|more| *more <= 1e9) {
                break;
            }
            found = found.widened(problem, more)?;
        }
        if found.verdict.conformant && !found.allowance.is_empty() {
            let basis = format!("{}; U was widened for stiction afterwards", trust.basis);
            found.trust = Trust { basis, ..trust };
        }
        Ok(found)
    }
}

fn trust(
    problem: &Problem,
    calibration: Option<&Calibration>,
    optimality_gap: Option<f64>,
    tight: &[Witness],
    is_proved: bool,
) -> Trust {
    let recordings = problem.recordings();
    match (calibration, optimality_gap) {
        (Some(calibration), _) => Trust::of_calibration(problem, calibration, is_proved),
        (None, Some(gap)) if gap > LARGEST_GAP => Trust::without_optimum(recordings, gap),
        _ if problem.setup().drive.is_fitted() => Trust::of_fitted_nominal(recordings),
        _ => Trust::of_fit(problem, tight),
    }
}
