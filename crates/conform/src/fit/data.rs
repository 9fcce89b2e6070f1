//! The recordings as a fit needs them: cases with their recorded inputs.

use std::sync::Arc;

use reachtube_reach::TimeGrid;

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::error::{Error, Result};

/// While parameters are moved, samples are thinned to about this number, of all cases together.
const MOST_SAMPLES: usize = 6_000;

/// Why warm-up cannot be fitted to some folds.
const NOT_KEPT: &str = "a fit of warm-up needs each recording, which a fold of recordings that \
    share their input has not kept; fit without warm-up, or read the recordings on one machine";

/// Why warm-up cannot be fitted to recordings of a robot that is always as warm.
pub(crate) const EQUALLY_WARM: &str = "a fit of warm-up needs a robot that warms up between \
    recordings, but every recording is the first of its suite; give the column order in \
    runs.csv, or the columns temp1 to tempn, or fit without warm-up";

/// The recordings of a problem.
pub(crate) struct Data {
    /// The distinct sample grids, the longest first; a grid that is the beginning of another is not
    /// distinct.
    pub grids: Vec<Arc<TimeGrid>>,
    pub tracks: Vec<Track>,
    pub motions: Vec<String>,
}

/// A case with its recorded inputs.
pub(crate) struct Track {
    pub case: Case,
    pub grid: usize,
    pub motion: usize,
}

impl Track {
    pub(crate) fn samples(&self, stride: usize) -> impl Iterator<Item = usize> + use<> {
        (0..self.case.measured.len()).step_by(stride)
    }
}

impl Data {
    /// Returns every how many samples rows are taken while parameters are moved.
    pub(crate) fn stride(&self) -> usize {
        let samples: usize = self.tracks.iter().map(|track| track.case.measured.len()).sum();
        samples.div_ceil(MOST_SAMPLES).max(1)
    }

    /// Returns the mean temperature of each part over the cases, n, °C; `None` if it is not known
    /// for all of them.
    pub(crate) fn mean_temperatures(&self) -> Option<Vec<f64>> {
        let of_track = |track: &Track| track.case.condition.temperatures.clone();
        let all = self.tracks.iter().map(of_track).collect::<Option<Vec<_>>>()?;
        let mean = |part: usize| all.iter().map(|own| own[part]).sum::<f64>() / all.len() as f64;
        Some((0..all.first()?.len()).map(mean).collect())
    }

    /// Returns whether every case is the first run of its suite, and no temperature is known.
    pub(crate) fn are_equally_warm(&self) -> bool {
        let mut conditions = self.tracks.iter().map(|track| &track.case.condition);
        self.mean_temperatures().is_none() && conditions.all(|condition| condition.place == 1)
    }

    /// Takes the cases of a problem; each run is a case when `by_run`.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] where a fold has not kept runs that are needed; as [`Problem::run`].
    pub(crate) fn new(problem: &Problem, by_run: bool) -> Result<Self> {
        let (mut cases, mut motions, mut motion_of) = (Vec::new(), Vec::<String>::new(), vec![]);
        for (index, suite) in problem.recordings().suites.iter().enumerate() {
            let name = suite.entry.motion.as_ref().unwrap_or(&suite.entry.name);
            let motion = motions.iter().position(|known| known == name).unwrap_or_else(|| {
                motions.push(name.clone());
                motions.len() - 1
            });
            let of_suite = problem.recorded_cases_of(suite, index, by_run, Ok);
            let of_suite = of_suite.map_err(|error| match error {
                Error::Fold(_) if by_run => Error::Fold(NOT_KEPT.into()),
                other => other,
            })?;
            motion_of.extend(of_suite.iter().map(|_| motion));
            cases.extend(of_suite);
        }
        let mut sorted: Vec<Arc<TimeGrid>> =
            cases.iter().map(|case| Arc::clone(&case.grid)).collect();
        sorted.sort_by_key(|grid| std::cmp::Reverse(grid.len()));
        let mut grids: Vec<Arc<TimeGrid>> = Vec::new();
        for grid in sorted {
            if !grids.iter().any(|longer| grid.is_prefix_of(longer)) {
                grids.push(grid);
            }
        }
        let track = |(case, motion): (Case, usize)| {
            let grid = grids.iter().position(|grid| case.grid.is_prefix_of(grid));
            Track { grid: grid.expect("every grid is in the list"), case, motion }
        };
        let tracks = cases.into_iter().zip(motion_of).map(track).collect();
        Ok(Self { tracks, grids, motions })
    }
}
