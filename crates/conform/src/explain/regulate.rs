//! The moves within bounds that keep a chain of states closest to zero.
//!
//! The program is a linear one with as many unknowns as a run has inputs and states (18,000 for 4 s
//! of a six-joint arm). Its structure, a chain, makes each Newton step one Riccati recursion, whose
//! time is linear in the samples. The conic solver of the sets takes 12 times as long on a chain of
//! 1,000 samples (1.58 s against 0.13 s; see the ignored test of the long chain).

use crate::explain::chain::{Chain, Riccati, dot};

/// Moves in [-1, 1], and the largest |x| of the states that follow.
#[derive(Debug)]
pub(super) struct Regulated {
    pub moves: Vec<f64>,
    pub largest: f64,
}

/// Relative distance of the largest |x| from the least that is accepted.
const ACCURACY: f64 = 0.02;

/// Iterations at most; more gain nothing.
const ITERATIONS: usize = 60;

/// Part of the way to a bound that a step goes at most.
const CAUTION: f64 = 0.99;

/// Minimises t over |x| <= t, |y| <= 1 for the states x and moves y of `chain`, until t falls below
/// `enough`. The linear program is solved by the primal-dual interior-point method of Mehrotra
/// (SIAM J. Optim. 2, 1992), each of whose steps is one Riccati recursion (Rao, Wright, Rawlings,
/// J. Optim. Theory Appl. 99, 1998).
pub(super) fn regulate(chain: &Chain, enough: f64) -> Regulated {
    let (mut states, mut moves) = start(chain);
    let mut step = NewtonStep::new(chain, &states, &moves);
    for _ in 0..ITERATIONS {
        let gap = states.gap() + moves.gap();
        if gap <= ACCURACY * states.bound
            || states.bound <= enough
            || !step.find(&states, &moves, gap)
        {
            break;
        }
        let primal =
            CAUTION * states.room(&step.states).min(moves.room(&step.moves)).min(1.0 / CAUTION);
        let dual = CAUTION
            * states.dual_room(&step.states).min(moves.dual_room(&step.moves)).min(1.0 / CAUTION);
        states.advance(&step.states, primal, dual);
        moves.advance(&step.moves, primal, dual);
    }
    Regulated {
        largest: states.values.iter().fold(0.0, |max, x| max.max(x.abs())),
        moves: moves.values,
    }
}

/// Returns the start: no moves, with multipliers on the central path.
fn start(chain: &Chain) -> (Band, Band) {
    let rest = chain.rest();
    let largest: f64 = rest.iter().fold(0.0, |max, x| max.max(x.abs()));
    let mut states = Band::new(1.1 * largest, rest);
    let mut moves = Band::new(1.0, vec![0.0; chain.moves()]);
    let inverse: f64 = states.slacks().map(|[above, below]| 1.0 / above + 1.0 / below).sum();
    states.set_multipliers(1.0 / inverse);
    moves.set_multipliers(1.0 / inverse);
    (states, moves)
}

/// Values that stay within ± a bound, with a multiplier for each side; or the change of all that in
/// one step.
#[derive(Debug, Clone)]
struct Band {
    bound: f64,
    values: Vec<f64>,
    multipliers: Vec<[f64; 2]>,
}

impl Band {
    fn new(bound: f64, values: Vec<f64>) -> Self {
        Self { bound, multipliers: vec![[0.0; 2]; values.len()], values }
    }

    /// Returns the slack above and below each value.
    fn slacks(&self) -> impl Iterator<Item = [f64; 2]> {
        self.values.iter().map(|value| [self.bound - value, self.bound + value])
    }

    /// Returns slacks and multipliers.
    fn pairs(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        self.slacks().zip(self.multipliers.iter().copied())
    }

    fn set_multipliers(&mut self, product: f64) {
        for (multipliers, value) in self.multipliers.iter_mut().zip(&self.values) {
            *multipliers = [product / (self.bound - value), product / (self.bound + value)];
        }
    }

    fn gap(&self) -> f64 {
        self.pairs()
            .map(|(slack, multiplier)| slack[0] * multiplier[0] + slack[1] * multiplier[1])
            .sum()
    }

    /// Returns the gap after a step.
    fn gap_after(&self, change: &Self, primal: f64, dual: f64) -> f64 {
        let pairs = self.pairs().zip(change.pairs());
        pairs
            .flat_map(|(own, change)| {
                [0, 1].map(|i| (own.0[i] + primal * change.0[i]) * (own.1[i] + dual * change.1[i]))
            })
            .sum()
    }

    /// Returns how far `change` may be followed until a slack is used up.
    fn room(&self, change: &Self) -> f64 {
        let rooms = self.slacks().zip(change.slacks()).flat_map(|(slack, more)| room(slack, more));
        rooms.fold(f64::INFINITY, f64::min)
    }

    /// Returns how far `change` may be followed until a multiplier is used up.
    fn dual_room(&self, change: &Self) -> f64 {
        let rooms = self
            .multipliers
            .iter()
            .zip(&change.multipliers)
            .flat_map(|(own, more)| room(*own, *more));
        rooms.fold(f64::INFINITY, f64::min)
    }

    fn advance(&mut self, change: &Self, primal: f64, dual: f64) {
        self.bound += primal * change.bound;
        self.values
            .iter_mut()
            .zip(&change.values)
            .for_each(|(value, more)| *value += primal * more);
        for (own, more) in self.multipliers.iter_mut().zip(&change.multipliers) {
            *own = [own[0] + dual * more[0], own[1] + dual * more[1]];
        }
    }
}

