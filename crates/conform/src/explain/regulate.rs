//! The moves within bounds that keep a chain of states closest to zero.
//!
//! The program is a linear one with as many unknowns as a run has inputs and states (18,000 for 4 s
//! of a six-joint arm). Its structure, a chain, makes each Newton step one Riccati recursion, whose
//! time is linear in the samples. The conic solver of the sets takes 12 times as long on a chain of
//! 1,000 samples (1.58 s against 0.13 s; see the ignored test of the long chain). The chains of
//! several runs are regulated side by side, in the lanes of vector instructions.

use reachtube_scalar::{Dispatch, Kernel, Lanes, Lanewise};

use crate::explain::chain::{Chain, Riccati, dot};

/// Number of chains that are regulated side by side.
pub(super) const TOGETHER: usize = 4;

/// Moves in [-1, 1], and the largest |x| of the states that follow.
#[derive(Debug, Clone, PartialEq)]
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

/// Minimises t over |x| <= t, |y| <= 1 for the states x and moves y of each chain, until t falls
/// below `enough`. Neighbours that are alike are regulated together, which does not change a bit of
/// the result.
pub(super) fn regulate(chains: &[Chain<f64>], enough: f64) -> Vec<Regulated> {
    let alike = chains.chunk_by(|a, b| a.is_alike(b));
    let groups = alike.flat_map(|alike| alike.chunks(TOGETHER));
    let of_group = |group: &[Chain<f64>]| match group {
        [alone] => f64::dispatch(Regulation { chain: alone, enough }),
        _ => {
            let chain = &Chain::<Lanes<TOGETHER>>::of_lanes(group);
            let mut all = Lanes::<TOGETHER>::dispatch(Regulation { chain, enough });
            all.truncate(group.len());
            all
        }
    };
    groups.flat_map(of_group).collect()
}

/// The linear program of a chain, or of one in each lane, solved by the primal-dual interior-point
/// method of Mehrotra (SIAM J. Optim. 2, 1992), each of whose steps is one Riccati recursion (Rao,
/// Wright, Rawlings, J. Optim. Theory Appl. 99, 1998).
struct Regulation<'a, S> {
    chain: &'a Chain<S>,
    enough: f64,
}

impl<S: Lanewise> Kernel for Regulation<'_, S> {
    /// One answer for each lane.
    type Output = Vec<Regulated>;

    /// A lane that is done goes on without anybody looking, until all are.
    #[inline(always)]
    fn run(self) -> Vec<Regulated> {
        let (mut states, mut moves) = start(self.chain);
        let mut step = NewtonStep::new(self.chain, &states, &moves);
        let mut done: Vec<Option<Regulated>> = vec![None; S::LANES];
        for iteration in 0..=ITERATIONS {
            let gap = states.gap() + moves.gap();
            let is_close = |lane: usize| {
                let bound = states.bound.lane(lane);
                gap.lane(lane) <= ACCURACY * bound || bound <= self.enough
            };
            let ends = |lane: usize| iteration == ITERATIONS || is_close(lane);
            take(&mut done, &states, &moves, ends);
            if done.iter().all(Option::is_some) {
                break;
            }
            let is_step = step.find(&states, &moves, gap);
            take(&mut done, &states, &moves, |lane| !is_step[lane]);
            let (caution, whole) = (S::from(CAUTION), S::from(1.0 / CAUTION));
            let [states_room, moves_room] = [states.room(&step.states), moves.room(&step.moves)];
            let primal = caution * least(least(states_room[0], moves_room[0]), whole);
            let dual = caution * least(least(states_room[1], moves_room[1]), whole);
            states.advance(&step.states, primal, dual);
            moves.advance(&step.moves, primal, dual);
        }
        done.into_iter().flatten().collect()
    }
}

/// Takes the answer of each lane that `ends` and has none.
fn take<S: Lanewise>(
    done: &mut [Option<Regulated>],
    states: &Band<S>,
    moves: &Band<S>,
    ends: impl Fn(usize) -> bool,
) {
    let open = done.iter_mut().enumerate().filter(|(lane, done)| done.is_none() && ends(*lane));
    open.for_each(|(lane, done)| {
        let of_lane = |values: &[S]| values.iter().map(|x| x.lane(lane)).collect::<Vec<_>>();
        let largest = of_lane(&states.values).iter().fold(0.0, |max: f64, x| max.max(x.abs()));
        *done = Some(Regulated { moves: of_lane(&moves.values), largest });
    });
}

