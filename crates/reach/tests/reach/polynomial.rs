//! Reachable sets of polynomial systems against exact hulls, simulated behaviours and published
//! problems.

use proptest::prelude::*;
use rayon::prelude::*;
use reachtube_ode::{Ensemble, Run, VectorField};
use reachtube_reach::{
    Disturbance, Flowpipe,
    FlowpipeMethod::{self, Linearisation},
    FlowpipeOutcome, FlowpipeSettings, Hyperrectangle, PolynomialSystem, Propagation, ReachError,
    ReachSets, TimeGrid, UncertainInput,
};
use reachtube_scalar::{Interval, Lanes, Lanewise, MapWorkspace, PolynomialMap, Powers};

use crate::arm::arm;
use crate::lwa4p;
use crate::random::Random;
use crate::systems::{
    self, Polynomial, constant, cubic_arm, laub_loomis, linear, van_der_pol, variables,
};

pub fn set(centre: &[f64], radius: &[f64]) -> Hyperrectangle {
    Hyperrectangle { centre: centre.to_vec(), radius: radius.to_vec() }
}

#[test]
fn a_linear_system_has_the_exact_hull_to_a_few_thousandths() {
    let (arm, grid) = (arm(), TimeGrid::uniform(0.004, 501));
    let system = PolynomialSystem::new(12, 6, &linear(&arm)).unwrap();
    let initial = set(&[0.01; 12], &[0.003; 12]);
    let torque = set(&[0.2, -0.1, 0.0, 0.05, 0.1, 0.0], &[0.4, 0.5, 0.3, 0.1, 0.05, 0.06]);
    let inputs: Vec<f64> = (0..501 * 6).map(|at| (0.01 * at as f64).sin()).collect();
    let input = UncertainInput { measured: &inputs, set: &torque };
    let flowpipe =
        Flowpipe::new(&system, &grid, &[0.1; 12], &initial, &input, &FlowpipeSettings::default())
            .unwrap();
    let propagation = Propagation::new(&arm, &grid).unwrap();
    let gains = Disturbance::Measurable.input_gains(&propagation);
    let exact = ReachSets::new(&propagation, &gains, &initial, &torque);
    let start = reachtube_reach::IntervalVector::from_element(12, Interval::point(0.1));
    let nominal = propagation.solve(&start, &inputs);
    for k in 0..501 {
        for (i, side) in flowpipe.sample(k).iter().enumerate() {
            let hull = nominal.state(k)[i];
            let (low, high) =
                ((hull + exact.lower_inner(k, i)).hi(), (hull + exact.upper_inner(k, i)).lo());
            assert!(
                side.lo() <= low && side.hi() >= high,
                "sample {k}, state {i}: {side:?}, {low}, {high}"
            );
            let excess = side.width() / (high - low);
            assert!(excess < 1.004, "sample {k}, state {i}: {excess}");
            if k < 500 {
                let tube = flowpipe.step(k)[i];
                assert!(tube.encloses(side) && tube.encloses(&flowpipe.sample(k + 1)[i]));
            }
        }
    }
}

/// ẋ = f(x, u), with the sines and cosines of the first states as further variables, over any
/// lanes.
struct Field<'a, S> {
    map: &'a PolynomialMap,
    angles: usize,
    ws: MapWorkspace<S>,
    at: Vec<S>,
}

