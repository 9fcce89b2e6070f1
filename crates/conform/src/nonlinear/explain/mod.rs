//! Behaviours of a model that come close to recordings: what a run could have been.

mod chain;
mod regulate;
#[cfg(test)]
mod tests;

use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_ode::RungeKutta4;
use reachtube_reach::Hyperrectangle;
use reachtube_robot::Robot;
use reachtube_scalar::rounding::{add_down, add_up, sub_up};

use self::chain::Chain;
use self::regulate::regulate;
use super::case::Case;
use super::sensitivity::{STEP_NORM, simulate};
use crate::error::Result;
use crate::recordings::read_run;
use crate::{Recordings, Settings, UncertaintySets};
use reachtube_abstraction::{Linearisation, ModelField, PolynomialModel};
use reachtube_recordings::{DataSet, Run};

/// What counts as one unit of position, rad, and of velocity, rad/s, where the largest residual is
/// made least. It is about what recordings leave open: those of the LWA 4P differ by up to 0.0003
/// rad between q and the integral of q̇, and q̇ by up to 0.009 rad/s from a local parabola.
const UNITS: [f64; 2] = [1e-3, 1e-2];

/// Residuals below this many units are not made smaller.
const ENOUGH: f64 = 1e-5;

/// How far the model's own residual may exceed that of its linearisation before it is linearised
/// again.
const SLACK: f64 = 1.02;

/// Linearisations of one run.
const PASSES: usize = 4;

/// How close a model comes to a recorded run: the largest |recorded - simulated| over all samples
/// and joints of the closest motion found, whose start lies in start + X0 and whose input lies in
/// u_m + U and is held from each sample to the next. Infinite where the simulation ran away.
///
/// That motion is a witness: the run is explained within these residuals. That there is none closer
/// is not said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Explanation {
    /// The run (index in the data set).
    pub run: usize,
    /// rad.
    pub position: f64,
    /// rad/s.
    pub velocity: f64,
}

/// The explanation of each run of each suite, in the order of the recordings, on all cores.
///
/// # Errors
///
/// Defects of a run that has changed since it was first read.
pub fn explain(
    data: &DataSet,
    robot: &Robot,
    settings: &Settings,
    model: &PolynomialModel,
    cases: &[Case],
    recordings: &Recordings,
    sets: &UncertaintySets,
) -> Result<Vec<Explanation>> {
    let suites = recordings.suites.iter().enumerate();
    let runs: Vec<(usize, usize)> = suites
        .flat_map(|(suite, read)| read.runs.iter().map(move |run| (suite, run.index)))
        .collect();
    let of = |&(suite, run): &(usize, usize)| {
        let is_its = |case: &&Case| case.suite == suite && case.run.is_none_or(|own| own == run);
        let case = cases.iter().find(is_its).expect("every run of the recordings has a case");
        let (recorded, _) =
            read_run(data, run, robot, settings).map_err(reachtube_recordings::Error::Defects)?;
        let Behaviour { position, velocity, .. } = Search::new(model, case, sets, &recorded).run();
        Ok(Explanation { run, position, velocity })
    };
    runs.par_iter().map(of).collect()
}

/// A motion of the model, and how far the recorded one is from it.
#[derive(Debug)]
struct Behaviour {
    /// Samples but the last x n.
    inputs: Vec<f64>,
    /// Samples x 2n from the start on, as far as it could be followed.
    states: Vec<f64>,
    position: f64,
    velocity: f64,
}

impl Behaviour {
    /// The larger residual in units.
    fn largest(&self) -> f64 {
        (self.position / UNITS[0]).max(self.velocity / UNITS[1])
    }
}

/// The behaviour sought for one run: the model is linearised along the recorded motion, then along
/// the one found.
struct Search<'a> {
    model: &'a PolynomialModel,
    recorded: &'a Run,
    /// Lowest and highest start, 2n.
    start: Vec<[f64; 2]>,
    /// Lowest and highest input, samples but the last x n.
    inputs: Vec<[f64; 2]>,
    substeps: usize,
}

