use std::iter::repeat_n;

use reachtube_abstraction::{Linearisation, PolynomialModel};
use reachtube_reach::{Disturbance, Hyperrectangle};
use reachtube_recordings::Run;
use reachtube_scalar::rounding::{add_down, add_up, sub_up};

use crate::data::case::Case;
use crate::explain::chain::Chain;
use crate::explain::regulate::{Regulated, regulate};
use crate::explain::steps::{ModelSteps, Step};
use crate::nominal::simulate::{STEP_NORM, simulate};
use crate::sets::UncertaintySets;

/// Linearised residuals that differ by this many units are the same.
const SAME: f64 = 1e-5;

/// How far the model's own residual may exceed the residual of its linearisation before it is
/// linearised again.
const SLACK: f64 = 1.02;

/// Linearisations of one run.
const PASSES: usize = 4;

/// A disturbance that is held for the whole motion is a state of the chain, in this many units at
/// the edge of its set: so few that it never decides how close the motion is.
const CONSTANT_UNITS: f64 = 1e-6;

/// A motion of the model, and its residuals from the recorded one.
#[derive(Debug)]
pub(super) struct Behaviour {
    /// Samples but the last x n.
    pub inputs: Vec<f64>,
    /// The disturbance that was held for the whole motion, n; `None` if it may change at each
    /// sample.
    pub constant: Option<Vec<f64>>,
    /// Samples x 2n from the start on, as far as it could be followed.
    pub states: Vec<f64>,
    /// The largest residual of a position, rad.
    pub position: f64,
    /// The largest residual of a velocity, rad/s.
    pub velocity: f64,
    /// The largest residual in units.
    pub largest: f64,
}

/// What counts as close.
#[derive(Debug, Clone, Copy)]
pub(super) struct Closeness<'a> {
    /// The unit of each state, 2n, rad and rad/s, in which the largest residual is minimised.
    pub units: &'a [f64],
    /// Residuals below this many units are not made smaller.
    pub enough: f64,
}

/// The search for the motion of the model that is closest to one run: the model is linearised along
/// the recorded motion, then along the one found.
pub(super) struct ClosestMotion<'a> {
    model: &'a PolynomialModel,
    recorded: &'a Run,
    /// Lowest and highest start, 2n.
    start: Vec<[f64; 2]>,
    /// Lowest and highest input, samples but the last x n.
    inputs: Vec<[f64; 2]>,
    /// The input that is given, samples but the last x n.
    given: &'a [f64],
    /// Lowest and highest disturbance, n, where one is held for the whole motion.
    constant: Option<Vec<[f64; 2]>>,
    closeness: Closeness<'a>,
    substeps: usize,
}

impl<'a> ClosestMotion<'a> {
    pub(super) fn new(
        model: &'a PolynomialModel,
        case: &'a Case,
        sets: &UncertaintySets,
        disturbance: Disturbance,
        recorded: &'a Run,
        closeness: Closeness<'a>,
    ) -> Self {
        let n = case.joints();
        let acting = &case.inputs[..n * recorded.len().saturating_sub(1)];
        let inputs =
            (0..acting.len()).map(|at| bounds(acting[at], &sets.input_set, at % n)).collect();
        let base = case.start.clone();
        let start = (0..2 * n).map(|i| bounds(base[i], &sets.initial_set, i)).collect();
        let mut linearisation = Linearisation::new(model);
        let norms = acting.chunks_exact(n).enumerate().map(|(k, u)| {
            let (a, _) = linearisation.at(recorded.state(k), u);
            let norm = a.row_iter().map(|row| row.lp_norm(1)).fold(0.0, f64::max);
            norm * (recorded.times[k + 1] - recorded.times[k])
        });
        let substeps = (norms.fold(0.0, f64::max) / STEP_NORM).ceil().clamp(1.0, 1e3) as usize;
        let constant = (disturbance == Disturbance::Constant)
            .then(|| (0..n).map(|j| bounds(0.0, &sets.input_set, j)).collect());
        Self { model, recorded, start, inputs, given: acting, constant, closeness, substeps }
    }

