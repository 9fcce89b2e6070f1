//! Reachable sets as Taylor models: simulated behaviours, exact solutions, published problems.

use reachtube_reach::{
    Disturbance, Flowpipe, FlowpipeMethod, FlowpipeOutcome, FlowpipeSettings, Hyperrectangle,
    PolynomialSystem, Propagation, ReachError, ReachSets, TimeGrid, UncertainInput,
};
use reachtube_scalar::Interval;

use crate::arm::arm;
use crate::simulated_case::{contain_a_thousand, set, simulate_random_cases, with_zonotopes};
use crate::systems::{self, coupled_van_der_pol, laub_loomis, linear, van_der_pol, variables};

fn of_order(order: u32) -> FlowpipeSettings {
    FlowpipeSettings {
        method: FlowpipeMethod::TaylorModels { order },
        ..FlowpipeSettings::default()
    }
}

/// Computes the flowpipe of a system without inputs.
fn propagate(
    system: &PolynomialSystem,
    grid: &TimeGrid,
    start: &Hyperrectangle,
    settings: &FlowpipeSettings,
) -> Flowpipe {
    let none = Hyperrectangle::zero(0);
    let input = UncertainInput { measured: &[], set: &none };
    Flowpipe::new(system, grid, &vec![0.0; start.dimension()], start, &input, settings).unwrap()
}

#[test]
fn behaviours_of_random_systems_stay_inside() {
    simulate_random_cases(1_000, |seed| FlowpipeMethod::TaylorModels {
        order: 1 + seed as u32 % 5,
    });
}

/// Trajectories found by search reach the inner bound [1.800, 1.904] x [0.848, 1.284].
#[test]
fn van_der_pol_is_enclosed_tightly() {
    let start = set(&[1.4, 2.4], &[0.15, 0.05]);
    let f = systems::van_der_pol_components();
    let flowpipe = contain_a_thousand(&van_der_pol(), &f, start, (0.01, 701), &of_order(8));
    let [x, y] = flowpipe.sample(700) else { unreachable!() };
    assert!(x.lo() <= 1.8005 && x.hi() >= 1.9035 && x.width() < 0.110, "{x:?}");
    assert!(y.lo() <= 0.8485 && y.hi() >= 1.2835 && y.width() < 0.440, "{y:?}");
}

/// Trajectories found by search reach widths of x4 of 0.0126 and 0.0255.
#[test]
fn laub_loomis_is_enclosed_tightly() {
    for (w, order, bound, inner) in [(0.05, 4, 4.5, 0.0125), (0.1, 4, 5.0, 0.0254)] {
        let start = set(&[1.2, 1.05, 1.5, 2.4, 1.0, 0.1, 0.45], &[w; 7]);
        let f = systems::laub_loomis_components();
        let flowpipe = contain_a_thousand(&laub_loomis(), &f, start, (0.05, 401), &of_order(order));
        let width = flowpipe.sample(400)[3].width();
        assert!(width > inner && width < 1.06 * inner, "W = {w}: x4 is {width} wide");
        let highest = (0..400).map(|k| flowpipe.step(k)[3].hi()).fold(f64::MIN, f64::max);
        assert!(highest < bound, "W = {w}: x4 up to {highest}");
    }
}

#[test]
fn a_solution_in_closed_form_is_enclosed() {
    // The solution of ẋ = x² from [0.9, 1.1] is x = x0 / (1 - x0 t).
    let z = variables(1, 2);
    let square = PolynomialSystem::new(1, 0, &[&z[0] * &z[0]]).unwrap();
    let grid = TimeGrid::uniform(0.01, 61);
    let flowpipe = propagate(&square, &grid, &set(&[1.0], &[0.1]), &of_order(10));
    assert!(flowpipe.is_reached());
    let exact = |x0: f64, t: f64| x0 / (1.0 - x0 * t);
    for (k, t) in grid.times().iter().enumerate() {
        let side = flowpipe.sample(k)[0];
        let (low, high) = (exact(0.9, *t), exact(1.1, *t));
        assert!(side.lo() <= low && side.hi() >= high, "{side:?} at {t}");
        assert!(side.width() < (high - low) * (1.0 + 1e-5) + 1e-12, "{side:?} at {t}");
        if k < 60 {
            let (tube, middle) = (flowpipe.step(k)[0], t + 0.005);
            assert!(tube.contains(exact(0.9, middle)) && tube.contains(exact(1.1, middle)));
        }
    }
}

#[test]
fn a_linear_system_without_uncertain_input_has_its_exact_hull() {
    let (arm, grid) = (arm(), TimeGrid::uniform(0.004, 251));
    let system = PolynomialSystem::new(12, 6, &linear(&arm)).unwrap();
    let (initial, torque) = (set(&[0.01; 12], &[0.003; 12]), Hyperrectangle::zero(6));
    let inputs: Vec<f64> = (0..251 * 6).map(|at| (0.01 * at as f64).sin()).collect();
    let input = UncertainInput { measured: &inputs, set: &torque };
    let flowpipe =
        Flowpipe::new(&system, &grid, &[0.1; 12], &initial, &input, &of_order(4)).unwrap();
    let propagation = Propagation::new(&arm, &grid).unwrap();
    let exact = ReachSets::new(
        &propagation,
        &Disturbance::Sample.input_gains(&propagation),
        &initial,
        &torque,
    );
    let start = reachtube_reach::IntervalVector::from_element(12, Interval::point(0.1));
    let nominal = propagation.solve(&start, &inputs);
    for k in 0..251 {
        for (i, side) in flowpipe.sample(k).iter().enumerate() {
            let hull = nominal.state(k)[i];
            let (low, high) =
                ((hull + exact.lower_inner(k, i)).hi(), (hull + exact.upper_inner(k, i)).lo());
            assert!(
                side.lo() <= low && side.hi() >= high,
                "sample {k}, state {i}: {side:?}, {low}, {high}"
            );
            assert!(
                side.width() < 1.01 * (high - low),
                "sample {k}, state {i}: {side:?}, {low}, {high}"
            );
        }
    }
}