impl<'a> Search<'a> {
    fn new(
        model: &'a PolynomialModel,
        case: &Case,
        sets: &UncertaintySets,
        recorded: &'a Run,
    ) -> Self {
        let n = case.joints();
        let acting = &case.inputs[..n * recorded.len().saturating_sub(1)];
        let inputs =
            (0..acting.len()).map(|at| bounds(acting[at], &sets.input_set, at % n)).collect();
        let start = (0..2 * n).map(|i| bounds(case.start[i], &sets.initial_set, i)).collect();
        let mut linearisation = Linearisation::new(model);
        let norms = acting.chunks_exact(n).enumerate().map(|(k, u)| {
            let (a, _) = linearisation.at(recorded.state(k), u);
            let norm = a.row_iter().map(|row| row.lp_norm(1)).fold(0.0, f64::max);
            norm * (recorded.times[k + 1] - recorded.times[k])
        });
        let substeps = (norms.fold(0.0, f64::max) / STEP_NORM).ceil().clamp(1.0, 1e3) as usize;
        Self { model, recorded, start, inputs, substeps }
    }

    fn run(&self) -> Behaviour {
        let centre: Vec<f64> = self.inputs.iter().map(middle).collect();
        let (mut best, mut expected) = self.pass(&self.recorded.states, &centre);
        for _ in 1..PASSES {
            if !best.largest().is_finite() || best.largest() <= SLACK * expected + ENOUGH {
                break;
            }
            let (next, next_expected) = self.pass(&best.states, &best.inputs);
            if next.largest() >= best.largest() {
                break;
            }
            (best, expected) = (next, next_expected);
        }
        best
    }

    /// What is found with the model linearised along a motion, and what its largest residual would
    /// be if the linearisation were the model.
    fn pass(&self, states: &[f64], inputs: &[f64]) -> (Behaviour, f64) {
        let found = regulate(&self.chain(states, inputs), ENOUGH);
        let place = |([low, high], y): (&[f64; 2], &f64)| {
            (0.5 * (low + high + y * (high - low))).clamp(*low, *high)
        };
        let mut moves = found.moves.iter();
        let start: Vec<f64> = self.start.iter().zip(moves.by_ref()).map(place).collect();
        let inputs = self.inputs.iter().zip(moves).map(place).collect();
        (self.behaviour(&start, inputs), found.largest)
    }

    /// The distance of the linearised model from the recorded motion in units, as start and inputs
    /// move through their boxes, [-1, 1] each.
    fn chain(&self, states: &[f64], inputs: &[f64]) -> Chain {
        let n = self.recorded.joints;
        let mut chain = Chain::new(2 * n);
        let reach =
            &|i: usize, j: usize| if i == j { radius(&self.start[i]) / unit(n, i) } else { 0.0 };
        let rows = (0..2 * n).flat_map(|i| (0..4 * n).map(move |j| reach(i, j))).collect();
        chain.push(
            rows,
            (0..2 * n).map(|i| (middle(&self.start[i]) - self.recorded.states[i]) / unit(n, i)),
        );
        let mut steps = Steps::new(self.model, self.substeps);
        for k in 1..self.recorded.len() {
            let (before, after) = states[(k - 1) * 2 * n..(k + 1) * 2 * n].split_at(2 * n);
            let held = &inputs[(k - 1) * n..k * n];
            let times = [self.recorded.times[k - 1], self.recorded.times[k]];
            self.link(k, steps.step(times, before, after, held), before, held, &mut chain);
        }
        chain
    }

