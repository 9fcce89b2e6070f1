//! The smallest sets for which every recording lies in the reachable set.
//!
//! Each round poses a program, solves it, and shows the reachable sets of its answer to the claim.
//! A point outside is separated from the set by a direction, and the row of this direction joins
//! the next program (docs/method.md, section 4). The program of an exact plant stays the same but
//! for these cutting planes. Any other plant is linearised anew about the sets found so far, until
//! they settle, and rows outside its computed reachable sets are asked for with a margin
//! (docs/method.md, correction K).

use reachtube_files::Journal;

use crate::claim::claim::Claim;
use crate::claim::look::{Look, Near};
use crate::data::problem::Problem;
use crate::error::Result;
use crate::progress::Progress;
use crate::sets::UncertaintySets;
use crate::tube::judged::{At, Judged};
use crate::tube::plant::{Plant, Round};
use crate::tube::state::{Margin, SearchState};
use crate::tube::tube::Tube;

/// Rounds of linearisation after which the sets are taken as they are; with margins at most twice
/// as many.
const ROUNDS: usize = 20;

/// Rounds at most where recorded points must lie in the set itself.
const ROUNDS_OF_POINTS: usize = 100;

/// Rounds at most of an exact plant.
const ROUNDS_OF_CUTS: usize = 200;

/// Factor on what is missing with which rows outside the enclosure are asked for.
const MARGIN: f64 = 1.1;

/// Points this close to the boundary in the first round are tried in every round of an exact plant;
/// all others when none of them is outside any more.
const NEAR: f64 = 0.97;

/// The end of a search.
pub(super) struct Ended<'a> {
    pub state: SearchState,
    pub round: Round<'a>,
    /// Its dual objective.
    pub lower_bound: f64,
    /// The reachable sets, which an exact plant's search does not compute.
    pub tube: Option<Tube>,
}

/// What lies outside the reachable sets of a round.
#[derive(Default)]
struct Outside {
    /// The reachable sets, where they were computed with directed rounding.
    tube: Option<Tube>,
    judged: Judged,
    rows: Vec<Margin>,
}

/// Runs rounds until nothing lies outside, or no more can be done.
///
/// # Errors
///
/// When the model cannot be followed along a case, a program is not solved, or the journal cannot
/// be written; as [`Claim::judge`].
pub(super) fn search<'a>(
    (problem, plant): (&Problem, &'a dyn Plant),
    claim: &dyn Claim,
    journal: &Journal,
    progress: &dyn Progress,
) -> Result<Ended<'a>> {
    let is_exact = plant.is_exact();
    let mut state = journal.load()?.unwrap_or_else(|| SearchState::start(problem.shape()));
    let (mut before, mut near) = (None, Vec::new());
    loop {
        progress.go_on()?;
        // Pose the program, solve it, and take the answer.
        let mut round = plant.round(&mut state, before.take())?;
        let solution = round.program.solve_from(&mut round.rows)?;
        let is_settled =
            state.take(&problem.kinds(), &solution.sets, round.program.cost(&solution.sets));
        journal.save(&state)?;
        if !is_exact {
            progress.finished(&linearised(&state));
            if !is_settled && state.rounds < ROUNDS {
                continue;
            }
        }
        // Look for what lies outside the reachable sets.
        state.reachable_sets += 1;
        let Outside { tube, judged, rows } = match is_exact {
            true => outside_exact(plant, claim, &state.sets, &mut near)?,
            false => outside_enclosed(problem, plant, claim, &state)?,
        };
        let is_lost = rows.iter().any(|row| row.margin.is_infinite());
        let ends = is_lost || state.rounds >= most_rounds(is_exact, &state);
        if ends || rows.is_empty() && judged.furthest.is_empty() {
            if is_exact && claim.tolerance().is_some() {
                progress.finished(&cut(&state));
            }
            return Ok(Ended { state, round, lower_bound: solution.lower_bound, tube });
        }
        // Ask for it in the next round.
        let outside = judged.furthest.iter();
        let outside: Vec<(At, Vec<f64>)> =
            outside.map(|((at, _), point)| (*at, point.direction.clone())).collect();
        let new = state.take_points(&judged, claim.furthest(&outside));
        if !is_exact {
            missing(rows.len(), new, judged.unproved_count())
                .iter()
                .for_each(|m| progress.finished(m));
        }
        state.add(rows);
        journal.save(&state)?;
        before = Some(round);
    }
}

/// Looks for points outside the reachable sets of an exact plant, whose rows hold: among the points
/// near the boundary, and then among all. The list `near` keeps the points of all that
/// may be outside.
fn outside_exact(
    plant: &dyn Plant,
    claim: &dyn Claim,
    sets: &UncertaintySets,
    near: &mut Vec<Near>,
) -> Result<Outside> {
    let Some(tolerance) = claim.tolerance() else { return Ok(Outside::default()) };
    if near.is_empty() {
        near.push(Near { sets: sets.clone(), margin: NEAR });
    }
    let among = |near: &[Near]| -> Result<Judged> {
        let look = Look::Search { tolerance, near: near.to_vec() };
        Ok(claim.judge(plant, sets, &look)?.judged.unwrap_or_default())
    };
    let mut judged = among(near)?;
    if judged.furthest.is_empty() {
        near.push(Near { sets: sets.clone(), margin: 1.0 + tolerance });
        judged = among(&near[near.len() - 1..])?;
    }
    Ok(Outside { judged, ..Outside::default() })
}

/// Encloses the reachable sets, and looks for rows and points outside; rows with what they miss and
/// a little more.
fn outside_enclosed(
    problem: &Problem,
    plant: &dyn Plant,
    claim: &dyn Claim,
    state: &SearchState,
) -> Result<Outside> {
    let look = Look::Proof { at: None, asked: state.asked() };
    let tube = claim.judge(plant, &state.sets, &look)?;
    let mut rows = Vec::new();
    tube.for_each_row(problem, |row| {
        for edge in row.edges.iter().filter(|edge| edge.excess > 0.0) {
            rows.push(Margin {
                case: row.strand,
                sample: row.sample,
                state: row.state,
                side: edge.side,
                margin: MARGIN * edge.excess,
            });
        }
    })?;
    Ok(Outside { judged: tube.judged.clone().unwrap_or_default(), tube: Some(tube), rows })
}

fn most_rounds(is_exact: bool, state: &SearchState) -> usize {
    match (is_exact, state.directions.is_empty()) {
        (true, _) => ROUNDS_OF_CUTS,
        (false, true) => 2 * ROUNDS,
        (false, false) => ROUNDS_OF_POINTS,
    }
}

fn linearised(SearchState { rounds, cost, change, .. }: &SearchState) -> String {
    format!(
        "round {rounds}: the linearised sets cost {cost:.4}; radii and centres changed by \
         {change:.1e}"
    )
}

fn cut(SearchState { rounds, directions, .. }: &SearchState) -> String {
    format!("the cutting planes ended in round {rounds}: directions {}", directions.len())
}

/// Words what lies outside computed sets.
fn missing(rows: usize, directions: usize, points: usize) -> Vec<String> {
    let of_rows = (rows > 0).then(|| {
        format!("{rows} bounds are not enclosed; the next round asks for them with a margin")
    });
    let of_points = (directions > 0).then(|| {
        format!(
            "recorded points that are not proved to lie in the set: {points}; new directions in \
             the next round: {directions}"
        )
    });
    of_rows.into_iter().chain(of_points).collect()
}
