//! Evaluation of a nominal model and its sets on a motion that was left out of both.

use std::slice::from_ref;

use crate::error::{Error, Result};
use crate::fit::evaluation::FitTask;
use crate::fit::record::UnseenMotion;
use crate::next_motion::allowance::Missing;
use crate::program::program::Program;

/// A motion that is left out of a fit and of its sets.
pub(crate) struct Unseen<'a> {
    /// The task at every sample, with what limits the sets of the other motions.
    pub whole: FitTask<'a>,
    pub motion: usize,
}

impl Unseen<'_> {
    /// Finds the sets of the other motions for `numbers`, and compares the motion with them. Also
    /// returns the rows of the motion that lie beyond these sets; `None` if a nominal motion
    /// diverges.
    pub(crate) fn compare(&self, numbers: &[f64]) -> Result<(UnseenMotion, Option<Missing>)> {
        let Self { whole, motion } = self;
        let name = whole.data.motions[*motion].clone();
        let others = whole.tracks(Some(*motion));
        let all = whole.tracks(None);
        let own: Vec<usize> = all.iter().copied().filter(|t| !others.contains(t)).collect();
        let model = match whole.model(numbers, &all) {
            Err(Error::RunsAway { .. }) => return Ok((UnseenMotion::runs_away(name), None)),
            model => model?,
        };
        let mut rows = Vec::new();
        let smallest = whole.smallest_from(&model, &others, &mut rows)?;
        let cost = whole.smallest_from(&model, &all, &mut rows)?.cost_by_time;
        let program = whole.program(&model, &own);
        let input_only = whole.settings.nominal.is_measured();
        let growth = program.growth(&smallest.sets, input_only);
        let own_rows = from_ref(&program);
        let [initial_growth, input_growth] =
            Program::growth_in_turn(own_rows, &smallest.sets, input_only);
        let wider = program.wider(own_rows, &smallest.sets, input_only, |_| true);
        let wider = wider.map(|parts| parts.into_iter().fold(1.0, f64::max));
        let of_track = |t: &usize| {
            let own = whole.program(&model, &[*t]);
            [own.outside(&smallest.sets), own.rows() / 2]
        };
        let [outside, rows] =
            own.iter().map(of_track).fold([0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        let mut missing = Missing::new();
        program.missing(&smallest.sets, &mut missing);
        let unseen = UnseenMotion {
            motion: name,
            cost: Some(cost),
            cost_without: Some(smallest.cost_by_time),
            growth,
            initial_growth,
            input_growth,
            wider,
            grown_cost: growth.map(|growth| program.cost(&smallest.sets.grown(growth, input_only))),
            outside: Some(outside),
            rows,
        };
        Ok((unseen, Some(missing)))
    }
}
