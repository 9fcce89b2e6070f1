//! The linear program: the smallest sets whose reachable hull reaches as far as the deviations.
//!
//! Unknowns are the centres c = (c_x, c_u), the radii r = (r_x, r_u) and, where the noise is free,
//! its radii r_v. For each sample k and state i, with E_k = (e^{A t_k}, Γ(t_k)) and
//! R_k = (|e^{A t_k}|, κ(t_k)):
//!
//! -  (E_k c)_i + (R_k r)_i + r_v,i >= max d_i(t_k)
//! - -(E_k c)_i + (R_k r)_i + r_v,i >= max -d_i(t_k)
//!
//! and the cost is Σ_k w_k Σ_i s_i 2 ((R_k r)_i + r_v,i), where w_k is the time for which sample k
//! stands, and blocks at one time count by their mean (docs/method.md, corrections A, E and F).
//! Inside the program w_k is counted in mean steps.

use std::sync::Arc;

use reachtube_reach::Hyperrectangle;

use crate::data::settings::{Noise, Settings};
use crate::data::shape::Shape;
use crate::data::side::Side;
use crate::error::{Error, Result};
use crate::program::block::Block;
use crate::program::costs::{SampleTimes, cost};
use crate::program::cut::Cut;
use crate::program::dot::dot;
use crate::program::gains::Gains;
use crate::program::layout::{Layout, Limits};
use crate::program::solver::{FINE, Triplets, polished, solve_cone};
use crate::search::optimality::optimality_gap;
use crate::sets::UncertaintySets;

/// A row within this part of the radius of the reachable set is called tight.
pub(crate) const TIGHT: f64 = 1e-6;

/// Rows within this part of the largest deviation nearly decide the sets.
pub(crate) const CLOSE: f64 = 0.02;

/// The least size of the unknowns: recordings may agree exactly.
const LEAST_SCALE: f64 = 1e-12;

/// What is below this part of the largest deviation is rounding.
pub(super) const ROUNDING: f64 = 1e-14;

/// Rounds of row generation at most.
const ROUNDS: usize = 200;

/// The program is solved again with units of the solution's size while the gap is above this.
const GAP: f64 = 1e-8;

/// How often the program is solved with other units at most.
const SCALINGS: usize = 4;

/// The program.
#[derive(Clone)]
pub(crate) struct Program<'a> {
    pub(super) settings: &'a Settings,
    pub(crate) shape: Shape,
    pub(super) blocks: Vec<Block>,
    /// For each block, the first one with the same coefficients.
    pub(super) groups: Arc<[usize]>,
    /// For each block and sample, the time for which it stands, in mean steps.
    pub(crate) parts: Arc<Vec<Vec<f64>>>,
    /// The mean step, s.
    pub(super) step: f64,
    /// The weight of each state, s.
    pub(super) weights: Vec<f64>,
    /// Between what each centre (c_x, c_u) must lie, where that is restricted.
    pub(super) centre_bounds: Vec<[f64; 2]>,
    pub(super) limits: Limits,
    /// Cost of each radius (r_x, r_u), in mean steps.
    pub(crate) cost: Vec<f64>,
    /// Cost of each noise radius, in mean steps.
    pub(crate) noise_cost: Vec<f64>,
    /// Largest |d| in the checked states, at least the smallest normal number.
    pub(super) scale: f64,
    /// Rows in directions other than the states.
    pub(crate) cuts: Vec<Cut>,
}

/// The answer of the solver.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Solution {
    /// The sets; their rows hold to the solver's tolerance only.
    pub sets: UncertaintySets,
    /// The dual objective: no sets that satisfy the rows cost less, up to the solver's tolerance.
    pub lower_bound: f64,
    /// Number of rows in the whole program.
    pub rows: usize,
    /// Number of rows that were generated.
    pub generated: usize,
    /// Rounds of row generation.
    pub rounds: usize,
}

/// Where a row of the program stands: block, sample, state, side.
pub(crate) type RowIndex = (usize, usize, usize, Side);

