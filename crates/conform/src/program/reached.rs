//! How far rows of the program lie beyond the reach of sets.

use std::collections::{BTreeMap, HashSet};

use crate::data::side::Side;
use crate::program::dot::dot;
use crate::program::gains::Gains;
use crate::program::program::{Program, ROUNDING, RowIndex, TIGHT, Unknowns};
use crate::sets::UncertaintySets;

/// A row counts as violated beyond this part of its own size.
const TOLERANCE: f64 = 1e-10;

/// Number of windows of the horizon; each adds its worst violated row to the next round.
const WINDOWS: usize = 24;

/// A row beside sets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reached {
    pub index: RowIndex,
    /// Deviation minus reach, unrounded.
    pub excess: f64,
    /// The part of the reach that the radii of X0 and U give.
    pub radius: f64,
}

impl Program<'_> {
    /// The right-hand side of a row: the deviation along its direction, less the known noise.
    pub(super) fn bound(&self, (b, k, i, side): RowIndex) -> f64 {
        let envelope = &self.blocks[b].envelope;
        let known = self.settings.noise.known(i);
        match side {
            Side::Upper => envelope.upper(k, i) - known,
            Side::Lower => -envelope.lower(k, i) - known,
        }
    }

    pub(crate) fn reached(&self, index: RowIndex, unknowns: &Unknowns) -> Reached {
        let (b, k, i, _) = index;
        let (centre, Gains { gains, .. }) = self.row(b, k, i);
        let reach = [dot(centre, &unknowns.centre), dot(gains, unknowns.radius_of(b))];
        self.beside(index, reach, unknowns)
    }

    pub(crate) fn all_reached(&self, unknowns: &Unknowns) -> impl Iterator<Item = Reached> {
        let states = self.settings.states.rows(self.shape.outputs);
        let samples = self
            .blocks
            .iter()
            .enumerate()
            .flat_map(|(b, block)| (0..block.envelope.len()).map(move |k| (b, k)));
        let rows = samples.flat_map(move |(b, k)| (0..states).map(move |i| (b, k, i)));
        rows.flat_map(move |(b, k, i)| {
            let (centre, Gains { gains, .. }) = self.row(b, k, i);
            let reach = [dot(centre, &unknowns.centre), dot(gains, unknowns.radius_of(b))];
            Side::BOTH.map(|side| self.beside((b, k, i, side), reach, unknowns))
        })
    }

    /// Compares a row with the centre of the sets' reach, and with the radius that the radii of X0
    /// and U give it.
    fn beside(&self, index: RowIndex, [centre, radius]: [f64; 2], unknowns: &Unknowns) -> Reached {
        let (_, _, i, side) = index;
        let reach = side.sign() * centre + radius;
        let excess = self.bound(index) - reach - unknowns.free_noise[i];
        Reached { index, excess, radius }
    }

    /// Returns the worst violated row of each window, state and side, over the blocks that share
    /// their coefficients, that is not among `known` yet.
    pub(super) fn violated(&self, sets: &UncertaintySets, known: &[RowIndex]) -> Vec<RowIndex> {
        let unknowns = self.unknowns(sets);
        let known: HashSet<&RowIndex> = known.iter().collect();
        let mut worst: BTreeMap<(usize, usize, usize, bool), (f64, RowIndex)> = BTreeMap::new();
        for row in self.all_reached(&unknowns) {
            let Reached { index, excess, .. } = row;
            if !self.is_violated(&row) || known.contains(&index) {
                continue;
            }
            let (b, k, i, side) = index;
            let window = k * WINDOWS / self.blocks[b].envelope.len();
            let key = (self.groups[b], window, i, side == Side::Upper);
            let entry = worst.entry(key).or_insert((excess, index));
            if excess > entry.0 {
                *entry = (excess, index);
            }
        }
        worst.into_values().map(|(_, index)| index).collect()
    }

    /// Returns whether a row misses more than rounding.
    pub(crate) fn is_violated(&self, row: &Reached) -> bool {
        let size = || self.bound(row.index).abs().max(row.radius);
        row.excess > ROUNDING * self.scale && row.excess > TOLERANCE * size()
    }

    /// Returns the rows that touch the hull of the sets' reach, within 1e-6 of its radius.
    pub(crate) fn tight(&self, sets: &UncertaintySets) -> Vec<RowIndex> {
        let unknowns = self.unknowns(sets);
        let rows = self.all_reached(&unknowns).filter(|row| touches(row, &unknowns));
        rows.map(|row| row.index).collect()
    }

    pub(crate) fn tight_among(
        &self,
        rows: impl Iterator<Item = RowIndex>,
        sets: &UncertaintySets,
    ) -> Vec<RowIndex> {
        let unknowns = self.unknowns(sets);
        let own = rows.filter(|(b, k, ..)| *k < self.blocks[*b].envelope.len());
        own.filter(|index| touches(&self.reached(*index, &unknowns), &unknowns)).collect()
    }

    pub(crate) fn keep_close(&self, rows: &mut Vec<RowIndex>, sets: &UncertaintySets, part: f64) {
        let unknowns = self.unknowns(sets);
        rows.retain(|row| self.reached(*row, &unknowns).excess > -part * self.scale);
    }
}

fn touches(row: &Reached, unknowns: &Unknowns) -> bool {
    row.excess >= -TIGHT * (row.radius + unknowns.free_noise[row.index.2])
}
