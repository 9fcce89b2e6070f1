//! Table II: the uncertainty sets of model 1.

use std::path::Path;

use reachtube_conform::{
    Centre, Keep, Notion, Problem, Progress, Settings, Setup, States, UncertaintySets, conform,
};
use reachtube_reach::{Disturbance, Hyperrectangle};
use reachtube_recordings::{DataSet, Torque};
use reachtube_robot::Robot;
use serde::Serialize;

use super::paper::{PAPER_POSITIONS, PAPER_VELOCITIES, PaperSets};
use crate::error::Result;

/// What Table II is made of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table2Options {
    /// The suites; all where none is named.
    pub suites: Vec<String>,
    /// The notions of enclosure, each for both cases of the table.
    pub notions: Vec<Notion>,
    /// How the disturbance may change in time. The paper's V is constant (Prop. 1).
    pub disturbance: Disturbance,
}

impl Default for Table2Options {
    /// Returns the paper's notion and disturbance, for all suites.
    fn default() -> Self {
        Self { suites: Vec::new(), notions: vec![Notion::Hull], disturbance: Disturbance::Constant }
    }
}

/// One half of Table II in one notion: the smallest sets of model 1, p = 1, of the LWA 4P.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table2Case {
    /// Which states had to be enclosed: all of them ("velocity conformant"), or positions
    /// ("position conformant").
    pub states: States,
    /// The notion.
    pub notion: Notion,
    /// Whether the recordings were proved to be enclosed.
    pub conformant: bool,
    /// Σ_k Σ_i width_i(t_k) of the reachable sets.
    pub cost: f64,
    /// No sets cost less.
    pub lower_bound: Option<f64>,
    /// X0 and U.
    pub sets: UncertaintySets,
    /// What can hardly be right about them, one sentence each.
    pub warnings: Vec<String>,
    /// The paper's.
    pub paper: &'static PaperSets,
}

/// Table II.
#[derive(Debug, Clone, PartialEq, Serialize)]
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

/// Finds the sets of model 1, p = 1, of the LWA 4P for recordings of compensated torques. The sets
/// contain the origin, as the paper's do.
///
/// # Errors
///
/// As [`Problem::read`] and [`conform`].
pub fn table2(
    folder: &Path,
    options: &Table2Options,
    progress: &(dyn Progress + Sync),
) -> Result<Table2> {
    let cases: Vec<(Notion, States)> = options
        .notions
        .iter()
        .flat_map(|notion| [States::All, States::Positions].map(|states| (*notion, states)))
        .collect();
    let setup = |(notion, states): (Notion, States)| {
        let settings = Settings {
            notion,
            states,
            disturbance: options.disturbance,
            centre: Centre::Origin,
            ..Settings::new(Torque::Compensated, 6)
        };
        Setup::new(Robot::lwa4p(), settings)
    };
    // Recordings are read once, and kept where one of the notions needs them again.
    let strongest = options.notions.iter().copied().find(|notion| *notion != Notion::Hull);
    let first = setup((strongest.unwrap_or_default(), States::All))?;
    let source = Box::new(DataSet::open(folder)?);
    let problem = Problem::read(first, source, &options.suites, Keep::Needed, progress)?;
    let case = |&(notion, states): &(Notion, States)| {
        let found = conform(&problem.with_setup(setup((notion, states))?), progress, None)?;
        Ok(Table2Case {
            states,
            notion,
            conformant: found.verdict.conformant,
            cost: found.cost,
            lower_bound: found.lower_bound,
            sets: found.sets,
            warnings: found.warnings.into_iter().map(|warning| warning.text).collect(),
            paper: if states == States::All { &PAPER_VELOCITIES } else { &PAPER_POSITIONS },
        })
    };
    Ok(Table2 {
        options: options.clone(),
        runs: problem.recordings().run_count(),
        suites: problem.recordings().suites.len(),
        cases: cases.iter().map(case).collect::<Result<_>>()?,
    })
}

impl Table2Case {
    /// Returns the bounds of X0 in q and q̇ and of U for a joint, from 0.
    #[must_use]
    pub fn bounds(&self, joint: usize) -> [(f64, f64); 3] {
        let bounds = |set: &Hyperrectangle, i: usize| set.bounds(i);
        let UncertaintySets { initial_set, input_set, .. } = &self.sets;
        let n = input_set.dimension();
        [bounds(initial_set, joint), bounds(initial_set, n + joint), bounds(input_set, joint)]
    }
}
