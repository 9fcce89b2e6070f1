//! The linear program: the smallest sets whose reachable hull reaches as far as the deviations.
//!
//! Unknowns are the centres c = (c_x, c_u), the radii r = (r_x, r_u) and, where it is asked for,
//! the radii r_v of the noise. For each sample k and state i, with E_k = (e^{A t_k}, Γ(t_k)) and
//! R_k = (|e^{A t_k}|, κ(t_k)):
//!
//! -  (E_k c)_i + (R_k r)_i + r_v,i >= max d_i(t_k)
//! - -(E_k c)_i + (R_k r)_i + r_v,i >= max -d_i(t_k)
//!
//! and the cost is Σ_k Σ_i s_i 2 ((R_k r)_i + r_v,i) over every distinct sample time, at which
//! blocks count by their mean, corrections A, E and F of the method.

use reachtube_reach::Hyperrectangle;

use super::deviation::{Deviation, Grid};
use super::solver::{Triplets, solve_cone};
use super::{Centre, Envelope, Noise, Settings, Side, UncertaintySets};
use crate::error::{Error, Result};

/// A row counts as violated beyond this part of its own size.
const TOLERANCE: f64 = 1e-10;

/// A row within this part of the radius of the reachable set is called tight.
pub(super) const TIGHT: f64 = 1e-6;

/// What is below this part of the largest deviation is rounding.
const ROUNDING: f64 = 1e-14;

/// The horizon is cut into this many windows; each hands in its worst row when it is violated.
const WINDOWS: usize = 24;

/// Rounds of row generation at most.
const ROUNDS: usize = 200;

/// The rows of one sample grid of one linear system, ready to be evaluated at the speed of memory.
#[derive(Debug, Clone)]
pub struct Block {
    /// Sample times, s.
    pub times: Vec<f64>,
    /// Samples x states x (unknown centres, then radii): the entries of E_k, then of R_k.
    pub coefficients: Vec<f64>,
    /// What must be covered.
    pub envelope: Envelope,
}

impl Block {
    /// One for each grid, with the deviations on it merged.
    pub fn of_grids(grids: &[Grid], deviations: &[Deviation], joints: usize) -> Vec<Self> {
        let mut merged: Vec<Envelope> = grids.iter().map(|_| Envelope::new(2 * joints)).collect();
        deviations.iter().for_each(|deviation| merged[deviation.grid].merge(&deviation.envelope));
        let block = |(grid, envelope): (&Grid, Envelope)| Self {
            times: grid.propagation.grid().times().to_vec(),
            coefficients: coefficients(grid),
            envelope,
        };
        grids.iter().zip(merged).map(block).collect()
    }
}

/// The program.
pub struct Program<'a> {
    settings: &'a Settings,
    joints: usize,
    blocks: Vec<Block>,
    /// For each block and sample, how much its widths count.
    shares: Vec<Vec<f64>>,
    /// Between what each centre (c_x, c_u) must lie, where that is restricted.
    centers: Vec<[f64; 2]>,
    /// Cost of each radius (r_x, r_u).
    cost: Vec<f64>,
    /// Cost of each noise radius.
    noise_cost: Vec<f64>,
    /// Largest |d| in the checked states, at least the smallest normal number.
    scale: f64,
}

/// What the solver found.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The sets; their rows hold to the solver's tolerance only.
    pub sets: UncertaintySets,
    /// The dual objective: no sets that satisfy the rows cost less, up to the solver's tolerance.
    pub lower_bound: f64,
    /// Rows in the whole program.
    pub rows: usize,
    /// Rows that were generated.
    pub generated: usize,
    /// Rounds of row generation.
    pub rounds: usize,
}

/// A row's place: block, sample, state, side.
pub(super) type Place = (usize, usize, usize, Side);

