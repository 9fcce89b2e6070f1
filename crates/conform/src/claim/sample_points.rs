//! The recorded points, sample by sample: the deviations of all runs from the nominal motions of
//! a linear model, their states for any other.

use reachtube_recordings::Run;
use reachtube_scalar::Interval;

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::tube::deviation::Nominal;
use crate::tube::judged::At;

/// The points of runs at one sample of one strand: a grid of a linear model, a case of any other.
#[derive(Debug, Clone, Default)]
pub(crate) struct SamplePoints {
    pub strand: usize,
    pub sample: usize,
    /// The deviations d = x_m(t_k) - x̂(t_k), rounded, or the states x_m(t_k), points x 2n.
    pub values: Vec<f64>,
    /// How far each value may be from the exact one, points x 2n, rounded up.
    pub errors: Vec<f32>,
    /// The number of states, 2n.
    pub states: usize,
    /// The suite, and the run (index in the source), of each point.
    pub owners: Vec<(u32, u32)>,
}

impl SamplePoints {
    /// Iterates over the points, 2n entries each.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.states.max(1))
    }

    pub(crate) fn place(&self) -> At {
        (self.strand as u32, self.sample as u32)
    }

    pub(crate) fn point(&self, index: usize) -> &[f64] {
        &self.values[index * self.states..][..self.states]
    }

    /// Returns how far the value in state `state` of a point may be from the exact one.
    pub(crate) fn error(&self, index: usize, state: usize) -> f64 {
        f64::from(self.errors[index * self.states + state])
    }

    /// Returns the point with the largest lᵀ d, and that value.
    pub(crate) fn furthest(&self, direction: &[f64]) -> (usize, f64) {
        let along = |d: &[f64]| d.iter().zip(direction).map(|(d, l)| d * l).sum::<f64>();
        let points = self.iter().map(along).enumerate();
        points.fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best })
    }
}

/// Collects the points of a problem, from the second sample of each strand on: at the first one the
/// set is a box, and its hull is the set itself. The points of all runs stay in memory, 24 n bytes
/// each.
///
/// # Guarantee
///
/// Outer: the exact deviation from the nominal motion of a linear model lies within `errors` of
/// its point. Recorded states are exact.
pub(crate) fn points(problem: &Problem) -> Result<Vec<SamplePoints>> {
    match problem.dynamics().linear_system() {
        Some(_) => deviations(problem),
        None => states(problem),
    }
}

fn states(problem: &Problem) -> Result<Vec<SamplePoints>> {
    let cases = problem.cases()?;
    let lengths = cases.iter().map(|case| case.grid.len());
    let mut all = AllPoints::empty(lengths, problem.states());
    for (strand, case) in cases.iter().enumerate() {
        let suite = &problem.recordings().suites[case.suite];
        let is_own = |index: usize| case.run.is_none_or(|run| run == index);
        for summary in suite.runs.iter().filter(|summary| is_own(summary.index)) {
            let (owner, run) =
                ((case.suite as u32, summary.index as u32), problem.run(summary.index)?);
            for at in all.0[strand].iter_mut().take(run.len().saturating_sub(1)) {
                at.values.extend(run.state(at.sample));
                at.errors.extend(run.state(at.sample).iter().map(|_| 0.0));
                at.owners.push(owner);
            }
        }
    }
    Ok(all.into_samples())
}

/// Collects the deviations of all runs from the nominal motions of a linear model.
fn deviations(problem: &Problem) -> Result<Vec<SamplePoints>> {
    let grids = problem.grids()?;
    let lengths = grids.as_slice().iter().map(|grid| grid.propagation.grid().len());
    let mut all = AllPoints::empty(lengths, problem.states());
    let of_case = |case: Case| Ok((Nominal::new(grids, &case), case.run));
    for (index, suite) in problem.recordings().suites.iter().enumerate() {
        for (nominal, run) in problem.cases_of(index, of_case)? {
            let is_own = |index: usize| run.is_none_or(|run| run == index);
            for summary in suite.runs.iter().filter(|summary| is_own(summary.index)) {
                let owner = (index as u32, summary.index as u32);
                all.take(owner, &nominal, &*problem.run(summary.index)?);
            }
        }
    }
    Ok(all.into_samples())
}

/// Points by grid and sample.
struct AllPoints(Vec<Vec<SamplePoints>>);

impl AllPoints {
    /// Returns no points, at every sample but the first of strands of these lengths.
    fn empty(lengths: impl Iterator<Item = usize>, states: usize) -> Self {
        let empty = |(strand, samples): (usize, usize)| {
            let at = |sample| SamplePoints { strand, sample, states, ..SamplePoints::default() };
            (1..samples).map(at).collect()
        };
        Self(lengths.enumerate().map(empty).collect())
    }

    /// Takes the points of a run: its suite and index are `owner`.
    fn take(&mut self, owner: (u32, u32), nominal: &Nominal, recorded: &Run) {
        let samples = self.0[nominal.grid].iter_mut().take(recorded.len().saturating_sub(1));
        for at in samples {
            at.take(recorded.state(at.sample), nominal.trajectory.state(at.sample));
            at.owners.push(owner);
        }
    }

    fn into_samples(self) -> Vec<SamplePoints> {
        self.0.into_iter().flatten().filter(|at| !at.owners.is_empty()).collect()
    }
}

impl SamplePoints {
    fn take(&mut self, measured: &[f64], nominal: &[Interval]) {
        for (x, nominal) in measured.iter().zip(nominal) {
            let exact = Interval::point(*x) - *nominal;
            self.values.push(exact.mid());
            self.errors.push((exact.rad() as f32).next_up());
        }
    }
}
