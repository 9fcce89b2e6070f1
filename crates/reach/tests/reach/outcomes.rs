//! Flowpipes that stop early, and arguments that do not fit.

use reachtube_reach::{
    Flowpipe, FlowpipeOutcome, FlowpipeSettings, Hyperrectangle, PolynomialSystem, ReachError,
    TimeGrid, UncertainInput,
};
use reachtube_scalar::Interval;

use crate::simulated_case::set;
use crate::systems::{Polynomial, variables};

#[test]
fn a_flowpipe_that_stops_early_is_an_outcome() {
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
    // The solution x = 1/(1/x0 - t) from x0 = 1.1 has a pole at t = 1/1.1.
    let FlowpipeOutcome::Failed { time, state, widths } = flowpipe.outcome() else {
        panic!("the solution has a pole")
    };
    assert!((0.7..1.0 / 1.1).contains(time) && *state == 0 && widths[0] > 1.0, "{time} {widths:?}");
    let last = flowpipe.len() - 1;
    assert_eq!(grid.times()[last], *time);
    assert!(flowpipe.sample(last)[0].contains(1.0 / (1.0 / 1.1 - time)));
}

#[test]
fn arguments_that_do_not_fit_are_errors() {
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
