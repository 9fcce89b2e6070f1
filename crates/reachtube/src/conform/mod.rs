//! Conformance: deviations -> envelope -> linear program -> sets -> verdict.

mod check;
mod deviation;
mod dynamics;
mod envelope;
mod identify;
mod nonlinear;
mod program;
mod proof;
mod recordings;
mod rows;
mod sets;
mod settings;
mod solver;
mod trust;
mod verify;
mod within_box;

pub use check::{Check, Place, SuiteCheck, Violations, check};
pub use deviation::{Deviation, Grid, Grids, RunNominal, nominals, suite_deviations};
pub use dynamics::Dynamics;
pub use envelope::Envelope;
pub use identify::{Conformance, Search, Watch, conform, conform_dynamics};
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
