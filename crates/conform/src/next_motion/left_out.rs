use rayon::prelude::*;

use crate::data::problem::Problem;
use crate::error::Result;
use crate::next_motion::allowance::Missing;
use crate::next_motion::motions::Motions;
use crate::next_motion::outer_gauge::{COARSE, OuterGauge, outer_gauge};
use crate::next_motion::without_motion::LeftOut;
use crate::program::program::{CLOSE, Program, RowIndex};
use crate::progress::Progress;
use crate::sets::UncertaintySets;
use crate::tube::flowpipes::{Effort, rows_outside};

/// Number of motions at most for which the program is solved again.
const MOST_PROGRAMS: usize = 60;

/// A motion beside the others.
struct Without<'a> {
    problem: &'a Problem,
    suites: Vec<bool>,
}

/// Motions that were left out, beside the sets of the others.
#[derive(Debug, Default)]
pub(crate) struct LeftOutMotions {
    pub each: Vec<LeftOut>,
    /// The rows of each motion that lie beyond the sets of the others. `None` for a single motion,
    /// for a program that could not be solved, and for a model that is not linear.
    pub missing: Option<Vec<Missing>>,
}

/// Leaves each motion out of the program that gave the smallest sets, one after the other, and
/// compares the motion with the sets of the others: with their rows for a linear model, and with
/// the computed outer sets for any other. Nothing with fewer than two motions, and for other
/// notions than the hull. `sets` are the smallest for all motions: a motion that does not touch
/// their reachable set decides nothing, and without it they are the smallest still. `rows` are the
/// rows of the program that were generated for these sets; each of the other programs begins with
/// the rows that nearly decide the sets.
pub(crate) fn leave_each_out(
    problem: &Problem,
    program: &Program,
    sets: &UncertaintySets,
    mut rows: Vec<RowIndex>,
    progress: &dyn Progress,
) -> Result<LeftOutMotions> {
    let motions = Motions::new(problem.recordings());
    if motions.count() < 2 || problem.settings().notion.asks_points() {
        return Ok(LeftOutMotions::default());
    }
    let suites = 0..problem.recordings().suites.len();
    let all = motions.distinct().into_iter().map(|motion| {
        let suites = suites.clone().map(|suite| motions.of_suite(suite) == motion).collect();
        (motion, Without { problem, suites })
    });
    program.keep_close(&mut rows, sets, CLOSE);
    // Which motions need a program, in their order, so that the answer does not depend on cores. A
    // row of one suite touches the sets only if the row of all suites does.
    let mut programs = 0;
    let deciding = program.deciding(sets);
    let numbered = all.map(|(motion, without)| {
        let own = without.rows(program, |suite| without.suites[suite])?;
        let decides = !own.tight_among(deciding.iter().copied(), sets).is_empty();
        programs += usize::from(decides);
        Ok((motion, without, decides.then_some(programs)))
    });
    let numbered: Vec<_> = numbered.collect::<Result<_>>()?;
    let is_linear = problem.dynamics().linear_system().is_some();
    let leave_out = |(motion, without, number): &(&str, Without, Option<usize>)| {
        progress.go_on()?;
        let unknown = LeftOut::unknown(motion, without.row_count()?);
        match *number {
            None => {
                let (cost, none) = (Some(program.cost(sets)), is_linear.then_some(1.0));
                let left = LeftOut {
                    cost,
                    outside: Some(0),
                    gauge: Some(1.0),
                    initial_gauge: none,
                    input_gauge: none,
                    wider: none,
                    ..unknown
                };
                Ok((left, Some(Missing::new())))
            }
            Some(number) if number > MOST_PROGRAMS => Ok((unknown, Some(Missing::new()))),
            Some(_) => {
                let (own, others) = (without.own(program)?, without.others(program)?);
                without.compare(&others, &rows, &own, unknown)
            }
        }
    };
    let left: Vec<_> = numbered.par_iter().map(leave_out).collect::<Result<_>>()?;
    let (each, missing): (Vec<LeftOut>, Vec<Option<Missing>>) = left.into_iter().unzip();
    let missing: Option<Vec<Missing>> = missing.into_iter().collect();
    Ok(LeftOutMotions { each, missing: missing.filter(|_| is_linear) })
}

/// Finds the sets of the other motions of a linear model, and compares `motion` with them. Returns
/// its rows that lie beyond them too; `None` if the program could not be solved.
pub(crate) fn leave_out(problem: &Problem, motion: &str) -> Result<(LeftOut, Option<Missing>)> {
    let motions = Motions::new(problem.recordings());
    let suites = 0..problem.recordings().suites.len();
    let suites = suites.map(|suite| motions.of_suite(suite) == motion).collect();
    let without = Without { problem, suites };
    let limits = problem.with_suites(|suite| !without.suites[suite]).limits();
    let program = Program::of_problem(problem)?.with_limits(limits);
    let (own, others) = (without.own(&program)?, without.others(&program)?);
    let unknown = LeftOut::unknown(motion, without.row_count()?);
    without.compare(&others, &[], &own, unknown)
}