/// Returns the start: no moves, with multipliers on the central path.
#[inline(always)]
fn start<S: Lanewise>(chain: &Chain<S>) -> (Band<S>, Band<S>) {
    let rest = chain.rest();
    let largest = rest.iter().fold(S::zero(), |max, x| max.zip(*x, |max, x| max.max(x.abs())));
    let mut states = Band::new(S::from(1.1) * largest, rest);
    let mut moves = Band::new(S::one(), vec![S::zero(); chain.moves()]);
    let inverse = sum(states.slacks().map(|[above, below]| S::one() / above + S::one() / below));
    states.set_multipliers(S::one() / inverse);
    moves.set_multipliers(S::one() / inverse);
    (states, moves)
}

/// Values that stay within ± a bound, with a multiplier for each side; or the change of all that in
/// one step.
#[derive(Debug, Clone)]
struct Band<S> {
    bound: S,
    values: Vec<S>,
    multipliers: Vec<[S; 2]>,
}

impl<S: Lanewise> Band<S> {
    fn new(bound: S, values: Vec<S>) -> Self {
        Self { bound, multipliers: vec![[S::zero(); 2]; values.len()], values }
    }

    /// Returns the slack above and below each value.
    #[inline(always)]
    fn slacks(&self) -> impl Iterator<Item = [S; 2]> {
        self.values.iter().map(|value| [self.bound - *value, self.bound + *value])
    }

    /// Returns slacks and multipliers.
    #[inline(always)]
    fn pairs(&self) -> impl Iterator<Item = ([S; 2], [S; 2])> {
        self.slacks().zip(self.multipliers.iter().copied())
    }

    #[inline(always)]
    fn set_multipliers(&mut self, product: S) {
        for (multipliers, value) in self.multipliers.iter_mut().zip(&self.values) {
            *multipliers = [product / (self.bound - *value), product / (self.bound + *value)];
        }
    }

    #[inline(always)]
    fn gap(&self) -> S {
        sum(self
            .pairs()
            .map(|(slack, multiplier)| slack[0] * multiplier[0] + slack[1] * multiplier[1]))
    }

    /// Returns the gap after a step.
    #[inline(always)]
    fn gap_after(&self, change: &Self, primal: S, dual: S) -> S {
        let pairs = self.pairs().zip(change.pairs());
        pairs.fold(S::zero(), |gap, (own, change)| {
            let side =
                |i: usize| (own.0[i] + primal * change.0[i]) * (own.1[i] + dual * change.1[i]);
            gap + side(0) + side(1)
        })
    }

    /// Returns how far `change` may be followed until a slack is used up, and until a multiplier
    /// is.
    #[inline(always)]
    fn room(&self, change: &Self) -> [S; 2] {
        let most = [S::from(f64::INFINITY); 2];
        self.pairs().zip(change.pairs()).fold(most, |[primal, dual], (own, more)| {
            [room(primal, own.0, more.0), room(dual, own.1, more.1)]
        })
    }

    #[inline(always)]
    fn advance(&mut self, change: &Self, primal: S, dual: S) {
        self.bound += primal * change.bound;
        self.values
            .iter_mut()
            .zip(&change.values)
            .for_each(|(value, more)| *value += primal * *more);
        for (own, more) in self.multipliers.iter_mut().zip(&change.multipliers) {
            *own = [own[0] + dual * more[0], own[1] + dual * more[1]];
        }
    }
}

/// Returns how far both sides may change until one is used up, at most `most`.
#[inline(always)]
fn room<S: Lanewise>(most: S, own: [S; 2], change: [S; 2]) -> S {
    let side = |i: usize| {
        own[i].zip(change[i], |own, more| if more < 0.0 { -own / more } else { f64::INFINITY })
    };
    least(least(most, side(0)), side(1))
}

#[inline(always)]
fn least<S: Lanewise>(a: S, b: S) -> S {
    a.zip(b, f64::min)
}

#[inline(always)]
fn sum<S: Lanewise>(terms: impl Iterator<Item = S>) -> S {
    terms.fold(S::zero(), |sum, term| sum + term)
}

/// The Newton step. With s and λ the slacks and multipliers above (+) and below (-) a value z,
/// h = λ / s and a = (μ - Δs Δλ) / s the target of their product, the changes minimise
/// ½ (h⁺ + h⁻) Δz² + (a⁺ - a⁻) Δz - (h⁺ - h⁻) Δz Δt.
struct NewtonStep<'a, S> {
    riccati: Riccati<'a, S>,
    states: Band<S>,
    moves: Band<S>,
    /// The changes of x and y for each unit of t.
    per_bound: [Vec<S>; 2],
    scratch: [Vec<S>; 2],
}

