//! Conformance: deviations -> envelope -> linear program -> sets -> verdict.

mod check;
mod conformance;
mod deviation;
mod dynamics;
mod envelope;
mod error;
mod model;
mod nonlinear;
mod program;
mod proof;
mod recordings;
mod rows;
mod sets;
mod settings;
mod solver;
mod suite_reach;
mod trust;
mod verify;
mod within_box;

pub use check::{Check, Place, SuiteCheck, Violations, check};
pub use conformance::{Conformance, Search, Watch, conform, conform_dynamics};
pub use deviation::{Deviation, Grid, Grids, RunNominal, nominals, suite_deviations};
pub use dynamics::Dynamics;
pub use envelope::Envelope;
pub use error::{Error, Result};
pub use model::{
    DataRecord, Explained, FORMAT, MOST_TIGHT, Model, Residual, RunRecord, SuiteRecord, VERSION,
};
pub use nonlinear::{Case, Explanation, explain};
pub(crate) use nonlinear::{Effort, flowpipes, lost, nominal};
pub use program::{Block, Program, Solution};
pub use proof::{Enclosure, Lost, Proof, TightRow};
pub use recordings::{Progress, Recordings, RunSummary, SharedInput, Suite};
use serde::{Deserialize, Serialize};
pub use sets::UncertaintySets;
pub use settings::{
    Centre, Method, Noise, NominalStart, Notion, Settings, States, Tolerance, Weights,
};
pub use suite_reach::{SuiteReach, reach};
pub use trust::{Trust, clopper_pearson, scenario_bound};
pub use verify::{Row, check_rows};

/// A side of a set along a state axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The highest values.
    Upper,
    /// The lowest values.
    Lower,
}

impl Side {
    /// 1 or -1.
    pub fn sign(self) -> f64 {
        match self {
            Self::Upper => 1.0,
            Self::Lower => -1.0,
        }
    }
}
