//! One step of a fit: a linear program in the sets and the parameters together.
//!
//! With the nominal motion x̂ and the rows E, R at the present parameters, and their derivatives
//! along the present sets (c, r), the sets (c', r') and a change p of the parameters must satisfy,
//! for each case, sample and state,
//!
//! ± E c' + R r' + (± ∂x̂ ± ∂E c + ∂R r) p >= ± (x_m - x̂),
//!
//! and cost w r' + (∂w r) p plus the pull, within the trust region.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use rayon::prelude::*;

use crate::data::side::Side;
use crate::error::Result;
use crate::fit::evaluation::{FitModel, FitTask, Smallest, StepRow};
use crate::fit::slopes::Slope;
use crate::program::dot::dot;
use crate::program::layout::Layout;
use crate::program::program::Program;
use crate::program::solver::{Triplets, solve_cone};

/// A row counts as violated beyond this part of the largest row.
const TOLERANCE: f64 = 1e-7;

/// Windows of the horizon at most; each adds its worst violated row. The time of the solver grows
/// with the rows, and more rounds of fewer rows take less time.
const WINDOWS: usize = 6;

/// Samples of a window at least.
const SAMPLES: usize = 4;

/// Rounds of row generation at most.
const ROUNDS: usize = 25;

/// Rows within this part of the largest deviation are kept for the next step.
const CLOSE: f64 = 0.005;

/// The weight of the pull at least, in parts of the cost: without any, the program has no unique
/// answer where a parameter does nothing.
const LEAST_PULL: f64 = 1e-6;

/// How much each of the sets' numbers may cost more or less after a step, in parts of the cost and
/// per unit of the trust region. The derivatives of the rows are those along the present sets.
/// Where other sets cost nearly as little, a step that left them would promise what no step gains.
const SET_TRUST: f64 = 0.1;

/// The tolerance of the solver. A step need not be exact: the cost at its end decides.
const SOLVER_TOLERANCE: f64 = 1e-8;

/// The program of one step.
pub(crate) struct StepProgram<'a> {
    pub fit: &'a FitTask<'a>,
    pub model: &'a FitModel,
    pub slopes: &'a [Slope],
    pub program: &'a Program<'a>,
    /// The tracks whose rows count.
    pub tracks: &'a [usize],
    pub numbers: &'a [f64],
    /// The smallest sets at the present parameters.
    pub smallest: &'a Smallest,
    /// How far each number may move.
    pub trust: f64,
    /// The parameters that may move. After the sets, the unknowns are their numbers, and then
    /// bounds of the absolute values of these numbers.
    pub free: &'a [usize],
    /// Cost of a number's distance from 0.
    pub pull: f64,
}

/// What rows reach at some unknowns, the numbers of the parameters included.
struct Reach {
    /// How far each nominal motion moves at the samples that have rows, samples x 2n; empty for
    /// other tracks.
    motions: Vec<Vec<f64>>,
    /// For each grid samples x 2n pairs: what the centres give to the upper side and take from the
    /// lower one, and what the radii give to both.
    grids: Vec<Vec<[f64; 2]>>,
    /// Radii of V that are unknown, 2n.
    noise: Vec<f64>,
}

/// Where a step leads.
pub(crate) struct StepSolution {
    pub numbers: Vec<f64>,
    /// The cost and the pull that the linearised program foretells.
    pub cost: f64,
}

