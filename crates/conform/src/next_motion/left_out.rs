use rayon::prelude::*;

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::data::settings::{NominalStart, Notion};
use crate::deviation::Deviation;
use crate::error::Result;
use crate::flowpipes::{Effort, rows_outside};
use crate::linear::program::Program;
use crate::next_motion::motions::Motions;
use crate::next_motion::outer_gauge::{OuterGauge, outer_gauge};
use crate::next_motion::without_motion::LeftOut;
use crate::progress::Progress;
use crate::sets::UncertaintySets;

/// Number of motions at most for which the program is solved again.
const MOST_PROGRAMS: usize = 60;

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
    let (program, deviations) = (Program::of_problem(problem)?, problem.deviations()?);
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

/// Leaves each motion out of the last program of a search for a model that is not linear, and
/// compares the motion with the computed outer sets. Nothing with fewer than two motions, and for
/// other notions than the hull. `sets` belong to all motions, as in [`leave_each_out`].
///
/// # Errors
///
/// When sizes do not fit, or the job is cancelled.
pub(crate) fn leave_each_out_of_search(
    problem: &Problem,
    sets: &UncertaintySets,
    program: &Program,
    progress: &dyn Progress,
) -> Result<Vec<LeftOut>> {
    let motions = Motions::new(problem.recordings());
    if motions.count() < 2 || problem.settings().notion != Notion::Hull {
        return Ok(Vec::new());
    }
    let cases = problem.cases()?;
    let input_only = problem.settings().nominal == NominalStart::Own;
    let mut programs = 0;
    let leave_out = |motion: &str| {
        progress.go_on()?;
        let is_own = |suite: usize| motions.of_suite(suite) == motion;
        let own = program.with_blocks(|case| is_own(cases[case].suite));
        let of_motion: Vec<&Case> = cases.iter().filter(|case| is_own(case.suite)).collect();
        let states = problem.settings().states.rows(problem.joints());
        let rows = states * of_motion.iter().map(|case| case.measured.len()).sum::<usize>();
        let unknown =
            LeftOut { motion: motion.into(), cost: None, rows, outside: None, gauge: None };
        if !own.touches(sets) {
            let cost = Some(program.cost(sets));
            return Ok(LeftOut { cost, outside: Some(0), gauge: Some(1.0), ..unknown });
        }
        programs += 1;
        let others = program.with_blocks(|case| !is_own(cases[case].suite));
        let Some(solution) = (programs <= MOST_PROGRAMS).then(|| others.solve().ok()).flatten()
        else {
            return Ok(unknown);
        };
        let sets = others.repaired(&solution.sets);
        let grown = |factor: f64| sets.grown(factor, input_only);
        let of_case = |case: &&Case| rows_outside(problem, case, &sets);
        let sum = |a: Option<usize>, b: Option<usize>| Ok(a.zip(b).map(|(a, b)| a + b));
        let outside = of_motion.par_iter().map(of_case).try_reduce(|| Some(0), sum)?;
        let [_, input, both] = own.growth_factors(&sets);
        let guess = if input_only { input } else { both }.unwrap_or(1.0);
        let suites: Vec<bool> = (0..problem.recordings().suites.len()).map(is_own).collect();
        let gauge = match outside {
            Some(0) => Some(1.0),
            _ => match outer_gauge(problem, &suites, Effort::Quick, guess, &grown)? {
                OuterGauge::Factor(factor) => Some(factor),
                OuterGauge::None | OuterGauge::Lost(_) => None,
            },
        };
        Ok(LeftOut { cost: Some(others.cost(&sets)), outside, gauge, ..unknown })
    };
    motions.distinct().into_iter().map(leave_out).collect()
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
