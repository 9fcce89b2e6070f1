//! Disturbances of a six-joint arm, a million in the long test, stay within the reachable sets, and
//! the worst ones reach their faces.

use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_reach::{Disturbance, Hyperrectangle, Propagation, ReachSets, TimeGrid};

use crate::arm::arm;
use crate::random::Random;

const SAMPLES: usize = 71;
const STEP: f64 = 0.004;

/// Number of disturbances simulated at once, as the columns of a matrix.
const BATCH: usize = 500;

/// Largest rounding error of the simulation.
const ROUNDING: f64 = 1e-12;

fn sets() -> (Hyperrectangle, Hyperrectangle) {
    let ramp = |n: usize, low: f64, step: f64| (0..n).map(|i| low + step * i as f64).collect();
    let initial = Hyperrectangle { centre: ramp(12, -0.03, 0.006), radius: ramp(12, 0.002, 0.001) };
    let input = Hyperrectangle { centre: ramp(6, 0.4, -0.2), radius: ramp(6, 0.3, 0.15) };
    (initial, input)
}

/// A propagation, its reachable sets, and the floating-point step of the simulation.
struct Case {
    propagation: Propagation,
    reach: ReachSets,
    phi: DMatrix<f64>,
    gamma: DMatrix<f64>,
}

impl Case {
    fn new(disturbance: Disturbance) -> Self {
        let propagation = Propagation::new(&arm(), &TimeGrid::uniform(STEP, SAMPLES)).unwrap();
        let (initial, input) = sets();
        let reach =
            ReachSets::new(&propagation, &disturbance.input_gains(&propagation), &initial, &input);
        let (phi, gamma) =
            (propagation.step(0).phi.map(|x| x.mid()), propagation.step(0).gamma.map(|x| x.mid()));
        Self { propagation, reach, phi, gamma }
    }

    fn advance(&self, states: &DMatrix<f64>, inputs: &DMatrix<f64>) -> DMatrix<f64> {
        &self.phi * states + &self.gamma * inputs
    }

    /// Fails where a state at sample k leaves the reachable set; returns the largest deviation
    /// relative to the radius.
    fn assert_inside(&self, states: &DMatrix<f64>, k: usize) -> f64 {
        let mut used: f64 = 0.0;
        for i in 0..states.nrows() {
            let (low, high) = (self.reach.lower_outer(k, i), self.reach.upper_outer(k, i));
            let row = states.row(i);
            let (least, most) = (row.min(), row.max());
            assert!(
                low - ROUNDING <= least && most <= high + ROUNDING,
                "{least}, {most} leave {low}, {high} in state {i}, sample {k}"
            );
            let (centre, radius) = (0.5 * (low + high), 0.5 * (high - low));
            used = used.max((most - centre).max(centre - least) / radius);
        }
        used
    }
}

/// The motion of the disturbances of a batch within the unit box.
#[derive(Clone, Copy, Debug)]
enum Motion {
    /// A new uniform value at each sample.
    Uniform,
    /// A new vertex at each sample.
    BangBang,
    /// A vertex of which each coordinate changes sides at random.
    Switching,
    /// A constant vertex.
    Held,
}

impl Motion {
    fn start(self, random: &mut Random) -> f64 {
        if matches!(self, Motion::Uniform) { random.symmetric() } else { random.sign() }
    }

    fn next(self, before: f64, random: &mut Random) -> f64 {
        match self {
            Motion::Uniform => random.symmetric(),
            Motion::BangBang => random.sign(),
            Motion::Switching if random.bits() >> 60 == 0 => -before,
            Motion::Switching | Motion::Held => before,
        }
    }
}

fn within(set: &Hyperrectangle, unit: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(unit.nrows(), unit.ncols(), |i, j| {
        set.centre[i] + set.radius[i] * unit[(i, j)]
    })
}

/// Simulates a batch; returns the largest deviation at the end relative to the radius.
fn simulate(case: &Case, motion: Motion, seed: u64) -> f64 {
    let mut random = Random::new(seed);
    let (initial, input) = sets();
    let mut states =
        within(&initial, &DMatrix::from_fn(12, BATCH, |_, _| motion.start(&mut random)));
    let mut unit = DMatrix::from_fn(6, BATCH, |_, _| motion.start(&mut random));
    let mut used = case.assert_inside(&states, 0);
    for k in 1..SAMPLES {
        states = case.advance(&states, &within(&input, &unit));
        used = case.assert_inside(&states, k);
        unit.apply(|x| *x = motion.next(*x, &mut random));
    }
    used
}

