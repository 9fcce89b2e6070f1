use reachtube_abstraction::ModelKind;
use reachtube_ode::InitialValueProblem;
use reachtube_reach::{
    Flowpipe, FlowpipeSettings, Hyperrectangle, Nonlinear, TimeGrid, UncertainInput,
};
use reachtube_robot::Robot;

use crate::common::{model, number, numbers, simulated};

/// Simulated runs of each model lie in its flowpipe, for starts and inputs at corners of their
/// sets.
#[test]
fn flowpipes_of_the_models_enclose_their_runs() {
    let (robot, mut seed) = (Robot::lwa4p(), 11);
    let times: Vec<f64> = (0..=25).map(|k| 0.004 * f64::from(k)).collect();
    for (kind, order) in [(ModelKind::One, 3), (ModelKind::Two, 4), (ModelKind::Three, 3)] {
        let model = model(&robot, kind, order);
        let system = model.polynomial_system().unwrap();
        let (q, qd) = (numbers(&mut seed, 6, 0.2), numbers(&mut seed, 6, 0.3));
        let nominal = numbers(&mut seed, 6 * 25, 2.0);
        let (initial, disturbance) = (0.003, 0.2);
        let flowpipe = Flowpipe::new(
            system,
            &TimeGrid::uniform(0.004, 26),
            &[q.clone(), qd.clone()].concat(),
            &Hyperrectangle { centre: vec![0.0; 12], radius: vec![initial; 12] },
            &UncertainInput {
                measured: &nominal,
                set: &Hyperrectangle { centre: vec![0.0; 6], radius: vec![disturbance; 6] },
            },
            &FlowpipeSettings::default(),
        )
        .unwrap();
        assert!(flowpipe.is_reached(), "{kind:?}");
        for _ in 0..20 {
            let moved = |values: &[f64], seed: &mut u64, size: f64| -> Vec<f64> {
                values.iter().map(|v| v + size * number(seed).signum()).collect()
            };
            let start =
                model.state(&moved(&q, &mut seed, initial), &moved(&qd, &mut seed, initial));
            let inputs = moved(&nominal, &mut seed, disturbance);
            let behaviour = simulated::<f64>(
                &model,
                &times,
                &[InitialValueProblem { start: &start, inputs: &inputs }],
            );
            for (k, x) in behaviour.chunks(model.states()).enumerate() {
                for (value, set) in x.iter().zip(flowpipe.sample(k)) {
                    // The integrator is exact to 1e-9 here.
                    assert!(
                        set.lo() - 1e-9 <= *value && *value <= set.hi() + 1e-9,
                        "{kind:?} sample {k}: {value} {set:?}"
                    );
                }
            }
        }
        let spread = flowpipe.sample(25).iter().map(|set| set.width()).fold(0.0, f64::max);
        assert!(spread < 0.2, "{kind:?}: {spread}");
    }
}
