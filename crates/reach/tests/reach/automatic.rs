//! Flowpipes whose method, order and step are found by trial.

use reachtube_reach::{
    AutomaticFlowpipe, Flowpipe, FlowpipeMethod, Hyperrectangle, PolynomialSystem, TimeGrid,
    UncertainInput,
};
use reachtube_scalar::{Interval, PolynomialMap};

use crate::simulated_case::{map, set};
use crate::systems::{self, coupled_van_der_pol, production_destruction, variables};

fn automatic(
    system: &PolynomialSystem,
    grid: &TimeGrid,
    start: &Hyperrectangle,
    input: &UncertainInput<'_>,
) -> AutomaticFlowpipe {
    Flowpipe::automatic(system, grid, &vec![0.0; start.dimension()], start, input).unwrap()
}

/// Returns the solution of ẋ = f(x) from `x` after `h` by `count` Runge-Kutta steps.
fn simulated(map: &PolynomialMap, x: &[f64], h: f64, count: usize) -> Vec<f64> {
    let h = h / count as f64;
    let moved = |x: &[f64], k: &[f64], h: f64| -> Vec<f64> {
        x.iter().zip(k).map(|(x, k)| x + h * k).collect()
    };
    (0..count).fold(x.to_vec(), |x, _| {
        let a = map.evaluate(&x);
        let b = map.evaluate(&moved(&x, &a, h / 2.0));
        let c = map.evaluate(&moved(&x, &b, h / 2.0));
        let d = map.evaluate(&moved(&x, &c, h));
        (0..x.len()).map(|i| x[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i])).collect()
    })
}

/// Steps of 2 s are too long: no tube of the first step is verified. Two states start as points.
#[test]
fn a_step_that_is_too_long_is_divided() {
    let (grid, none) = (TimeGrid::uniform(2.0, 6), set(&[], &[]));
    let start = set(&[9.75, 0.01, 0.01, 0.093], &[0.25, 0.0, 0.0, 0.0025]);
    let input = UncertainInput { measured: &[], set: &none };
    let found = automatic(&production_destruction(), &grid, &start, &input);
    assert!(found.flowpipe.is_reached() && found.parts > 1, "{} parts", found.parts);
    assert_eq!(found.flowpipe.len(), 6);
    let map = map(4, &systems::production_destruction_components());
    for x in [9.5, 9.75, 10.0] {
        let mut state = vec![x, 0.01, 0.01, 1.0 / (1.0 + x)];
        for k in 0..5 {
            let middle = simulated(&map, &state, 1.0, 200);
            state = simulated(&map, &state, 2.0, 400);
            let sides = found.flowpipe.sample(k + 1).iter().zip(found.flowpipe.step(k));
            for ((sample, step), (end, middle)) in sides.zip(state.iter().zip(&middle)) {
                let near = |side: &Interval| *side + Interval::centred(0.0, 1e-9);
                assert!(near(sample).contains(*end), "{sample:?} {end} after step {k}");
                assert!(near(step).contains(*middle), "{step:?} {middle} within step {k}");
            }
        }
    }
    // The solutions are 0.77 apart.
    let widest = found.flowpipe.sample(5).iter().map(|x| x.width()).fold(0.0, f64::max);
    assert!(widest < 1.2, "{widest}");
}

/// Linearisation loses the set at 2.2 s.
#[test]
fn taylor_models_are_chosen_where_linearisation_fails() {
    let start = set(&[1.4, 2.4, 1.4, 2.4, 70.0], &[0.15, 0.05, 0.15, 0.05, 10.0]);
    let (grid, none) = (TimeGrid::uniform(0.01, 231), set(&[], &[]));
    let input = UncertainInput { measured: &[], set: &none };
    let found = automatic(&coupled_van_der_pol(), &grid, &start, &input);
    assert!(found.flowpipe.is_reached(), "{:?}", found.flowpipe.outcome());
    let method = found.settings.method;
    assert!(matches!(method, FlowpipeMethod::TaylorModels { .. }), "{method:?}");
}

/// Linearisation reaches the end 2.5 times as wide as trajectories found by search.
#[test]
fn a_wide_flowpipe_does_not_end_the_search() {
    let start = set(&[1.2, 1.05, 1.5, 2.4, 1.0, 0.1, 0.45], &[0.05; 7]);
    let (grid, none) = (TimeGrid::uniform(0.1, 201), set(&[], &[]));
    let input = UncertainInput { measured: &[], set: &none };
    let found = automatic(&systems::laub_loomis(), &grid, &start, &input);
    let width = found.flowpipe.sample(200)[3].width();
    assert!(found.flowpipe.is_reached() && width > 0.0125 && width < 1.1 * 0.0126, "{width}");
}

/// The solution x = x0 / (1 - x0 t) of ẋ = x² from [-9, 1] has a pole at 1 s, so that polynomials
/// in x0 converge slowly.
#[test]
fn a_set_that_is_too_large_is_divided() {
    let z = variables(1, 2);
    let system = PolynomialSystem::new(1, 0, &[&z[0] * &z[0]]).unwrap();
    let (grid, none) = (TimeGrid::uniform(0.01, 91), set(&[], &[]));
    let input = UncertainInput { measured: &[], set: &none };
    let found = automatic(&system, &grid, &set(&[-4.0], &[5.0]), &input);
    assert!(found.flowpipe.is_reached() && found.settings.pieces[0] > 1, "{:?}", found.settings);
    assert!(found.flowpipe.sample(90)[0].width() < 2.0 * 11.0);
    for (k, t) in grid.times().iter().enumerate() {
        let exact = |x: f64| x / (1.0 - x * t);
        let side = found.flowpipe.sample(k)[0];
        assert!(side.lo() <= exact(-9.0) && side.hi() >= exact(1.0), "{side:?} at {t} s");
    }
}

#[test]
fn a_pole_is_an_outcome_and_measured_inputs_are_held_over_parts() {
    // ẋ = x² + u from [0.9, 1.1] has a pole before 1.2 s, whatever the settings.
    let z = variables(2, 2);
    let system = PolynomialSystem::new(1, 1, &[&z[0] * &z[0] + z[1].clone()]).unwrap();
    let (start, point) = (set(&[1.0], &[0.1]), set(&[0.0], &[0.0]));
    let measured = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    let input = UncertainInput { measured: &measured, set: &point };
    let found = automatic(&system, &TimeGrid::uniform(0.2, 7), &start, &input);
    assert!(!found.flowpipe.is_reached());
    let last = found.flowpipe.len() - 1;
    assert!((3..6).contains(&last), "{last}");
    let map = map(2, &[&z[0] * &z[0] + z[1].clone(), &z[1] - &z[1]]);
    let mut x = 1.0;
    for (k, u) in measured.iter().enumerate().take(last) {
        x = simulated(&map, &[x, *u], 0.2, 400)[0];
        let side = found.flowpipe.sample(k + 1)[0] + Interval::centred(0.0, 1e-9);
        assert!(side.contains(x), "{side:?} {x}");
    }
    let few = UncertainInput { measured: &measured[..3], set: &point };
    let grid = TimeGrid::uniform(0.2, 7);
    assert!(Flowpipe::automatic(&system, &grid, &[0.0], &start, &few).is_err());
}
