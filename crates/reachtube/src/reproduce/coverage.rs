//! Whether the bounds for the next motion hold, over many virtual campaigns of motions.

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use rayon::prelude::*;
use reachtube_conform::{
    CONFIDENCE, Check, Hulls, Keep, Model, Problem, Settings, Setup, Silent, Verdict, conform,
};
use reachtube_recordings::{MemoryRuns, Torque};
use reachtube_robot::Robot;
use serde::Serialize;

use super::error::ReproduceError;
use super::random_motions::{random_motions, two_joints};
use crate::error::Result;
use crate::random::{SeedableRng, SplitMix64};

/// Motions that every campaign records: to find sets with, and half of them to calibrate others.
const FITTED: usize = 20;

/// Motions that every campaign keeps back for the hold-out bound.
const HELD_OUT: usize = 15;

/// Motions over which the true probability of a violation is measured, the same for all campaigns.
const NEXT: usize = 2000;

/// The virtual campaigns.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CoverageOptions {
    /// Number of campaigns.
    pub campaigns: usize,
    /// Seed of the motions.
    pub seed: u64,
}

impl Default for CoverageOptions {
    /// Returns 400 campaigns.
    fn default() -> Self {
        Self { campaigns: 400, seed: 1 }
    }
}

/// How often one statement about the next motion was wrong.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
}

impl CoverageRow {
    /// Returns whether the statement was wrong no more often than it may be, within three standard
    /// errors.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.observed <= self.nominal + 3.0 * self.standard_error
    }
}

/// Nominal and observed rates of each bound.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coverage {
    /// The options of the campaigns.
    pub options: CoverageOptions,
    /// Number of motions that sets are found on.
    pub fitted: usize,
    /// Number of motions kept back for the hold-out bound.
    pub held_out: usize,
    /// Number of those found on that calibrate the others' sets instead.
    pub calibrating: usize,
    /// Number of motions that measure the true probabilities.
    pub next: usize,
    /// One row for each statement.
    pub rows: Vec<CoverageRow>,
}

/// What one campaign states: bound and truth of the scenario, the hold-out and the calibration
/// bound at confidence, and the calibration bound on average.
type Stated = [(f64, f64); 4];

