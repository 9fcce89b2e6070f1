//! The deviation d = x_m(t_k) - x̂(t_k) of recordings from the nominal motion of a linear model:
//! what the uncertainty sets must cover.

use reachtube_reach::Trajectory;
use reachtube_scalar::rounding::{sub_down, sub_up};

use crate::data::case::Case;
use crate::data::envelope::Envelope;
use crate::tube::grids::Grids;

/// The envelope of the deviations of one suite from nominal motions that face the same sets.
#[derive(Debug, Clone)]
pub(crate) struct Deviation {
    pub suite: usize,
    /// The sets that they face.
    pub strand: usize,
    /// The deviations; each bound is outer.
    pub envelope: Envelope,
}

/// The nominal motion x̂ of a linear model along a case.
#[derive(Debug, Clone)]
pub(crate) struct Nominal {
    pub grid: usize,
    /// x̂ at the samples, enclosed.
    pub trajectory: Trajectory,
}

impl Nominal {
    /// Solves the linear model along a case.
    ///
    /// # Guarantee
    ///
    /// Outer: the exact solution lies in the trajectory.
    pub(crate) fn new(grids: &Grids, case: &Case) -> Self {
        let grid = grids.find(&case.grid);
        let trajectory =
            grids.as_slice()[grid].propagation.solve(&case.start_interval(), &case.inputs);
        Self { grid, trajectory }
    }
}

impl Deviation {
    /// Computes the deviations of a case from its nominal motion, on the strand of its grid.
    ///
    /// # Guarantee
    ///
    /// Outer: the exact deviation of every run from the exact solution of the model lies in the
    /// envelope.
    pub(crate) fn new(case: &Case, Nominal { grid, trajectory }: &Nominal) -> Self {
        let envelope = case.measured.map(
            |k, i, upper| sub_up(upper, trajectory.state(k)[i].lo()),
            |k, i, lower| sub_down(lower, trajectory.state(k)[i].hi()),
        );
        Self { suite: case.suite, strand: *grid, envelope }
    }

    pub(crate) fn lost_after(self, last: usize) -> Self {
        let (infinity, known) = (f64::INFINITY, |k: usize| k <= last);
        let envelope = self.envelope.map(
            |k, _, upper| if known(k) { upper } else { infinity },
            |k, _, lower| if known(k) { lower } else { -infinity },
        );
        Self { envelope, ..self }
    }

    /// Merges the deviations of one suite that face the same set, whether or not they share their
    /// nominal motion.
    pub(crate) fn merge(parts: impl IntoIterator<Item = Self>) -> Vec<Self> {
        let mut merged: Vec<Self> = Vec::new();
        for part in parts {
            let key = (part.suite, part.strand);
            match merged.iter_mut().find(|known| (known.suite, known.strand) == key) {
                Some(known) => known.envelope.merge(&part.envelope),
                None => merged.push(part),
            }
        }
        merged
    }
}
