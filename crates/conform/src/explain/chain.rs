//! A chain of states, each determined by the one before and by moves, and the moves of least
//! quadratic cost.

use std::ops::Range;

use reachtube_scalar::Lanewise;

/// A chain x_k = G_k y_k + Φ_k x_{k-1} + d_k with x_{-1} = 0, or one in each lane of S. All states
/// x_k have one dimension; the moves y_k may have any.
#[derive(Debug)]
pub(super) struct Chain<S> {
    states: usize,
    links: Vec<Link<S>>,
    /// d, one entry per state of each link.
    pub drift: Vec<S>,
    moves: usize,
}

#[derive(Debug)]
struct Link<S> {
    /// (G, Φ), row-major.
    rows: Vec<S>,
    /// The link's own moves among all.
    moves: Range<usize>,
}

impl Chain<f64> {
    /// Returns a chain without links for states of dimension `states`.
    pub(super) fn new(states: usize) -> Self {
        Self { states, links: Vec::new(), drift: Vec::new(), moves: 0 }
    }

    /// Appends a link: a row (G, Φ) and a drift for each state.
    pub(super) fn push(&mut self, rows: Vec<f64>, drift: impl IntoIterator<Item = f64>) {
        let moves = self.moves..self.moves + rows.len() / self.states - self.states;
        self.moves = moves.end;
        self.links.push(Link { rows, moves });
        self.drift.extend(drift);
    }

    /// Appends the first link: each state has a move of its own.
    pub(super) fn push_diagonal(
        &mut self,
        gains: impl Iterator<Item = f64>,
        drift: impl IntoIterator<Item = f64>,
    ) {
        let mut rows = vec![0.0; self.states * 2 * self.states];
        gains.enumerate().for_each(|(i, gain)| rows[i * (2 * self.states + 1)] = gain);
        self.push(rows, drift);
    }

    /// Returns whether two chains have as many states, links and moves.
    pub(super) fn is_alike(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|chain| chain.links.iter().map(|link| &link.moves));
        self.states == other.states && own.eq(others)
    }
}

impl<S: Lanewise> Chain<S> {
    /// Lays chains that are alike beside each other, one in each lane. The last one is in all lanes
    /// that remain.
    pub(super) fn of_lanes(chains: &[Chain<f64>]) -> Self {
        let of = |lane: usize| &chains[lane.min(chains.len() - 1)];
        let join = |pick: &dyn Fn(&Chain<f64>) -> &[f64]| -> Vec<S> {
            let entries = 0..pick(of(0)).len();
            entries.map(|at| S::from_lanes(|lane| pick(of(lane))[at])).collect()
        };
        let link = |(k, Link { moves, .. }): (usize, &Link<f64>)| Link {
            rows: join(&|chain| &chain.links[k].rows),
            moves: moves.clone(),
        };
        Self {
            states: of(0).states,
            links: of(0).links.iter().enumerate().map(link).collect(),
            drift: join(&|chain| &chain.drift),
            moves: of(0).moves,
        }
    }

    /// Returns the number of all moves.
    pub(super) fn moves(&self) -> usize {
        self.moves
    }

    /// Returns the states without moves.
    #[inline(always)]
    pub(super) fn rest(&self) -> Vec<S> {
        let mut x = self.drift.clone();
        for (k, link) in self.links.iter().enumerate().skip(1) {
            let (before, after) =
                x[(k - 1) * self.states..(k + 1) * self.states].split_at_mut(self.states);
            for (x, row) in
                after.iter_mut().zip(link.rows.chunks_exact(link.rows.len() / self.states))
            {
                *x += dot(&row[link.moves.len()..], before);
            }
        }
        x
    }

    fn widest(&self) -> usize {
        self.states + self.links.iter().map(|link| link.moves.len()).max().unwrap_or(0)
    }
}

/// The Riccati recursion of ½ Σ Q x² + ½ Σ R y² over a chain without drift, Q and R diagonal, R >
/// 0.
#[derive(Debug)]
pub(super) struct Riccati<'a, S> {
    chain: &'a Chain<S>,
    /// For each link the upper rows of the Cholesky factor of the cost of (y_k, x_{k-1}), one per
    /// move, row-major.
    eliminated: Vec<Vec<S>>,
    /// P_k of the cost ½ x_kᵀ P x_k.
    cost: Vec<S>,
    /// P (G, Φ), then (G, Φ)ᵀ P (G, Φ).
    carried: Vec<S>,
    square: Vec<S>,
    /// (y_k, x_{k-1}), and the factor of x_k.
    both: Vec<S>,
    slope: Vec<S>,
}

impl<'a, S: Lanewise> Riccati<'a, S> {
    /// Allocates the recursion for `chain`.
    pub(super) fn new(chain: &'a Chain<S>) -> Self {
        let (states, widest) = (chain.states, chain.widest());
        let zeros = |count: usize| vec![S::zero(); count];
        let rows = |link: &Link<S>| zeros(link.moves.len() * (link.moves.len() + states));
        Self {
            chain,
            eliminated: chain.links.iter().map(rows).collect(),
            cost: zeros(states * states),
            carried: zeros(states * widest),
            square: zeros(widest * widest),
            both: zeros(widest),
            slope: zeros(states),
        }
    }

