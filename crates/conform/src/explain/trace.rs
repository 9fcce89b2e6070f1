//! Trace conformance: one motion of a linear model through all samples of a recording.

use rayon::prelude::*;
use reachtube_reach::{Disturbance, Hyperrectangle, IntervalVector};
use reachtube_scalar::rounding::{add_down, sub_down, sub_up};
use serde::{Deserialize, Serialize};

use crate::dynamics::Dynamics;
use crate::error::{Error, Result};
use crate::explain::closest_motion::{Closeness, ClosestMotion};
use crate::found::Found;
use crate::grids::Grid;
use crate::notion::smallest_sets as points;
use crate::problem::case::Case;
use crate::problem::problem::Problem;
use crate::progress::Progress;
use crate::sets::UncertaintySets;
use crate::settings::{Noise, Notion, Settings};

/// What the radii of U are widened by first, N m, so that doubles lie in u + U.
const LEAST_RADIUS: f64 = 1e-9;

/// What the radii of X0 are widened by, in parts of V: the search for a motion is accurate to 2 %,
/// so that a start at the edges of X0 and V at once would not be found.
const START_ROOM: f64 = 0.05;

/// The largest factor on U that is tried.
const LARGEST_FACTOR: f64 = 1024.0;

/// How accurately the least factor is found.
const ACCURACY: f64 = 0.01;

/// A motion that comes as close as this part of V is close enough.
const ENOUGH: f64 = 0.98;

const NEEDS_NOISE: &str = "needs a measurement noise V in every state, because no motion of a \
                           model meets measured states exactly; a model gets V by conform \
                           --noise, for example --noise 0.001,0.01";

/// Whether each recording is, up to the measurement noise V, one motion of the model: its start
/// lies in X0, its input in U, held from each sample to the next, and all its samples within V of
/// the recorded ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TraceVerdict {
    /// For how many recordings such a motion was not found and proved.
    pub unproved: usize,
    /// By which factor U must grow about its centre so that there is one for each recording, found
    /// to 1 %; 1 where U suffices, nothing where a factor of 1024 does not.
    pub factor: Option<f64>,
    /// The recording that needs the largest factor, where one needs more than 1.
    pub worst: Option<String>,
}

/// The factor of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TraceFactor {
    /// Index of the suite.
    pub suite: usize,
    /// The run (index in the source).
    pub run: usize,
    /// As [`TraceVerdict::factor`].
    pub factor: Option<f64>,
}

impl TraceFactor {
    /// Whether a motion under the sets themselves was proved.
    pub fn holds(&self) -> bool {
        self.factor == Some(1.0)
    }
}

impl TraceVerdict {
    /// Collects the factors of all runs.
    pub(crate) fn new(problem: &Problem, factors: &[TraceFactor]) -> Self {
        let size = |trace: &TraceFactor| trace.factor.unwrap_or(f64::INFINITY);
        let worst = factors.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        Self {
            unproved: factors.iter().filter(|trace| !trace.holds()).count(),
            factor: worst.map_or(Some(1.0), |worst| worst.factor),
            worst: worst
                .filter(|worst| !worst.holds())
                .map(|worst| problem.entry(worst.run).file.clone()),
        }
    }
}

/// Checks that traces can be asked of a model under some settings.
///
/// # Errors
///
/// [`Error::Trace`] with the remedy.
pub(crate) fn check_settings(settings: &Settings, dynamics: &Dynamics) -> Result<()> {
    if settings.notion != Notion::Trace {
        Ok(())
    } else if dynamics.linear_system().is_none() {
        Err(Error::Trace(
            "is proved for linear models only; for others --explain searches for the closest \
             motion",
        ))
    } else if settings.disturbance == Disturbance::Constant {
        Err(Error::Trace(
            "is for disturbances that may change at each sample: for a model that was found with \
             conform --disturbance sample or measurable",
        ))
    } else {
        match &settings.noise {
            Noise::None => Err(Error::Trace(NEEDS_NOISE)),
            Noise::Fixed(radii) if radii.contains(&0.0) => Err(Error::Trace(NEEDS_NOISE)),
            Noise::Fixed(_) | Noise::Fitted => Ok(()),
        }
    }
}