impl<'a, S: Lanewise> NewtonStep<'a, S> {
    fn new(chain: &'a Chain<S>, states: &Band<S>, moves: &Band<S>) -> Self {
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

    /// Computes predictor and corrector; returns in which lanes there is a step.
    #[inline(always)]
    fn find(&mut self, states: &Band<S>, moves: &Band<S>, gap: S) -> Vec<bool> {
        fill(&mut self.scratch[0], states.pairs().map(|(s, m)| m[0] / s[0] + m[1] / s[1]));
        fill(&mut self.scratch[1], moves.pairs().map(|(s, m)| m[0] / s[0] + m[1] / s[1]));
        let mut is_step = self.riccati.factor(&self.scratch[0], &self.scratch[1]);
        let total = sum(self.scratch[0].iter().copied());
        fill(&mut self.scratch[0], states.pairs().map(|(s, m)| m[1] / s[1] - m[0] / s[0]));
        self.scratch[1].fill(S::zero());
        let [x, y] = &mut self.per_bound;
        self.riccati.solve(&self.scratch[0], &self.scratch[1], x, y);
        let curvature = total + dot(&self.scratch[0], x);
        self.predict(states, moves, curvature);
        let rooms = [states.room(&self.states), moves.room(&self.moves)];
        let [primal, dual] = [0, 1].map(|i| least(least(rooms[0][i], rooms[1][i]), S::one()));
        let left = states.gap_after(&self.states, primal, dual)
            + moves.gap_after(&self.moves, primal, dual);
        let pairs = 2 * (states.values.len() + moves.values.len());
        let part = left / gap;
        self.correct(states, moves, curvature, part * part * part * gap / S::from(pairs as f64));
        for (lane, is_step) in is_step.iter_mut().enumerate() {
            *is_step &= self.states.bound.lane(lane).is_finite() && curvature.lane(lane) > 0.0;
        }
        is_step
    }

    /// Steps towards products of zero.
    #[inline(always)]
    fn predict(&mut self, states: &Band<S>, moves: &Band<S>, curvature: S) {
        for change in [&mut self.states, &mut self.moves] {
            change.multipliers.fill([S::zero(); 2]);
            change.values.fill(S::zero());
        }
        self.follow(states, moves, -S::one() / curvature);
    }

    /// Steps towards products of `mu`, including the second-order term of the predictor.
    #[inline(always)]
    fn correct(&mut self, states: &Band<S>, moves: &Band<S>, curvature: S, mu: S) {
        self.states.aim(states, mu);
        self.moves.aim(moves, mu);
        let tilt = sum(self.states.multipliers.iter().map(|a| a[0] + a[1])) - S::one();
        fill(&mut self.scratch[0], self.states.multipliers.iter().map(|a| a[0] - a[1]));
        fill(&mut self.scratch[1], self.moves.multipliers.iter().map(|a| a[0] - a[1]));
        let [q, r] = &self.scratch;
        self.riccati.solve(q, r, &mut self.states.values, &mut self.moves.values);
        let leaning = sum(states
            .pairs()
            .zip(&self.states.values)
            .map(|((s, m), x)| (m[0] / s[0] - m[1] / s[1]) * *x));
        self.follow(states, moves, (tilt + leaning) / curvature);
    }

    /// Adds the effect of a change of t, and turns the targets of the multipliers into their
    /// changes.
    #[inline(always)]
    fn follow(&mut self, states: &Band<S>, moves: &Band<S>, change: S) {
        (self.states.bound, self.moves.bound) = (change, S::zero());
        let all = [(&mut self.states, states), (&mut self.moves, moves)];
        for ((step, own), per_bound) in all.into_iter().zip(&self.per_bound) {
            step.values.iter_mut().zip(per_bound).for_each(|(value, per)| *value += change * *per);
            let bound = step.bound;
            for ((aim, value), (slack, multiplier)) in
                step.multipliers.iter_mut().zip(&step.values).zip(own.pairs())
            {
                let more = [bound - *value, bound + *value];
                *aim = [0, 1].map(|i| aim[i] - multiplier[i] * (S::one() + more[i] / slack[i]));
            }
        }
    }
}

impl<S: Lanewise> Band<S> {
    /// Replaces the multipliers' changes by what their products with the slacks of `own` aim at.
    #[inline(always)]
    fn aim(&mut self, own: &Self, mu: S) {
        let bound = self.bound;
        for ((change, value), slack) in
            self.multipliers.iter_mut().zip(&self.values).zip(own.slacks())
        {
            let more = [bound - *value, bound + *value];
            *change = [0, 1].map(|i| (mu - more[i] * change[i]) / slack[i]);
        }
    }
}

#[inline(always)]
fn fill<S>(to: &mut [S], from: impl Iterator<Item = S>) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = from);
}
