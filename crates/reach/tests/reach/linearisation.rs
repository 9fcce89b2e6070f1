//! Reachable sets by linearisation against exact hulls, simulated behaviours and published
//! problems.

use proptest::prelude::*;
use reachtube_reach::{
    Disturbance, Flowpipe, FlowpipeSettings, Hyperrectangle, PolynomialSystem, Propagation,
    ReachSets, TimeGrid, UncertainInput,
};
use reachtube_scalar::Interval;

use crate::arm::arm;
use crate::lwa4p;
use crate::simulated_case::{Case, contain_a_thousand, map, set, with_zonotopes};
use crate::systems::{self, Polynomial, cubic_arm, laub_loomis, linear, van_der_pol, variables};

#[test]
fn a_linear_system_has_the_exact_hull_within_0_4_percent() {
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

/// Returns ẋ = u - x + p (1, 1, 1, 1) with p = x₁x₂ + x₂x₃ + x₃x₄ - x₄x₁; at most three of the
/// products are large together.
fn frustrated() -> Vec<Polynomial> {
    let z = variables(5, 2);
    let products = &z[0] * &z[1] + &z[1] * &z[2] + &z[2] * &z[3] - &z[3] * &z[0];
    z[..4].iter().map(|x| &z[4] + &products - x.clone()).collect()
}

#[test]
fn vertices_give_smaller_sets_and_keep_some_that_fail_without() {
    let (f, grid, rest) = (frustrated(), TimeGrid::uniform(0.05, 201), set(&[0.0; 4], &[0.0; 4]));
    let system = PolynomialSystem::new(4, 1, &f).unwrap();
    let propagate = |vertex_variables: usize, input: &Hyperrectangle| {
        let uncertain = UncertainInput { measured: &vec![0.0; 200], set: input };
        let settings = FlowpipeSettings { vertex_variables, ..FlowpipeSettings::default() };
        Flowpipe::new(&system, &grid, &[0.0; 4], &rest, &uncertain, &settings).unwrap()
    };
    let small = set(&[0.0], &[0.05]);
    let (with, without) = (propagate(4, &small), propagate(0, &small));
    for k in 0..201 {
        let sides = without.sample(k).iter().zip(with.sample(k));
        sides.for_each(|(outer, inner)| {
            assert!((*outer + Interval::centred(0.0, 1e-12)).encloses(inner), "{k}")
        });
    }
    assert!(with.sample(200)[0].width() < 0.9 * without.sample(200)[0].width());
    let large = set(&[0.0], &[0.09]);
    assert!(!propagate(0, &large).is_reached());
    let flowpipe = propagate(4, &large);
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
fn behaviours_of_the_cubic_arm_stay_inside() {
    let (grid, m) = (TimeGrid::uniform(0.004, 251), 6);
    let start = set(&[0.0; 12], &[0.01; 12]);
    let input = set(&[2.0, -2.0, 1.0, 0.5, 0.3, -0.2], &[0.5, 0.4, 0.3, 0.1, 0.05, 0.05]);
    let uncertain = UncertainInput { measured: &vec![0.0; 250 * m], set: &input };
    let (flowpipe, zonotopes) =
        with_zonotopes(&cubic_arm(1.0), &grid, &start, &uncertain, &FlowpipeSettings::default());
    assert!(flowpipe.is_reached());
    let zonotope = &zonotopes[250];
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

/// Ascent along adjoint solutions found the best known inner bound, at most 1.151 times smaller;
/// this test only checks that the sets do not grow.
#[test]
fn cubic_friction_with_the_sets_of_the_paper_is_enclosed_for_five_seconds() {
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

fn in_pieces(pieces: Vec<usize>) -> FlowpipeSettings {
    FlowpipeSettings { pieces, ..FlowpipeSettings::default() }
}

#[test]
fn van_der_pol_is_enclosed() {
    let start = set(&[1.4, 2.4], &[0.15, 0.05]);
    let f = systems::van_der_pol_components();
    let flowpipe =
        contain_a_thousand(&van_der_pol(), &f, start, (0.01, 701), &in_pieces(vec![6, 3]));
    let [x, y] = flowpipe.sample(700) else { unreachable!() };
    assert!(x.width() < 0.13 && y.width() < 0.55, "{x:?} {y:?}");
}

#[test]
fn laub_loomis_stays_below_the_published_bounds() {
    for (w, bound, pieces) in [(0.01, 4.5, 1), (0.05, 4.5, 1), (0.1, 5.0, 2)] {
        let start = set(&[1.2, 1.05, 1.5, 2.4, 1.0, 0.1, 0.45], &[w; 7]);
        let f = systems::laub_loomis_components();
        let pieces = in_pieces(vec![1, 1, pieces, pieces, 1, 1, 1]);
        let flowpipe = contain_a_thousand(&laub_loomis(), &f, start, (0.02, 1001), &pieces);
        let highest = (0..1000).map(|k| flowpipe.step(k)[3].hi()).fold(f64::MIN, f64::max);
        assert!(highest < bound, "W = {w}: x4 up to {highest}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]
    /// The solution of ẋ = x (1 - x) is x0 / (x0 + (1 - x0) e^{-t}), which increases with x0.
    #[test]
    fn the_logistic_equation_agrees_with_its_closed_form(
        x0 in 0.15..0.9_f64, r in 0.0..0.04_f64, h in 0.01..0.2_f64,
    ) {
        let z = variables(1, 2);
        let system = PolynomialSystem::new(1, 0, &[z[0].clone() - &z[0] * &z[0]]).unwrap();
        let none = Hyperrectangle::zero(0);
        let input = UncertainInput { measured: &[], set: &none };
        let (grid, settings) = (TimeGrid::uniform(h, 21), FlowpipeSettings::default());
        let initial = set(&[0.0], &[r]);
        let flowpipe = Flowpipe::new(&system, &grid, &[x0], &initial, &input, &settings).unwrap();
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
