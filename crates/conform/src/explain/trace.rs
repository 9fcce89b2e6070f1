//! Trace conformance: one motion of the model through all samples of a recording.

use std::iter::repeat_n;

use rayon::prelude::*;
use reachtube_reach::{Flowpipe, FlowpipeSettings, Hyperrectangle, UncertainInput};
use reachtube_recordings::Run;
use reachtube_scalar::rounding::{add_down, sub_down, sub_up};
use serde::{Deserialize, Serialize};

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::data::settings::NEEDS_NOISE;
use crate::error::{Error, Result};
use crate::explain::closest_motion::{Behaviour, Closeness, ClosestMotion};
use crate::sets::UncertaintySets;

/// The largest factor on U that is tried.
const LARGEST_FACTOR: f64 = 1024.0;

/// How accurately the least factor is found.
const ACCURACY: f64 = 0.01;

/// Largest number of generators of the flowpipe that proves one motion, in multiples of the number
/// of states. Its sets are rounding and remainders, so more gain nothing.
const ORDER: usize = 4;

/// Into how many parts each step is divided to prove a motion, one number after the other.
const PARTS: [usize; 3] = [1, 8, 64];

/// A motion that comes as close as this part of V is close enough.
const ENOUGH: f64 = 0.98;

/// Whether each recording is, up to the measurement noise V, one motion of the model: its start
/// lies in X0, its disturbance in U, held from each sample to the next, or throughout where the
/// model's is constant, and all its samples within V of the recorded ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TraceVerdict {
    /// For how many recordings such a motion was not found and proved.
    pub unproved: usize,
    /// By which factor U must grow about its centre so that there is one for each recording, found
    /// to 1 %; 1 where U suffices, `None` if a factor of 1024 does not.
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
    pub(crate) fn holds(&self) -> bool {
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
    let states = 2 * problem.joints();
    let noise: Vec<f64> = (0..states).map(|i| sets.noise_radius(i)).collect();
    if noise.contains(&0.0) {
        return Err(Error::Trace(NEEDS_NOISE));
    }
    let of_case = |case: Case| {
        let of = |run: usize| {
            let trace = Trace { problem, case: &case, sets, noise: &noise, run };
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

/// One run, and the sets of the model.
struct Trace<'a> {
    problem: &'a Problem,
    case: &'a Case,
    sets: &'a UncertaintySets,
    noise: &'a [f64],
    run: usize,
}

impl Trace<'_> {
    /// Returns 1, or else the least factor, to the accuracy of the search, for which a motion was
    /// proved; `None` if there is none.
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
        let (dynamics, n) = (self.problem.dynamics(), self.case.joints());
        let disturbance = self.problem.settings().disturbance;
        let closeness = Closeness { units: self.noise, enough: ENOUGH };
        let model = dynamics.polynomials();
        let found =
            ClosestMotion::new(model, self.case, &sets, disturbance, &recorded, closeness).run();
        let Some(start) = found.states.get(..2 * n) else { return Ok(false) };
        let starts = start.iter().zip(&self.case.start).enumerate();
        let mut in_start = starts.map(|(i, (x, base))| lies_in(*x, *base, &sets.initial_set, i));
        let is_in_input = match &found.constant {
            Some(constant) => (0..n).all(|j| lies_in(constant[j], 0.0, &sets.input_set, j)),
            None => {
                let mut inputs = found.inputs.iter().zip(&*self.case.inputs).enumerate();
                inputs.all(|(at, (u, given))| lies_in(*u, *given, &sets.input_set, at % n))
            }
        };
        Ok(found.largest <= 1.0
            && in_start.all(|lies| lies)
            && is_in_input
            && self.stays_close(&found, &recorded)?)
    }

    /// Returns whether the exact solution from the start and under the input that were found is
    /// proved to stay within V of the recording at all samples: its flowpipe does, whose sets have
    /// no width but from rounding and remainders. Shorter steps make the remainders smaller.
    fn stays_close(&self, found: &Behaviour, recorded: &Run) -> Result<bool> {
        for parts in PARTS {
            if self.flowpipe_stays_close(found, recorded, parts)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// As [`stays_close`](Self::stays_close), with every step divided into `parts`.
    fn flowpipe_stays_close(
        &self,
        found: &Behaviour,
        recorded: &Run,
        parts: usize,
    ) -> Result<bool> {
        let n = self.case.joints();
        let point = Hyperrectangle::zero;
        // The sum of a given input and a constant disturbance is not a double: it is enclosed.
        let (given, set) = match &found.constant {
            Some(constant) => {
                let set = Hyperrectangle { centre: constant.clone(), ..point(n) };
                (&self.case.inputs[..n * (recorded.len() - 1)], set)
            }
            None => (&found.inputs[..], point(n)),
        };
        let held = given.chunks_exact(n).flat_map(|u| repeat_n(u, parts));
        let flowpipe = Flowpipe::new(
            self.problem.dynamics().polynomial_system()?,
            &self.case.grid.prefix(recorded.len()).refined(parts),
            &found.states[..2 * n],
            &point(2 * n),
            &UncertainInput { measured: &held.flatten().copied().collect::<Vec<f64>>(), set: &set },
            &FlowpipeSettings { vertex_variables: 0, order: Some(ORDER), ..Default::default() },
        )?;
        let is_close = |k: usize| {
            let states = flowpipe.sample(k * parts).iter();
            states.zip(recorded.state(k)).zip(self.noise).all(|((x, measured), noise)| {
                sub_up(x.hi(), *measured) <= *noise && sub_up(*measured, x.lo()) <= *noise
            })
        };
        Ok(flowpipe.is_reached() && (0..recorded.len()).all(is_close))
    }
}

/// Returns whether x - base lies in dimension i of a set, with directed rounding.
fn lies_in(x: f64, base: f64, set: &Hyperrectangle, i: usize) -> bool {
    let (centre, radius) = (set.centre[i], set.radius[i]);
    sub_up(x, base) <= add_down(centre, radius) && sub_down(x, base) >= sub_up(centre, radius)
}