    /// Searches for the motion.
    pub(super) fn run(&self) -> Behaviour {
        let found = run_together(std::slice::from_ref(self)).pop();
        found.expect("each search has an answer")
    }

    /// Returns the motion at moves that were found with the model linearised along another.
    fn moved(&self, found: &Regulated) -> Behaviour {
        let place = |([low, high], y): (&[f64; 2], &f64)| {
            (0.5 * (low + high + y * (high - low))).clamp(*low, *high)
        };
        let mut moves = found.moves.iter();
        let start: Vec<f64> = self.start.iter().zip(moves.by_ref()).map(place).collect();
        let (constant, inputs) = match &self.constant {
            None => (None, self.inputs.iter().zip(moves).map(place).collect()),
            Some(allowed) => {
                let constant: Vec<f64> = allowed.iter().zip(moves).map(place).collect();
                let inputs = self.given.iter().zip(constant.iter().cycle()).map(|(u, d)| u + d);
                (Some(constant.clone()), inputs.collect())
            }
        };
        self.behaviour(&start, inputs, constant)
    }

    /// Returns the distance of the linearised model from the recorded motion in units, as a chain
    /// in the start and inputs, which move through their boxes, [-1, 1] each. A disturbance that is
    /// held for the whole motion moves in the first link, and is a part of the chain's state.
    fn chain(&self, states: &[f64], inputs: &[f64]) -> Chain<f64> {
        let (n, units) = (self.recorded.joints, self.closeness.units);
        let radii = self.start.iter().zip(units).map(|(start, unit)| radius(start) / unit);
        let distances =
            (0..2 * n).map(|i| (middle(&self.start[i]) - self.recorded.states[i]) / units[i]);
        let constant = self.chain_states() - 2 * n;
        let mut chain = Chain::new(self.chain_states());
        chain.push_diagonal(
            radii.chain(repeat_n(CONSTANT_UNITS, constant)),
            distances.chain(repeat_n(0.0, constant)),
        );
        let mut steps = ModelSteps::new(self.model, self.substeps);
        for k in 1..self.recorded.len() {
            let (before, after) = states[(k - 1) * 2 * n..(k + 1) * 2 * n].split_at(2 * n);
            let held = &inputs[(k - 1) * n..k * n];
            let times = [self.recorded.times[k - 1], self.recorded.times[k]];
            self.link(k, steps.step(times, before, after, held), before, held, &mut chain);
        }
        chain
    }

    /// The number of states of the chain: 2n, and n where a disturbance is held.
    fn chain_states(&self) -> usize {
        2 * self.recorded.joints + self.constant.as_ref().map_or(0, Vec::len)
    }

    /// Appends the step to sample k, made from the state `before` under the input `held`, as a link
    /// from the recorded state and the middle of the allowed inputs.
    fn link(&self, k: usize, step: Step, before: &[f64], held: &[f64], chain: &mut Chain<f64>) {
        let (n, units) = (held.len(), self.closeness.units);
        let allowed = &self.inputs[(k - 1) * n..k * n];
        let from = self.recorded.state(k - 1);
        let all = self.chain_states();
        let mut rows = Vec::with_capacity(all * (all + n));
        let mut drift = Vec::with_capacity(all);
        for (i, to) in self.recorded.state(k).iter().enumerate() {
            let mut push = |of: &mut dyn Iterator<Item = f64>| rows.extend(of);
            let moved = |j: usize| step.transition[i * 2 * n + j] * units[j] / units[i];
            match &self.constant {
                None => {
                    let gain = |(j, u)| step.gain[i * n + j] * radius(u) / units[i];
                    push(&mut allowed.iter().enumerate().map(gain));
                    push(&mut (0..2 * n).map(moved));
                }
                Some(constant) => {
                    let gain =
                        |(j, d)| step.gain[i * n + j] * radius(d) / (units[i] * CONSTANT_UNITS);
                    push(&mut (0..2 * n).map(moved));
                    push(&mut constant.iter().enumerate().map(gain));
                }
            }
            let moved: f64 =
                (0..2 * n).map(|j| step.transition[i * 2 * n + j] * (from[j] - before[j])).sum();
            let pushed: f64 =
                (0..n).map(|j| step.gain[i * n + j] * (middle(&allowed[j]) - held[j])).sum();
            drift.push((step.reached[i] + moved + pushed - to) / units[i]);
        }
        for i in 2 * n..all {
            rows.extend((0..all).map(|j| f64::from(u8::from(i == j))));
            drift.push(0.0);
        }
        chain.push(rows, drift);
    }

