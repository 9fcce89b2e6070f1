//! How large X0 and V may be.

use crate::data::problem::Problem;
use crate::data::settings::{InitialLimit, Noise, NominalStart};
use crate::program::layout::Limits;

/// The least limit of a set, rad or rad/s, which is as good as 0. The program keeps room between
/// its bounds.
const LEAST_LIMIT: f64 = 1e-9;

/// The part by which X0 may reach beyond the recorded starts that limit it, so that the program has
/// an interior.
const START_ROOM: f64 = 1e-6;

impl Problem {
    /// Returns what is limited: a V that is fitted, by the sensor noise; X0, by that noise where
    /// each run starts at its own measured state, and by the recorded starts where the settings say
    /// so.
    pub(crate) fn limits(&self) -> Limits {
        let radii = || self.read.sensor_noise.radius.iter().map(|r| r.max(LEAST_LIMIT)).collect();
        let settings = self.settings();
        let limited = match settings.initial_limit {
            InitialLimit::None => 0,
            InitialLimit::Positions => self.inputs(),
            InitialLimit::States => self.states(),
        };
        let starts = self.farthest_starts();
        let of_starts = |i: usize| match i < limited {
            // The program keeps room inside its limits.
            true => starts[i] * (1.0 + START_ROOM) + LEAST_LIMIT,
            false => f64::INFINITY,
        };
        Limits {
            noise: (settings.noise == Noise::Fitted).then(radii),
            start: match settings.nominal.is_measured() {
                true => Some(radii()),
                false => (limited > 0).then(|| (0..starts.len()).map(of_starts).collect()),
            },
        }
    }

    /// Returns how far the first states of the recordings lie from their nominal start at most, 2n.
    pub(crate) fn farthest_starts(&self) -> Vec<f64> {
        let mut farthest = vec![0.0_f64; self.states()];
        let is_past = self.settings().nominal == NominalStart::Past;
        for suite in &self.read.recordings.suites {
            for run in suite.runs.iter().filter(|_| is_past) {
                let starts = run.start.iter().zip(&run.told_start);
                for (far, (start, known)) in farthest.iter_mut().zip(starts) {
                    *far = far.max((start - known).abs());
                }
            }
            let bounds = suite.totals.start_bounds.iter().zip(&suite.nominal_start);
            for (far, (bounds, nominal)) in farthest.iter_mut().zip(bounds) {
                // Rounding keeps the order, so that no run lies further than one of the bounds.
                *far = bounds.iter().map(|x| (x - nominal).abs()).fold(*far, f64::max);
            }
        }
        farthest
    }
}
