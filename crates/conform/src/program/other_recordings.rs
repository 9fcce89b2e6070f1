//! Recordings that a linear program was not made of, beside its sets.

use std::collections::HashSet;
use std::ops::Range;
use std::sync::Arc;

use crate::error::Result;
use crate::program::block::Block;
use crate::program::program::{Program, RowIndex, Solution};
use crate::program::reached::Reached;
use crate::sets::UncertaintySets;
use crate::tube::deviation::Deviation;
use crate::tube::rows::NEGLIGIBLE_RADIUS;

/// States that are as near as this are the same, rad and rad/s: no sensor tells them apart, and the
/// solver leaves a centre of X0 that is as far off as 1e-10 of the largest deviation.
const SAME_STATE: f64 = 1e-9;

impl Program<'_> {
    pub(crate) fn with_deviations<'d>(
        &self,
        deviations: impl IntoIterator<Item = &'d Deviation>,
    ) -> Self {
        let mut program = self.emptied();
        let blocks = &mut program.blocks;
        deviations.into_iter().for_each(|d| blocks[d.strand].envelope.merge(&d.envelope));
        program.scale = program.largest_bound().max(f64::MIN_POSITIVE);
        program
    }

    /// Returns the program without rows.
    fn emptied(&self) -> Self {
        let blocks = self.blocks.iter().map(Block::emptied).collect();
        let Self { settings, shape, step, scale, .. } = *self;
        Self {
            settings,
            shape,
            blocks,
            groups: Arc::clone(&self.groups),
            parts: Arc::clone(&self.parts),
            step,
            weights: self.weights.clone(),
            centre_bounds: self.centre_bounds.clone(),
            limits: self.limits.clone(),
            cost: self.cost.clone(),
            noise_cost: self.noise_cost.clone(),
            scale,
            cuts: self.cuts.clone(),
        }
    }

    /// Returns what [`with_deviations`](Self::with_deviations) does for the deviations of some
    /// suites; this program has the deviations of all. Few bounds differ, and only they are
    /// computed.
    pub(crate) fn with_suites(
        &self,
        deviations: &[Deviation],
        is_kept: impl Fn(usize) -> bool,
    ) -> Self {
        let mut program = self.emptied();
        for (strand, (block, own)) in program.blocks.iter_mut().zip(&self.blocks).enumerate() {
            let facing = deviations.iter().filter(|d| d.strand == strand);
            let (kept, left_out): (Vec<&Deviation>, Vec<&Deviation>) =
                facing.partition(|d| is_kept(d.suite));
            let [kept, left_out] = [kept, left_out]
                .map(|part| part.into_iter().map(|d| &d.envelope).collect::<Vec<_>>());
            block.envelope = own.envelope.without(&left_out, &kept);
        }
        program.scale = program.largest_bound().max(f64::MIN_POSITIVE);
        program
    }

    /// Solves the program as [`solve`](Self::solve) does, and begins with the rows `near`, which
    /// nearly decide the sets of other deviations, and with the last samples. That is faster where
    /// the answer is near those sets.
    pub(crate) fn solve_near(&self, near: &[RowIndex]) -> Result<Solution> {
        let samples = |block: usize| self.blocks[block].envelope.len();
        let is_own = |(block, k, ..): &&RowIndex| *k < samples(*block);
        let mut rows: Vec<RowIndex> = near.iter().filter(is_own).copied().collect();
        let known: HashSet<RowIndex> = rows.iter().copied().collect();
        let begins = |block: usize| self.groups[block] == block;
        let last = self.indices(1);
        let last = last.filter(|(block, k, ..)| begins(*block) && k + 1 == samples(*block));
        rows.extend(last.filter(|row| !known.contains(row)));
        self.solve_from(&mut rows).or_else(|_| self.solve())
    }

    /// Returns the program with the rows of some of its blocks alone: the cost is the same.
    pub(crate) fn with_blocks(&self, keep: impl Fn(usize) -> bool) -> Self {
        let mut program = self.emptied();
        let own = program.blocks.iter_mut().zip(&self.blocks).enumerate();
        own.filter(|(index, _)| keep(*index)).for_each(|(_, (block, own))| *block = own.clone());
        program.scale = program.largest_bound().max(f64::MIN_POSITIVE);
        program
    }

    /// Returns the rows that touch the reach of the sets if they have one. At a first sample that
    /// no recording leaves, all rows touch a set without width, and none decides anything.
    pub(crate) fn deciding(&self, sets: &UncertaintySets) -> Vec<RowIndex> {
        let radius = self.unknowns(sets).radius;
        let has_width =
            |&(b, k, i, _): &RowIndex| self.row(b, k, i).1.dot(&radius) > NEGLIGIBLE_RADIUS;
        self.tight(sets).into_iter().filter(has_width).collect()
    }

    /// Returns the number of rows, both sides together, that do not hold, up to rounding.
    pub(crate) fn outside(&self, sets: &UncertaintySets) -> usize {
        let unknowns = self.unknowns(sets);
        let missed = self.all_reached(&unknowns).filter(|row| self.is_missed(row));
        let mut rows: Vec<_> =
            missed.map(|Reached { index: (b, k, i, _), .. }| (b, k, i)).collect();
        rows.dedup();
        rows.len()
    }

    /// Returns the factors of the radii of X0 alone, of U alone, and of both, with which every row
    /// holds up to rounding; `None` if no factor suffices.
    pub(crate) fn growth_factors(&self, sets: &UncertaintySets) -> [Option<f64>; 3] {
        let (states, all) = (sets.initial_set.dimension(), self.shape.radii());
        [0..states, states..all, 0..all].map(|part| self.factor(sets, part, |_, _| true))
    }

    /// Returns the factor of the radii of X0 and U, or of U alone, with which every row holds.
    pub(crate) fn growth(&self, sets: &UncertaintySets, input_only: bool) -> Option<f64> {
        let first = if input_only { sets.initial_set.dimension() } else { 0 };
        self.factor(sets, first..self.shape.radii(), |_, _| true)
    }

    /// Returns the factors of X0 and of U in turn with which the rows of all `programs` hold, up to
    /// rounding: the factor of the radii of X0 for the rows of first samples, where U has no effect
    /// yet, and then the factor of the radii of U for all other rows; `None` if no factor suffices.
    /// X0 keeps its radii where the noise of the sensors limits it (`input_only`).
    pub(crate) fn growth_in_turn(
        programs: &[Self],
        sets: &UncertaintySets,
        input_only: bool,
    ) -> [Option<f64>; 2] {
        let states = sets.initial_set.dimension();
        let initial = match input_only {
            true => Some(1.0),
            false => {
                Self::largest(programs, |own| own.factor(sets, 0..states, |sample, _| sample == 0))
            }
        };
        let input = initial.and_then(|factor| {
            let grown = sets.with_initial_scaled(factor);
            Self::input_factor(programs, &grown, input_only, |_| true)
        });
        [initial, input]
    }

    /// Returns by which factors the sets of the positions of parts become wider at the last samples
    /// of this program, if X0 and then U grow as the rows of `programs` need it whose state is
    /// asked: X0 in each state by what first samples miss, and U by a factor. The largest factor of
    /// several samples, 1 for each part if no row is missed; `None` if no factor suffices.
    pub(crate) fn wider(
        &self,
        programs: &[Self],
        sets: &UncertaintySets,
        input_only: bool,
        is_asked: impl Fn(usize) -> bool,
    ) -> Option<Vec<f64>> {
        let mut grown = sets.clone();
        for own in programs.iter().filter(|_| !input_only) {
            for row in own.all_reached(&own.unknowns(sets)) {
                let (_, k, i, _) = row.index;
                if k == 0 && is_asked(i) && own.is_missed(&row) {
                    let radius = &mut grown.initial_set.radius[i];
                    *radius = radius.max(sets.initial_set.radius[i] + row.excess);
                }
            }
        }
        let factor = Self::input_factor(programs, &grown, input_only, &is_asked)?;
        let radii = [sets, &grown.with_input_scaled(factor)].map(|sets| self.unknowns(sets).radius);
        let wider = |part: usize| {
            let wider = |b: usize| {
                let last = self.blocks[b].envelope.len().checked_sub(1)?;
                let gains = self.row(b, last, part).1;
                let noise = sets.noise_radius(part);
                let [before, after] = radii.each_ref().map(|radius| gains.dot(radius) + noise);
                (before > NEGLIGIBLE_RADIUS).then(|| after / before)
            };
            (0..self.blocks.len()).filter_map(wider).fold(1.0, f64::max)
        };
        Some((0..self.shape.inputs).map(wider).collect())
    }

    /// Returns the factor of the radii of U with which the rows hold that X0 does not decide alone
    /// and whose state is asked. Where X0 keeps its radii, U must make up for first samples, too.
    fn input_factor(
        programs: &[Self],
        sets: &UncertaintySets,
        input_only: bool,
        is_asked: impl Fn(usize) -> bool,
    ) -> Option<f64> {
        let states = sets.initial_set.dimension();
        let is_left = |k: usize, i: usize| (input_only || k > 0) && is_asked(i);
        Self::largest(programs, |own| own.factor(sets, states..own.shape.radii(), is_left))
    }

    fn largest(programs: &[Self], factor: impl Fn(&Self) -> Option<f64>) -> Option<f64> {
        let mut factors = programs.iter().map(factor);
        factors.try_fold(1.0, |max: f64, factor| factor.map(|factor| max.max(factor)))
    }

    /// Returns whether a row of recordings without which the sets were found leaves them by more
    /// than rounding and the solver's accuracy. Where each motion starts at its own state, X0 may
    /// be as small as these, and no factor of U encloses a first sample that misses it.
    pub(crate) fn is_missed(&self, row: &Reached) -> bool {
        row.excess > SAME_STATE && self.is_violated(row)
    }

    /// Returns the factor of given radii with which the rows of given samples and states hold, up
    /// to rounding; `None` if no factor suffices.
    fn factor(
        &self,
        sets: &UncertaintySets,
        part: Range<usize>,
        is_asked: impl Fn(usize, usize) -> bool,
    ) -> Option<f64> {
        let unknowns = self.unknowns(sets);
        let needed = |row: Reached| {
            let (b, k, i, _) = row.index;
            1.0 + row.excess / self.row(b, k, i).1.dot_of(part.clone(), &unknowns.radius)
        };
        let rows = self.all_reached(&unknowns).filter(|row| is_asked(row.index.1, row.index.2));
        let factor = rows.filter(|row| self.is_missed(row)).map(needed).fold(1.0, f64::max);
        factor.is_finite().then_some(factor)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use reachtube_reach::Hyperrectangle;

    use super::*;
    use crate::data::envelope::Envelope;
    use crate::data::settings::Settings;
    use crate::data::shape::Shape;
    use crate::program::block::Block;

    /// A mass starts at its own state, and the solver left the centre of an empty X0 off by a
    /// little. U cannot mend that, and need not.
    #[test]
    fn a_start_that_the_solver_missed_is_enclosed() {
        let row = |entries: [f64; 3]| [entries, entries].concat();
        let coefficients =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 1.0]].map(row).concat();
        let factors = |centre: f64, end: f64| {
            let mut envelope = Envelope::new(2);
            envelope.include(0, &[0.0, 0.0, 0.5 * end, end]);
            let coefficients = Arc::new(coefficients.clone());
            let (times, scale) = ([0.0, 1.0].into(), [].into());
            let block = Block { times, coefficients, scale, envelope };
            let settings = Settings::default();
            let shape = Shape::of_states(2, 1);
            let program = Program::new((&settings, shape), &[1.0; 2], vec![block]);
            let set = |centre, radius| Hyperrectangle { centre, radius };
            let sets = UncertaintySets {
                initial_set: set(vec![centre; 2], vec![0.0; 2]),
                input_set: set(vec![0.0], vec![1.0]),
                noise_set: None,
            };
            let [_, input, _] = program.growth_factors(&sets);
            (input, program.outside(&sets))
        };
        assert_eq!(factors(4e-11, 0.5), (Some(1.0), 0));
        let (grown, outside) = factors(4e-11, 2.0);
        assert!((grown.unwrap() - 2.0).abs() < 1e-6 && outside == 2, "{grown:?}, {outside}");
        assert_eq!(factors(1e-6, 0.5).0, None, "another start");
    }
}