impl<'a, S: Lanewise + Powers> Field<'a, S> {
    fn new(map: &'a PolynomialMap, angles: usize) -> Self {
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

pub fn map(variables: usize, f: &[Polynomial]) -> PolynomialMap {
    let f: Vec<_> = f.iter().map(|f| f.map_coefficients(|c| c.mid())).collect();
    PolynomialMap::new(variables, &f)
}

/// Sets, a grid, and how they are sampled.
pub struct Case {
    pub map: PolynomialMap,
    /// The first states, whose sines and cosines f has.
    pub angles: usize,
    pub flowpipe: Flowpipe,
    pub start: Hyperrectangle,
    pub input: Hyperrectangle,
    pub step: f64,
    /// Simulated samples in one step of the flowpipe: the input changes at each.
    pub parts: usize,
    pub substeps: usize,
}

/// What a simulation may be off by, relative to the size of the states: see
/// `simulations_are_as_exact_as_is_assumed`.
const SLACK: f64 = 1e-7;

impl Case {
    /// Simulates so many behaviours from `seed` on; each state at each sample and in between is in
    /// the sets. The largest part of a width at the end that was seen.
    pub fn simulate(&self, runs: usize, seed: u64) -> f64 {
        let mut random = Random::new(seed);
        let steps = self.flowpipe.len() - 1;
        let times: Vec<f64> =
            (0..=steps * self.parts).map(|k| k as f64 * self.step / self.parts as f64).collect();
        let kinds: Vec<bool> = (0..runs).map(|run| run % 2 == 0).collect();
        let mut pick = |set: &Hyperrectangle, corner: bool, out: &mut Vec<f64>| {
            for (c, r) in set.centre.iter().zip(&set.radius) {
                out.push(c + r * if corner { random.sign() } else { random.symmetric() });
            }
        };
        let (mut starts, mut inputs) = (vec![Vec::new(); runs], vec![Vec::new(); runs]);
        for run in 0..runs {
            pick(&self.start, kinds[run], &mut starts[run]);
            (0..steps * self.parts).for_each(|_| pick(&self.input, kinds[run], &mut inputs[run]));
        }
        let all: Vec<Run<'_>> =
            starts.iter().zip(&inputs).map(|(start, inputs)| Run { start, inputs }).collect();
        let n = self.start.dimension();
        let mut seen: Vec<Option<Interval>> = vec![None; n];
        let look = |_: usize, sample: usize, x: &[f64]| {
            let (k, part) = (sample / self.parts, sample % self.parts);
            let sides = if part == 0 { self.flowpipe.sample(k) } else { self.flowpipe.step(k) };
            for (i, (side, x)) in sides.iter().zip(x).enumerate() {
                let near = *side + Interval::centred(0.0, SLACK * (1.0 + x.abs()));
                assert!(
                    near.contains(*x),
                    "{x} is not in {side:?}: state {i} at sample {k} and {part} parts"
                );
                if k == steps {
                    let x = Interval::point(*x);
                    seen[i] = Some(seen[i].map_or(x, |seen| seen.hull(x)));
                }
            }
        };
        let mut ensemble = Ensemble::<Lanes<8>>::new(n);
        let outcomes = ensemble.integrate(
            &mut Field::new(&self.map, self.angles),
            &times,
            self.substeps,
            &all,
            look,
        );
        assert!(outcomes.iter().all(|outcome| outcome.is_reached()));
        let used = |(seen, side): (&Option<Interval>, &Interval)| {
            seen.map_or(0.0, |x| x.width() / side.width())
        };
        seen.iter().zip(self.flowpipe.sample(steps)).map(used).fold(0.0, f64::max)
    }
}

/// A polynomial with few terms of degree 3 at most.
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

/// Random numbers of states and inputs, f with and without terms along common directions, sets,
/// grids.
pub fn random_case(seed: u64, method: FlowpipeMethod) -> Case {
    let mut random = Random::new(seed);
    let (n, m) = (1 + random.bits() as usize % 4, random.bits() as usize % 3);
    // Every other system has sines and cosines, where they can be followed.
    let plain = random.sign() > 0.0 || method != Linearisation;
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
        zonotopes: vec![],
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

#[test]
fn none_of_a_million_behaviours_of_random_systems_leaves_its_sets() {
    let runs = 5_000;
    let used: Vec<f64> = (1..=200_u64)
        .into_par_iter()
        .map(|seed| random_case(seed, Linearisation).simulate(runs, seed))
        .collect();
    // Some of them come close to the sides of the sets, which are thus not just large.
    let close = used.iter().filter(|used| **used > 0.9).count();
    assert!(close > 100, "{close} of 200 came close");
}

#[test]
fn simulations_are_as_exact_as_is_assumed() {
    for seed in 1..=200 {
        let case = random_case(seed, Linearisation);
        let steps = case.flowpipe.len() - 1;
        let times: Vec<f64> = (0..=2 * steps).map(|k| 0.5 * k as f64 * case.step).collect();
        let corner: Vec<f64> =
            case.start.centre.iter().zip(&case.start.radius).map(|(c, r)| c + r).collect();
        let inputs: Vec<f64> = (0..2 * steps)
            .flat_map(|k| {
                let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
                case.input.centre.iter().zip(&case.input.radius).map(move |(c, r)| c + sign * r)
            })
            .collect();
        let run = Run { start: &corner, inputs: &inputs };
        let end = |substeps: usize| {
            let mut end = corner.clone();
            let mut ensemble = Ensemble::<f64>::new(corner.len());
            let keep = |_: usize, _: usize, x: &[f64]| end.copy_from_slice(x);
            let _ = ensemble.integrate(
                &mut Field::new(&case.map, case.angles),
                &times,
                substeps,
                &[run],
                keep,
            );
            end
        };
        for (coarse, fine) in end(case.substeps).iter().zip(end(8 * case.substeps)) {
            assert!(
                (coarse - fine).abs() <= 0.5 * SLACK * (1.0 + fine.abs()),
                "{seed}: {coarse} {fine}"
            );
        }
    }
}

/// ẋ = u - x + p (1, 1, 1, 1) with p = x₁x₂ + x₂x₃ + x₃x₄ - x₄x₁: three of the products are large
/// together at most.
fn frustrated() -> Vec<Polynomial> {
    let z = variables(5, 2);
    let products = &z[0] * &z[1] + &z[1] * &z[2] + &z[2] * &z[3] - &z[3] * &z[0];
    z[..4].iter().map(|x| &z[4] + &products - x.clone()).collect()
}

#[test]
fn corners_give_smaller_sets_and_keep_some_that_are_lost_without() {
    let (f, grid, rest) = (frustrated(), TimeGrid::uniform(0.05, 201), set(&[0.0; 4], &[0.0; 4]));
    let system = PolynomialSystem::new(4, 1, &f).unwrap();
    let follow = |vertex_variables: usize, input: &Hyperrectangle| {
        let uncertain = UncertainInput { measured: &vec![0.0; 200], set: input };
        let settings = FlowpipeSettings { vertex_variables, ..FlowpipeSettings::default() };
        Flowpipe::new(&system, &grid, &[0.0; 4], &rest, &uncertain, &settings).unwrap()
    };
    let small = set(&[0.0], &[0.05]);
    let (with, without) = (follow(4, &small), follow(0, &small));
    for k in 0..201 {
        let sides = without.sample(k).iter().zip(with.sample(k));
        sides.for_each(|(outer, inner)| {
            assert!((*outer + Interval::centred(0.0, 1e-12)).encloses(inner), "{k}")
        });
    }
    assert!(with.sample(200)[0].width() < 0.9 * without.sample(200)[0].width());
    let large = set(&[0.0], &[0.09]);
    assert!(!follow(0, &large).is_reached());
    let flowpipe = follow(4, &large);
    assert!(flowpipe.is_reached());
    let case = Case {
        map: map(5, &f),
        angles: 0,
        flowpipe,
        start: rest,
        input: large,
        step: 0.05,
        parts: 1,
        substeps: 4,
    };
    assert!(case.simulate(1000, 1) > 0.2);
}

#[test]
fn behaviours_of_the_cubic_arm_stay_within() {
    let (grid, m) = (TimeGrid::uniform(0.004, 251), 6);
    let start = set(&[0.0; 12], &[0.01; 12]);
    let input = set(&[2.0, -2.0, 1.0, 0.5, 0.3, -0.2], &[0.5, 0.4, 0.3, 0.1, 0.05, 0.05]);
    let uncertain = UncertainInput { measured: &vec![0.0; 250 * m], set: &input };
    let settings = FlowpipeSettings { zonotopes: vec![250], ..FlowpipeSettings::default() };
    let flowpipe =
        Flowpipe::new(&cubic_arm(1.0), &grid, &[0.0; 12], &start, &uncertain, &settings).unwrap();
    assert!(flowpipe.is_reached());
    let zonotope = flowpipe.zonotopes(250).next().unwrap();
    let polygon = zonotope.polygon(0, 6);
    for (at, i) in [(0, 0), (1, 6)] {
        let side = flowpipe.sample(250)[i];
        let highest = polygon.iter().map(|vertex| vertex[at]).fold(f64::MIN, f64::max);
        assert!(side.contains(highest) && side.hi() - highest < 1e-9 * side.width());
    }
    let map = map(18, &systems::cubic_arm_components(1.0));
    let case = Case { map, angles: 0, flowpipe, start, input, step: 0.004, parts: 1, substeps: 1 };
    assert!(case.simulate(1000, 1) > 0.2);
}

/// The best inner bound known (1.151 times smaller at most) was found by ascent along adjoint
/// solutions; here it is enough that the sets do not grow.
#[test]
fn cubic_friction_at_the_papers_own_sets_is_followed_for_five_seconds() {
    let ((initial, torque), grid) = (lwa4p::table2(1.0), TimeGrid::uniform(0.004, 1251));
    let uncertain = UncertainInput { measured: &vec![0.0; 1250 * 6], set: &torque };
    let settings = FlowpipeSettings::default();
    let flowpipe =
        Flowpipe::new(&lwa4p::model1(), &grid, &[0.0; 12], &initial, &uncertain, &settings)
            .unwrap();
    assert!(flowpipe.is_reached(), "{:?}", flowpipe.outcome());
    // Widths of the inner bound, rounded down.
    let inner = [2.90, 5.01, 4.98, 2.21, 3.00, 2.79, 0.603, 1.268, 1.299, 0.521, 0.904, 0.578];
    for (side, inner) in flowpipe.sample(1250).iter().zip(inner) {
        assert!(side.width() > inner && side.width() < 1.2 * inner, "{side:?} {inner}");
    }
    let case = Case {
        map: map(18, &lwa4p::components()),
        angles: 0,
        flowpipe,
        start: initial,
        input: torque,
        step: 0.004,
        parts: 1,
        substeps: 1,
    };
    assert!(case.simulate(16, 1) > 0.02);
}

/// A published problem: 10,000 simulated trajectories lie in the flowpipe.
pub fn contain_ten_thousand(
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
    (0..10_u64).into_par_iter().for_each(|seed| assert!(case.simulate(1000, seed + 1) > 0.02));
    case.flowpipe
}

fn in_pieces(pieces: Vec<usize>) -> FlowpipeSettings {
    FlowpipeSettings { pieces, ..FlowpipeSettings::default() }
}

#[test]
fn van_der_pol_is_enclosed() {
    let start = set(&[1.4, 2.4], &[0.15, 0.05]);
    let f = systems::van_der_pol_components();
    let flowpipe =
        contain_ten_thousand(&van_der_pol(), &f, start, (0.01, 701), &in_pieces(vec![6, 3]));
    let [x, y] = flowpipe.sample(700) else { unreachable!() };
    assert!(x.width() < 0.13 && y.width() < 0.55, "{x:?} {y:?}");
}

#[test]
fn laub_loomis_keeps_below_the_published_bounds() {
    for (w, bound, pieces) in [(0.01, 4.5, 1), (0.05, 4.5, 1), (0.1, 5.0, 2)] {
        let start = set(&[1.2, 1.05, 1.5, 2.4, 1.0, 0.1, 0.45], &[w; 7]);
        let f = systems::laub_loomis_components();
        let pieces = in_pieces(vec![1, 1, pieces, pieces, 1, 1, 1]);
        let flowpipe = contain_ten_thousand(&laub_loomis(), &f, start, (0.02, 1001), &pieces);
        let highest = (0..1000).map(|k| flowpipe.step(k)[3].hi()).fold(f64::MIN, f64::max);
        assert!(highest < bound, "W = {w}: x4 up to {highest}");
    }
}

#[test]
fn what_cannot_be_followed_is_an_answer() {
    let z = variables(1, 2);
    let square = PolynomialSystem::new(1, 0, &[&z[0] * &z[0]]).unwrap();
    let none = Hyperrectangle::zero(0);
    let input = UncertainInput { measured: &[], set: &none };
    let grid = TimeGrid::uniform(0.01, 201);
    let flowpipe = Flowpipe::new(
        &square,
        &grid,
        &[1.0],
        &set(&[0.0], &[0.1]),
        &input,
        &FlowpipeSettings::default(),
    )
    .unwrap();
    // x = 1/(1/x0 - t) has a pole at 1/1.1.
    let FlowpipeOutcome::Failed { time, state, widths } = flowpipe.outcome() else {
        panic!("it has a pole")
    };
    assert!((0.7..1.0 / 1.1).contains(time) && *state == 0 && widths[0] > 1.0, "{time} {widths:?}");
    let last = flowpipe.len() - 1;
    assert_eq!(grid.times()[last], *time);
    assert!(flowpipe.sample(last)[0].contains(1.0 / (1.0 / 1.1 - time)));
}

#[test]
fn what_does_not_fit_is_named() {
    let z = variables(2, 2);
    let system = PolynomialSystem::new(1, 1, &[&z[0] * &z[1]]).unwrap();
    let (grid, settings) = (TimeGrid::uniform(0.1, 3), FlowpipeSettings::default());
    let (point, held) = (set(&[0.0], &[0.1]), [1.0, 1.0]);
    let run = |start: &[f64], initial: &Hyperrectangle, held: &[f64]| {
        let input = UncertainInput { measured: held, set: &point };
        Flowpipe::new(&system, &grid, start, initial, &input, &settings)
    };
    assert!(run(&[1.0], &point, &held).unwrap().is_reached());
    assert!(run(&[1.0], &point, &[1.0; 3]).is_ok());
    assert!(matches!(run(&[1.0], &point, &[1.0; 4]), Err(ReachError::Shape { found_rows: 4, .. })));
    assert!(matches!(
        run(&[1.0, 2.0], &point, &held),
        Err(ReachError::Shape { found_rows: 2, .. })
    ));
    assert!(matches!(run(&[f64::NAN], &point, &held), Err(ReachError::NotFinite { row: 0, .. })));
    let negative = set(&[0.0], &[-0.1]);
    assert!(matches!(run(&[1.0], &negative, &held), Err(ReachError::Negative { value: -0.1, .. })));
    assert!(PolynomialSystem::new(2, 0, &[&z[0] * &z[1]]).is_err());
    assert!(PolynomialSystem::new(1, 0, &[&z[0] * &z[1]]).is_err());
    let unbounded = Polynomial::constant(Interval::ENTIRE);
    assert!(matches!(PolynomialSystem::new(1, 0, &[unbounded]), Err(ReachError::NotFinite { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]
    /// ẋ = x (1 - x) has the solution x0 / (x0 + (1 - x0) e^{-t}), which grows with x0.
    #[test]
    fn the_logistic_equation_has_its_closed_form(x0 in 0.15..0.9_f64, r in 0.0..0.04_f64, h in 0.01..0.2_f64) {
        let z = variables(1, 2);
        let system = PolynomialSystem::new(1, 0, &[z[0].clone() - &z[0] * &z[0]]).unwrap();
        let none = Hyperrectangle::zero(0);
        let input = UncertainInput { measured: &[], set: &none };
        let grid = TimeGrid::uniform(h, 21);
        let flowpipe =
            Flowpipe::new(&system, &grid, &[x0], &set(&[0.0], &[r]), &input, &FlowpipeSettings::default()).unwrap();
        prop_assert!(flowpipe.is_reached());
        let exact = |x0: f64, t: f64| x0 / (x0 + (1.0 - x0) * (-t).exp());
        for k in 0..20 {
            let (low, high) = (exact(x0 - r, grid.times()[k]), exact(x0 + r, grid.times()[k]));
            let side = flowpipe.sample(k)[0];
            prop_assert!(side.lo() <= low + 1e-14 && side.hi() >= high - 1e-14);
            prop_assert!(side.width() <= 1.5 * (high - low) + 0.02 * h, "{side:?} {low} {high}");
            let middle = exact(x0 + r, grid.times()[k] + 0.5 * h);
            prop_assert!(flowpipe.step(k)[0].contains(middle));
        }
    }
}
