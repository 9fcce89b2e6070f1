//! The growth of sets under which computed outer sets enclose suites.

use rayon::prelude::*;

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::sets::UncertaintySets;
use crate::tube::flowpipes::{Effort, Enclosed, enclosed};

/// Ratio of the factors that are tried for a model that is not linear.
pub(super) const STEP: f64 = 1.01;

/// The first step away from a guess, in powers of [`STEP`].
const FIRST_STEP: i32 = 8;

/// Number of factors that are tried at most, as powers of [`STEP`]: up to 160.
const MOST_STEPS: i32 = 512;

/// The gauge of suites by computed outer sets.
pub(super) enum OuterGauge {
    /// The least factor that was found to suffice.
    Factor(f64),
    /// No factor suffices.
    None,
    /// The reachable sets are lost under this factor, and less does not suffice.
    Lost(f64),
}

/// Accuracy of a gauge that only describes, as a number of powers of [`STEP`]: 8 %.
pub(super) const COARSE: i32 = FIRST_STEP;

/// Returns the gauge of the suites that are marked by the computed outer sets: a power of [`STEP`]
/// that suffices, of which the power that is `finest` lower does not. It is assumed that larger
/// sets have larger outer sets, and that sets larger than one whose reachable set is lost lose
/// theirs too. The search begins at `guess`.
pub(super) fn outer_gauge(
    problem: &Problem,
    suites: &[bool],
    effort: Effort,
    (guess, finest): (f64, i32),
    grown: &(impl Fn(f64) -> UncertaintySets + Sync),
) -> Result<OuterGauge> {
    let cases: Vec<&Case> = problem.cases()?.iter().filter(|case| suites[case.suite]).collect();
    let answer = |steps: i32| {
        let sets = grown(STEP.powi(steps));
        let of_case = |case: &&Case| enclosed(problem, case, &sets, effort);
        let worse = |a: Enclosed, b: Enclosed| Ok(a.max(b));
        cases.par_iter().map(of_case).try_reduce(|| Enclosed::Yes, worse)
    };
    // Look about the guess, in steps that double, then halve the interval: `low` does not suffice,
    // and what `high` does is known.
    let guess = (guess.ln() / STEP.ln()).ceil() as i32;
    let (mut low, mut high) = (-1, guess.clamp(0, MOST_STEPS));
    let (mut at_high, mut step) = (answer(high)?, FIRST_STEP);
    if at_high == Enclosed::No {
        while at_high == Enclosed::No && high < MOST_STEPS {
            (low, high, step) = (high, (high + step).min(MOST_STEPS), 2 * step);
            at_high = answer(high)?;
        }
    } else {
        while high - step > low {
            match answer(high - step)? {
                Enclosed::No => low = high - step,
                other => (high, at_high, step) = (high - step, other, 2 * step),
            }
        }
    }
    while high - low > finest && at_high != Enclosed::No {
        let middle = i32::midpoint(low, high);
        match answer(middle)? {
            Enclosed::No => low = middle,
            other => (high, at_high) = (middle, other),
        }
    }
    let factor = STEP.powi(high);
    Ok(match at_high {
        Enclosed::Yes => OuterGauge::Factor(factor),
        Enclosed::No => OuterGauge::None,
        Enclosed::Lost => OuterGauge::Lost(factor),
    })
}