impl StepProgram<'_> {
    /// Solves the step by row generation. `rows` are the first rows, or none, and become the rows
    /// that nearly decide the answer.
    pub(crate) fn solve(&self, rows: &mut Vec<StepRow>) -> Result<StepSolution> {
        if rows.is_empty() {
            rows.extend(&self.smallest.deciding);
        }
        let (mut unknowns, mut cost) = self.solve_rows(rows)?;
        let mut reach = self.reach_of(&unknowns);
        for _ in 0..ROUNDS {
            let added = self.violated(&reach, rows);
            if added.is_empty() {
                break;
            }
            rows.extend(added);
            (unknowns, cost) = self.solve_rows(rows)?;
            reach = self.reach_of(&unknowns);
        }
        // The rows that nearly decide the answer are kept for the next step.
        let limit = -CLOSE * self.program.scale();
        rows.retain(|row| self.excess(&reach, *row) > limit);
        Ok(StepSolution { numbers: self.numbers_of(&unknowns), cost })
    }

    fn layout(&self) -> Layout {
        let Program { shape, cost, noise_cost, .. } = &self.program;
        Layout::new(self.fit.settings, *shape, cost, noise_cost)
    }

    fn numbers_of(&self, unknowns: &[f64]) -> Vec<f64> {
        let free = self.free;
        let mut numbers = self.numbers.to_vec();
        for (p, x) in free.iter().zip(&unknowns[unknowns.len() - 2 * free.len()..]) {
            numbers[*p] = *x;
        }
        numbers
    }

    fn moved(&self, unknowns: &[f64]) -> Vec<f64> {
        let pairs = self.numbers_of(unknowns).into_iter().zip(self.numbers);
        pairs.map(|(new, here)| new - here).collect()
    }

    fn samples(&self, track: usize) -> usize {
        self.model.motions[track].len() / self.fit.states()
    }

    /// The entries of E and of R in one row.
    fn reach(&self, track: usize, k: usize, i: usize) -> (&[f64], &[f64]) {
        let n = self.fit.inputs();
        let grid = self.fit.data.tracks[track].grid;
        let start = (k * 2 * n + i) * 6 * n;
        self.model.coefficients[grid][start..start + 6 * n].split_at(3 * n)
    }

    /// The derivative of a row with respect to parameter `p`.
    fn slope(&self, p: usize, (t, k, i, side): StepRow) -> f64 {
        let states = self.fit.states();
        let slope = &self.slopes[p];
        let motion = side.sign() * slope.motions[t][k * states + i];
        slope.reach.as_ref().map_or(motion, |reach| {
            let [centre, radius] = reach[self.fit.data.tracks[t].grid][k * states + i];
            motion + side.sign() * centre + radius
        })
    }

    /// The derivative of the cost of the present sets with respect to each parameter.
    fn cost_slopes(&self) -> Vec<f64> {
        let n = self.fit.inputs();
        let of = |slope: &Slope| {
            let Some(reach) = &slope.reach else { return 0.0 };
            let blocks = reach.iter().zip(&*self.program.parts);
            blocks
                .map(|(reach, parts)| {
                    let samples = reach.chunks_exact(2 * n).zip(parts);
                    samples
                        .map(|(rows, part)| {
                            let states = rows.iter().zip(&self.fit.weights);
                            2.0 * part * states.map(|([_, r], s)| s * r).sum::<f64>()
                        })
                        .sum::<f64>()
                })
                .sum()
        };
        self.slopes.iter().map(of).collect()
    }

    fn entries(&self, row: StepRow, layout: &Layout) -> Vec<(usize, f64)> {
        let (t, k, i, side) = row;
        let (centre, radius) = self.reach(t, k, i);
        let mut entries = layout.entries(centre, radius.iter().copied(), i, side);
        let slopes = self.free.iter().map(|&p| self.slope(p, row));
        entries.extend(slopes.enumerate().map(|(at, slope)| (layout.cost.len() + at, slope)));
        entries
    }

    /// Solves with these rows only; returns the unknowns and their cost.
    fn solve_rows(&self, rows: &[StepRow]) -> Result<(Vec<f64>, f64)> {
        let (layout, free) = (self.layout(), self.free);
        let (sets, count) = (layout.cost.len(), free.len());
        let scale = self.program.scale();
        let units = self.program.units(&layout, Some(&self.smallest.sets));
        let units = units.into_iter().map(|unit| unit * scale);
        let unit: Vec<f64> = units.chain(std::iter::repeat_n(1.0, 2 * count)).collect();
        let (mut matrix, mut bounds) = (Triplets::default(), Vec::new());
        for &row in rows {
            let entries = self.entries(row, &layout);
            let size = entries.iter().map(|(j, a)| (a * unit[*j]).abs()).fold(0.0, f64::max);
            matrix.row(entries.into_iter().map(|(j, a)| (j, -a * unit[j] / size)));
            let present = free.iter().map(|&p| self.slope(p, row) * self.numbers[p]);
            bounds.push(-(self.fit.deviation(self.model, row) + present.sum::<f64>()) / size);
        }
        layout.restrict(self.fit.settings.centre, &mut matrix, &mut bounds, &unit);
        layout.limit(&self.fit.limits, &mut matrix, &mut bounds, &unit);
        let total = self.smallest.cost.max(self.program.negligible_in_steps());
        let present = layout.unknowns(&self.smallest.sets);
        for (j, (here, w)) in present.iter().zip(&layout.cost).enumerate() {
            let most = self.trust * SET_TRUST * total / w;
            matrix.row([(j, 1.0)]);
            matrix.row([(j, -1.0)]);
            bounds.extend([(here + most) / unit[j], (most - here) / unit[j]]);
        }
        for (at, &p) in free.iter().enumerate() {
            let (number, size) = (sets + at, sets + count + at);
            let [low, high] = self.fit.parameters.list()[p].bounds;
            matrix.row([(number, 1.0), (size, -1.0)]);
            matrix.row([(number, -1.0), (size, -1.0)]);
            matrix.row([(number, 1.0)]);
            matrix.row([(number, -1.0)]);
            let (top, bottom) = (self.numbers[p] + self.trust, self.numbers[p] - self.trust);
            bounds.extend([0.0, 0.0, top.min(high), -bottom.max(low)]);
        }
        self.keep_conditions(sets, &mut matrix, &mut bounds);
        let slopes = self.cost_slopes();
        let pull = self.pull.max(LEAST_PULL * total);
        let of_set = |(j, w): (usize, &f64)| {
            if j < layout.centres() { 0.0 } else { w * unit[j] / total }
        };
        let mut objective: Vec<f64> = layout.cost.iter().enumerate().map(of_set).collect();
        objective.extend(free.iter().map(|&p| slopes[p] / total));
        objective.extend(free.iter().map(|_| pull / total));
        let found = solve_cone(&objective, &matrix, &bounds, SOLVER_TOLERANCE)?.found;
        let value: f64 = found.iter().zip(&objective).map(|(x, w)| x * w).sum();
        let present: f64 = free.iter().map(|&p| slopes[p] * self.numbers[p]).sum();
        let held = (0..self.numbers.len()).filter(|p| !free.contains(p));
        let held: f64 = held.map(|p| pull * self.numbers[p].abs()).sum();
        let unknowns = found.iter().zip(&unit).map(|(x, unit)| x * unit).collect();
        Ok((unknowns, value * total - present + held))
    }

    /// Keeps the conditions of the parameters; the numbers are the unknowns from `first` on.
    fn keep_conditions(&self, first: usize, matrix: &mut Triplets, bounds: &mut Vec<f64>) {
        for (entries, mut bound) in self.fit.parameters.conditions(self.numbers) {
            let place = |p: usize| self.free.iter().position(|own| *own == p);
            let mut own = Vec::new();
            for (p, factor) in entries {
                match place(p) {
                    Some(at) => own.push((first + at, factor)),
                    None => bound -= factor * self.numbers[p],
                }
            }
            if !own.is_empty() {
                matrix.row(own);
                bounds.push(bound);
            }
        }
    }

    fn reach_of(&self, unknowns: &[f64]) -> Reach {
        let (layout, moved) = (self.layout(), self.moved(unknowns));
        let (n, centres) = (self.fit.inputs(), layout.centres());
        // Derivatives of numbers that are held are not known, and not needed.
        let moved: Vec<(&Slope, f64)> =
            self.slopes.iter().zip(moved).filter(|(_, x)| *x != 0.0).collect();
        let mut motions = vec![Vec::new(); self.model.motions.len()];
        let of_track = |&t: &usize| {
            let mut change = vec![0.0; self.model.motions[t].len()];
            for (slope, x) in &moved {
                change.iter_mut().zip(&slope.motions[t]).for_each(|(sum, slope)| *sum += slope * x);
            }
            (t, change)
        };
        let changes: Vec<(usize, Vec<f64>)> = self.tracks.par_iter().map(of_track).collect();
        changes.into_iter().for_each(|(t, change)| motions[t] = change);
        let (centre, radius) = unknowns.split_at(centres);
        let of_grid = |(g, rows): (usize, &Arc<Vec<f64>>)| {
            let own = rows.chunks_exact(6 * n).map(|row| {
                let (of_centre, of_radius) = row.split_at(3 * n);
                [dot(&of_centre[..centres], centre), dot(of_radius, &radius[..3 * n])]
            });
            let mut sums: Vec<[f64; 2]> = own.collect();
            for (slope, x) in &moved {
                let changed = slope.reach.iter().flat_map(|reach| &reach[g]);
                for (sum, slope) in sums.iter_mut().zip(changed) {
                    *sum = [sum[0] + slope[0] * x, sum[1] + slope[1] * x];
                }
            }
            sums
        };
        let grids = self.model.coefficients.iter().enumerate().map(of_grid).collect();
        let noise = unknowns.get(centres + 3 * n..).unwrap_or_default();
        let has_noise = layout.cost.len() > centres + 3 * n;
        let noise = if has_noise { noise[..2 * n].to_vec() } else { vec![0.0; 2 * n] };
        Reach { motions, grids, noise }
    }

    fn excess(&self, reach: &Reach, row: StepRow) -> f64 {
        let (t, k, i, side) = row;
        let at = k * self.fit.states() + i;
        let [centre, radius] = reach.grids[self.fit.data.tracks[t].grid][at];
        let reached = side.sign() * (reach.motions[t][at] + centre) + radius + reach.noise[i];
        self.fit.deviation(self.model, row) - reached
    }

    fn violated(&self, reach: &Reach, known: &[StepRow]) -> Vec<StepRow> {
        let known: HashSet<StepRow> = known.iter().copied().collect();
        let states = self.fit.settings.states.rows(self.fit.states());
        let limit = TOLERANCE * self.program.scale();
        type Worst = BTreeMap<(usize, usize, usize, bool), (f64, StepRow)>;
        let take = |worst: &mut Worst, key, excess: f64, row| {
            let entry = worst.entry(key).or_insert((excess, row));
            if excess > entry.0 {
                *entry = (excess, row);
            }
        };
        let of_track = |&t: &usize| {
            let mut worst = Worst::new();
            let (samples, grid) = (self.samples(t), self.fit.data.tracks[t].grid);
            let windows = WINDOWS.min(samples.div_ceil(SAMPLES));
            for k in 0..samples {
                for i in 0..states {
                    for side in Side::BOTH {
                        let row = (t, k, i, side);
                        let excess = self.excess(reach, row);
                        if excess > limit && !known.contains(&row) {
                            let key = (grid, k * windows / samples, i, side == Side::Upper);
                            take(&mut worst, key, excess, row);
                        }
                    }
                }
            }
            worst
        };
        let parts: Vec<Worst> = self.tracks.par_iter().map(of_track).collect();
        let mut all = Worst::new();
        for (key, (excess, row)) in parts.into_iter().flatten() {
            take(&mut all, key, excess, row);
        }
        all.into_values().map(|(_, row)| row).collect()
    }
}