impl<'a> Program<'a> {
    /// The program of some blocks; `weights` are s, 2n.
    pub fn new(settings: &'a Settings, weights: &[f64], blocks: Vec<Block>) -> Self {
        let joints = weights.len() / 2;
        let shares = shares(blocks.iter().map(|block| block.times.as_slice()));
        let (cost, noise_cost) = cost(&blocks, &shares, weights);
        let (centers, scale) = (Vec::new(), f64::MIN_POSITIVE);
        let mut program =
            Self { settings, joints, blocks, shares, centers, cost, noise_cost, scale };
        program.scale = program.largest_bound().max(f64::MIN_POSITIVE);
        program
    }

    /// The same with each centre (c_x, c_u) between two numbers.
    pub(super) fn with_centers(self, centers: Vec<[f64; 2]>) -> Self {
        Self { centers, ..self }
    }

    /// The cost of some sets.
    pub fn cost(&self, sets: &UncertaintySets) -> f64 {
        let radii = sets.initial_set.radius.iter().chain(&sets.input_set.radius);
        let noise = (0..2 * self.joints).map(|i| self.noise_cost[i] * sets.noise_radius(i));
        radii.zip(&self.cost).map(|(r, w)| r * w).sum::<f64>() + noise.sum::<f64>()
    }

    /// Number of rows of the whole program.
    pub fn rows(&self) -> usize {
        let states = self.settings.states.rows(self.joints);
        self.blocks.iter().map(|block| 2 * states * block.envelope.len()).sum()
    }

    /// Solves the program by row generation: few of the rows decide, and only they are handed to
    /// the solver.
    ///
    /// # Errors
    ///
    /// [`Error::Program`] when the solver does not reach an optimum.
    pub fn solve(&self) -> Result<Solution> {
        let mut places = self.first_rows();
        for round in 1..=ROUNDS {
            let (candidates, lower_bound) = self.solve_rows(&places)?;
            let added = self.violated(&candidates[0], &places);
            if added.is_empty() {
                let [found, polished] = candidates;
                let better = self.repaired_cost(&polished) < self.repaired_cost(&found);
                let sets = if better { polished } else { found };
                let (rows, generated) = (self.rows(), places.len());
                return Ok(Solution { sets, lower_bound, rows, generated, rounds: round });
            }
            places.extend(added);
        }
        Err(Error::Program(format!(
            "{ROUNDS} rounds of row generation left violated rows; report this with the data"
        )))
    }

    fn largest_bound(&self) -> f64 {
        self.places(1).map(|place| self.bound(place).abs()).fold(0.0, f64::max)
    }

