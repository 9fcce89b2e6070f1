//! Whether the bounds for the next motion hold, over many virtual campaigns of motions.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use rayon::prelude::*;
use reachtube_conform::next_motion::CONFIDENCE;
use reachtube_conform::{Check, Model, Problem, Silent, Tube, Verdict, conform};
use reachtube_recordings::MemoryRuns;
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::Serialize;

use super::chosen_model::{self, Choice};
use super::virtual_motions::{problem, truth, virtual_motions};
use crate::error::{Error, Result};
use crate::random::{SeedableRng, SplitMix64};
use crate::virtual_robot::{VirtualRobot, VirtualRobotParameters};

/// Motions that every campaign records, as many as the paper's.
const MOTIONS: usize = 38;

/// Number of these motions that are held out for the hold-out bound.
const HELD_OUT: usize = 15;

/// Motions of them that calibrate the sets of the others.
const CALIBRATING: usize = 19;

/// The virtual campaigns.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CoverageOptions {
    /// Number of campaigns.
    pub campaigns: usize,
    /// Number of further motions over which the true probability of a violation is measured, the
    /// same for all campaigns.
    pub next: usize,
    /// Seed of the motions.
    pub seed: u64,
}

impl Default for CoverageOptions {
    fn default() -> Self {
        Self { campaigns: 200, next: 2000, seed: 1 }
    }
}

/// How often one statement about the next motion was wrong.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CoverageRow {
    /// The statement.
    pub statement: String,
    /// The mean of the probabilities that it gave.
    pub mean_bound: f64,
    /// The mean of the true probabilities that the next motion leaves the sets.
    pub mean_truth: f64,
    /// How often it may be wrong: the part of the campaigns, or, of a bound on average, the mean of
    /// the true probabilities.
    pub nominal: f64,
    /// How often it was.
    pub observed: f64,
    /// Standard error of `observed`.
    pub standard_error: f64,
    /// The bound 1/(n + 1) that would have been stated if the model had been fixed beforehand, for
    /// models that were chosen otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub if_fixed: Option<f64>,
    /// The probability that each campaign stated, and the true one.
    pub campaigns: Vec<(f64, f64)>,
}

impl CoverageRow {
    /// Returns whether the statement is about each campaign, at confidence, and not about their
    /// mean.
    pub(crate) fn is_at_confidence(&self) -> bool {
        self.statement.contains("confidence")
    }

    /// Returns whether the statement was wrong no more often than it may be, within three standard
    /// errors.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.observed <= self.nominal + 3.0 * self.standard_error
    }
}

/// Nominal and observed rates of each bound.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Coverage {
    /// The options of the campaigns.
    pub options: CoverageOptions,
    /// Number of motions of each campaign.
    pub motions: usize,
    /// Number of these motions that are held out for the hold-out bound.
    pub held_out: usize,
    /// Number of them that calibrate the sets of the others.
    pub calibrating: usize,
    /// Number of motions that calibrate models which were chosen in several ways.
    pub chosen_by: usize,
    /// One row for each statement.
    pub rows: Vec<CoverageRow>,
}

/// What one campaign states: bound and truth of the scenario, the hold-out and the calibration
/// bound at confidence, and the calibration bound on average.
type Stated = [(f64, f64); 4];

/// What a campaign states, and what it states of models chosen in several ways: bound and truth.
type Campaign = (Stated, Vec<(f64, f64)>);

