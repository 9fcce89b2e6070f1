//! Tests that each lane of an ensemble is a run of its own.

use proptest::prelude::*;
use reachtube_ode::{Ensemble, InitialValueProblem, RungeKutta4, VectorField};
use reachtube_scalar::{Lanes, Lanewise};

/// A Duffing oscillator with dry friction: products, a sine and a branch, with two inputs.
struct Duffing;

impl<S: Lanewise> VectorField<S> for Duffing {
    fn rate(&mut self, t: f64, x: &[S], u: &[S], dx: &mut [S]) {
        let dry = x[1].map(|v| if v > 0.0 { 0.3 } else { -0.2 });
        let spring = x[0] * x[0] * x[0] - x[0].sin_cos().0 / (S::from(2.0) + u[1]);
        (dx[0], dx[1]) = (x[1], u[0] + S::from(t.sin()) - dry - spring);
    }
}

const SPANS: usize = 5;

fn all<S: Lanewise>(runs: &[InitialValueProblem<'_>], times: &[f64]) -> Vec<Vec<f64>> {
    let mut found = vec![Vec::new(); runs.len()];
    let outcomes =
        Ensemble::<S>::new(2).integrate(&mut Duffing, times, 3, runs, |run, sample, x| {
            assert_eq!(found[run].len(), 2 * sample);
            found[run].extend_from_slice(x);
        });
    assert!(outcomes.len() == runs.len() && outcomes.iter().all(|outcome| outcome.is_reached()));
    found
}

proptest! {
    #[test]
    fn lanes_equal_single_runs_to_the_last_bit(
        starts in prop::collection::vec(prop::array::uniform2(-1.5..1.5f64), 1..20),
        inputs in prop::collection::vec(-0.5..0.5f64, 20 * 2 * SPANS),
    ) {
        let times: Vec<f64> = (0..=SPANS).map(|k| 0.2 * k as f64 + 0.01 * (k * k) as f64).collect();
        let rows = inputs.chunks(2 * SPANS);
        let runs: Vec<_> = starts
            .iter()
            .zip(rows)
            .map(|(start, inputs)| InitialValueProblem { start, inputs })
            .collect();
        let single: Vec<_> = runs
            .iter()
            .map(|run| {
                let (mut x, mut states) = ([run.start[0], run.start[1]], run.start.to_vec());
                for k in 0..SPANS {
                    let u = &run.inputs[2 * k..2 * k + 2];
                    RungeKutta4::<f64>::new(2).integrate(
                        &mut Duffing,
                        [times[k], times[k + 1]],
                        3,
                        &mut x,
                        u,
                    );
                    states.extend(x);
                }
                states
            })
            .collect();
        prop_assert_eq!(&all::<f64>(&runs, &times), &single);
        prop_assert_eq!(&all::<Lanes<3>>(&runs, &times), &single);
        prop_assert_eq!(&all::<Lanes<4>>(&runs, &times), &single);
        prop_assert_eq!(&all::<Lanes<8>>(&runs, &times), &single);
    }
}

#[test]
fn an_ensemble_without_runs_or_spans_works() {
    assert!(
        Ensemble::<Lanes<4>>::new(2)
            .integrate(&mut Duffing, &[0.0, 1.0], 1, &[], |_, _, _| panic!())
            .is_empty()
    );
    let mut observed = 0;
    let run = InitialValueProblem { start: &[1.0, 2.0], inputs: &[] };
    let outcomes =
        Ensemble::<Lanes<4>>::new(2).integrate(&mut Duffing, &[0.0], 1, &[run], |_, _, x| {
            assert_eq!(x, [1.0, 2.0]);
            observed += 1;
        });
    assert!(outcomes[0].is_reached() && observed == 1);
}