    /// The step to sample k, made from the state `before` under the input `held`, as a link from
    /// the recorded state and the middle of the allowed inputs.
    fn link(&self, k: usize, step: Step, before: &[f64], held: &[f64], chain: &mut Chain) {
        let n = held.len();
        let allowed = &self.inputs[(k - 1) * n..k * n];
        let from = self.recorded.state(k - 1);
        let mut rows = Vec::with_capacity(6 * n * n);
        let mut drift = Vec::with_capacity(2 * n);
        for (i, to) in self.recorded.state(k).iter().enumerate() {
            let gains =
                allowed.iter().enumerate().map(|(j, u)| step.gain[(i, j)] * radius(u) / unit(n, i));
            rows.extend(gains);
            rows.extend((0..2 * n).map(|j| step.transition[(i, j)] * unit(n, j) / unit(n, i)));
            let moved: f64 =
                (0..2 * n).map(|j| step.transition[(i, j)] * (from[j] - before[j])).sum();
            let pushed: f64 =
                (0..n).map(|j| step.gain[(i, j)] * (middle(&allowed[j]) - held[j])).sum();
            drift.push((step.reached[i] + moved + pushed - to) / unit(n, i));
        }
        chain.push(rows, drift);
    }

    fn behaviour(&self, start: &[f64], inputs: Vec<f64>) -> Behaviour {
        let n = self.recorded.joints;
        let states = simulate(self.model, &self.recorded.times, self.substeps, start, &inputs)
            .unwrap_or_default();
        let mut residuals = [0.0_f64; 2];
        for (at, (x, recorded)) in states.iter().zip(&self.recorded.states).enumerate() {
            let residual = &mut residuals[at / n % 2];
            *residual = residual.max((x - recorded).abs());
        }
        if states.len() < self.recorded.states.len() {
            residuals = [f64::INFINITY; 2];
        }
        Behaviour { inputs, states, position: residuals[0], velocity: residuals[1] }
    }
}

/// The unit of state i.
fn unit(joints: usize, i: usize) -> f64 {
    UNITS[i / joints]
}

/// Lowest and highest of base + set in dimension i, rounded inwards; one number, the nearest, where
/// no other lies between.
fn bounds(base: f64, set: &Hyperrectangle, i: usize) -> [f64; 2] {
    let (center, radius) = (set.center[i], set.radius[i]);
    let (low, high) =
        (add_up(base, sub_up(center, radius)), add_down(base, add_down(center, radius)));
    if low <= high { [low, high] } else { [base + center; 2] }
}

fn middle([low, high]: &[f64; 2]) -> f64 {
    0.5 * (low + high)
}

fn radius([low, high]: &[f64; 2]) -> f64 {
    0.5 * (high - low)
}

/// The model from one sample to the next, and its derivatives.
struct Steps<'a> {
    model: &'a PolynomialModel,
    linearisation: Linearisation,
    field: ModelField<'a, f64>,
    method: RungeKutta4<f64>,
    substeps: usize,
}

struct Step {
    /// The state reached, with what else the model counts as state.
    reached: Vec<f64>,
    transition: DMatrix<f64>,
    gain: DMatrix<f64>,
}

impl<'a> Steps<'a> {
    fn new(model: &'a PolynomialModel, substeps: usize) -> Self {
        let (linearisation, field) = (Linearisation::new(model), ModelField::new(model));
        Self { model, linearisation, field, method: RungeKutta4::new(model.states()), substeps }
    }

    /// From the state `before` under a held input; the derivatives are those halfway to `after`.
    fn step(&mut self, times: [f64; 2], before: &[f64], after: &[f64], held: &[f64]) -> Step {
        let n = held.len();
        let mut x = self.model.state(&before[..n], &before[n..]);
        self.method.integrate(&mut self.field, times, self.substeps, &mut x, held);
        let middle: Vec<f64> = before.iter().zip(after).map(|(x, y)| 0.5 * (x + y)).collect();
        let (a, b) = self.linearisation.at(&middle, held);
        let mut augmented = DMatrix::zeros(3 * n, 3 * n);
        augmented.view_mut((0, 0), (2 * n, 2 * n)).copy_from(a);
        augmented.view_mut((0, 2 * n), (2 * n, n)).copy_from(b);
        let exponential = (augmented * (times[1] - times[0])).exp();
        Step {
            reached: x,
            transition: exponential.view((0, 0), (2 * n, 2 * n)).into_owned(),
            gain: exponential.view((0, 2 * n), (2 * n, n)).into_owned(),
        }
    }
}
