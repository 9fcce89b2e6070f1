//! Reachable sets of systems with sines and cosines of their states.

use reachtube_reach::{
    Flowpipe, FlowpipeMethod, FlowpipeOutcome, FlowpipeSettings, Hyperrectangle, PolynomialSystem,
    ReachError, TimeGrid, UncertainInput,
};

use crate::simulated_case::{Case, map, set};
use crate::systems::{Polynomial, constant, variables};

/// Returns q̈ = u - sin q - q̇/10 in the variables (q, q̇, u, sin q, cos q).
fn pendulum() -> Vec<Polynomial> {
    let z = variables(5, 2);
    vec![z[1].clone(), z[2].clone() - z[3].clone() - &z[1] * &constant(0.1)]
}

#[test]
fn a_pendulum_that_turns_over_is_enclosed() {
    let (f, grid) = (pendulum(), TimeGrid::uniform(0.01, 401));
    let system = PolynomialSystem::trigonometric(2, 1, &[0], &f).unwrap();
    let (start, input) = (set(&[0.0, 2.6], &[0.01, 0.01]), set(&[0.0], &[0.002]));
    let uncertain = UncertainInput { measured: &vec![0.0; 400], set: &input };
    let flowpipe =
        Flowpipe::new(&system, &grid, &[0.0; 2], &start, &uncertain, &FlowpipeSettings::default())
            .unwrap();
    assert!(flowpipe.is_reached());
    let end = flowpipe.sample(400)[0];
    assert!(end.lo() > std::f64::consts::PI && end.width() < 1.0, "{end:?}");
    let case = Case {
        map: map(5, &f),
        angles: 1,
        flowpipe,
        start,
        input,
        step: 0.01,
        parts: 1,
        substeps: 1,
    };
    assert!(case.simulate(2_000, 3) > 0.5);
}

/// Sine and cosine as further states describe the same system.
#[test]
fn sines_as_functions_are_within_sines_as_states() {
    let grid = TimeGrid::uniform(0.01, 101);
    let own = PolynomialSystem::trigonometric(2, 1, &[0], &pendulum()).unwrap();
    let z = variables(5, 2);
    let f = [
        z[1].clone(),
        z[4].clone() - z[2].clone() - &z[1] * &constant(0.1),
        &z[1] * &z[3],
        -(&z[1] * &z[2]),
    ];
    let lifted = PolynomialSystem::new(4, 1, &f).unwrap();
    let input = UncertainInput { measured: &vec![0.1; 100], set: &set(&[0.0], &[1e-3]) };
    let propagate = |system: &PolynomialSystem, start: &[f64], radius: &[f64]| {
        let initial = set(&vec![0.0; start.len()], radius);
        Flowpipe::new(system, &grid, start, &initial, &input, &FlowpipeSettings::default()).unwrap()
    };
    let (q, r) = (0.7_f64, 1e-3);
    let functions = propagate(&own, &[q, 0.5], &[r, r]);
    let states = propagate(&lifted, &[q, 0.5, q.sin(), q.cos()], &[r, r, r, r]);
    assert!(functions.is_reached() && states.is_reached());
    for k in 1..101 {
        for (own, other) in functions.sample(k).iter().zip(states.sample(k)) {
            assert!(
                other.encloses(own) && own.width() > 0.3 * other.width(),
                "sample {k}: {own:?} {other:?}"
            );
        }
    }
}

/// Where the angle is arbitrary, its sine is between -1 and 1, which bounds the growth of the sets.
#[test]
fn an_arbitrary_angle_has_bounded_sets() {
    let system = PolynomialSystem::trigonometric(2, 1, &[0], &pendulum()).unwrap();
    let (grid, start) = (TimeGrid::uniform(0.01, 301), set(&[0.0; 2], &[4.0, 1.0]));
    let input = UncertainInput { measured: &vec![0.0; 300], set: &set(&[0.0], &[0.0]) };
    let flowpipe =
        Flowpipe::new(&system, &grid, &[0.0; 2], &start, &input, &FlowpipeSettings::default())
            .unwrap();
    assert!(flowpipe.is_reached());
    let velocity = flowpipe.sample(300)[1];
    let most = 1.0 + 3.0;
    assert!(velocity.hi() > 1.0 && velocity.hi() < most, "{velocity:?}");
    // The sine of an angle of 10⁹ rad has no bound.
    let far =
        Flowpipe::new(&system, &grid, &[1e9, 0.0], &start, &input, &FlowpipeSettings::default());
    assert!(matches!(far.unwrap().outcome(), FlowpipeOutcome::Failed { time: 0.0, .. }));
    let beyond = PolynomialSystem::trigonometric(2, 1, &[2], &pendulum());
    assert!(matches!(beyond, Err(ReachError::Shape { rows: 2, found_rows: 3, .. })));
}

#[test]
fn taylor_models_refuse_sines_as_functions() {
    let system = PolynomialSystem::trigonometric(2, 1, &[0], &pendulum()).unwrap();
    let settings = FlowpipeSettings {
        method: FlowpipeMethod::TaylorModels { order: 3 },
        ..FlowpipeSettings::default()
    };
    let input = UncertainInput { measured: &[0.0; 2], set: &Hyperrectangle::zero(1) };
    let grid = TimeGrid::uniform(0.01, 3);
    let refused =
        Flowpipe::new(&system, &grid, &[0.1, 0.0], &Hyperrectangle::zero(2), &input, &settings);
    assert_eq!(refused.unwrap_err(), ReachError::Trigonometric);
}
