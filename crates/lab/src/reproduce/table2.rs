//! Table II: the uncertainty sets of model 1.

use reachtube_arm::{ArmSettings, setup};
use std::path::Path;

use reachtube_conform::settings::{Centre, InitialLimit, States};
use reachtube_conform::{
    Conformance, Keep, Notion, Problem, Progress, Settings, Setup, UncertaintySets, conform,
};
use reachtube_reach::{Disturbance, Hyperrectangle};
use reachtube_recordings::{DataSet, Torque};
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::Serialize;

use super::paper::{PAPER_POSITIONS, PAPER_VELOCITIES, PaperSets};
use crate::error::Result;

/// What Table II is made of.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Table2Options {
    /// The suites; all if none is named.
    pub suites: Vec<String>,
    /// The notions of enclosure, each for both cases of the table.
    pub notions: Vec<Notion>,
    /// How far X0 may reach. The paper's X0 has the same positions in both cases, about as far as
    /// its recordings start from their mean.
    pub initial_limit: InitialLimit,
}

impl Default for Table2Options {
    fn default() -> Self {
        Self {
            suites: Vec::new(),
            notions: vec![Notion::Hull],
            initial_limit: InitialLimit::Positions,
        }
    }
}

/// One half of Table II in one notion: the smallest sets of model 1, p = 1, of the LWA 4P.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Table2Case {
    /// Which states had to be enclosed: all of them ("velocity conformant"), or positions
    /// ("position conformant").
    pub states: States,
    /// The notion.
    pub notion: Notion,
    /// How the disturbance may change in time.
    pub disturbance: Disturbance,
    /// Whether the recordings were proved to be enclosed.
    pub conformant: bool,
    /// The integral over time of Σ_i width_i of the reachable sets.
    pub cost: f64,
    /// Σ_k Σ_i width_i(t_k) of the reachable sets, as the paper sums them.
    pub cost_of_samples: f64,
    /// No sets cost less.
    pub lower_bound: Option<f64>,
    /// X0 and U.
    pub sets: UncertaintySets,
    /// Implausible results, one sentence each.
    pub warnings: Vec<String>,
    /// The paper's.
    pub(crate) paper: &'static PaperSets,
}

/// Table II.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Table2 {
    /// The options.
    pub options: Table2Options,
    /// Number of recordings.
    pub runs: usize,
    /// Number of suites.
    pub suites: usize,
    /// Both cases for each notion.
    pub cases: Vec<Table2Case>,
}

/// What was found for one half of the table in one notion.
pub(super) struct FoundCase {
    /// The robot and the settings.
    pub setup: Setup,
    /// The sets.
    pub found: Conformance,
}

/// The recordings, and what was found for them.
pub(super) struct Found {
    pub problem: Problem,
    /// Both halves of the table for each notion.
    pub cases: Vec<FoundCase>,
}

impl Found {
    /// Finds the sets of model 1, p = 1, of the LWA 4P for recordings of compensated torques. The
    /// sets contain the origin, as the paper's do.
    ///
    /// # Errors
    ///
    /// As [`Problem::read`] and [`conform`].
    pub(super) fn new(
        folder: &Path,
        options: &Table2Options,
        progress: &(dyn Progress + Sync),
    ) -> Result<Self> {
        // Recordings are read once, and kept where one of the notions needs them again.
        let strongest = options.notions.iter().copied().find(|notion| *notion != Notion::Hull);
        let first = options.setup(strongest.unwrap_or_default(), States::All)?;
        let source = Box::new(DataSet::open(folder)?);
        let problem = Problem::read(first, source, &options.suites, Keep::Needed, progress)?;
        let mut cases = Vec::new();
        for notion in &options.notions {
            for states in [States::All, States::Positions] {
                let setup = options.setup(*notion, states)?;
                let found = conform(&problem.with_setup(setup.clone()), progress, None)?;
                cases.push(FoundCase { setup, found });
            }
        }
        Ok(Self { problem, cases })
    }

    pub(super) fn table(&self, options: &Table2Options) -> Table2 {
        Table2 {
            options: options.clone(),
            runs: self.problem.recordings().run_count(),
            suites: self.problem.recordings().suites.len(),
            cases: self.cases.iter().map(FoundCase::row).collect(),
        }
    }
}

impl FoundCase {
    pub(super) fn states(&self) -> States {
        self.setup.settings().states
    }

    fn row(&self) -> Table2Case {
        let (settings, found) = (self.setup.settings(), &self.found);
        let all = settings.states == States::All;
        Table2Case {
            states: settings.states,
            notion: settings.notion,
            disturbance: settings.disturbance,
            conformant: found.verdict.conformant,
            cost: found.cost,
            cost_of_samples: found.cost_of_samples,
            lower_bound: found.lower_bound,
            sets: found.sets.clone(),
            warnings: found.warnings.iter().map(|warning| warning.text.clone()).collect(),
            paper: if all { &PAPER_VELOCITIES } else { &PAPER_POSITIONS },
        }
    }
}

impl Table2Options {
    fn setup(&self, notion: Notion, states: States) -> Result<Setup> {
        // Constant for the hull, as the paper's V (Prop. 1). Under constant disturbances the set
        // itself is so thin that X0 has to fill it.
        let disturbance = match notion {
            Notion::Hull => Disturbance::Constant,
            _ => Disturbance::Sample,
        };
        let settings = Settings {
            notion,
            states,
            disturbance,
            initial_limit: self.initial_limit,
            centre: Centre::Origin,
            ..Settings::default()
        };
        Ok(setup(Robot::lwa4p(), ArmSettings::new(Torque::Compensated, 6), settings)?)
    }
}

impl Table2Case {
    /// Returns the bounds of X0 in q and q̇ and of U for a joint, from 0.
    pub(crate) fn bounds(&self, joint: usize) -> [(f64, f64); 3] {
        let bounds = |set: &Hyperrectangle, i: usize| set.bounds(i);
        let UncertaintySets { initial_set, input_set, .. } = &self.sets;
        let n = input_set.dimension();
        [bounds(initial_set, joint), bounds(initial_set, n + joint), bounds(input_set, joint)]
    }

    pub(crate) fn name(&self) -> &'static str {
        match self.states {
            States::All => "velocity conformant",
            States::Positions => "position conformant",
        }
    }
}
