//! The noise of the sensors, which limits V and, where each run has its own nominal start, X0.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::recordings::Recordings;
use crate::data::suite::Suite;

/// Standard deviations within which noise is taken to lie: of two million normal samples, one is
/// expected outside.
const DEVIATIONS: f64 = 5.0;

/// The noise of the sensors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SensorNoise {
    /// Its radius in each state, 2n, rad and rad/s.
    pub radius: Vec<f64>,
    /// Whether it was estimated from the recordings: 5 standard deviations of what they hold at the
    /// highest frequencies, and of what velocities contradict positions by; the median over the
    /// runs, of which 256 of each suite count. Otherwise it was given.
    pub estimated: bool,
}

impl SensorNoise {
    pub(crate) fn given(radius: Vec<f64>) -> Self {
        Self { radius, estimated: false }
    }

    /// Estimates the noise from recordings of `parts` parts. Runs of fewer than 20 samples do not
    /// count; without any other the radii are 0.
    pub(crate) fn estimate(recordings: &Recordings, parts: usize) -> Self {
        let runs = recordings.suites.iter().flat_map(Suite::sample);
        let of_runs: Vec<&Vec<f64>> = runs.filter_map(|run| run.noise.as_ref()).collect();
        let median = |i: usize| {
            let mut deviations: Vec<f64> = of_runs.iter().map(|noise| noise[i]).collect();
            deviations.sort_by(f64::total_cmp);
            deviations.get(deviations.len() / 2).copied().unwrap_or(0.0)
        };
        let radius = (0..2 * parts).map(|i| DEVIATIONS * median(i)).collect();
        Self { radius, estimated: true }
    }
}