/// Makes campaigns of random motions of a virtual arm with two joints, finds sets for each, and
/// compares what is stated of the next motion with how often 2000 others leave the sets. The
/// motions are drawn independently from one distribution, so the assumptions of all bounds hold.
///
/// # Errors
///
/// Fails with [`ReproduceError::NoCampaigns`] where there are none, and as
/// [`conform`](reachtube_conform::conform).
///
/// # Examples
///
/// ```
/// use reachtube::reproduce::{CoverageOptions, coverage};
///
/// let coverage = coverage(&CoverageOptions { campaigns: 2, seed: 1 }, &|_done, _total| ())?;
/// assert_eq!(coverage.rows.len(), 4);
/// # Ok::<(), reachtube::Error>(())
/// ```
pub fn coverage(
    options: &CoverageOptions,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Coverage> {
    let total = options.campaigns;
    if total == 0 {
        return Err(ReproduceError::NoCampaigns.into());
    }
    let robot = two_joints()?;
    let mut random = SplitMix64::seed_from_u64(options.seed);
    let next = problem(&robot, random_motions(&robot, NEXT, &mut random)?, &[], &[])?;
    let done = AtomicUsize::new(0);
    let campaign = |index: usize| {
        let mut random = SplitMix64::seed_from_u64(options.seed ^ ((index as u64 + 1) << 20));
        let motions = random_motions(&robot, FITTED + HELD_OUT, &mut random)?;
        let stated = campaign(&robot, &motions, &next)?;
        progress(done.fetch_add(1, Relaxed) + 1, total);
        Ok(stated)
    };
    let stated: Vec<Stated> =
        (0..total).into_par_iter().map(campaign).collect::<Result<Vec<_>>>()?;
    let names = ["scenario bound", "hold-out bound", "calibration bound"];
    let mut rows: Vec<CoverageRow> = (0..3)
        .map(|kind| at_confidence(names[kind], stated.iter().map(|stated| stated[kind])))
        .collect();
    rows.push(on_average(stated.iter().map(|stated| stated[3])));
    Ok(Coverage {
        options: options.clone(),
        fitted: FITTED,
        held_out: HELD_OUT,
        calibrating: FITTED / 2,
        next: NEXT,
        rows,
    })
}

/// Finds sets for the motions of one campaign, and measures what is stated of them.
fn campaign(robot: &Robot, motions: &MemoryRuns, next: &Problem) -> Result<Stated> {
    let names = |from: usize, to: usize| (from..to).map(|m| format!("M{m}")).collect::<Vec<_>>();
    let read =
        |names: &[String], calibrate: &[String]| problem(robot, motions.clone(), names, calibrate);
    let fitted = names(0, FITTED);
    let fit = read(&fitted, &[])?;
    let found = conform(&fit, &Silent, None)?;
    let truth = truth(next, &found.hulls)?;
    let held_out = read(&names(FITTED, FITTED + HELD_OUT), &[])?;
    let hulls = Hulls::new(&held_out, found.sets.clone())?;
    let verdict = Verdict::new(&held_out, &hulls, |_, _, _| ())?;
    let check = Check::new(&Model::new(&fit, &found), &held_out, verdict);
    let hold_out = check.trust.map_or(1.0, |trust| trust.violation_probability);
    let calibrated = conform(&read(&fitted, &fitted[FITTED / 2..])?, &Silent, None)?;
    let of_calibrated = self::truth(next, &calibrated.hulls)?;
    let average = calibrated.trust.average_probability.unwrap_or(1.0);
    Ok([
        (found.trust.violation_probability, truth),
        (hold_out, truth),
        (calibrated.trust.violation_probability, of_calibrated),
        (average, of_calibrated),
    ])
}

fn problem(
    robot: &Robot,
    motions: MemoryRuns,
    names: &[String],
    calibrate: &[String],
) -> Result<Problem> {
    let calibrate = calibrate.to_vec();
    let settings = Settings { calibrate, ..Settings::new(Torque::Compensated, 2) };
    let setup = Setup::new(robot.clone(), settings)?;
    Ok(Problem::read(setup, Box::new(motions), names, Keep::Needed, &Silent)?)
}

/// Returns the part of the next motions that leave the sets.
fn truth(next: &Problem, hulls: &Hulls) -> Result<f64> {
    let hulls = Hulls::new(next, hulls.sets.clone())?;
    let verdict = Verdict::new(next, &hulls, |_, _, _| ())?;
    let leaving = verdict.suites.iter().filter(|suite| !suite.holds()).count();
    Ok(leaving as f64 / verdict.suites.len() as f64)
}

/// Counts the campaigns whose truth is above the bound.
fn at_confidence(name: &str, stated: impl Iterator<Item = (f64, f64)> + Clone) -> CoverageRow {
    let nominal = 1.0 - CONFIDENCE;
    let count = stated.clone().count() as f64;
    CoverageRow {
        statement: format!("{name}, at confidence {:.0} %", 100.0 * CONFIDENCE),
        mean_bound: stated.clone().map(|(bound, _)| bound).sum::<f64>() / count,
        mean_truth: stated.clone().map(|(_, truth)| truth).sum::<f64>() / count,
        nominal,
        observed: stated.filter(|(bound, truth)| truth > bound).count() as f64 / count,
        standard_error: (nominal * (1.0 - nominal) / count).sqrt(),
    }
}

/// Compares the mean of the truths with a bound that holds on average.
fn on_average(stated: impl Iterator<Item = (f64, f64)> + Clone) -> CoverageRow {
    let count = stated.clone().count() as f64;
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / count;
    let bound = mean(&mut stated.clone().map(|(bound, _)| bound));
    let truth = mean(&mut stated.clone().map(|(_, truth)| truth));
    let variance = mean(&mut stated.map(|(_, value)| (value - truth) * (value - truth)));
    CoverageRow {
        statement: "calibration bound 1/(n + 1), on average".into(),
        mean_bound: bound,
        mean_truth: truth,
        nominal: bound,
        observed: truth,
        standard_error: (variance / count).sqrt(),
    }
}