#[test]
fn zonotopes_contain_the_hull_and_are_not_much_larger() {
    let start = set(&[1.4, 2.4], &[0.015, 0.005]);
    let (grid, none) = (TimeGrid::uniform(0.01, 101), set(&[], &[]));
    let no_input = UncertainInput { measured: &[], set: &none };
    let (flowpipe, zonotopes) =
        with_zonotopes(&van_der_pol(), &grid, &start, &no_input, &of_order(4));
    let polygon = zonotopes[100].polygon(0, 1);
    for (at, side) in flowpipe.sample(100).iter().enumerate() {
        let ends = polygon
            .iter()
            .map(|vertex| vertex[at])
            .fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
        assert!(ends.0 <= side.lo() + 1e-12 && ends.1 >= side.hi() - 1e-12, "{ends:?} {side:?}");
        assert!(ends.1 - ends.0 < 1.1 * side.width());
    }
}

#[test]
fn fewer_generators_make_larger_sets() {
    let start = set(&[1.4, 2.4], &[0.05, 0.05]);
    let grid = TimeGrid::uniform(0.01, 301);
    let none = set(&[], &[]);
    let propagated = |order: Option<usize>| {
        let settings = FlowpipeSettings { order, ..of_order(3) };
        let no_input = UncertainInput { measured: &[], set: &none };
        let (flowpipe, zonotopes) =
            with_zonotopes(&van_der_pol(), &grid, &start, &no_input, &settings);
        (flowpipe, zonotopes[300].generators().len())
    };
    let ((all, of_all), (few, of_few)) = (propagated(None), propagated(Some(20)));
    // Beside the stored generators, a zonotope has linear terms and a box.
    assert!(of_all > 500 && of_few <= 40 + 2 * 2, "{of_all} {of_few}");
    for (all, few) in all.sample(300).iter().zip(few.sample(300)) {
        assert!(few.width() >= all.width() && few.width() < 1.5 * all.width(), "{few:?} {all:?}");
    }
}

#[test]
fn a_flowpipe_that_stops_early_is_an_outcome() {
    let z = variables(1, 2);
    let square = PolynomialSystem::new(1, 0, &[&z[0] * &z[0]]).unwrap();
    let grid = TimeGrid::uniform(0.01, 201);
    let flowpipe = propagate(&square, &grid, &set(&[1.0], &[0.1]), &of_order(6));
    // The solution x = 1/(1/x0 - t) from x0 = 1.1 has a pole at t = 1/1.1.
    let FlowpipeOutcome::Failed { time, state, widths } = flowpipe.outcome() else {
        panic!("the solution has a pole")
    };
    assert!((0.7..1.0 / 1.1).contains(time) && *state == 0 && widths[0] > 1.0, "{time} {widths:?}");
    let last = flowpipe.len() - 1;
    assert_eq!(grid.times()[last], *time);
    assert!(flowpipe.sample(last)[0].contains(1.0 / (1.0 / 1.1 - time)));
}

/// The coupling of two oscillators is a state whose rate is 0.
#[test]
fn a_constant_state_stays_constant() {
    let start = set(&[1.4, 2.4, 1.4, 2.4, 70.0], &[0.15, 0.05, 0.15, 0.05, 10.0]);
    let grid = TimeGrid::uniform(0.01, 101);
    for settings in [FlowpipeSettings::default(), of_order(4)] {
        let flowpipe = propagate(&coupled_van_der_pol(), &grid, &start, &settings);
        assert!(flowpipe.is_reached(), "{:?} {:?}", settings.method, flowpipe.outcome());
        let near = Interval::new(60.0 - 1e-9, 80.0 + 1e-9).unwrap();
        let sides = (0..101).map(|k| flowpipe.sample(k)[4]);
        let tubes = (0..100).map(|k| flowpipe.step(k)[4]);
        for side in sides.chain(tubes) {
            assert!(near.encloses(&side), "{:?}: {side:?}", settings.method);
            assert!(side.contains(60.0) && side.contains(80.0), "{side:?}");
        }
    }
}

/// Linearisation and Taylor models enclose the same system from a set of width 0 in two states.
#[test]
fn sets_of_width_zero_in_some_states_are_propagated() {
    let start = set(&[9.75, 0.01, 0.01, 0.093], &[0.25, 0.0, 0.0, 0.0025]);
    let f = systems::production_destruction_components();
    for settings in [FlowpipeSettings::default(), of_order(3)] {
        let system = systems::production_destruction();
        let flowpipe = contain_a_thousand(&system, &f, start.clone(), (0.05, 201), &settings);
        assert!(
            flowpipe.sample(200).iter().all(|side| side.width() < 1.0),
            "{:?}",
            settings.method
        );
    }
}

#[test]
fn an_order_that_does_not_fit_is_an_error() {
    let z = variables(40, 1);
    let still = PolynomialSystem::new(40, 0, &z).unwrap();
    let none = Hyperrectangle::zero(0);
    let input = UncertainInput { measured: &[], set: &none };
    let start = Hyperrectangle::zero(40);
    let of = |order| {
        Flowpipe::new(
            &still,
            &TimeGrid::uniform(0.1, 2),
            &[0.0; 40],
            &start,
            &input,
            &of_order(order),
        )
    };
    let error = of(200).unwrap_err();
    assert!(
        matches!(error, ReachError::Order(_)) && error.to_string().contains("40 variables"),
        "{error}"
    );
    assert!(of(0).unwrap().is_reached());
}
