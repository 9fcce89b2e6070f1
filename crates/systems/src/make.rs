//! The smallest sets of a system, beside those without it.

use std::collections::BTreeMap;

use rayon::prelude::*;
use reachtube_files::SealedFile;
use reachtube_finding::Finding;
use schemars::JsonSchema;
use serde::Serialize;

use crate::description::{
    BoxCentre, MatrixEntry, NamedSignal, NominalStartRule, SetDescriptions, SystemDescription,
    SystemKind,
};
use crate::error::Result;
use crate::findings::against;
use crate::model::{OutputWidth, OutputsAlone, RunsLeftOut, SystemModel, SystemRecording};
use crate::motion::NominalMotions;
use crate::rows::{FoundSets, SetRows};
use crate::run::SystemRun;
use crate::system::OutputSystem;

/// Up to this many recordings are left out in turn; of more, every second one.
const MOST_IN_TURN: usize = 64;

/// A recording counts as inside sets that need no more than this part, which is rounding.
const INSIDE: f64 = 1.0 + 1e-9;

/// The model of a system, and what speaks against it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MadeSystem {
    /// The model.
    pub model: SystemModel,
    /// What speaks against it.
    pub findings: Vec<Finding>,
}

impl MadeSystem {
    /// Returns whether the sets are proved and narrower than those without a model.
    #[must_use]
    pub fn is_useful(&self) -> bool {
        self.model.is_useful()
    }
}

impl OutputSystem {
    /// Returns what every second recording needs of the sets that the others give, and the mean
    /// widths of these, times what is needed on average. The largest need is too much a matter of
    /// luck to choose by.
    pub(crate) fn half_left_out(&self, runs: &[SystemRun]) -> Result<(RunsLeftOut, f64)> {
        let weights = self.weights(runs);
        let motions = NominalMotions::new(self, runs)?;
        let rows = SetRows::new(self, &motions);
        let kept: Vec<usize> = (0..runs.len()).step_by(2).collect();
        let sets = rows.smallest(&kept, &weights)?.sets;
        let others = (0..runs.len()).skip(1).step_by(2);
        let needed: Vec<(usize, f64)> =
            others.map(|run| (run, rows.beside(run, &sets).0)).collect();
        let width = weighted(&rows.widths(&sets), &weights);
        let mean = needed.iter().map(|(_, needed)| needed).sum::<f64>() / needed.len() as f64;
        let needed_width = if needed.is_empty() { width } else { width * mean };
        Ok((RunsLeftOut::new(&motions, needed, false), needed_width))
    }

    /// Does what [`conform`](Self::conform) does for a system whose numbers are known.
    pub(crate) fn made(
        &self,
        runs: &[SystemRun],
        left_out: Option<RunsLeftOut>,
    ) -> Result<MadeSystem> {
        let weights = self.weights(runs);
        let motions = NominalMotions::new(self, runs)?;
        let rows = SetRows::new(self, &motions);
        let all: Vec<usize> = (0..runs.len()).collect();
        let found = rows.smallest(&all, &weights)?;
        let widths = rows.widths(&found.sets);
        let spread = rows.spread();
        let widths_of = |i: usize| self.output_width(i, (&widths, spread[i]), runs);
        let outputs = (0..self.outputs()).map(widths_of).collect();
        let left_out = match left_out {
            Some(known) => known,
            None => self::left_out(&rows, &found, &weights)?,
        };
        let recordings = runs.iter().map(|run| SystemRecording {
            run: run.name.clone(),
            sha256: run.sha256.clone(),
            samples: run.len(),
        });
        let cost = weighted(&widths, &weights);
        let model = SystemModel {
            verified: found.is_proved,
            cost: found.cost,
            lower_bound: found.lower_bound,
            outputs,
            without_model: self.without_model(runs, &weights, (cost, motions.start_samples))?,
            left_out,
            start_samples: motions.start_samples,
            recordings: recordings.collect(),
            ..SystemModel::new(self.description.clone(), found.sets)
        };
        let findings = against(&model, runs, motions.is_unobserved);
        Ok(MadeSystem { model: model.sealed(), findings })
    }