    /// Factors the recursion for new Q, one entry per state, and R, one per move; returns in which
    /// lanes every step was positive definite.
    #[inline(always)]
    pub(super) fn factor(&mut self, q: &[S], r: &[S]) -> Vec<bool> {
        let states = self.chain.states;
        let mut is_definite = vec![true; S::LANES];
        self.cost.fill(S::zero());
        for (k, link) in self.chain.links.iter().enumerate().rev() {
            for (i, q) in q[k * states..(k + 1) * states].iter().enumerate() {
                self.cost[i * states + i] += *q;
            }
            self.carry(link);
            let all = link.moves.len() + states;
            for (i, r) in r[link.moves.clone()].iter().enumerate() {
                self.square[i * all + i] += *r;
            }
            eliminate(&mut self.square[..all * all], all, link.moves.len(), &mut is_definite);
            self.eliminated[k].copy_from_slice(&self.square[..link.moves.len() * all]);
            for i in 0..states {
                for j in i..states {
                    let cost = self.square[(link.moves.len() + i) * all + link.moves.len() + j];
                    (self.cost[i * states + j], self.cost[j * states + i]) = (cost, cost);
                }
            }
        }
        is_definite
    }

    /// Computes the upper triangle of the cost of (y_k, x_{k-1}) through x_k.
    #[inline(always)]
    fn carry(&mut self, link: &Link<S>) {
        let (states, all) = (self.chain.states, link.moves.len() + self.chain.states);
        self.carried.fill(S::zero());
        self.square.fill(S::zero());
        for (i, carried) in self.carried.chunks_exact_mut(all).take(states).enumerate() {
            for (cost, row) in self.cost[i * states..].iter().zip(link.rows.chunks_exact(all)) {
                add_scaled(carried, *cost, row);
            }
        }
        for (row, carried) in link.rows.chunks_exact(all).zip(self.carried.chunks_exact(all)) {
            for (i, square) in self.square.chunks_exact_mut(all).take(all).enumerate() {
                add_scaled(&mut square[i..], row[i], &carried[i..]);
            }
        }
    }

    /// Finds the states `x` and moves `y` of the chain without drift that minimise the quadratic
    /// cost + q·x + r·y.
    #[inline(always)]
    pub(super) fn solve(&mut self, q: &[S], r: &[S], x: &mut [S], y: &mut [S]) {
        self.backward(q, r, y);
        let states = self.chain.states;
        let before = &mut self.slope;
        before.fill(S::zero());
        for ((link, rows), x) in
            self.chain.links.iter().zip(&self.eliminated).zip(x.chunks_exact_mut(states))
        {
            let width = link.moves.len();
            let both = &mut self.both[..width + states];
            both[width..].copy_from_slice(before);
            for (j, row) in rows.chunks_exact(both.len()).enumerate().rev() {
                both[j] = -(y[link.moves.start + j] + dot(&row[j + 1..], &both[j + 1..])) / row[j];
            }
            y[link.moves.clone()].copy_from_slice(&both[..width]);
            for (x, row) in x.iter_mut().zip(link.rows.chunks_exact(both.len())) {
                *x = dot(row, both);
            }
            before.copy_from_slice(x);
        }
    }

    /// Writes into `y` the rest of r after the elimination of later moves.
    #[inline(always)]
    fn backward(&mut self, q: &[S], r: &[S], y: &mut [S]) {
        let states = self.chain.states;
        self.slope.fill(S::zero());
        for ((link, rows), q) in
            self.chain.links.iter().zip(&self.eliminated).zip(q.chunks_exact(states)).rev()
        {
            let width = link.moves.len();
            let both = &mut self.both[..width + states];
            add_scaled(&mut self.slope, S::one(), q);
            both[..width].copy_from_slice(&r[link.moves.clone()]);
            both[width..].fill(S::zero());
            for (slope, row) in self.slope.iter().zip(link.rows.chunks_exact(both.len())) {
                add_scaled(both, *slope, row);
            }
            for (j, row) in rows.chunks_exact(both.len()).enumerate() {
                both[j] /= row[j];
                let done = both[j];
                add_scaled(&mut both[j + 1..], -done, &row[j + 1..]);
            }
            y[link.moves.clone()].copy_from_slice(&both[..width]);
            self.slope.copy_from_slice(&both[width..]);
        }
    }
}

/// Performs the first `count` steps of Cholesky's factorisation of a symmetric matrix in its upper
/// triangle; notes the lanes where it is not positive definite.
#[inline(always)]
fn eliminate<S: Lanewise>(matrix: &mut [S], size: usize, count: usize, is_definite: &mut [bool]) {
    for j in 0..count {
        let (done, left) = matrix[j * size..].split_at_mut(size);
        let root = done[j].map(f64::sqrt);
        let lanes = is_definite.iter_mut().enumerate();
        lanes.for_each(|(lane, is_definite)| *is_definite &= root.lane(lane).is_normal());
        done[j..].iter_mut().for_each(|x| *x /= root);
        for (i, row) in (j + 1..size).zip(left.chunks_exact_mut(size)) {
            add_scaled(&mut row[i..], -done[i], &done[i..]);
        }
    }
}

#[inline(always)]
fn add_scaled<S: Lanewise>(to: &mut [S], k: S, from: &[S]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += k * *from);
}

#[inline(always)]
pub(super) fn dot<S: Lanewise>(a: &[S], b: &[S]) -> S {
    a.iter().zip(b).fold(S::zero(), |sum, (a, b)| sum + *a * *b)
}
