use reachtube_finding::Finding;
use reachtube_recordings::Run;

use crate::data::problem::Problem;
use crate::error::Result;
use crate::next_motion::calibration::{Calibration, Gauge};
use crate::result::findings::plausibility::of_held_out;

/// Number of runs that are looked at, at most.
const RUNS: usize = 8;

/// Calibration is named when it scaled the sets by this factor or more.
const LARGE_FACTOR: f64 = 2.0;

/// Returns what most likely makes an answer implausible: what the drive of the model finds in the
/// recordings, or a calibration that scaled the sets by much.
pub(super) fn likely_cause(
    problem: &Problem,
    calibration: Option<&Calibration>,
) -> Result<Option<Finding>> {
    let scaled = calibration.filter(|found| found.factor >= LARGE_FACTOR).map(scaled_by);
    let runs = first_runs(problem)?;
    Ok(problem.setup().drive.cause(runs, problem.settings().method, scaled))
}

fn first_runs(problem: &Problem) -> Result<Vec<Run>> {
    let suites = &problem.recordings().suites;
    let stride = suites.len().div_ceil(RUNS).max(1);
    let firsts = suites.iter().step_by(stride).map(|suite| suite.totals.first);
    firsts.map(|run| Ok(problem.run(run)?.into_owned())).collect()
}

/// Reports which motion that was held out made the sets as large as they are.
fn scaled_by(Calibration { fitted, gauges, factor, .. }: &Calibration) -> Finding {
    let far = |a: &&Gauge, b: &&Gauge| a.gauge.total_cmp(&b.gauge);
    let motion = gauges.iter().max_by(far).map_or("", |gauge| gauge.motion.as_str());
    of_held_out(motion, fitted, *factor)
}
