use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::deviation::Deviation;
use crate::error::Result;
use crate::linear::program::Program;
use crate::linear::smallest_sets::program;
use crate::next_motion::motions::Motions;
use crate::problem::problem::Problem;
use crate::sets::UncertaintySets;
use crate::settings::{NominalStart, Notion};

/// Number of motions at most for which the program is solved again.
const MOST_PROGRAMS: usize = 60;

/// The sets of all motions but one, and how that one lies to them. A description, to rounding:
/// nothing of it is proved, and it bounds no probability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// The motion that is left out.
    pub motion: String,
    /// The cost of the smallest sets for the others, over the same samples as the cost of all.
    /// Nothing where it was not computed.
    pub cost: Option<f64>,
    /// Number of rows of the motion.
    pub rows: usize,
    /// How many of them leave these sets.
    pub outside: Option<usize>,
    /// The factor, at least 1, by which the radii of these sets must grow to enclose the motion.
    /// Nothing where no factor suffices.
    pub gauge: Option<f64>,
}

/// Leaves each motion out of the program of a linear model, one after the other. Nothing with fewer
/// than two motions, for any other model, and for other notions than the hull. `sets` are the
/// smallest for all motions: a motion that does not touch their reachable set decides nothing, and
/// without it they are the smallest still.
///
/// # Errors
///
/// As [`Problem::deviations`].
pub(crate) fn leave_each_out(problem: &Problem, sets: &UncertaintySets) -> Result<Vec<LeftOut>> {
    let motions = Motions::new(problem.recordings());
    let is_built =
        problem.settings().notion == Notion::Hull && problem.dynamics().linear_system().is_some();
    if motions.count() < 2 || !is_built {
        return Ok(Vec::new());
    }
    let (program, deviations) = (program(problem)?, problem.deviations()?);
    let input_only = problem.settings().nominal == NominalStart::Own;
    let of = |motion: &&str| -> Vec<&Deviation> {
        deviations.iter().filter(|d| motions.of_suite(d.suite) == *motion).collect()
    };
    let decides =
        |own: &Vec<&Deviation>| program.with_deviations(own.iter().copied()).touches(sets);
    // Which motions need a program, in their order, so that the answer does not depend on cores.
    let all: Vec<&str> = motions.distinct();
    let mut programs = 0;
    let steps: Vec<(&str, Step)> = all
        .iter()
        .map(|motion| {
            let step = match decides(&of(motion)) {
                false => Step::Same,
                true if programs == MOST_PROGRAMS => Step::Skip,
                true => {
                    programs += 1;
                    Step::Solve
                }
            };
            (*motion, step)
        })
        .collect();
    let leave_out = |(motion, step): &(&str, Step)| {
        let own: Vec<Program> =
            of(motion).into_iter().map(|d| program.with_deviations([d])).collect();
        let rows = own.iter().map(|own| own.rows() / 2).sum();
        let unknown =
            LeftOut { motion: (*motion).into(), cost: None, rows, outside: None, gauge: None };
        match step {
            Step::Skip => unknown,
            Step::Same => {
                let cost = Some(program.cost(sets));
                LeftOut { cost, outside: Some(0), gauge: Some(1.0), ..unknown }
            }
            Step::Solve => {
                let others = deviations.iter().filter(|d| motions.of_suite(d.suite) != *motion);
                unknown.with(&program.with_deviations(others), &own, input_only)
            }
        }
    };
    Ok(steps.par_iter().map(leave_out).collect())
}

/// What leaving a motion out takes.
enum Step {
    /// A program of the other motions.
    Solve,
    /// Nothing, because the motion decides nothing.
    Same,
    /// A program too many.
    Skip,
}

impl LeftOut {
    /// Solves the program of the other motions and compares the motion's own rows with its sets.
    /// A program that the solver gives up on leaves nothing to compare with.
    fn with(self, others: &Program, own: &[Program], input_only: bool) -> Self {
        let Ok(solution) = others.solve() else { return self };
        let sets = others.repaired(&solution.sets);
        let gauge = |own: &Program| {
            let [_, input, both] = own.growth_factors(&sets);
            if input_only { input } else { both }
        };
        Self {
            cost: Some(others.cost(&sets)),
            outside: Some(own.iter().map(|own| own.outside(&sets)).sum()),
            gauge: own.iter().map(gauge).try_fold(1.0, |max: f64, g| g.map(|g| max.max(g))),
            ..self
        }
    }
}
