use std::path::Path;

use reachtube_files::{Journal, TOOL, hex};
use sha2::{Digest, Sha256};

use crate::claim::claim::Claim;
use crate::claim::look::Look;
use crate::claim::notion::plant;
use crate::claim::touching::touching;
use crate::data::problem::Problem;
use crate::data::settings::Method;
use crate::error::Result;
use crate::next_motion::left_out::{LeftOutMotions, leave_each_out};
use crate::program::program::{Program, RowIndex, TIGHT};
use crate::progress::{Progress, Silent};
use crate::search::bisection::bisect;
use crate::search::found::{Deciding, Found, SearchSummary, TOUCHING};
use crate::search::optimality::optimality_gap;
use crate::search::prove::prove;
use crate::search::search::{Ended, search};
use crate::tube::plant::Plant;

/// Finds the smallest sets for all recordings of a problem, and those without each motion, unless
/// the motions were left out before (`left_out`). What a search for the sets of a model that is not
/// linear has finished is kept in the file `resume` and removed at the end.
pub(crate) fn smallest_sets(
    problem: &Problem,
    claim: &dyn Claim,
    left_out: Option<LeftOutMotions>,
    (progress, resume): (&dyn Progress, Option<&Path>),
) -> Result<Found> {
    let plant = &*plant(problem)?;
    let journal = Journal::new(resume.filter(|_| !plant.is_exact()), digest(problem));
    let found = match problem.settings().method {
        Method::Bisection if !plant.is_exact() => bisect(problem, claim, &journal, progress)?,
        _ => {
            let ended = search((problem, plant), claim, &journal, progress)?;
            let (found, program, rows) = finish((problem, plant), claim, ended)?;
            let left_out = match left_out {
                Some(known) => known,
                None => leave_each_out(problem, &program, &found.tube.sets, rows, progress)?,
            };
            Found { left_out, ..found }
        }
    };
    journal.remove();
    Ok(found)
}

fn digest(problem: &Problem) -> String {
    let mut digest = Sha256::new();
    let (settings, drive) = (problem.settings(), problem.setup().drive.identity());
    let decides = serde_json::to_string(&(TOOL, settings, drive));
    digest.update(decides.expect("settings have only finite numbers and string keys"));
    digest.update(&problem.recordings().root);
    for suite in &problem.recordings().suites {
        digest.update(&suite.entry.name);
    }
    hex(&digest.finalize())
}

/// Finds the smallest sets of a linear model alone.
pub(crate) fn smallest_sets_alone(problem: &Problem, claim: &dyn Claim) -> Result<Found> {
    let plant = &*plant(problem)?;
    let ended = search((problem, plant), claim, &Journal::new(None, String::new()), &Silent)?;
    Ok(finish((problem, plant), claim, ended)?.0)
}

/// Proves the sets that a search found. Returns the last program and its rows too.
fn finish<'a>(
    (problem, plant): (&Problem, &dyn Plant),
    claim: &dyn Claim,
    ended: Ended<'a>,
) -> Result<(Found, Program<'a>, Vec<RowIndex>)> {
    let Ended { state, round, lower_bound, tube } = ended;
    let (program, is_exact) = (round.program, plant.is_exact());
    let sets = match claim.tolerance() {
        None if is_exact => program.repaired(&state.sets),
        _ => state.sets.clone(),
    };
    let tube = match tube {
        Some(tube) if tube.sets == sets => tube,
        Some(_) => claim.judge(plant, &sets, &Look::proof())?,
        None => prove((problem, plant), claim, &sets, program.scale())?,
    };
    let costs = plant.costs(&tube)?;
    let gap = optimality_gap(costs.cost, lower_bound, program.negligible_cost());
    let summary = || SearchSummary {
        rounds: state.rounds,
        reachable_sets: state.reachable_sets,
        linearised_cost: Some(program.cost(&state.sets)),
        linearised_cost_of_samples: Some(program.paper_sums(&state.sets).of_samples),
        runs_away: round.runs_away,
    };
    let deciding = match claim.tolerance() {
        _ if !is_exact => Deciding::Rows(program.tight(&tube.sets).into_iter().collect()),
        None => Deciding::Touching(TIGHT),
        Some(_) => Deciding::Touching(TOUCHING),
    };
    let found = Found {
        lower_bound: is_exact.then_some(lower_bound),
        optimality_gap: is_exact.then_some(gap),
        search: (!is_exact).then(summary),
        touching: touching((problem, plant), &program, &tube, &state.directions),
        ..Found::new(tube, costs, deciding)
    };
    Ok((found, program, round.rows))
}
