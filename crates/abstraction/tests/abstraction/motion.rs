use reachtube_abstraction::{ModelField, ModelKind};
use reachtube_ode::{DormandPrince, InitialValueProblem, Tolerance};
use reachtube_robot::{DrivenBy, Robot, RobotField};
use reachtube_scalar::Lanes;

use crate::common::{largest, model, numbers, simulated};

#[test]
fn integrators_and_lanes_agree_on_the_motion_of_a_model() {
    let (robot, mut seed) = (Robot::lwa4p(), 5);
    let times: Vec<f64> = (0..=25).map(|k| 0.004 * f64::from(k)).collect();
    let inputs = numbers(&mut seed, 6 * 25, 3.0);
    for (kind, order) in [(ModelKind::One, 3), (ModelKind::Two, 12), (ModelKind::Three, 4)] {
        let model = model(&robot, kind, order);
        let starts: Vec<Vec<f64>> = (0..6)
            .map(|_| model.state(&numbers(&mut seed, 6, 0.1), &numbers(&mut seed, 6, 0.1)))
            .collect();
        let runs: Vec<_> =
            starts.iter().map(|start| InitialValueProblem { start, inputs: &inputs }).collect();
        let alone = simulated::<f64>(&model, &times, &runs);
        assert_eq!(alone, simulated::<Lanes<4>>(&model, &times, &runs), "{kind:?}");
        let states = model.states();
        let fine = Tolerance { relative: 1e-10, absolute: 1e-10 };
        let mut solver = DormandPrince::new(states, fine);
        let outcome =
            solver.simulate(&mut ModelField::new(&model), &times, runs[0], |sample, x| {
                let error = largest(x.iter().zip(&alone[sample * states..]).map(|(a, b)| a - b));
                assert!(error < 1e-7, "{kind:?}: {error} at sample {sample}");
            });
        assert!(outcome.is_reached());
    }
}

/// Near the expansion point, a model of high order moves as the robot does.
#[test]
fn a_simulated_model_3_moves_as_the_robot() {
    let (robot, mut seed) = (Robot::lwa4p(), 9);
    let model = model(&robot, ModelKind::Three, 6);
    let times: Vec<f64> = (0..=25).map(|k| 0.004 * f64::from(k)).collect();
    let inputs = numbers(&mut seed, 6 * 25, 3.0);
    let (q, qd) = (numbers(&mut seed, 6, 0.1), numbers(&mut seed, 6, 0.1));
    let (start, body) = (model.state(&q, &qd), [q, qd].concat());
    let mut motion = Vec::new();
    let mut solver = DormandPrince::new(12, Tolerance::default());
    let run = InitialValueProblem { start: &body, inputs: &inputs };
    let mut field = RobotField::new(&robot, DrivenBy::Input);
    assert!(solver.simulate(&mut field, &times, run, |_, x| motion.push(x.to_vec())).is_reached());
    let mut solver = DormandPrince::new(24, Tolerance::default());
    let run = InitialValueProblem { start: &start, inputs: &inputs };
    let outcome = solver.simulate(&mut ModelField::new(&model), &times, run, |sample, x| {
        let error = largest(x.iter().zip(&motion[sample]).map(|(a, b)| a - b));
        assert!(error < 1e-4, "{error} at sample {sample}");
    });
    assert!(outcome.is_reached());
    let travelled = largest(motion[25].iter().zip(&motion[0]).map(|(a, b)| a - b));
    assert!(travelled > 0.05, "{travelled}");
}
