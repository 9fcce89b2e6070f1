//! A chain of states, each determined by the one before and by moves, and the moves of least
//! quadratic cost.

use std::ops::Range;

/// A chain x_k = G_k y_k + Φ_k x_{k-1} + d_k with x_{-1} = 0. All states x_k have one dimension;
/// the moves y_k may have any.
#[derive(Debug)]
pub(super) struct Chain {
    states: usize,
    links: Vec<Link>,
    /// d, one entry per state of each link.
    pub drift: Vec<f64>,
    moves: usize,
}

#[derive(Debug)]
struct Link {
    /// (G, Φ), row-major.
    rows: Vec<f64>,
    /// The link's own moves among all.
    moves: Range<usize>,
}

impl Chain {
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

    /// Returns the number of all moves.
    pub(super) fn moves(&self) -> usize {
        self.moves
    }

    /// Returns the states without moves.
    pub(super) fn rest(&self) -> Vec<f64> {
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
pub(super) struct Riccati<'a> {
    chain: &'a Chain,
    /// For each link the upper rows of the Cholesky factor of the cost of (y_k, x_{k-1}), one per
    /// move, row-major.
    eliminated: Vec<Vec<f64>>,
    /// P_k of the cost ½ x_kᵀ P x_k.
    cost: Vec<f64>,
    /// P (G, Φ), then (G, Φ)ᵀ P (G, Φ).
    carried: Vec<f64>,
    square: Vec<f64>,
    /// (y_k, x_{k-1}), and the factor of x_k.
    both: Vec<f64>,
    slope: Vec<f64>,
}

impl<'a> Riccati<'a> {
    /// Allocates the recursion for `chain`.
    pub(super) fn new(chain: &'a Chain) -> Self {
        let (states, widest) = (chain.states, chain.widest());
        let rows = |link: &Link| vec![0.0; link.moves.len() * (link.moves.len() + states)];
        Self {
            chain,
            eliminated: chain.links.iter().map(rows).collect(),
            cost: vec![0.0; states * states],
            carried: vec![0.0; states * widest],
            square: vec![0.0; widest * widest],
            both: vec![0.0; widest],
            slope: vec![0.0; states],
        }
    }

    /// Factors the recursion for new Q, one entry per state, and R, one per move; returns whether
    /// every step was positive definite.
    pub(super) fn factor(&mut self, q: &[f64], r: &[f64]) -> bool {
        let states = self.chain.states;
        self.cost.fill(0.0);
        for (k, link) in self.chain.links.iter().enumerate().rev() {
            for (i, q) in q[k * states..(k + 1) * states].iter().enumerate() {
                self.cost[i * states + i] += q;
            }
            self.carry(link);
            let all = link.moves.len() + states;
            for (i, r) in r[link.moves.clone()].iter().enumerate() {
                self.square[i * all + i] += r;
            }
            if !eliminate(&mut self.square[..all * all], all, link.moves.len()) {
                return false;
            }
            self.eliminated[k].copy_from_slice(&self.square[..link.moves.len() * all]);
            for i in 0..states {
                for j in i..states {
                    let cost = self.square[(link.moves.len() + i) * all + link.moves.len() + j];
                    (self.cost[i * states + j], self.cost[j * states + i]) = (cost, cost);
                }
            }
        }
        true
    }

    /// Computes the upper triangle of the cost of (y_k, x_{k-1}) through x_k.
    fn carry(&mut self, link: &Link) {
        let (states, all) = (self.chain.states, link.moves.len() + self.chain.states);
        self.carried.fill(0.0);
        self.square.fill(0.0);
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
    pub(super) fn solve(&mut self, q: &[f64], r: &[f64], x: &mut [f64], y: &mut [f64]) {
        self.backward(q, r, y);
        let states = self.chain.states;
        let before = &mut self.slope;
        before.fill(0.0);
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
    fn backward(&mut self, q: &[f64], r: &[f64], y: &mut [f64]) {
        let states = self.chain.states;
        self.slope.fill(0.0);
        for ((link, rows), q) in
            self.chain.links.iter().zip(&self.eliminated).zip(q.chunks_exact(states)).rev()
        {
            let width = link.moves.len();
            let both = &mut self.both[..width + states];
            add_scaled(&mut self.slope, 1.0, q);
            both[..width].copy_from_slice(&r[link.moves.clone()]);
            both[width..].fill(0.0);
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
/// triangle; returns false where it is not positive definite.
fn eliminate(matrix: &mut [f64], size: usize, count: usize) -> bool {
    for j in 0..count {
        let (done, left) = matrix[j * size..].split_at_mut(size);
        let root = done[j].sqrt();
        if !root.is_normal() {
            return false;
        }
        done[j..].iter_mut().for_each(|x| *x /= root);
        for (i, row) in (j + 1..size).zip(left.chunks_exact_mut(size)) {
            add_scaled(&mut row[i..], -done[i], &done[i..]);
        }
    }
    true
}

fn add_scaled(to: &mut [f64], k: f64, from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += k * from);
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