fn room(own: [f64; 2], change: [f64; 2]) -> [f64; 2] {
    let side = |i: usize| if change[i] < 0.0 { -own[i] / change[i] } else { f64::INFINITY };
    [side(0), side(1)]
}

/// The Newton step. With s and λ the slacks and multipliers above (+) and below (-) a value z,
/// h = λ / s and a = (μ - Δs Δλ) / s the target of their product, the changes minimise
/// ½ (h⁺ + h⁻) Δz² + (a⁺ - a⁻) Δz - (h⁺ - h⁻) Δz Δt.
struct NewtonStep<'a> {
    riccati: Riccati<'a>,
    states: Band,
    moves: Band,
    /// The changes of x and y for each unit of t.
    per_bound: [Vec<f64>; 2],
    scratch: [Vec<f64>; 2],
}

impl<'a> NewtonStep<'a> {
    fn new(chain: &'a Chain, states: &Band, moves: &Band) -> Self {
        let pair = || [states.values.clone(), moves.values.clone()];
        let riccati = Riccati::new(chain);
        Self {
            riccati,
            states: states.clone(),
            moves: moves.clone(),
            per_bound: pair(),
            scratch: pair(),
        }
    }

    /// Computes predictor and corrector; returns whether there is a step.
    fn find(&mut self, states: &Band, moves: &Band, gap: f64) -> bool {
        fill(&mut self.scratch[0], states.pairs().map(|(s, m)| m[0] / s[0] + m[1] / s[1]));
        fill(&mut self.scratch[1], moves.pairs().map(|(s, m)| m[0] / s[0] + m[1] / s[1]));
        if !self.riccati.factor(&self.scratch[0], &self.scratch[1]) {
            return false;
        }
        let total: f64 = self.scratch[0].iter().sum();
        fill(&mut self.scratch[0], states.pairs().map(|(s, m)| m[1] / s[1] - m[0] / s[0]));
        self.scratch[1].fill(0.0);
        let [x, y] = &mut self.per_bound;
        self.riccati.solve(&self.scratch[0], &self.scratch[1], x, y);
        let curvature = total + dot(&self.scratch[0], x);
        self.predict(states, moves, curvature);
        let primal = states.room(&self.states).min(moves.room(&self.moves)).min(1.0);
        let dual = states.dual_room(&self.states).min(moves.dual_room(&self.moves)).min(1.0);
        let left = states.gap_after(&self.states, primal, dual)
            + moves.gap_after(&self.moves, primal, dual);
        let pairs = 2 * (states.values.len() + moves.values.len());
        self.correct(states, moves, curvature, (left / gap).powi(3) * gap / pairs as f64);
        self.states.bound.is_finite() && curvature > 0.0
    }

    /// Steps towards products of zero.
    fn predict(&mut self, states: &Band, moves: &Band, curvature: f64) {
        for change in [&mut self.states, &mut self.moves] {
            change.multipliers.fill([0.0; 2]);
            change.values.fill(0.0);
        }
        self.follow(states, moves, -1.0 / curvature);
    }

    /// Steps towards products of `mu`, including the second-order term of the predictor.
    fn correct(&mut self, states: &Band, moves: &Band, curvature: f64, mu: f64) {
        self.states.aim(states, mu);
        self.moves.aim(moves, mu);
        let tilt: f64 = -1.0 + self.states.multipliers.iter().map(|a| a[0] + a[1]).sum::<f64>();
        fill(&mut self.scratch[0], self.states.multipliers.iter().map(|a| a[0] - a[1]));
        fill(&mut self.scratch[1], self.moves.multipliers.iter().map(|a| a[0] - a[1]));
        let [q, r] = &self.scratch;
        self.riccati.solve(q, r, &mut self.states.values, &mut self.moves.values);
        let leaning: f64 = states
            .pairs()
            .zip(&self.states.values)
            .map(|((s, m), x)| (m[0] / s[0] - m[1] / s[1]) * x)
            .sum();
        self.follow(states, moves, (tilt + leaning) / curvature);
    }

    /// Adds the effect of a change of t, and turns the targets of the multipliers into their
    /// changes.
    fn follow(&mut self, states: &Band, moves: &Band, change: f64) {
        (self.states.bound, self.moves.bound) = (change, 0.0);
        let all = [(&mut self.states, states), (&mut self.moves, moves)];
        for ((step, own), per_bound) in all.into_iter().zip(&self.per_bound) {
            step.values.iter_mut().zip(per_bound).for_each(|(value, per)| *value += change * per);
            let bound = step.bound;
            for ((aim, value), (slack, multiplier)) in
                step.multipliers.iter_mut().zip(&step.values).zip(own.pairs())
            {
                let more = [bound - value, bound + value];
                *aim = [0, 1].map(|i| aim[i] - multiplier[i] * (1.0 + more[i] / slack[i]));
            }
        }
    }
}

impl Band {
    /// Replaces the multipliers' changes by what their products with the slacks of `own` aim at.
    fn aim(&mut self, own: &Self, mu: f64) {
        let bound = self.bound;
        for ((change, value), slack) in
            self.multipliers.iter_mut().zip(&self.values).zip(own.slacks())
        {
            let more = [bound - value, bound + value];
            *change = [0, 1].map(|i| (mu - more[i] * change[i]) / slack[i]);
        }
    }
}

fn fill(to: &mut [f64], from: impl Iterator<Item = f64>) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = from);
}
