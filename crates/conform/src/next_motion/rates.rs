use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use serde::Serialize;

use crate::claim::verdict::Verdict;
use crate::data::recordings::Recordings;
use crate::next_motion::motions::Motions;
use crate::next_motion::trust::{CONFIDENCE, TrustKind};

/// Number of times that the motions are drawn anew.
const RESAMPLES: usize = 10_000;

/// Seed of the draws, so that the same recordings have the same intervals.
const SEED: u64 = 1;

/// With fewer motions the draws are so few that an interval means nothing.
pub(crate) const FEWEST_MOTIONS: usize = 4;

/// Rates at which held-out recordings leave the sets. A description of these recordings with the
/// spread over their motions, and no guarantee for others.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rates {
    /// Number of motions.
    pub motions: usize,
    /// Rows (suite, sample, state).
    pub rows: Rate,
    /// Suites (windows of a log) with at least one row outside.
    pub suites: Rate,
    /// Level of the intervals.
    pub level: f64,
    /// Number of bootstrap samples for the intervals.
    pub resamples: usize,
    /// How far the rates carry: a description.
    pub kind: TrustKind,
}

/// A rate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rate {
    /// How many lie outside.
    pub outside: usize,
    /// Number of all.
    pub of: usize,
    /// Percentiles of the rate when whole motions are drawn with replacement (cluster bootstrap):
    /// rows of one motion are no independent draws. Nothing with fewer than four motions, or where
    /// nothing or everything lies outside.
    pub interval: Option<[f64; 2]>,
}

/// What of one motion lies outside: rows, all rows, suites, all suites.
#[derive(Debug, Clone, Copy, Default)]
struct Counts([usize; 4]);

impl Rates {
    /// Counts what lies outside by motion.
    pub(crate) fn new(recordings: &Recordings, verdict: &Verdict) -> Self {
        let motions = Motions::new(recordings);
        let names = motions.distinct();
        let mut counts = vec![Counts::default(); names.len()];
        for (index, suite) in verdict.suites.iter().enumerate() {
            let own = names.iter().position(|name| *name == motions.of_suite(index));
            let outside = suite.violations.count;
            let suite = [outside, suite.rows, usize::from(outside > 0), 1];
            if let Some(Counts(own)) = own.map(|own| &mut counts[own]) {
                own.iter_mut().zip(suite).for_each(|(sum, count)| *sum += count);
            }
        }
        let [rows, suites] = rates(&counts);
        Self {
            motions: names.len(),
            rows,
            suites,
            level: CONFIDENCE,
            resamples: RESAMPLES,
            kind: TrustKind::Description,
        }
    }
}

/// Returns the rates of rows and of suites, with intervals that count motions.
fn rates(counts: &[Counts]) -> [Rate; 2] {
    let total = sum(counts.iter());
    let mut random = SplitMix64::seed_from_u64(SEED);
    let mut draw = || {
        let any = |_: &Counts| &counts[(random.next_u64() % counts.len() as u64) as usize];
        sum(counts.iter().map(any).collect::<Vec<_>>().into_iter())
    };
    let enough = counts.len() >= FEWEST_MOTIONS;
    let drawn: Vec<Counts> = (0..if enough { RESAMPLES } else { 0 }).map(|_| draw()).collect();
    [0, 2].map(|first| {
        let (outside, of) = (total.0[first], total.0[first + 1]);
        let part = |counts: &Counts| counts.0[first] as f64 / counts.0[first + 1].max(1) as f64;
        let mut parts: Vec<f64> = drawn.iter().map(part).collect();
        parts.sort_by(f64::total_cmp);
        let tail = 0.5 * (1.0 - CONFIDENCE);
        let at = |quantile: f64| parts[(quantile * (parts.len() - 1) as f64).round() as usize];
        let has_spread = enough && outside > 0 && outside < of;
        Rate { outside, of, interval: has_spread.then(|| [at(tail), at(1.0 - tail)]) }
    })
}

fn sum<'c>(counts: impl Iterator<Item = &'c Counts>) -> Counts {
    counts.fold(Counts::default(), |sum, counts| {
        Counts(std::array::from_fn(|i| sum.0[i] + counts.0[i]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_count_motions_and_not_rows() {
        // Half of 8 motions outside whole, the others not at all: rows add no information to
        // motions. The binomial of 8 at one half has its 2.5 % and 97.5 % points at 1 and 7.
        let motions = |rows: usize| -> Vec<Counts> {
            (0..8).map(|m| Counts([rows * (m % 2), rows, m % 2, 1])).collect()
        };
        for rows in [1, 1000] {
            let [of_rows, of_suites] = rates(&motions(rows));
            assert_eq!(of_rows.interval, Some([1.0 / 8.0, 7.0 / 8.0]));
            assert_eq!(of_rows.interval, of_suites.interval);
        }
    }

    #[test]
    fn three_motions_and_motions_without_spread_have_no_interval() {
        let [rows, _] = rates(&[Counts([1, 10, 1, 1]); 3]);
        assert_eq!((rows.outside, rows.of, rows.interval), (3, 30, None));
        let [rows, _] = rates(&[Counts([0, 10, 0, 1]); 9]);
        assert_eq!(rows.interval, None);
        let [rows, suites] = rates(&[Counts([1, 10, 1, 1]); 4]);
        assert_eq!((rows.interval, suites.interval), (Some([0.1, 0.1]), None));
    }
}
