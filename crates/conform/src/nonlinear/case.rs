//! What one reachable set is computed for.

use rayon::prelude::*;
use reachtube_reach::TimeGrid;
use reachtube_robot::Robot;

use crate::error::Result;
use crate::recordings::{Recordings, Suite, read_run};
use crate::{Envelope, NominalStart, Settings};
use reachtube_recordings::DataSet;

/// A suite whose runs share their input, or a run with an input of its own.
#[derive(Debug, Clone)]
pub struct Case {
    /// The suite, and the run where it is a case of its own, for people.
    pub name: String,
    /// Index of the suite in the recordings.
    pub suite: usize,
    /// The run (index in the data set), where it is a case of its own.
    pub run: Option<usize>,
    /// Sample times.
    pub grid: TimeGrid,
    /// The input u, row-major, samples x n, N m.
    pub inputs: Vec<f64>,
    /// The nominal initial state, 2n: the mean of the runs' first states rounded to double
    /// precision, which defines it, or the run's own.
    pub start: Vec<f64>,
    /// The measured states.
    pub measured: Envelope,
}

impl Case {
    /// The cases of all suites, in their order.
    ///
    /// # Errors
    ///
    /// Defects of a run that has changed since it was first read.
    pub fn all(
        data: &DataSet,
        robot: &Robot,
        settings: &Settings,
        recordings: &Recordings,
    ) -> Result<Vec<Self>> {
        let of_suite = |(index, suite): (usize, &Suite)| match &suite.shared {
            Some(shared) => Ok(vec![Self {
                name: format!("suite {}", suite.entry.name),
                suite: index,
                run: None,
                grid: shared.grid.clone(),
                inputs: shared.inputs.clone(),
                start: mean_start(suite),
                measured: suite.envelope.clone(),
            }]),
            None => {
                let own = |run: usize| Self::of_run(data, robot, settings, (index, suite), run);
                suite.runs.par_iter().map(|run| own(run.index)).collect()
            }
        };
        let parts =
            recordings.suites.iter().enumerate().map(of_suite).collect::<Result<Vec<_>>>()?;
        Ok(parts.concat())
    }

    fn of_run(
        data: &DataSet,
        robot: &Robot,
        settings: &Settings,
        (index, suite): (usize, &Suite),
        run: usize,
    ) -> Result<Self> {
        let (recorded, input) =
            read_run(data, run, robot, settings).map_err(reachtube_recordings::Error::Defects)?;
        let mut measured = Envelope::new(2 * recorded.joints);
        measured.include(run as u32, &recorded.states);
        let start = match settings.nominal {
            NominalStart::Mean => mean_start(suite),
            NominalStart::Own => recorded.state(0).to_vec(),
        };
        let name = format!("suite {}, run {}", suite.entry.name, data.runs()[run].file);
        let (grid, inputs) = (input.grid, input.inputs);
        Ok(Self { name, suite: index, run: Some(run), grid, inputs, start, measured })
    }

    /// Number of joints n.
    pub fn joints(&self) -> usize {
        self.start.len() / 2
    }
}

fn mean_start(suite: &Suite) -> Vec<f64> {
    suite.mean_start.iter().map(|x| x.mid()).collect()
}