impl Without<'_> {
    fn rows<'p>(&self, program: &Program<'p>, of: impl Fn(usize) -> bool) -> Result<Program<'p>> {
        Ok(match self.problem.dynamics().linear_system() {
            Some(_) => {
                program.with_deviations(self.problem.deviations()?.iter().filter(|d| of(d.suite)))
            }
            None => {
                let cases = self.problem.cases()?;
                program.with_blocks(|block| of(cases[block].suite))
            }
        })
    }

    /// Returns the program of the other motions; `program` has all motions.
    fn others<'p>(&self, program: &Program<'p>) -> Result<Program<'p>> {
        match self.problem.dynamics().linear_system() {
            Some(_) => {
                let deviations = self.problem.deviations()?;
                Ok(program.with_suites(deviations, |suite| !self.suites[suite]))
            }
            None => self.rows(program, |suite| !self.suites[suite]),
        }
    }

    /// Returns the number of rows of the motion, both sides together.
    fn row_count(&self) -> Result<usize> {
        let problem = self.problem;
        let samples: usize = match problem.dynamics().linear_system() {
            Some(_) => {
                let own = problem.deviations()?.iter().filter(|d| self.suites[d.suite]);
                own.map(|d| d.envelope.len()).sum()
            }
            None => {
                let own = problem.cases()?.iter().filter(|case| self.suites[case.suite]);
                own.map(|case| case.measured.len()).sum()
            }
        };
        Ok(samples * problem.settings().states.rows(problem.states()))
    }

    fn own<'p>(&self, program: &Program<'p>) -> Result<Vec<Program<'p>>> {
        let own = (0..self.suites.len()).filter(|suite| self.suites[*suite]);
        own.map(|suite| self.rows(program, |other| other == suite)).collect()
    }

    /// Solves the program of the other motions and compares the motion with its sets. A program
    /// that the solver gives up on leaves nothing to compare with.
    fn compare(
        &self,
        others: &Program,
        rows: &[RowIndex],
        own: &[Program],
        unknown: LeftOut,
    ) -> Result<(LeftOut, Option<Missing>)> {
        let Ok(solution) = others.solve_near(rows) else {
            return Ok((unknown, None));
        };
        let sets = others.repaired(&solution.sets);
        let input_only = self.problem.settings().nominal.is_measured();
        let growth = |own: &Program| own.growth(&sets, input_only);
        let growth = own.iter().map(growth).try_fold(1.0, |max: f64, g| g.map(|g| max.max(g)));
        let compared = match self.problem.dynamics().linear_system() {
            Some(_) => {
                let [initial_gauge, input_gauge] = Program::growth_in_turn(own, &sets, input_only);
                let wider = others.wider(own, &sets, input_only, |_| true);
                let wider = wider.map(|parts| parts.into_iter().fold(1.0, f64::max));
                let outside = Some(own.iter().map(|own| own.outside(&sets)).sum());
                LeftOut { outside, gauge: growth, initial_gauge, input_gauge, wider, ..unknown }
            }
            None => {
                let (outside, gauge) = self.outer(&sets, growth.unwrap_or(1.0), input_only)?;
                LeftOut { outside, gauge, ..unknown }
            }
        };
        let mut missing = Missing::default();
        own.iter().for_each(|own| own.missing(&sets, &mut missing));
        Ok((LeftOut { cost: Some(others.cost(&sets)), ..compared }, Some(missing)))
    }

    /// Returns how many of the motion's rows leave the computed outer sets, and the motion's gauge
    /// by these; the search for it begins at `guess`.
    fn outer(
        &self,
        sets: &UncertaintySets,
        guess: f64,
        input_only: bool,
    ) -> Result<(Option<usize>, Option<f64>)> {
        let problem = self.problem;
        let own = problem.cases()?.par_iter().filter(|case| self.suites[case.suite]);
        let sum = |a: Option<usize>, b: Option<usize>| Ok(a.zip(b).map(|(a, b)| a + b));
        let outside = own.map(|case| rows_outside(problem, case, sets));
        let outside = outside.try_reduce(|| Some(0), sum)?;
        let grown = |factor: f64| sets.grown(factor, input_only);
        let gauge = match outside {
            Some(0) => Some(1.0),
            _ => {
                match outer_gauge(problem, &self.suites, Effort::Quick, (guess, COARSE), &grown)? {
                    OuterGauge::Factor(factor) => Some(factor),
                    OuterGauge::None | OuterGauge::Lost(_) => None,
                }
            }
        };
        Ok((outside, gauge))
    }
}
