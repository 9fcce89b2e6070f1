//! `reachtube reproduce coverage`: how often the bounds for the next motion are wrong.

use clap::Args;
use reachtube::reproduce::{Coverage, CoverageOptions, CoverageRow, coverage};

use crate::error::Result;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::untitled;

const HELP: &str = "\
Example:
  reachtube reproduce coverage --campaigns 200 --seed 1

Exit codes: 0 every bound holds within three standard errors, 1 one does not, 2 error.";

/// Simulate how often the bounds for the next motion are wrong
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Number of campaigns
    #[arg(long, default_value_t = 200, value_name = "COUNT")]
    pub campaigns: usize,
    /// Number of further motions that measure the truth
    #[arg(long, default_value_t = 2000, value_name = "COUNT")]
    pub next: usize,
    /// Seed of the motions
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// Runs `reproduce coverage`.
pub(super) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let bar = Progress::of("simulating");
    let options = CoverageOptions { campaigns: args.campaigns, next: args.next, seed: args.seed };
    let coverage = coverage(&options, &|done, total| bar.show(done, total))?;
    drop(bar);
    output::show(json, &coverage, || summary(&coverage))?;
    Ok(Outcome::of(coverage.rows.iter().all(CoverageRow::holds)))
}

/// Returns how often each bound was wrong, beside how often it may be.
fn summary(coverage: &Coverage) -> String {
    let Coverage { options, motions, held_out, calibrating, chosen_by, .. } = coverage;
    format!(
        "{} campaigns of {motions} random motions (seed {}); the hold-out bound is for sets found \
         on {} of them, by the other {held_out}; the calibration bounds are for sets found on {}, \
         scaled to hold the other {calibrating}; models that were chosen in several ways are \
         calibrated by {chosen_by} motions; the truth is the part of {} further motions that leave \
         the sets\n\n{}",
        options.campaigns,
        options.seed,
        motions - held_out,
        motions - calibrating,
        options.next,
        untitled(&coverage.table())
    )
}
