use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Result;
use crate::model::SystemModel;
use crate::motion::NominalMotions;
use crate::rows::SetRows;
use crate::run::SystemRun;

/// What other recordings say of the model of a system.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SystemCheck {
    /// Whether every output at every sample is proved to lie in the sets.
    pub conformant: bool,
    /// The number of outputs that were compared: one for each sample and output.
    pub values: usize,
    /// The number of these that are not proved to lie in the sets.
    pub outside: usize,
    /// The recordings, each with the part of the sets that it needs.
    pub runs: Vec<CheckedRun>,
}

/// How a recording lies to the sets.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CheckedRun {
    /// Its name.
    pub run: String,
    /// The largest part of a set that a sample needs; more than 1 is outside, and `None` where no
    /// factor suffices.
    pub needed: Option<f64>,
    /// The output that needs it.
    pub output: String,
    /// The time of that sample since the first one, s.
    pub time: f64,
    /// The number of outputs that are not proved to lie in the sets.
    pub outside: usize,
}

impl SystemModel {
    /// Compares recordings with the model, sample by sample.
    ///
    /// # Guarantee
    ///
    /// An output that is not counted as outside is proved to lie in the hull of the reachable set,
    /// which is taken from inside; directed rounding.
    ///
    /// # Errors
    ///
    /// Recordings that do not fit the system.
    pub fn check(&self, runs: &[SystemRun]) -> Result<SystemCheck> {
        let system = self.system()?;
        let runs = system.with_past(runs)?;
        let motions = NominalMotions::new(&system, &runs)?;
        let rows = SetRows::new(&system, &motions);
        let of_run = |(at, run): (usize, &SystemRun)| {
            let (needed, [k, i], outside) = rows.beside(at, &self.sets);
            CheckedRun {
                run: run.name.clone(),
                needed: Some(needed).filter(|needed| needed.is_finite()),
                output: self.system.outputs[i].name().into(),
                time: run.times[k],
                outside,
            }
        };
        let checked: Vec<CheckedRun> = runs.par_iter().enumerate().map(of_run).collect();
        let outside = checked.iter().map(|run| run.outside).sum();
        Ok(SystemCheck {
            conformant: outside == 0,
            values: runs.iter().map(|run| run.outputs.len()).sum(),
            outside,
            runs: checked,
        })
    }
}
