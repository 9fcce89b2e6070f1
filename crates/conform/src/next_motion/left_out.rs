use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::deviation::Deviation;
use crate::error::Result;
use crate::linear::program::Program;
use crate::linear::smallest_sets::program;
use crate::next_motion::motions::Motions;
use crate::problem::problem::Problem;
use crate::sets::UncertaintySets;

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
/// than two motions, or for any other model. `sets` are the smallest for all motions: a motion that
/// does not touch their reachable set decides nothing, and without it they are the smallest still.
///
/// # Errors
///
/// As [`Problem::deviations`].
pub(crate) fn leave_each_out(problem: &Problem, sets: &UncertaintySets) -> Result<Vec<LeftOut>> {
    let motions = Motions::new(problem.recordings());
    if motions.count() < 2 || problem.dynamics().linear_system().is_none() {
        return Ok(Vec::new());
    }
    let (program, deviations) = (program(problem)?, problem.deviations()?);
    let input_only = problem.limits().start.is_some();
    let of = |motion: &&str| {
        let is_own = |d: &&Deviation| motions.of_suite(d.suite) == *motion;
        let own: Vec<Program> =
            deviations.iter().filter(is_own).map(|d| program.with_deviations([d])).collect();
        let rows = own.iter().map(|own| own.rows() / 2).sum();
        let left = LeftOut {
            motion: (*motion).into(),
            cost: Some(program.cost(sets)),
            rows,
            outside: Some(0),
            gauge: Some(1.0),
        };
        let decides = own.iter().any(|own| !own.tight(sets).is_empty());
        let others = || program.with_deviations(deviations.iter().filter(|d| !is_own(d)));
        (left, own, decides.then(others))
    };
    let mut programs = 0;
    let mut all: Vec<_> = motions.distinct().iter().map(of).collect();
    for (left, _, others) in &mut all {
        programs += usize::from(others.is_some());
        if programs > MOST_PROGRAMS && others.take().is_some() {
            (left.cost, left.outside, left.gauge) = (None, None, None);
        }
    }
    let solve = |(left, own, others): (LeftOut, Vec<Program>, Option<Program>)| match others {
        None => left,
        Some(others) => left.with(&others, &own, input_only),
    };
    Ok(all.into_par_iter().map(solve).collect())
}

impl LeftOut {
    /// Solves the program of the other motions and compares the motion's own rows with its sets.
    /// A program that the solver gives up on leaves nothing to compare with.
    fn with(self, others: &Program, own: &[Program], input_only: bool) -> Self {
        let Ok(solution) = others.solve() else {
            return Self { cost: None, outside: None, gauge: None, ..self };
        };
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