    fn behaviour(&self, start: &[f64], inputs: Vec<f64>, constant: Option<Vec<f64>>) -> Behaviour {
        let n = self.recorded.joints;
        let states = simulate(self.model, &self.recorded.times, self.substeps, start, &inputs)
            .unwrap_or_default();
        let (mut residuals, mut largest) = ([0.0_f64; 2], 0.0_f64);
        for (at, (x, recorded)) in states.iter().zip(&self.recorded.states).enumerate() {
            let (residual, difference) = (&mut residuals[at / n % 2], (x - recorded).abs());
            *residual = residual.max(difference);
            largest = largest.max(difference / self.closeness.units[at % (2 * n)]);
        }
        if states.len() < self.recorded.states.len() {
            (residuals, largest) = ([f64::INFINITY; 2], f64::INFINITY);
        }
        Behaviour {
            inputs,
            constant,
            states,
            position: residuals[0],
            velocity: residuals[1],
            largest,
        }
    }
}

/// Repeats the linearisation of each search until the model meets its residual. Searches with as
/// many samples have their chains regulated side by side.
pub(super) fn run_together(searches: &[ClosestMotion]) -> Vec<Behaviour> {
    let centres = searches.iter().map(|search| search.inputs.iter().map(middle).collect());
    let centres: Vec<Vec<f64>> = centres.collect();
    let along = searches.iter().zip(&centres);
    let mut best =
        pass(along.map(|(search, centre)| (search, &*search.recorded.states, &**centre)));
    let mut is_open = vec![true; searches.len()];
    for _ in 1..PASSES {
        for ((found, expected), is_open) in best.iter().zip(&mut is_open) {
            *is_open &= found.largest.is_finite() && found.largest > SLACK * expected + SAME;
        }
        let open = || searches.iter().zip(&best).zip(&is_open).filter(|(_, is_open)| **is_open);
        let next =
            pass(open().map(|((search, (found, _)), _)| (search, &*found.states, &*found.inputs)));
        let places = best.iter_mut().zip(&mut is_open).filter(|(_, is_open)| **is_open);
        for ((best, is_open), next) in places.zip(next) {
            if next.0.largest < best.0.largest {
                *best = next;
            } else {
                *is_open = false;
            }
        }
    }
    best.into_iter().map(|(found, _)| found).collect()
}

/// Returns the motions found with models linearised along other motions, of given states and
/// inputs, and the largest residual that each would have if the linearisation were the model.
fn pass<'a, 'm: 'a>(
    searches: impl Iterator<Item = (&'a ClosestMotion<'m>, &'a [f64], &'a [f64])>,
) -> Vec<(Behaviour, f64)> {
    let (searches, chains): (Vec<_>, Vec<_>) =
        searches.map(|(search, states, inputs)| (search, search.chain(states, inputs))).unzip();
    let Some(first) = searches.first() else { return Vec::new() };
    let found = regulate(&chains, first.closeness.enough);
    searches
        .iter()
        .zip(&found)
        .map(|(search, found)| (search.moved(found), found.largest))
        .collect()
}

/// Returns the lowest and highest number of base + set in dimension i, rounded inwards; the nearest
/// number twice where none lies between.
fn bounds(base: f64, set: &Hyperrectangle, i: usize) -> [f64; 2] {
    let (centre, radius) = (set.centre[i], set.radius[i]);
    let (low, high) =
        (add_up(base, sub_up(centre, radius)), add_down(base, add_down(centre, radius)));
    if low <= high { [low, high] } else { [base + centre; 2] }
}

fn middle([low, high]: &[f64; 2]) -> f64 {
    0.5 * (low + high)
}

fn radius([low, high]: &[f64; 2]) -> f64 {
    0.5 * (high - low)
}
