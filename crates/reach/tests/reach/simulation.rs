//! Numerical integration of the linear system, against enclosures of its solution.

use crate::arm::arm;
use crate::random::Random;
use reachtube_ode::{DormandPrince, Ensemble, InitialValueProblem, Tolerance};
use reachtube_reach::{IntervalVector, Propagation, TimeGrid};
use reachtube_scalar::{Interval, Lanes};

#[test]
fn simulated_runs_lie_in_the_enclosed_solution() {
    let mut random = Random::new(7);
    let times: Vec<f64> =
        (0..60).map(|k| 0.004 * f64::from(k) + 1e-3 * random.symmetric()).collect();
    let (system, grid) = (arm(), TimeGrid::from_times(&times).unwrap());
    let start: Vec<f64> = (0..12).map(|_| random.symmetric()).collect();
    let inputs: Vec<f64> = (0..6 * 60).map(|_| 20.0 * random.symmetric()).collect();
    let point = IntervalVector::from_iterator(12, start.iter().map(|x| Interval::point(*x)));
    let exact = Propagation::new(&system, &grid).unwrap().solve(&point, &inputs);
    let run = InitialValueProblem { start: &start, inputs: &inputs[..6 * 59] };
    let close = |sample: usize, x: &[f64]| {
        let near =
            |(exact, x): (&Interval, &f64)| (*exact + Interval::centred(0.0, 1e-8)).contains(*x);
        assert!(exact.state(sample).iter().zip(x).all(near), "sample {sample}: {x:?}");
    };
    let fine = Tolerance { relative: 1e-11, absolute: 1e-11 };
    assert!(DormandPrince::new(12, fine).simulate(&mut &system, &times, run, close).is_reached());
    let mut ensemble = Ensemble::<Lanes<4>>::new(12);
    let outcomes =
        ensemble.integrate(&mut &system, &times, 8, &[run; 3], |_, sample, x| close(sample, x));
    assert!(outcomes.iter().all(|outcome| outcome.is_reached()));
}
