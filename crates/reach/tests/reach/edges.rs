//! Systems and grids with few samples, states or inputs.

use nalgebra::{DMatrix, DVector, dmatrix, dvector};
use reachtube_reach::{
    Disturbance, Hyperrectangle, IntervalVector, LinearSystem, Propagation, ReachError, ReachSets,
    StepBounds, StepRadii, TimeGrid,
};
use reachtube_scalar::Interval;

const DISTURBANCES: [Disturbance; 3] =
    [Disturbance::Constant, Disturbance::Sample, Disturbance::Measurable];

fn grids() -> Vec<TimeGrid> {
    let recorded = |times: &[f64]| TimeGrid::from_times(times).unwrap();
    vec![
        recorded(&[]),
        recorded(&[3.0]),
        recorded(&[3.0, 3.5]),
        recorded(&[0.0, 0.1, 0.25]),
        TimeGrid::uniform(0.1, 0),
        TimeGrid::uniform(0.1, 1),
        TimeGrid::uniform(0.1, 3),
    ]
}

fn sets(n: usize) -> Hyperrectangle {
    Hyperrectangle { centre: vec![0.5; n], radius: vec![0.25; n] }
}

/// Runs all computations on every small grid and checks for one result per sample and one box per
/// step.
fn run_all(system: &LinearSystem) {
    let (n, m) = (system.states(), system.inputs());
    for grid in grids() {
        let propagation = Propagation::new(system, &grid).unwrap();
        for disturbance in DISTURBANCES {
            let gains = disturbance.input_gains(&propagation);
            assert_eq!(gains.len(), grid.len(), "{disturbance:?} on {grid:?}");
            let reach = ReachSets::new(&propagation, &gains, &sets(n), &sets(m));
            assert_eq!(reach.len(), grid.len());
            if grid.len() > 0 {
                let ends = [(reach.upper_outer(0, 0), reach.upper_inner(0, 0), 0.75)];
                let ends = ends.into_iter().chain([(
                    -reach.lower_outer(0, 0),
                    -reach.lower_inner(0, 0),
                    -0.25,
                )]);
                ends.for_each(|(outer, inner, x)| {
                    assert!(inner <= x && x <= outer && outer - inner < 1e-15)
                });
            }
            let inputs = vec![1.0; grid.len() * m];
            let nominal =
                propagation.solve(&IntervalVector::from_element(n, Interval::ONE), &inputs);
            assert_eq!(nominal.len(), grid.len());
            let radii = StepRadii::new(&propagation, disturbance, &sets(n), &sets(m));
            let tube = StepBounds::new(&propagation, &nominal, &inputs, &reach, &sets(m), &radii);
            assert_eq!(tube.len(), grid.len().saturating_sub(1));
        }
    }
}

#[test]
fn few_samples_inputs_and_states() {
    run_all(
        &LinearSystem::new(dmatrix![0.0, 1.0; 0.0, -2.0], dmatrix![0.0; 3.0], dvector![0.0, 0.1])
            .unwrap(),
    );
    run_all(&LinearSystem::new(dmatrix![-1.0], dmatrix![1.0], dvector![0.0]).unwrap());
}

#[test]
fn a_system_that_stands_still_and_one_without_inputs() {
    run_all(&LinearSystem::new(dmatrix![0.0], dmatrix![0.0], dvector![0.0]).unwrap());
    run_all(
        &LinearSystem::new(dmatrix![0.0, 1.0; -1.0, 0.0], DMatrix::zeros(2, 0), dvector![1.0, 0.0])
            .unwrap(),
    );
}

#[test]
fn matrices_that_do_not_fit_or_are_not_finite_are_errors() {
    let shape = LinearSystem::new(DMatrix::zeros(2, 2), DMatrix::zeros(3, 1), DVector::zeros(2))
        .unwrap_err();
    assert_eq!(shape.to_string(), "B is 3 x 1, expected 2 x 1");
    let drift = LinearSystem::new(DMatrix::zeros(2, 2), DMatrix::zeros(2, 1), DVector::zeros(1))
        .unwrap_err();
    assert_eq!(drift.to_string(), "the drift is 1 x 1, expected 2 x 1");
    let value =
        LinearSystem::new(dmatrix![f64::INFINITY], dmatrix![1.0], dvector![0.0]).unwrap_err();
    assert_eq!(value, ReachError::NotFinite { what: "A", row: 0, column: 0, value: f64::INFINITY });
}

#[test]
fn a_solution_that_overflows_is_an_error() {
    let explosive = LinearSystem::new(dmatrix![100.0], dmatrix![1.0], dvector![0.0]).unwrap();
    let error = Propagation::new(&explosive, &TimeGrid::uniform(0.1, 101)).unwrap_err();
    assert_eq!(error, ReachError::Horizon { time: 10.0 });
}
