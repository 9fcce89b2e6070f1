//! The recorded points of a linear model: the deviations of all runs, sample by sample. And the
//! projections in which points must lie in a set.

use reachtube_scalar::Interval;

use crate::deviation::Nominal;
use crate::error::Result;
use crate::problem::case::Case;
use crate::problem::problem::Problem;
use crate::settings::{Notion, States};

/// The points of all runs at one sample of one grid.
#[derive(Debug, Clone, Default)]
pub(crate) struct SamplePoints {
    /// The grid.
    pub grid: usize,
    /// The sample.
    pub sample: usize,
    /// The deviations d = x_m(t_k) - x̂(t_k), points x 2n, rounded.
    pub values: Vec<f64>,
    /// How far a deviation may be from its rounded value, 2n; the largest over the points.
    pub error: Vec<f64>,
    /// The suite, and the run (index in the source), of each point.
    pub owners: Vec<(u32, u32)>,
}

impl SamplePoints {
    /// Iterates over the points, 2n entries each.
    pub fn iter(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.error.len().max(1))
    }

    /// Returns a point, 2n entries.
    pub fn point(&self, index: usize) -> &[f64] {
        &self.values[index * self.error.len()..][..self.error.len()]
    }

    /// Returns the point with the largest lᵀ d, and that value.
    pub fn furthest(&self, direction: &[f64]) -> (usize, f64) {
        let along = |d: &[f64]| d.iter().zip(direction).map(|(d, l)| d * l).sum::<f64>();
        let points = self.iter().map(along).enumerate();
        points.fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best })
    }
}

/// Returns the states of each projection in which recorded points must lie in the reachable set.
pub(crate) fn projections(notion: Notion, states: States, joints: usize) -> Vec<Vec<usize>> {
    let rows = states.rows(joints);
    match notion {
        Notion::Exact | Notion::Trace => vec![(0..rows).collect()],
        _ if rows == joints => (0..joints).map(|i| vec![i]).collect(),
        _ => (0..joints).map(|i| vec![i, joints + i]).collect(),
    }
}

/// Collects the points of a problem whose model is linear, from the second sample of each grid on:
/// at the first one the set is a box, and its hull is the set itself. The points of all runs stay
/// in memory, 16 n bytes each.
///
/// # Guarantee
///
/// Outer: the exact deviation lies within `error` of its point.
///
/// # Errors
///
/// As [`Problem::grids`] and [`Problem::run`].
pub(crate) fn points(problem: &Problem) -> Result<Vec<SamplePoints>> {
    let (grids, states) = (problem.grids()?, 2 * problem.joints());
    let empty = |(grid, samples): (usize, usize)| {
        (1..samples).map(move |sample| SamplePoints {
            grid,
            sample,
            error: vec![0.0; states],
            ..SamplePoints::default()
        })
    };
    let lengths = grids.as_slice().iter().map(|grid| grid.propagation.grid().len());
    let mut all: Vec<Vec<SamplePoints>> =
        lengths.enumerate().map(|pair| empty(pair).collect()).collect();
    for (index, suite) in problem.recordings().suites.iter().enumerate() {
        let of_case = |case: Case| Ok((Nominal::new(grids, &case), case.run));
        for (nominal, run) in problem.cases_of(index, of_case)? {
            let mine =
                suite.every_run()?.iter().filter(|summary| run.is_none_or(|r| r == summary.index));
            for summary in mine {
                let recorded = problem.run(summary.index)?;
                let samples = all[nominal.grid].iter_mut().take(recorded.len().saturating_sub(1));
                for at in samples {
                    at.take(recorded.state(at.sample), nominal.trajectory.state(at.sample));
                    at.owners.push((index as u32, summary.index as u32));
                }
            }
        }
    }
    let mut all: Vec<SamplePoints> = all.into_iter().flatten().collect();
    all.retain(|at| !at.owners.is_empty());
    Ok(all)
}

impl SamplePoints {
    fn take(&mut self, measured: &[f64], nominal: &[Interval]) {
        for ((x, nominal), error) in measured.iter().zip(nominal).zip(&mut self.error) {
            let exact = Interval::point(*x) - *nominal;
            self.values.push(exact.mid());
            *error = error.max(exact.rad());
        }
    }
}
