//! States that follow from one another and from moves, and what moves cost least.

use nalgebra::linalg::Cholesky;
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut, Dyn};

/// x_k = Φ_k x_{k-1} + G_k y_k + d_k with x_{-1} = 0: states x_k of one dimension, moves y_k of any.
#[derive(Debug, Default)]
pub(super) struct Chain {
    links: Vec<Link>,
    /// d, one entry a state of each link.
    pub drift: Vec<f64>,
    moves: usize,
}

#[derive(Debug)]
struct Link {
    /// Φ.
    transition: DMatrix<f64>,
    /// G.
    gain: DMatrix<f64>,
    /// Where its moves begin.
    moves: usize,
}

impl Chain {
    /// One more link.
    pub fn push(&mut self, transition: DMatrix<f64>, gain: DMatrix<f64>, drift: &DVector<f64>) {
        let moves = self.moves;
        self.moves += gain.ncols();
        self.links.push(Link { transition, gain, moves });
        self.drift.extend(drift.iter());
    }

    /// Number of all moves.
    pub fn moves(&self) -> usize {
        self.moves
    }

    /// Adds to the states `x`, link after link, what follows from the states before.
    pub fn roll(&self, x: &mut [f64]) {
        let states = self.states();
        for (k, link) in self.links.iter().enumerate().skip(1) {
            let (before, after) = x[(k - 1) * states..(k + 1) * states].split_at_mut(states);
            view_mut(after).gemv(1.0, &link.transition, &view(before), 1.0);
        }
    }

    fn states(&self) -> usize {
        self.links.first().map_or(0, |link| link.transition.nrows())
    }
}

/// The Riccati recursion of ½ Σ Q x² + ½ Σ R y² over a chain without drift, Q and R diagonal, R > 0.
#[derive(Debug)]
pub(super) struct Riccati<'a> {
    chain: &'a Chain,
    /// Of S_k = R_k + G_kᵀ P_k G_k.
    factors: Vec<Cholesky<f64, Dyn>>,
    /// S_k⁻¹ G_kᵀ P_k Φ_k.
    feedback: Vec<DMatrix<f64>>,
    /// P_k, and what is on the way to it.
    cost: DMatrix<f64>,
    carried: DMatrix<f64>,
    spare: DMatrix<f64>,
}

impl<'a> Riccati<'a> {
    /// Room for `chain`.
    pub fn new(chain: &'a Chain) -> Self {
        let states = chain.states();
        let one = |link: &Link| Cholesky::pack_dirty(DMatrix::identity(link.gain.ncols(), link.gain.ncols()));
        let none = |link: &Link| DMatrix::zeros(link.gain.ncols(), states);
        let square = DMatrix::zeros(states, states);
        Self {
            factors: chain.links.iter().map(one).collect(),
            feedback: chain.links.iter().map(none).collect(),
            chain,
            cost: square.clone(),
            carried: square.clone(),
            spare: square,
        }
    }

    /// Takes new Q, one entry a state, and R, one a move; whether the recursion came through.
    pub fn factor(&mut self, q: &[f64], r: &[f64]) -> bool {
        let states = self.chain.states();
        self.cost.fill(0.0);
        for (k, link) in self.chain.links.iter().enumerate().rev() {
            for (i, q) in q[k * states..(k + 1) * states].iter().enumerate() {
                self.cost[(i, i)] += q;
            }
            if !self.eliminate(k, link, &r[link.moves..link.moves + link.gain.ncols()]) {
                return false;
            }
        }
        true
    }

    /// From P_k to what it makes x_{k-1} cost: Φᵀ P Φ - (Gᵀ P Φ)ᵀ S⁻¹ (Gᵀ P Φ).
    fn eliminate(&mut self, k: usize, link: &Link, r: &[f64]) -> bool {
        let feedback = &mut self.feedback[k];
        let mut pivot = std::mem::replace(&mut self.factors[k], Cholesky::pack_dirty(DMatrix::zeros(0, 0)))
            .unpack_dirty();
        self.carried.columns_mut(0, link.gain.ncols()).gemm(1.0, &self.cost, &link.gain, 0.0);
        pivot.gemm_tr(1.0, &link.gain, &self.carried.columns(0, link.gain.ncols()), 0.0);
        for (i, r) in r.iter().enumerate() {
            pivot[(i, i)] += r;
        }
        let Some(factor) = Cholesky::new(pivot) else { return false };
        feedback.gemm_tr(1.0, &self.carried.columns(0, link.gain.ncols()), &link.transition, 0.0);
        self.carried.gemm(1.0, &self.cost, &link.transition, 0.0);
        self.spare.gemm_tr(1.0, &link.transition, &self.carried, 0.0);
        // With L Lᵀ = S, what is taken away is the square of L⁻¹ Gᵀ P Φ, which keeps the cost symmetric.
        factor.l_dirty().solve_lower_triangular_mut(feedback);
        self.spare.gemm_tr(-1.0, feedback, feedback, 1.0);
        factor.l_dirty().tr_solve_lower_triangular_mut(feedback);
        std::mem::swap(&mut self.cost, &mut self.spare);
        self.factors[k] = factor;
        true
    }

    /// States `x` and moves `y` of the chain without drift that make the quadratic cost + q·x + r·y least.
    pub fn solve(&self, q: &[f64], r: &[f64], x: &mut [f64], y: &mut [f64]) {
        let states = self.chain.states();
        let mut slope = DVector::zeros(states);
        let mut carried = slope.clone();
        y.copy_from_slice(r);
        for (k, link) in self.chain.links.iter().enumerate().rev() {
            slope += view(&q[k * states..(k + 1) * states]);
            let mut y = view_mut(&mut y[link.moves..link.moves + link.gain.ncols()]);
            y.gemv_tr(1.0, &link.gain, &slope, 1.0);
            carried.gemv_tr(1.0, &link.transition, &slope, 0.0);
            carried.gemv_tr(-1.0, &self.feedback[k], &y, 1.0);
            self.factors[k].solve_mut(&mut y);
            y.neg_mut();
            std::mem::swap(&mut slope, &mut carried);
        }
        x.fill(0.0);
        for (k, link) in self.chain.links.iter().enumerate() {
            let mut y = view_mut(&mut y[link.moves..link.moves + link.gain.ncols()]);
            let (before, after) =
                x[k.saturating_sub(1) * states..(k + 1) * states].split_at_mut(k.min(1) * states);
            let mut after = view_mut(after);
            if k > 0 {
                y.gemv(-1.0, &self.feedback[k], &view(before), 1.0);
                after.gemv(1.0, &link.transition, &view(before), 0.0);
            }
            after.gemv(1.0, &link.gain, &y, 1.0);
        }
    }
}

fn view(values: &[f64]) -> DVectorView<'_, f64> {
    DVectorView::from_slice(values, values.len())
}

fn view_mut(values: &mut [f64]) -> DVectorViewMut<'_, f64> {
    let length = values.len();
    DVectorViewMut::from_slice(values, length)
}
