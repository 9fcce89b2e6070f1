use crate::data::envelope::Envelope;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::found::{Deciding, Found};
use crate::hulls::Hulls;
use crate::linear::block::Block;
use crate::linear::program::{Program, TIGHT};
use crate::optimality::optimality_gap;
use crate::sets::UncertaintySets;
use crate::weights::state_weights;

/// Inflations tried after the first repair, each twice the one before.
const REPAIRS: i32 = 60;

/// Finds the smallest sets of a linear model by one program over all suites, and repairs them until
/// every row is proved.
///
/// # Errors
///
/// [`Error::Program`](crate::Error::Program), and as [`Problem::deviations`].
pub(crate) fn smallest_sets(problem: &Problem) -> Result<Found> {
    let program = program(problem)?;
    let solution = program.solve()?;
    let hulls = prove(problem, program.repaired(&solution.sets), program.scale())?;
    let (paper_cost, hull_volume) = program.paper_sums(&hulls.sets);
    let (cost, lower_bound) = (program.cost(&hulls.sets), solution.lower_bound);
    let gap = optimality_gap(cost, lower_bound, program.negligible_cost());
    Ok(Found {
        cost,
        lower_bound: Some(lower_bound),
        optimality_gap: Some(gap),
        paper_cost: Some(paper_cost),
        hull_volume,
        search: None,
        left_out: Vec::new(),
        deciding: Deciding::Touching(TIGHT),
        hulls,
    })
}

/// Returns the program of a linear model and its recordings.
///
/// # Errors
///
/// As [`Problem::deviations`].
pub(crate) fn program(problem: &Problem) -> Result<Program<'_>> {
    let (settings, joints) = (problem.settings(), problem.joints());
    let (grids, deviations) = (problem.grids()?, problem.deviations()?);
    let envelopes: Vec<&Envelope> = deviations.iter().map(|d| &d.envelope).collect();
    let weights = state_weights(&settings.weights, &envelopes, joints);
    let blocks = Block::of_grids(grids.as_slice(), deviations, joints);
    Ok(Program::new(settings, &weights, blocks).with_limits(problem.limits()))
}

/// Makes sets that satisfy every row up to rounding true (docs/method.md, correction H): checks
/// them with directed rounding, and inflates the radii by a growing last bit until the check
/// passes. `scale` is the largest deviation.
///
/// # Errors
///
/// As [`Hulls::new`].
pub(crate) fn prove(problem: &Problem, sets: UncertaintySets, scale: f64) -> Result<Hulls> {
    let mut hulls = Hulls::new(problem, sets.clone())?;
    for attempt in 0..REPAIRS {
        if encloses(problem, &hulls)? {
            break;
        }
        let bit = f64::EPSILON * 2f64.powi(attempt);
        hulls = Hulls::new(problem, sets.inflated(1.0 + bit, bit * scale))?;
    }
    Ok(hulls)
}

/// Returns whether every row holds.
pub(crate) fn encloses(problem: &Problem, hulls: &Hulls) -> Result<bool> {
    let mut all = true;
    hulls.for_each_row(problem, |_, _, row| all &= row.holds())?;
    Ok(all)
}