impl<'a> Program<'a> {
    pub(crate) fn new(
        (settings, shape): (&'a Settings, Shape),
        weights: &[f64],
        blocks: Vec<Block>,
    ) -> Self {
        let times = blocks.iter().map(|block| &*block.times);
        let SampleTimes { parts, step } = SampleTimes::new(times);
        let (cost, noise_cost) = cost(shape, &blocks, &parts, weights);
        let mut program = Self {
            settings,
            shape,
            groups: Block::groups(&blocks),
            blocks,
            parts: Arc::new(parts),
            step,
            weights: weights.to_vec(),
            centre_bounds: Vec::new(),
            limits: Limits::default(),
            cost,
            noise_cost,
            scale: LEAST_SCALE,
            cuts: Vec::new(),
        };
        program.scale = program.largest_bound().max(LEAST_SCALE);
        program
    }

    pub(crate) fn with_centre_bounds(self, centre_bounds: Vec<[f64; 2]>) -> Self {
        Self { centre_bounds, ..self }
    }

    pub(crate) fn with_limits(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }

    /// Returns the number of rows of the whole program, each side counted.
    pub(crate) fn rows(&self) -> usize {
        let states = self.settings.states.rows(self.shape.outputs);
        self.blocks.iter().map(|block| 2 * states * block.envelope.len()).sum()
    }

    /// Solves the program by row generation: few of the rows decide, and only they are handed to
    /// the solver.
    ///
    /// # Errors
    ///
    /// [`Error::Program`] when the solver does not reach an optimum.
    pub(crate) fn solve(&self) -> Result<Solution> {
        self.solve_from(&mut self.first_rows())
    }

    /// Solves the program as [`solve`](Self::solve) does, with the rows `indices` first; takes the
    /// rows that were added.
    pub(crate) fn solve_from(&self, indices: &mut Vec<RowIndex>) -> Result<Solution> {
        let mut best: Option<(f64, Solution)> = None;
        let mut scalings = 0;
        for round in 1..=ROUNDS {
            let near = best.as_ref().map(|(_, solution)| &solution.sets);
            let (candidates, lower_bound) = match self.solve_rows(indices, near) {
                Err(_) if best.is_some() => break,
                answer => answer?,
            };
            let added = self.violated(&candidates[0], indices);
            if !added.is_empty() {
                indices.extend(added);
                continue;
            }
            let (rows, generated) = (self.rows(), indices.len());
            for sets in candidates {
                let negligible = self.negligible_in_steps();
                let gap = optimality_gap(self.repaired_cost(&sets), lower_bound, negligible);
                if best.as_ref().is_none_or(|(least, _)| gap < *least) {
                    let lower_bound = self.step * lower_bound;
                    let solution = Solution { sets, lower_bound, rows, generated, rounds: round };
                    best = Some((gap, solution));
                }
            }
            scalings += 1;
            if best.as_ref().is_some_and(|(gap, _)| *gap <= GAP) || scalings == SCALINGS {
                break;
            }
        }
        if let Some((_, solution)) = best {
            return Ok(solution);
        }
        Err(Error::Program(format!(
            "{ROUNDS} rounds of row generation left violated rows; report this with the data"
        )))
    }

    pub(super) fn largest_bound(&self) -> f64 {
        self.indices(1).map(|index| self.bound(index).abs()).fold(0.0, f64::max)
    }

    pub(crate) fn indices(&self, stride: usize) -> impl Iterator<Item = RowIndex> + '_ {
        let states = self.settings.states.rows(self.shape.outputs);
        self.blocks.iter().enumerate().flat_map(move |(b, block)| {
            (0..block.envelope.len()).step_by(stride).flat_map(move |k| {
                (0..states).flat_map(move |i| Side::BOTH.map(|side| (b, k, i, side)))
            })
        })
    }

    pub(crate) fn first_rows(&self) -> Vec<RowIndex> {
        let longest = self.blocks.iter().map(|block| block.envelope.len()).max().unwrap_or(0);
        let indices = self.indices((longest / 8).max(1));
        // What no set reaches, such as an output before an input acts on it, is no row.
        let is_reached = |(b, k, i, _): &RowIndex| self.row(*b, *k, *i).1.iter().any(|a| a > 0.0);
        indices.filter(|(b, ..)| self.groups[*b] == *b).filter(is_reached).collect()
    }

    /// The entries of E_k and of R_k in row i.
    pub(crate) fn row(&self, b: usize, k: usize, i: usize) -> (&[f64], Gains<'_>) {
        let width = self.shape.radii();
        let start = k * self.shape.entries() + i * 2 * width;
        let Block { coefficients, scale, .. } = &self.blocks[b];
        let (centre, gains) = coefficients[start..start + 2 * width].split_at(width);
        (centre, Gains { gains, scale })
    }

    pub(crate) fn run(&self, (b, k, i, side): RowIndex) -> u32 {
        let envelope = &self.blocks[b].envelope;
        match side {
            Side::Upper => envelope.upper_run(k, i),
            Side::Lower => envelope.lower_run(k, i),
        }
    }