    /// Returns the weight of each output in the cost.
    pub(crate) fn weights(&self, runs: &[SystemRun]) -> Vec<f64> {
        let of_range = |i: usize| {
            let [low, high] = self.range(i, runs);
            if high > low { (high - low).recip().clamp(1e-9, 1e9) } else { 1.0 }
        };
        let given = self.description.weights.clone();
        given.unwrap_or_else(|| (0..self.outputs()).map(of_range).collect())
    }

    /// Returns the lowest and the highest recorded value of an output.
    fn range(&self, i: usize, runs: &[SystemRun]) -> [f64; 2] {
        let values = runs.iter().flat_map(|run| run.outputs.iter().skip(i).step_by(self.outputs()));
        values
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
    }

    fn output_width(
        &self,
        i: usize,
        (widths, least): (&[Vec<f64>], f64),
        runs: &[SystemRun],
    ) -> OutputWidth {
        let own =
            || widths.iter().flat_map(|of| of.iter().skip(i).step_by(self.outputs()).copied());
        let [low, high] = self.range(i, runs);
        OutputWidth {
            name: self.description.outputs[i].name().into(),
            mean: own().sum::<f64>() / own().count() as f64,
            largest: own().fold(0.0, f64::max),
            least,
            motion: high - low,
        }
    }

    /// Returns the narrowest sets without a model: outputs that stay where they were, or go on as
    /// the samples tell that the system's starts come from. Its own widths have the weighted mean
    /// `own`.
    fn without_model(
        &self,
        runs: &[SystemRun],
        weights: &[f64],
        (own, start_samples): (f64, usize),
    ) -> Result<Option<OutputsAlone>> {
        let p = self.outputs();
        let has_past = matches!(
            self.description.start,
            Some(NominalStartRule::Past { outputs, .. }) if outputs > 1
        );
        let goes_on = has_past || start_samples > 1;
        let held = (false, "each output stays where it was");
        let going = (true, "each output goes on as the samples before tell");
        let mut best: Option<OutputsAlone> = None;
        if own == 0.0 {
            return Ok(best);
        }
        for (goes_on, how) in [held, going].into_iter().filter(|(going, _)| goes_on || !going) {
            let start = (goes_on && !has_past).then_some(NominalStartRule::Samples(start_samples));
            let system = Self::new(self.held(goes_on, start))?;
            let known = |run: &SystemRun| {
                let rate = |i: usize| match (&run.states, self.description.step) {
                    (Some(past), Some(step)) => (past[i] - past[p + i]) / step,
                    _ => 0.0,
                };
                let rates = (0..p).filter(|_| goes_on && has_past).map(rate);
                let states = run.outputs[..p].iter().copied().chain(rates).collect();
                SystemRun {
                    inputs: vec![],
                    states: (has_past || !goes_on).then_some(states),
                    ..run.clone()
                }
            };
            let known: Vec<SystemRun> = runs.iter().map(known).collect();
            let motions = NominalMotions::new(&system, &known)?;
            let rows = SetRows::new(&system, &motions);
            let all: Vec<usize> = (0..runs.len()).collect();
            let Ok(found) = rows.smallest(&all, weights) else { continue };
            let narrower = weighted(&rows.widths(&found.sets), weights) / own;
            if best.as_ref().is_none_or(|best| narrower < best.narrower) {
                best = Some(OutputsAlone { how: how.into(), narrower });
            }
        }
        Ok(best)
    }