    /// Every `stride`-th sample's rows.
    fn places(&self, stride: usize) -> impl Iterator<Item = Place> + '_ {
        let states = self.settings.states.rows(self.joints);
        self.blocks.iter().enumerate().flat_map(move |(b, block)| {
            (0..block.envelope.len()).step_by(stride).flat_map(move |k| {
                (0..states).flat_map(move |i| [(b, k, i, Side::Upper), (b, k, i, Side::Lower)])
            })
        })
    }

    fn first_rows(&self) -> Vec<Place> {
        let longest = self.blocks.iter().map(|block| block.envelope.len()).max().unwrap_or(0);
        self.places((longest / 8).max(1)).collect()
    }

    /// The right-hand side of a row: the deviation along its direction, less the noise that is
    /// known.
    fn bound(&self, (b, k, i, side): Place) -> f64 {
        let envelope = &self.blocks[b].envelope;
        let known = match &self.settings.noise {
            Noise::Fixed(radii) => radii[i],
            Noise::None | Noise::Free => 0.0,
        };
        match side {
            Side::Upper => envelope.upper(k, i) - known,
            Side::Lower => -envelope.lower(k, i) - known,
        }
    }

    /// Entries of E_k and of R_k in row i.
    fn row(&self, b: usize, k: usize, i: usize) -> (&[f64], &[f64]) {
        let width = 3 * self.joints;
        let start = (k * 2 * self.joints + i) * 2 * width;
        self.blocks[b].coefficients[start..start + 2 * width].split_at(width)
    }

    /// Deviation minus reach of a row, unrounded.
    fn excess(&self, place: Place, unknowns: &Unknowns) -> f64 {
        let (b, k, i, side) = place;
        let (center, radius) = self.row(b, k, i);
        let reach = side.sign() * dot(center, &unknowns.center) + dot(radius, &unknowns.radius);
        self.bound(place) - reach - unknowns.free_noise[i]
    }

    /// The worst violated row of each window, state and side that is not among `places` yet.
    fn violated(&self, sets: &UncertaintySets, places: &[Place]) -> Vec<Place> {
        let unknowns = self.unknowns(sets);
        let known: std::collections::HashSet<&Place> = places.iter().collect();
        let mut worst: std::collections::BTreeMap<(usize, usize, usize, bool), (f64, Place)> =
            Default::default();
        for place in self.places(1) {
            let excess = self.excess(place, &unknowns);
            let (b, k, i, side) = place;
            let size = self.bound(place).abs().max(dot(self.row(b, k, i).1, &unknowns.radius));
            if excess <= (TOLERANCE * size).max(ROUNDING * self.scale) || known.contains(&place) {
                continue;
            }
            let window = k * WINDOWS / self.blocks[b].envelope.len();
            let entry = worst.entry((b, window, i, side == Side::Upper)).or_insert((excess, place));
            if excess > entry.0 {
                *entry = (excess, place);
            }
        }
        worst.into_values().map(|(_, place)| place).collect()
    }

    fn unknowns(&self, sets: &UncertaintySets) -> Unknowns {
        let join =
            |x: &Hyperrectangle, u: &Hyperrectangle, pick: fn(&Hyperrectangle) -> &Vec<f64>| {
                pick(x).iter().chain(pick(u)).copied().collect()
            };
        let free = self.settings.noise == Noise::Free;
        Unknowns {
            center: join(&sets.initial_set, &sets.input_set, |set| &set.center),
            radius: join(&sets.initial_set, &sets.input_set, |set| &set.radius),
            free_noise: (0..2 * self.joints)
                .map(|i| if free { sets.noise_radius(i) } else { 0.0 })
                .collect(),
        }
    }

    /// Solves with the rows `places`; returns the sets as found and polished, and the dual
    /// objective.
    fn solve_rows(&self, places: &[Place]) -> Result<([UncertaintySets; 2], f64)> {
        let layout = Layout::new(self);
        let largest_cost = layout.cost.iter().copied().fold(0.0, f64::max);
        // Each unknown is measured so that its cost is that of the dearest, each row so that its
        // largest entry is 1.
        let unit: Vec<f64> = layout.cost.iter().map(|w| largest_cost / w).collect();
        let mut triplets = Triplets::default();
        let mut bounds = Vec::new();
        for &place in places {
            let (b, k, i, side) = place;
            let (center, radius) = self.row(b, k, i);
            let entries = layout.entries(center, radius, i, side);
            let scale = entries.iter().map(|(j, a)| (a * unit[*j]).abs()).fold(0.0, f64::max);
            triplets.row(entries.into_iter().map(|(j, a)| (j, -a * unit[j] / scale)));
            bounds.push(-self.bound(place) / (scale * self.scale));
        }
        layout.restrictions(self.settings.centre, &mut triplets, &mut bounds, &unit);
        for (center, [low, high]) in self.centers.iter().enumerate().take(layout.radii()) {
            for (sign, bound) in [(1.0, *high), (-1.0, -low)] {
                triplets.row([(center, sign)]);
                bounds.push(bound / (unit[center] * self.scale));
            }
        }
        let objective: Vec<f64> = layout
            .cost
            .iter()
            .enumerate()
            .map(|(j, w)| if layout.is_center(j) { 0.0 } else { w * unit[j] / largest_cost })
            .collect();
        let optimum = solve_cone(&objective, &triplets, &bounds)?;
        let sets = |x: &[f64]| {
            let unknowns: Vec<f64> =
                x.iter().zip(&unit).map(|(x, unit)| x * unit * self.scale).collect();
            layout.sets(&unknowns, self.settings)
        };
        let lower_bound = optimum.dual * self.scale * largest_cost + self.fixed_cost();
        Ok(([sets(&optimum.found), sets(&optimum.polished)], lower_bound))
    }

    /// The cost of the sets once they satisfy every row.
    fn repaired_cost(&self, sets: &UncertaintySets) -> f64 {
        self.cost(&sets.inflated(self.worst_ratio(sets), 0.0))
    }

    /// What known noise adds to every cost.
    fn fixed_cost(&self) -> f64 {
        match &self.settings.noise {
            Noise::Fixed(radii) => dot(radii, &self.noise_cost),
            Noise::None | Noise::Free => 0.0,
        }
    }

    /// The largest ratio of what a row needs to what the radii give it there, and 1 at least: r
    /// times that satisfies every row.
    pub fn worst_ratio(&self, sets: &UncertaintySets) -> f64 {
        let unknowns = self.unknowns(sets);
        let ratio = |place: Place| {
            let (b, k, i, _) = place;
            let given = dot(self.row(b, k, i).1, &unknowns.radius);
            if given > ROUNDING * self.scale {
                1.0 + self.excess(place, &unknowns) / given
            } else {
                1.0
            }
        };
        self.places(1).map(ratio).fold(1.0, f64::max)
    }

    /// The rows that touch the hull of the sets' reach, to a part of [`TIGHT`] of its radius.
    pub(super) fn tight(&self, sets: &UncertaintySets) -> Vec<Place> {
        let unknowns = self.unknowns(sets);
        let touches = |place: &Place| {
            let (b, k, i, _) = *place;
            let radius = dot(self.row(b, k, i).1, &unknowns.radius) + unknowns.free_noise[i];
            self.excess(*place, &unknowns) >= -TIGHT * radius
        };
        self.places(1).filter(touches).collect()
    }

    /// Largest |d| among the rows.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The interval hull of the reachable set in the units of the paper: (Σ_k Σ_i (E_k (y1 - y2))_i
    /// of eq. (21), Σ_k Δt Π_i 2 (R_k r)_i of eq. (2)).
    pub fn paper_sums(&self, sets: &UncertaintySets) -> (f64, f64) {
        let unknowns = self.unknowns(sets);
        let (mut signed, mut volume) = (0.0, 0.0);
        for (b, shares) in self.shares.iter().enumerate() {
            let times = &self.blocks[b].times;
            for (k, share) in shares.iter().enumerate() {
                let rows = (0..2 * self.joints).map(|i| self.row(b, k, i));
                let edges = rows.clone().map(|(center, _)| 2.0 * dot(center, &unknowns.radius));
                signed += share * edges.sum::<f64>();
                let product: f64 =
                    rows.map(|(_, radius)| 2.0 * dot(radius, &unknowns.radius)).product();
                volume += share * product * (times.get(k + 1).unwrap_or(&times[k]) - times[k]);
            }
        }
        (signed, volume)
    }
}

