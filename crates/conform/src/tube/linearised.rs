//! The program of a model that is not linear in one round of successive linearisation
//! (docs/method.md, correction K).
//!
//! The model is linearised along every nominal motion, about the centres found so far. Worst-case
//! motions, simulated with the model itself, show where it reaches further than its linearisation,
//! and move the rows.

use rayon::prelude::*;

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::data::side::Side;
use crate::error::Result;
use crate::nominal::simulate::runs_away;
use crate::program::block::Block;
use crate::program::program::Program;
use crate::sets::UncertaintySets;
use crate::tube::direction::Direction;
use crate::tube::plant::Round;
use crate::tube::sensitivity::Sensitivity;
use crate::tube::state::SearchState;
use crate::tube::worst_case::Correction;

/// Linearises the model along every case, and poses the program, with one block per case.
pub(super) fn round<'a>(problem: &'a Problem, state: &mut SearchState) -> Result<Round<'a>> {
    let (cases, sets) = (problem.cases()?, &state.sets);
    let sensitivities = sensitivities(problem, sets, &state.directions)?;
    let corrections = corrections(problem, state, &sensitivities)?;
    let ran_away = cases.iter().zip(&corrections);
    let runs_away =
        ran_away.filter_map(|(case, c)| c.runs_away.map(|time| (case.name.clone(), time))).next();
    let mut cuts = Vec::with_capacity(state.directions.len());
    let mut used = vec![0; cases.len()];
    for direction in &mut state.directions {
        let (case, sample) = (direction.at.0 as usize, direction.at.1 as usize);
        let (sensitivity, at) = (&sensitivities[case], &mut used[case]);
        let nominal = &sensitivity.nominal[sample * direction.direction.len()..];
        cuts.push(direction.cut(&sensitivity.directions[*at], nominal, sets));
        *at += 1;
    }
    let parts = cases.iter().zip(sensitivities).zip(&corrections);
    let mut blocks: Vec<Block> = parts
        .map(|((case, sensitivity), correction)| block(case, sensitivity, correction, sets))
        .collect();
    for margin in &state.margins {
        let envelope = &mut blocks[margin.case].envelope;
        envelope.widen(margin.sample, margin.state, margin.side, margin.margin);
    }
    let (settings, shape) = (problem.settings(), problem.shape());
    let mut program =
        Program::new((settings, shape), &settings.weights.of_states(shape.states), blocks)
            .with_centre_bounds(state.centre_bounds(&problem.kinds()))
            .with_limits(problem.limits());
    program.cuts = cuts;
    Ok(Round { rows: program.first_rows(), program, runs_away })
}

fn sensitivities(
    problem: &Problem,
    sets: &UncertaintySets,
    directions: &[Direction],
) -> Result<Vec<Sensitivity>> {
    let (model, disturbance) = (problem.nonlinear(), problem.settings().disturbance);
    let of = |(index, case): (usize, &Case)| {
        let mine = directions.iter().filter(|known| known.at.0 as usize == index);
        let asked: Vec<&Direction> = mine.collect();
        Sensitivity::new(model, case, sets, disturbance, &asked)
            .map_err(|time| runs_away(case, time))
    };
    problem.cases()?.par_iter().enumerate().map(of).collect()
}

/// Corrects the linearisation by worst-case motions; not in the first round, which has no sets yet.
fn corrections(
    problem: &Problem,
    state: &SearchState,
    sensitivities: &[Sensitivity],
) -> Result<Vec<Correction>> {
    let model = problem.nonlinear();
    let of = |(case, sensitivity): (&Case, &Sensitivity)| match state.rounds {
        0 => Correction::none(case.grid.len(), case.states()),
        _ => Correction::new(model, case, &state.sets, sensitivity),
    };
    Ok(problem.cases()?.par_iter().zip(sensitivities).map(of).collect())
}

/// Makes the rows of one case. With x̂ the motion from the centres c of the round before, the new
/// centres c' and radii r' must satisfy x̂ + E (c' - c) + R r' + correction >= x_m, and likewise
/// below.
fn block(
    case: &Case,
    sensitivity: Sensitivity,
    correction: &Correction,
    sets: &UncertaintySets,
) -> Block {
    let states = case.states();
    let centre: Vec<f64> =
        sets.initial_set.centre.iter().chain(&sets.input_set.centre).copied().collect();
    let from_nominal = |k: usize, i: usize, x: f64| {
        let (row, _) = sensitivity.row(k, i);
        let moved: f64 = row.iter().zip(&centre).map(|(e, c)| e * c).sum();
        x - sensitivity.nominal[k * states + i] + moved
    };
    let envelope = case.measured.map(
        |k, i, upper| from_nominal(k, i, upper) - correction.at(k, i, Side::Upper),
        |k, i, lower| from_nominal(k, i, lower) + correction.at(k, i, Side::Lower),
    );
    let coefficients = sensitivity.coefficients.into();
    let (times, scale) = (case.grid.times().into(), [].into());
    Block { times, coefficients, scale, envelope }
}
