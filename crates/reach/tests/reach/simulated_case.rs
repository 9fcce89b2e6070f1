//! Sets, a grid and a flowpipe, with simulated behaviours that must stay inside.

use std::sync::Mutex;

use rayon::prelude::*;
use reachtube_ode::{Ensemble, InitialValueProblem, VectorField};
use reachtube_reach::{
    Flowpipe, FlowpipeMethod, FlowpipeSettings, Hyperrectangle, PolynomialSystem, TimeGrid,
    UncertainInput, Zonotope,
};
use reachtube_scalar::{Interval, Lanes, Lanewise, MapWorkspace, PolynomialMap, Powers};

use crate::random::Random;
use crate::systems::{Polynomial, constant, variables};

pub(crate) fn set(centre: &[f64], radius: &[f64]) -> Hyperrectangle {
    Hyperrectangle { centre: centre.to_vec(), radius: radius.to_vec() }
}

/// The vector field ẋ = f(x, u) over any lanes, with the sines and cosines of the first states as
/// further variables.
pub(crate) struct Field<'a, S> {
    map: &'a PolynomialMap,
    angles: usize,
    ws: MapWorkspace<S>,
    at: Vec<S>,
}

impl<'a, S: Lanewise + Powers> Field<'a, S> {
    pub(crate) fn new(map: &'a PolynomialMap, angles: usize) -> Self {
        Self { map, angles, ws: map.workspace(), at: Vec::new() }
    }
}

impl<S: Lanewise + Powers> VectorField<S> for Field<'_, S> {
    fn rate(&mut self, _: f64, x: &[S], u: &[S], dx: &mut [S]) {
        self.at.clear();
        self.at.extend(x.iter().chain(u).cloned());
        self.at.extend(x[..self.angles].iter().map(|x| x.sin_cos().0));
        self.at.extend(x[..self.angles].iter().map(|x| x.sin_cos().1));
        self.map.evaluate_into(&self.at, &mut self.ws, dx);
    }
}

/// Returns f with the midpoints of its coefficients.
pub(crate) fn map(variables: usize, f: &[Polynomial]) -> PolynomialMap {
    let f: Vec<_> = f.iter().map(|f| f.map_coefficients(|c| c.mid())).collect();
    PolynomialMap::new(variables, &f)
}

/// A flowpipe and the settings of its simulations.
pub(crate) struct Case {
    pub map: PolynomialMap,
    /// Number of first states whose sines and cosines occur in f.
    pub angles: usize,
    pub flowpipe: Flowpipe,
    pub start: Hyperrectangle,
    pub input: Hyperrectangle,
    pub step: f64,
    /// Number of simulated samples in one step of the flowpipe; the input changes at each.
    pub parts: usize,
    /// Number of integration steps between two simulated samples.
    pub substeps: usize,
}

/// Largest error of a simulation, relative to the size of the states; checked in
/// `simulations_are_within_the_assumed_error`.
pub(crate) const SLACK: f64 = 1e-7;

impl Case {
    /// Simulates `runs` behaviours and fails where a state leaves the sets, at samples or between.
    ///
    /// Returns the largest ratio of the simulated width to the width of the set at the end, 0 if
    /// the flowpipe gave up in its first step.
    pub(crate) fn simulate(&self, runs: usize, seed: u64) -> f64 {
        let mut random = Random::new(seed);
        let steps = self.flowpipe.len() - 1;
        if steps == 0 {
            return 0.0;
        }
        let times: Vec<f64> =
            (0..=steps * self.parts).map(|k| k as f64 * self.step / self.parts as f64).collect();
        let kinds: Vec<bool> = (0..runs).map(|run| run % 2 == 0).collect();
        let mut pick = |set: &Hyperrectangle, vertex: bool, out: &mut Vec<f64>| {
            for (c, r) in set.centre.iter().zip(&set.radius) {
                out.push(c + r * if vertex { random.sign() } else { random.symmetric() });
            }
        };
        let (mut starts, mut inputs) = (vec![Vec::new(); runs], vec![Vec::new(); runs]);
        for run in 0..runs {
            pick(&self.start, kinds[run], &mut starts[run]);
            (0..steps * self.parts).for_each(|_| pick(&self.input, kinds[run], &mut inputs[run]));
        }
        let all: Vec<InitialValueProblem<'_>> = starts
            .iter()
            .zip(&inputs)
            .map(|(start, inputs)| InitialValueProblem { start, inputs })
            .collect();
        let n = self.start.dimension();
        let mut simulated: Vec<Option<Interval>> = vec![None; n];
        let check = |_: usize, sample: usize, x: &[f64]| {
            let (k, part) = (sample / self.parts, sample % self.parts);
            let sides = if part == 0 { self.flowpipe.sample(k) } else { self.flowpipe.step(k) };
            for (i, (side, x)) in sides.iter().zip(x).enumerate() {
                let near = *side + Interval::centred(0.0, SLACK * (1.0 + x.abs()));
                assert!(
                    near.contains(*x),
                    "{x} is not in {side:?}: state {i} at sample {k}, part {part}"
                );
                if k == steps {
                    let x = Interval::point(*x);
                    simulated[i] = Some(simulated[i].map_or(x, |hull| hull.hull(x)));
                }
            }
        };
        let mut ensemble = Ensemble::<Lanes<8>>::new(n);
        let outcomes = ensemble.integrate(
            &mut Field::new(&self.map, self.angles),
            &times,
            self.substeps,
            &all,
            check,
        );
        assert!(outcomes.iter().all(|outcome| outcome.is_reached()));
        let used = |(simulated, side): (&Option<Interval>, &Interval)| {
            simulated.map_or(0.0, |x| x.width() / side.width())
        };
        simulated.iter().zip(self.flowpipe.sample(steps)).map(used).fold(0.0, f64::max)
    }
}