/// Finds for each run the least factor on U for which a motion of the model through all samples was
/// proved, on all cores.
///
/// # Guarantee
///
/// With U grown by the factor, one solution of the model starts in X0, has its input in U and stays
/// within V of the recording at all samples: directed rounding. That no smaller factor does is not
/// proved.
///
/// # Errors
///
/// [`Error::Trace`] where V is 0 in a state; as [`Problem::run`].
pub(crate) fn trace_factors(problem: &Problem, sets: &UncertaintySets) -> Result<Vec<TraceFactor>> {
    let grids = problem.grids()?;
    let states = 2 * problem.joints();
    let noise: Vec<f64> = (0..states).map(|i| sets.noise_radius(i)).collect();
    if noise.contains(&0.0) {
        return Err(Error::Trace(NEEDS_NOISE));
    }
    let of_case = |case: Case| {
        let grid = &grids.as_slice()[grids.find(&case.grid)];
        let of = |run: usize| {
            let trace = Trace { problem, case: &case, grid, sets, noise: &noise, run };
            Ok(TraceFactor { suite: case.suite, run, factor: trace.factor()? })
        };
        match case.run {
            Some(run) => Ok(vec![of(run)?]),
            None => {
                let runs = problem.recordings().suites[case.suite].every_run()?;
                runs.par_iter().map(|summary| of(summary.index)).collect::<Result<Vec<_>>>()
            }
        }
    };
    let suites = 0..problem.recordings().suites.len();
    let parts = suites.map(|suite| problem.cases_of(suite, of_case)).collect::<Result<Vec<_>>>()?;
    Ok(parts.into_iter().flatten().flatten().collect())
}

/// Finds the smallest sets in which every recorded point lies, and widens U until one motion of the
/// model passes through all samples of each recording. A recording through which none passes,
/// however wide U is, does not count.
///
/// # Errors
///
/// As [`trace_factors`].
pub(crate) fn smallest_sets(problem: &Problem, progress: &dyn Progress) -> Result<Found> {
    points::smallest_sets_widened(problem, progress, |mut sets| {
        sets.input_set.radius.iter_mut().for_each(|radius| *radius += LEAST_RADIUS);
        for i in 0..2 * problem.joints() {
            sets.initial_set.radius[i] += START_ROOM * sets.noise_radius(i);
        }
        let factors = trace_factors(problem, &sets)?;
        let factor = factors.iter().filter_map(|trace| trace.factor).fold(1.0, f64::max);
        progress.finished(&format!(
            "{} of {} recordings are motions of the model within V; U is widened by {factor:.3}",
            factors.iter().filter(|trace| trace.holds()).count(),
            factors.len()
        ));
        Ok(sets.with_input_scaled(factor))
    })
}

/// One run, and the sets of the model.
struct Trace<'a> {
    problem: &'a Problem,
    case: &'a Case,
    grid: &'a Grid,
    sets: &'a UncertaintySets,
    noise: &'a [f64],
    run: usize,
}

impl Trace<'_> {
    /// Returns 1, or else the least factor, to the accuracy of the search, for which a motion was
    /// proved; nothing where there is none.
    fn factor(&self) -> Result<Option<f64>> {
        if self.holds(1.0)? {
            return Ok(Some(1.0));
        }
        if !self.holds(LARGEST_FACTOR)? {
            return Ok(None);
        }
        let (mut low, mut high) = (1.0, LARGEST_FACTOR);
        while high > (1.0 + ACCURACY) * low {
            let middle = (low * high).sqrt();
            if self.holds(middle)? { high = middle } else { low = middle }
        }
        Ok(Some(high))
    }

    /// Returns whether a motion was found and proved with U grown by `factor`.
    fn holds(&self, factor: f64) -> Result<bool> {
        let recorded = self.problem.run(self.run)?;
        let sets = self.sets.with_input_scaled(factor);
        let (model, n) = (self.problem.dynamics().polynomials(), self.case.joints());
        let closeness = Closeness { units: self.noise, enough: ENOUGH };
        let found = ClosestMotion::new(model, self.case, &sets, &recorded, closeness).run();
        let Some(start) = found.states.get(..2 * n) else { return Ok(false) };
        let in_start =
            (0..2 * n).all(|i| lies_in(start[i], self.case.start[i], &sets.initial_set, i));
        let inputs = found.inputs.iter().zip(&*self.case.inputs).enumerate();
        let mut in_input =
            inputs.map(|(at, (u, given))| lies_in(*u, *given, &sets.input_set, at % n));
        if !in_start || !in_input.all(|lies| lies) {
            return Ok(false);
        }
        let start = IntervalVector::from_iterator(2 * n, start.iter().map(|x| (*x).into()));
        // The input of the last sample has no effect.
        let inputs = [&found.inputs[..], &vec![0.0; n]].concat();
        let solution = self.grid.propagation.solve(&start, &inputs);
        let is_close = |k: usize| {
            let mut states = solution.state(k).iter().zip(recorded.state(k)).zip(self.noise);
            states.all(|((x, measured), noise)| {
                sub_up(x.hi(), *measured) <= *noise && sub_up(*measured, x.lo()) <= *noise
            })
        };
        Ok(solution.len() >= recorded.len() && (0..recorded.len()).all(is_close))
    }
}

/// Returns whether x - base lies in dimension i of a set, with directed rounding.
fn lies_in(x: f64, base: f64, set: &Hyperrectangle, i: usize) -> bool {
    let (centre, radius) = (set.centre[i], set.radius[i]);
    sub_up(x, base) <= add_down(centre, radius) && sub_down(x, base) >= sub_up(centre, radius)
}