fn simulate_batches(case: &Case, motion: Motion, disturbances: usize) -> f64 {
    let seed = |batch: usize| (batch + 1) as u64 + ((motion as u64) << 32);
    let batches = (0..disturbances / BATCH).into_par_iter();
    batches.map(|batch| simulate(case, motion, seed(batch))).reduce(|| 0.0, f64::max)
}

/// Simulates `count` disturbances, of each kind.
fn none_leaves_the_reachable_sets(count: usize) {
    let (sample, constant) = (Case::new(Disturbance::Sample), Case::new(Disturbance::Constant));
    assert!(simulate_batches(&sample, Motion::Uniform, 3 * count / 10) > 0.2);
    assert!(simulate_batches(&sample, Motion::BangBang, 3 * count / 10) > 0.4);
    assert!(simulate_batches(&sample, Motion::Switching, count / 5) > 0.8);
    // There are 2⁶ constant vertices: some batch contains the worst one, up to the initial state.
    assert!(simulate_batches(&constant, Motion::Held, count / 5) > 0.95);
}

#[test]
fn none_of_200_000_disturbances_leaves_the_reachable_sets() {
    none_leaves_the_reachable_sets(200_000);
}

#[test]
#[ignore = "takes long: a million disturbances"]
fn none_of_a_million_disturbances_leaves_the_reachable_sets() {
    none_leaves_the_reachable_sets(1_000_000);
}

/// Returns the vertex of `set` to which `row` points.
fn worst(set: &Hyperrectangle, row: impl Iterator<Item = f64>) -> DMatrix<f64> {
    let vertex: Vec<f64> =
        row.enumerate().map(|(j, x)| set.centre[j] + set.radius[j] * x.signum()).collect();
    DMatrix::from_vec(vertex.len(), 1, vertex)
}

/// Returns state i at sample k of the solution that maximises it.
fn furthest(case: &Case, disturbance: Disturbance, i: usize, k: usize) -> f64 {
    let (initial, input) = sets();
    let mid = |x: &reachtube_scalar::Interval| x.mid();
    let mut state = worst(&initial, case.propagation.exponential(k).row(i).iter().map(mid));
    for j in 0..k {
        let row = match disturbance {
            Disturbance::Constant => case.propagation.integral(k).row(i).map(|x| x.mid()),
            _ => case.propagation.exponential(k - 1 - j).row(i).map(|x| x.mid()) * &case.gamma,
        };
        state = case.advance(&state, &worst(&input, row.iter().copied()));
    }
    state[(i, 0)]
}

#[test]
fn the_worst_disturbance_reaches_every_face() {
    for disturbance in [Disturbance::Constant, Disturbance::Sample] {
        let case = Case::new(disturbance);
        for k in [0, 1, 7, 33, 70] {
            for i in 0..12 {
                let (end, inner) =
                    (furthest(&case, disturbance, i, k), case.reach.upper_inner(k, i));
                assert!(
                    (end - inner).abs() <= ROUNDING,
                    "{disturbance:?}: {end} is not {inner} in state {i}, sample {k}"
                );
                assert!(case.reach.upper_outer(k, i) - inner <= ROUNDING);
            }
        }
    }
}

#[test]
fn hulls_over_five_seconds_have_ten_exact_digits() {
    let propagation = Propagation::new(&arm(), &TimeGrid::uniform(0.004, 1251)).unwrap();
    let (initial, input) = sets();
    let reach = ReachSets::new(
        &propagation,
        &Disturbance::Sample.input_gains(&propagation),
        &initial,
        &input,
    );
    for (k, i) in (0..1251).flat_map(|k| (0..12).map(move |i| (k, i))) {
        let (outer, inner) = (reach.upper_outer(k, i), reach.upper_inner(k, i));
        let radius = reach.radius(k, i);
        assert!(
            outer - inner <= 1e-10 * radius.lo() && radius.width() <= 1e-11 * radius.lo(),
            "{k} {i}"
        );
    }
}