    /// Returns a system that depends on its outputs alone, which are held or go on.
    fn held(&self, goes_on: bool, start: Option<NominalStartRule>) -> SystemDescription {
        let p = self.outputs();
        let n = if goes_on { 2 * p } else { p };
        let named = |i: usize| NamedSignal::Name(format!("state {i}"));
        let h = self.description.step;
        let entry = |i: usize, j: usize| match (i == j, goes_on && j == i + p, h) {
            (true, _, h) => f64::from(u8::from(h.is_some())),
            (_, true, h) => h.unwrap_or(1.0),
            _ => 0.0,
        };
        let number = MatrixEntry::Number;
        let square = (0..n).map(|i| (0..n).map(|j| number(entry(i, j))).collect()).collect();
        let last = n - p;
        // A discrete system has the acceleration w over each step.
        let acts = |i: usize, j: usize| match (i == j + last, i == j, h) {
            (true, ..) if goes_on => h.unwrap_or(1.0),
            (true, ..) => 1.0,
            (_, true, Some(h)) => h * h / 2.0,
            _ => 0.0,
        };
        let seen = |i: usize| (0..n).map(|j| number(f64::from(u8::from(i == j)))).collect();
        SystemDescription {
            kind: if h.is_some() { SystemKind::Discrete } else { SystemKind::Continuous },
            step: h,
            states: (0..n).map(named).collect(),
            inputs: vec![],
            outputs: self.description.outputs.clone(),
            a: Some(square),
            b: None,
            e: Some((0..n).map(|i| (0..p).map(|j| number(acts(i, j))).collect()).collect()),
            c: Some((0..p).map(seen).collect()),
            d: None,
            f: None,
            delay: BTreeMap::new(),
            parameters: BTreeMap::new(),
            start,
            sets: SetDescriptions { centre: BoxCentre::Free, ..SetDescriptions::default() },
            weights: None,
        }
    }
}

/// Returns the weighted mean of widths over samples and outputs.
fn weighted(widths: &[Vec<f64>], weights: &[f64]) -> f64 {
    let p = weights.len();
    let count: usize = widths.iter().map(Vec::len).sum();
    let all = widths.iter().flat_map(|of| of.iter().enumerate());
    all.map(|(at, width)| width * weights[at % p]).sum::<f64>() / count as f64
}

/// Leaves recordings out of the sets: each in turn, or every second one of many.
fn left_out(rows: &SetRows<'_>, found: &FoundSets, weights: &[f64]) -> Result<RunsLeftOut> {
    let count = rows.motions.deviations.len();
    if count < 2 || !found.is_proved {
        return Ok(RunsLeftOut::default());
    }
    let is_in_turn = count <= MOST_IN_TURN;
    let parts: Vec<Vec<usize>> = match is_in_turn {
        true => (0..count).map(|run| vec![run]).collect(),
        false => vec![(0..count).skip(1).step_by(2).collect()],
    };
    let of_part = |part: &Vec<usize>| {
        let others: Vec<usize> = (0..count).filter(|run| !part.contains(run)).collect();
        let others = match is_in_turn {
            true => others,
            false => (0..count).step_by(2).collect(),
        };
        let sets = rows.smallest(&others, weights)?.sets;
        let needed = |run: &usize| (*run, rows.beside(*run, &sets).0);
        Ok(part.iter().map(needed).collect::<Vec<_>>())
    };
    let needed = parts.par_iter().map(of_part).collect::<Result<Vec<_>>>()?.concat();
    Ok(RunsLeftOut::new(rows.motions, needed, is_in_turn))
}

impl RunsLeftOut {
    /// Sums up the parts of sets that recordings need which were left out.
    fn new(motions: &NominalMotions, needed: Vec<(usize, f64)>, is_in_turn: bool) -> Self {
        let furthest = needed.iter().max_by(|a, b| a.1.total_cmp(&b.1)).copied();
        let (run, factor) = furthest.unwrap_or_default();
        Self {
            runs: needed.len(),
            is_in_turn,
            inside: needed.iter().filter(|(_, needed)| *needed <= INSIDE).count(),
            furthest: Some(motions.deviations[run].run.clone()),
            factor: Some(factor).filter(|factor| factor.is_finite()),
        }
    }
}