/// Makes small campaigns of random motions of the virtual robot, finds sets for each, and compares
/// what is stated of the next motion with how often further motions leave the sets. The motions are
/// drawn independently from one distribution, so the assumptions of the bounds hold. The last three
/// rows are the exception: these models were not fixed before a look at the motions that calibrate
/// them, and the bound is withdrawn.
///
/// # Errors
///
/// Fails with [`Error::NoCampaigns`] if there are none, and as
/// [`conform`](reachtube_conform::conform).
///
/// # Examples
///
/// ```no_run
/// use reachtube_lab::reproduce::{CoverageOptions, coverage};
///
/// let few = CoverageOptions { campaigns: 1, next: 5, seed: 1 };
/// let coverage = coverage(&few, &|_done, _total| ())?;
/// assert_eq!(coverage.rows.len(), 8);
/// # Ok::<(), reachtube_lab::Error>(())
/// ```
pub fn coverage(
    options: &CoverageOptions,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Coverage> {
    let total = options.campaigns;
    if total == 0 || options.next == 0 {
        return Err(Error::NoCampaigns);
    }
    let robot = VirtualRobot::new(&Robot::lwa4p(), VirtualRobotParameters::default())?;
    let mut random = SplitMix64::seed_from_u64(options.seed);
    let next = problem(virtual_motions(&robot, options.next, &mut random)?, 0..options.next, 0)?;
    let done = AtomicUsize::new(0);
    let campaign = |index: usize| {
        let mut random = SplitMix64::seed_from_u64(options.seed ^ ((index as u64 + 1) << 20));
        let motions = virtual_motions(&robot, MOTIONS, &mut random)?;
        let stated = campaign(&motions, &next)?;
        let chosen = Choice::ALL.map(|choice| choice.campaign(&motions, &next, &mut random));
        let stated = (stated, chosen.into_iter().collect::<Result<Vec<_>>>()?);
        progress(done.fetch_add(1, Relaxed) + 1, total);
        Ok(stated)
    };
    let stated: Vec<Campaign> =
        (0..total).into_par_iter().map(campaign).collect::<Result<Vec<_>>>()?;
    let names = ["scenario bound", "hold-out bound", "calibration bound"];
    let of = |kind: usize| stated.iter().map(|(stated, _)| stated[kind]).collect::<Vec<_>>();
    let mut rows: Vec<CoverageRow> =
        (0..3).map(|kind| at_confidence(names[kind], of(kind))).collect();
    rows.push(on_average("calibration bound 1/(n + 1), on average".into(), of(3)));
    for (index, choice) in Choice::ALL.into_iter().enumerate() {
        let campaigns = stated.iter().map(|(_, chosen)| chosen[index]).collect();
        let row =
            on_average(format!("calibration bound on average, {}", choice.words()), campaigns);
        let if_fixed =
            (choice != Choice::Beforehand).then_some(1.0 / (chosen_model::HELD_OUT as f64 + 1.0));
        rows.push(CoverageRow { if_fixed, ..row });
    }
    Ok(Coverage {
        options: options.clone(),
        motions: MOTIONS,
        held_out: HELD_OUT,
        calibrating: CALIBRATING,
        chosen_by: chosen_model::HELD_OUT,
        rows,
    })
}

/// Finds sets for the motions of one campaign in three ways, and measures what is stated of them.
fn campaign(motions: &MemoryRuns, next: &Problem) -> Result<Stated> {
    let read = |motions_used: Range<usize>, calibrating: usize| {
        problem(motions.clone(), motions_used, calibrating)
    };
    // The scenario bound, of sets for all motions.
    let all = conform(&read(0..MOTIONS, 0)?, &Silent, None)?;
    let scenario = (all.trust.violation_probability, truth(next, &all.tube)?);
    // The hold-out bound, of sets for some, by the others.
    let fit = read(HELD_OUT..MOTIONS, 0)?;
    let found = conform(&fit, &Silent, None)?;
    let others = read(0..HELD_OUT, 0)?;
    let tube = Tube::new(&others, found.sets.clone())?;
    let verdict = Verdict::new(&others, &tube)?;
    let check = Check::new(&Model::new(&fit, &found), &others, verdict);
    let hold_out = check.trust.map_or(1.0, |trust| trust.violation_probability);
    let hold_out = (hold_out, truth(next, &found.tube)?);
    // The calibration bounds, of sets for some that are scaled to hold the others.
    let found = conform(&read(0..MOTIONS, CALIBRATING)?, &Silent, None)?;
    let truth = truth(next, &found.tube)?;
    let average = found.trust.average_probability.unwrap_or(1.0);
    Ok([scenario, hold_out, (found.trust.violation_probability, truth), (average, truth)])
}

fn at_confidence(name: &str, campaigns: Vec<(f64, f64)>) -> CoverageRow {
    let nominal = 1.0 - CONFIDENCE;
    let count = campaigns.len() as f64;
    let stated = campaigns.iter().copied();
    CoverageRow {
        statement: format!("{name}, at confidence {:.0} %", 100.0 * CONFIDENCE),
        mean_bound: stated.clone().map(|(bound, _)| bound).sum::<f64>() / count,
        mean_truth: stated.clone().map(|(_, truth)| truth).sum::<f64>() / count,
        nominal,
        observed: stated.filter(|(bound, truth)| truth > bound).count() as f64 / count,
        standard_error: (nominal * (1.0 - nominal) / count).sqrt(),
        if_fixed: None,
        campaigns,
    }
}

/// Compares the mean of the truths with a bound that holds on average.
fn on_average(statement: String, campaigns: Vec<(f64, f64)>) -> CoverageRow {
    let count = campaigns.len() as f64;
    let stated = campaigns.iter().copied();
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / count;
    let bound = mean(&mut stated.clone().map(|(bound, _)| bound));
    let truth = mean(&mut stated.clone().map(|(_, truth)| truth));
    let variance = mean(&mut stated.map(|(_, value)| (value - truth) * (value - truth)));
    CoverageRow {
        statement,
        mean_bound: bound,
        mean_truth: truth,
        nominal: bound,
        observed: truth,
        standard_error: (variance / count).sqrt(),
        if_fixed: None,
        campaigns,
    }
}