/// The unknowns of the program, unscaled.
struct Unknowns {
    center: Vec<f64>,
    radius: Vec<f64>,
    free_noise: Vec<f64>,
}

/// Which column of the solver's matrix each unknown is.
struct Layout {
    joints: usize,
    centers: bool,
    /// Cost of each column; that of a centre is that of its radius, for scaling only.
    cost: Vec<f64>,
}

impl Layout {
    fn new(program: &Program) -> Self {
        let centers = program.settings.centre != Centre::Zero;
        let mut cost = if centers { program.cost.clone() } else { Vec::new() };
        cost.extend(&program.cost);
        if program.settings.noise == Noise::Free {
            cost.extend(&program.noise_cost);
        }
        // A radius without a cost is in no row (with one sample nothing depends on the input): any
        // cost makes it 0.
        let largest = cost.iter().copied().fold(0.0, f64::max);
        cost.iter_mut().filter(|w| **w == 0.0).for_each(|w| *w = largest);
        Self { joints: program.joints, centers, cost }
    }

    fn radii(&self) -> usize {
        if self.centers { 3 * self.joints } else { 0 }
    }

    fn is_center(&self, column: usize) -> bool {
        column < self.radii()
    }

    fn entries(
        &self,
        center: &[f64],
        radius: &[f64],
        state: usize,
        side: Side,
    ) -> Vec<(usize, f64)> {
        let signed = center.iter().map(|a| side.sign() * a).take(self.radii());
        let mut row: Vec<(usize, f64)> = signed.chain(radius.iter().copied()).enumerate().collect();
        let noise = self.radii() + 3 * self.joints;
        if self.cost.len() > noise {
            row.push((noise + state, 1.0));
        }
        row
    }