    pub(crate) fn unknowns(&self, sets: &UncertaintySets) -> Unknowns {
        let join = |pick: fn(&Hyperrectangle) -> &Vec<f64>| -> Vec<f64> {
            pick(&sets.initial_set).iter().chain(pick(&sets.input_set)).copied().collect()
        };
        let free = self.settings.noise == Noise::Fitted;
        let noise = |i: usize| if free { sets.noise_radius(i) } else { 0.0 };
        let radius = join(|set| &set.radius);
        let scaled = self.blocks.iter().map(|block| block.scaled(&radius)).collect();
        Unknowns {
            centre: join(|set| &set.centre),
            radius,
            scaled,
            free_noise: (0..self.shape.outputs).map(noise).collect(),
        }
    }

    /// Solves with the rows `indices` only, with units for sets `near` the optimum where such are
    /// known; returns the sets as found and polished, and the dual objective in mean steps.
    fn solve_rows(
        &self,
        indices: &[RowIndex],
        near: Option<&UncertaintySets>,
    ) -> Result<([UncertaintySets; 2], f64)> {
        let layout = Layout::new(self.settings, self.shape, &self.cost, &self.noise_cost);
        // Scale: each unknown as `units` says, each row so that its largest entry is 1.
        let unit = self.units(&layout, near);
        let largest_cost = layout.cost.iter().zip(&unit).map(|(w, u)| w * u).fold(0.0, f64::max);
        let (triplets, bounds) = self.constraints(indices, &layout, &unit);
        let weigh = |(j, w): (usize, &f64)| {
            if j < layout.centres() { 0.0 } else { w * unit[j] / largest_cost }
        };
        let objective: Vec<f64> = layout.cost.iter().enumerate().map(weigh).collect();
        let optimum = solve_cone(&objective, &triplets, &bounds, FINE)?;
        let polished = polished(&optimum, &triplets, &bounds);
        // Undo the scaling.
        let sets = |x: &[f64]| {
            let unknowns: Vec<f64> =
                x.iter().zip(&unit).map(|(x, unit)| x * unit * self.scale).collect();
            layout.sets(&unknowns, self.settings)
        };
        let lower_bound = optimum.dual * self.scale * largest_cost + self.fixed_cost();
        Ok(([sets(&optimum.found), sets(&polished)], lower_bound))
    }

    /// The scaled rows `indices`, the signs of the radii, and the bounds of the centres.
    fn constraints(
        &self,
        indices: &[RowIndex],
        layout: &Layout,
        unit: &[f64],
    ) -> (Triplets, Vec<f64>) {
        let mut triplets = Triplets::default();
        let mut bounds = Vec::new();
        for &index in indices {
            let (b, k, i, side) = index;
            let (centre, radius) = self.row(b, k, i);
            let entries = layout.entries(centre, radius.iter(), i, side);
            let scale = entries.iter().map(|(j, a)| (a * unit[*j]).abs()).fold(0.0, f64::max);
            triplets.row(entries.into_iter().map(|(j, a)| (j, -a * unit[j] / scale)));
            bounds.push(-self.bound(index) / (scale * self.scale));
        }
        self.add_cuts(layout, unit, &mut triplets, &mut bounds);
        layout.restrict(self.settings.centre, &mut triplets, &mut bounds, unit);
        let absolute: Vec<f64> = unit.iter().map(|unit| unit * self.scale).collect();
        layout.limit(&self.limits, &mut triplets, &mut bounds, &absolute);
        for (centre, [low, high]) in self.centre_bounds.iter().enumerate().take(layout.centres()) {
            for (sign, bound) in [(1.0, *high), (-1.0, -low)] {
                triplets.row([(centre, sign)]);
                bounds.push(bound / (unit[centre] * self.scale));
            }
        }
        (triplets, bounds)
    }

    fn fixed_cost(&self) -> f64 {
        match &self.settings.noise {
            Noise::Fixed(radii) => dot(radii, &self.noise_cost),
            Noise::None | Noise::Fitted => 0.0,
        }
    }

    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }
}

/// The unknowns of the program, in their own units.
pub(crate) struct Unknowns {
    pub(super) centre: Vec<f64>,
    pub(super) radius: Vec<f64>,
    /// For each block, the radii times its factors; empty if these are 1.
    scaled: Vec<Vec<f64>>,
    pub(super) free_noise: Vec<f64>,
}

impl Unknowns {
    /// Returns the radii of X0 and U along the motions of a block.
    pub(super) fn radius_of(&self, b: usize) -> &[f64] {
        if self.scaled[b].is_empty() { &self.radius } else { &self.scaled[b] }
    }
}