/// Returns a polynomial with a few terms of degree 3 at most.
fn random_polynomial(random: &mut Random, z: &[Polynomial]) -> Polynomial {
    let mut f = constant(random.symmetric());
    for _ in 0..4 {
        let mut term = constant(1.5 * random.symmetric());
        for _ in 0..1 + random.bits() % 3 {
            term *= z[random.bits() as usize % z.len()].clone();
        }
        f += term;
    }
    f
}

/// Returns a case with random numbers of states and inputs, a random system with or without terms
/// along common directions, and random sets.
pub(crate) fn random_case(seed: u64, method: FlowpipeMethod) -> Case {
    let mut random = Random::new(seed);
    let (n, m) = (1 + random.bits() as usize % 4, random.bits() as usize % 3);
    // About half of the systems have sines and cosines, where the method supports them.
    let plain = random.sign() > 0.0 || method != FlowpipeMethod::Linearisation;
    let angles = if plain { 0 } else { 1 + random.bits() as usize % n };
    let variables_of_f = n + m + 2 * angles;
    let z = variables(variables_of_f, 3);
    let mut f: Vec<Polynomial> = (0..n).map(|_| random_polynomial(&mut random, &z)).collect();
    if random.sign() > 0.0 {
        let shared = random_polynomial(&mut random, &z);
        f = z[..n].iter().map(|x| x * &constant(-0.5)).collect();
        f.iter_mut().for_each(|f| *f += &shared * &constant(random.symmetric()));
    }
    let mut any =
        |n: usize, scale: f64| (0..n).map(|_| scale * random.symmetric()).collect::<Vec<f64>>();
    let mut boxed = |n: usize, at: f64, size: f64| {
        let (centre, radius) = (any(n, at), any(n, size).iter().map(|r| r.abs()).collect());
        Hyperrectangle { centre, radius }
    };
    let (start, input) = (boxed(n, 0.5, 0.1), boxed(m, 1.0, 0.2));
    let step = 0.01 + 0.01 * f64::from(seed as u32 % 3);
    let system =
        PolynomialSystem::trigonometric(n, m, &(0..angles).collect::<Vec<_>>(), &f).unwrap();
    let settings = FlowpipeSettings {
        method,
        vertex_variables: seed as usize / 6 % 4 * 3,
        order: [None, Some(8)][seed as usize % 2],
        pieces: if seed.is_multiple_of(3) { vec![2; n] } else { vec![] },
    };
    let uncertain = UncertainInput { measured: &vec![0.0; 12 * m], set: &input };
    let grid = TimeGrid::uniform(step, 13);
    let flowpipe =
        Flowpipe::new(&system, &grid, &vec![0.0; n], &start, &uncertain, &settings).unwrap();
    Case {
        map: map(variables_of_f, &f),
        angles,
        flowpipe,
        start,
        input,
        step,
        parts: 2,
        substeps: 1,
    }
}

/// Simulates `runs` behaviours of each of 200 random cases.
pub(crate) fn simulate_random_cases(runs: usize, method: impl Fn(u64) -> FlowpipeMethod + Sync) {
    let simulated: Vec<(bool, f64)> = (1..=200_u64)
        .into_par_iter()
        .map(|seed| {
            let case = random_case(seed, method(seed));
            (case.flowpipe.is_reached(), case.simulate(runs, seed))
        })
        .collect();
    let reached = simulated.iter().filter(|(is_reached, _)| *is_reached).count();
    assert!(reached >= 195, "{reached} of 200 reach the end");
    // Some behaviours come close to the sides of the sets, so the sets are not merely large.
    let close = simulated.iter().filter(|(_, used)| *used > 0.9).count();
    assert!(close > 100, "{close} of 200 came close");
}

/// Computes the flowpipe of a published problem and checks that it contains a thousand simulated
/// trajectories.
pub(crate) fn contain_a_thousand(
    system: &PolynomialSystem,
    f: &[Polynomial],
    start: Hyperrectangle,
    (step, samples): (f64, usize),
    settings: &FlowpipeSettings,
) -> Flowpipe {
    let none = Hyperrectangle::zero(0);
    let uncertain = UncertainInput { measured: &[], set: &none };
    let zero = vec![0.0; start.dimension()];
    let grid = TimeGrid::uniform(step, samples);
    let flowpipe = Flowpipe::new(system, &grid, &zero, &start, &uncertain, settings).unwrap();
    assert!(flowpipe.is_reached(), "{:?}", flowpipe.outcome());
    let map = map(start.dimension(), f);
    let case = Case { map, angles: 0, flowpipe, start, input: none, step, parts: 1, substeps: 1 };
    assert!(case.simulate(1000, 1) > 0.02);
    case.flowpipe
}

/// Computes a flowpipe from 0 + `start`, and its zonotopes at all samples.
pub(crate) fn with_zonotopes(
    system: &PolynomialSystem,
    grid: &TimeGrid,
    start: &Hyperrectangle,
    input: &UncertainInput,
    settings: &FlowpipeSettings,
) -> (Flowpipe, Vec<Zonotope>) {
    let zonotopes = Mutex::new(Vec::new());
    let visit = |sample: usize, zonotope: Zonotope| {
        let mut zonotopes = zonotopes.lock().unwrap();
        assert_eq!(sample, zonotopes.len());
        zonotopes.push(zonotope);
    };
    let rest = vec![0.0; start.dimension()];
    let flowpipe =
        Flowpipe::visiting(system, grid, &rest, start, input, settings, Some(&visit)).unwrap();
    (flowpipe, zonotopes.into_inner().unwrap())
}
