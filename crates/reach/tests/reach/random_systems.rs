//! Simulated behaviours of random polynomial systems.

use reachtube_ode::{Ensemble, InitialValueProblem};
use reachtube_reach::FlowpipeMethod::Linearisation;

use crate::simulated_case::{Field, SLACK, random_case, simulate_random_cases};

#[test]
fn none_of_200_000_behaviours_of_random_systems_leaves_its_sets() {
    simulate_random_cases(1_000, |_| Linearisation);
}

#[test]
#[ignore = "takes long: a million behaviours"]
fn none_of_a_million_behaviours_of_random_systems_leaves_its_sets() {
    simulate_random_cases(5_000, |_| Linearisation);
}

#[test]
fn simulations_are_within_the_assumed_error() {
    for seed in 1..=200 {
        let case = random_case(seed, Linearisation);
        let steps = case.flowpipe.len() - 1;
        let times: Vec<f64> = (0..=2 * steps).map(|k| 0.5 * k as f64 * case.step).collect();
        let vertex: Vec<f64> =
            case.start.centre.iter().zip(&case.start.radius).map(|(c, r)| c + r).collect();
        let inputs: Vec<f64> = (0..2 * steps)
            .flat_map(|k| {
                let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
                case.input.centre.iter().zip(&case.input.radius).map(move |(c, r)| c + sign * r)
            })
            .collect();
        let run = InitialValueProblem { start: &vertex, inputs: &inputs };
        let end = |substeps: usize| {
            let mut end = vertex.clone();
            let mut ensemble = Ensemble::<f64>::new(vertex.len());
            let keep = |_: usize, _: usize, x: &[f64]| end.copy_from_slice(x);
            let outcomes = ensemble.integrate(
                &mut Field::new(&case.map, case.angles),
                &times,
                substeps,
                &[run],
                keep,
            );
            assert!(outcomes.iter().all(|outcome| outcome.is_reached()), "{seed}");
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
