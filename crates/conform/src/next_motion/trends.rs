use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::problem::Problem;
use crate::data::suite::Suite;
use crate::data::summary::RunSummary;

/// The least rank correlation that is called a trend.
const LEAST_CORRELATION: f64 = 0.7;

/// Standard deviations of the rank correlation of unrelated numbers, 1/√(runs - 1), that a trend
/// must exceed: one part in a hundred does by chance.
const DEVIATIONS: f64 = 2.6;

/// A part whose motion follows the order of the runs of a suite: the robot changed while it was
/// recorded, for example by warming up.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trend {
    /// The suite.
    pub suite: String,
    /// Number of its runs that were compared: all, or 256 of more.
    pub runs: usize,
    /// The part, from 1.
    pub part: usize,
    /// Spearman's rank correlation of the part's last position with the order of the runs.
    pub correlation: f64,
    /// The largest difference of these positions, rad or m.
    pub range: f64,
}

/// Returns the trends of all suites whose runs share their input. Positions are compared at the
/// last sample that was kept of all runs of a suite; the order is the index's.
pub(crate) fn trends(problem: &Problem) -> Vec<Trend> {
    let suites = problem.recordings().suites.iter().filter(|suite| suite.shared.is_some());
    suites.flat_map(|suite| of_suite(suite, problem.inputs())).collect()
}

fn of_suite(suite: &Suite, parts: usize) -> Vec<Trend> {
    let mut runs: Vec<&RunSummary> = suite.sample().collect();
    runs.sort_by_key(|run| run.condition.place);
    let count = runs.len();
    let stride = runs.iter().map(|run| run.marks.stride).max().unwrap_or(1);
    let last = runs.iter().map(|run| run.marks.last(stride)).min().unwrap_or(0);
    if last == 0 || count < 2 {
        return Vec::new();
    }
    let least = LEAST_CORRELATION.max(DEVIATIONS / ((count - 1) as f64).sqrt());
    let of_part = |part: usize| {
        let position = |run: &&RunSummary| run.marks.state(last)[part];
        let positions: Vec<f64> = runs.iter().map(position).collect();
        let correlation = rank_correlation(&positions);
        let extreme = |pick: fn(f64, f64) -> f64| positions.iter().copied().reduce(pick);
        let range = extreme(f64::max).unwrap_or(0.0) - extreme(f64::min).unwrap_or(0.0);
        (correlation.abs() >= least).then(|| Trend {
            suite: suite.entry.name.clone(),
            runs: count,
            part: part + 1,
            correlation,
            range,
        })
    };
    (0..parts).filter_map(of_part).collect()
}

/// Returns Spearman's correlation of values with their order; 0 if they are all the same.
fn rank_correlation(values: &[f64]) -> f64 {
    // Equal values share the mean of their ranks.
    let rank = |value: &f64| {
        let (below, same) = values.iter().fold((0.0, 0.0), |(below, same), other| {
            (below + f64::from(other < value), same + f64::from(other == value))
        });
        below + 0.5 * (same - 1.0)
    };
    let middle = 0.5 * (values.len() as f64 - 1.0);
    let (mut both, mut ranks, mut orders) = (0.0, 0.0, 0.0);
    for (order, value) in values.iter().enumerate() {
        let (rank, order) = (rank(value) - middle, order as f64 - middle);
        (both, ranks, orders) = (both + rank * order, ranks + rank * rank, orders + order * order);
    }
    if ranks > 0.0 { both / (ranks * orders).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::rank_correlation;

    #[test]
    fn ranks_not_sizes_decide_and_ties_share_theirs() {
        assert_eq!(rank_correlation(&[1.0, 2.0, 30.0, 31.0]), 1.0);
        assert_eq!(rank_correlation(&[4.0, 3.0, -2.0]), -1.0);
        assert_eq!(rank_correlation(&[1.0, 1.0, 1.0]), 0.0);
        // By hand: ranks 0.5, 0.5, 2 against 0, 1, 2 give 1.5 / √(1.5 · 2).
        assert!((rank_correlation(&[1.0, 1.0, 2.0]) - 0.75f64.sqrt()).abs() < 1e-15);
    }
}