    /// r >= 0, and |c| <= r where the origin must lie in the sets.
    fn restrictions(
        &self,
        centre: Centre,
        triplets: &mut Triplets,
        bounds: &mut Vec<f64>,
        unit: &[f64],
    ) {
        for column in self.radii()..self.cost.len() {
            triplets.row([(column, -1.0)]);
            bounds.push(0.0);
        }
        if centre == Centre::Origin {
            for center in 0..self.radii() {
                let radius = center + self.radii();
                for sign in [1.0, -1.0] {
                    triplets.row([(center, sign * unit[center] / unit[radius]), (radius, -1.0)]);
                    bounds.push(0.0);
                }
            }
        }
    }

    fn sets(&self, unknowns: &[f64], settings: &Settings) -> UncertaintySets {
        let (n, radii) = (self.joints, self.radii());
        let set = |from: usize, to: usize| {
            let radius: Vec<f64> =
                unknowns[radii + from..radii + to].iter().map(|r| r.max(0.0)).collect();
            let mut center =
                if self.centers { unknowns[from..to].to_vec() } else { vec![0.0; to - from] };
            if settings.centre == Centre::Origin {
                center.iter_mut().zip(&radius).for_each(|(c, r)| *c = c.clamp(-r, *r));
            }
            Hyperrectangle { center, radius }
        };
        let noise = |radius: Vec<f64>| Some(Hyperrectangle { center: vec![0.0; 2 * n], radius });
        let noise_set = match &settings.noise {
            Noise::None => None,
            Noise::Fixed(given) => noise(given.clone()),
            Noise::Free => noise(unknowns[radii + 3 * n..].iter().map(|r| r.max(0.0)).collect()),
        };
        UncertaintySets { initial_set: set(0, 2 * n), input_set: set(2 * n, 3 * n), noise_set }
    }
}

fn coefficients(grid: &Grid) -> Vec<f64> {
    let mut all = Vec::new();
    for (k, gain) in grid.gains.iter().enumerate() {
        let (e, g) = (grid.propagation.exponential(k), grid.propagation.integral(k));
        for i in 0..e.nrows() {
            all.extend(e.row(i).iter().chain(g.row(i).iter()).map(|x| x.mid()));
            all.extend(e.row(i).iter().map(|x| x.mid().abs()));
            all.extend(gain.row(i).iter().map(|x| x.lo()));
        }
    }
    all
}

/// For each of several lists of sample times, what each sample counts: those at one time together
/// 1.
pub(super) fn shares<'t>(lists: impl Iterator<Item = &'t [f64]> + Clone) -> Vec<Vec<f64>> {
    let nanoseconds = |t: &f64| (t * 1e9).round() as i64;
    let mut counts = std::collections::HashMap::new();
    lists.clone().flatten().for_each(|t| *counts.entry(nanoseconds(t)).or_insert(0.0) += 1.0);
    lists.map(|times| times.iter().map(|t| 1.0 / counts[&nanoseconds(t)]).collect()).collect()
}

fn cost(blocks: &[Block], shares: &[Vec<f64>], weights: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (states, unknowns) = (weights.len(), weights.len() / 2 * 3);
    let (mut cost, mut noise) = (vec![0.0; unknowns], vec![0.0; states]);
    for (block, shares) in blocks.iter().zip(shares) {
        let samples = block.coefficients.chunks_exact(states * 2 * unknowns);
        for (rows, share) in samples.zip(shares) {
            for (i, row) in rows.chunks_exact(2 * unknowns).enumerate() {
                let weight = 2.0 * share * weights[i];
                row[unknowns..].iter().zip(&mut cost).for_each(|(a, w)| *w += weight * a);
                noise[i] += weight;
            }
        }
    }
    (cost, noise)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
