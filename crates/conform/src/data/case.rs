use std::sync::Arc;

use reachtube_reach::{IntervalVector, TimeGrid};

use crate::data::condition::Condition;
use crate::data::envelope::Envelope;

/// A case: what one reachable set is computed for. It is a suite whose runs share their input and
/// nominal start, or one run that has its own.
#[derive(Debug, Clone)]
pub struct Case {
    /// The suite, and the run where it is a case of its own, for people.
    pub name: String,
    /// Index of the suite in [`Recordings::suites`](crate::Recordings::suites).
    pub suite: usize,
    /// The run (index in the source) where it is a case of its own.
    pub run: Option<usize>,
    /// The sample times.
    pub grid: Arc<TimeGrid>,
    /// The input u, row-major, samples x n, N m: the recorded one, less the correction of the model
    /// if it has one. It is by definition what it is in double precision.
    pub inputs: Arc<[f64]>,
    /// The nominal initial state, 2n: the suite's, or the run's own first state. It defines the
    /// nominal motion exactly as it is in double precision.
    pub start: Vec<f64>,
    /// The measured states.
    pub measured: Arc<Envelope>,
    /// The conditions that friction may depend on.
    pub condition: Condition,
}

impl Case {
    pub(crate) fn states(&self) -> usize {
        self.start.len()
    }

    /// Returns the number of parts n, of two states and an input each.
    #[must_use]
    pub fn parts(&self) -> usize {
        self.start.len() / 2
    }

    /// Returns the nominal initial state as intervals without width, 2n. Exact.
    pub(crate) fn start_interval(&self) -> IntervalVector {
        IntervalVector::from_iterator(self.start.len(), self.start.iter().map(|&x| x.into()))
    }
}
