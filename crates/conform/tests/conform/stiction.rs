//! Dry friction of joints that may come to rest, beside U.

use reachtube_conform::{
    Keep, Problem, Settings, Setup, Silent, Stiction, Tube, UncertaintySets, reach, stiction,
};
use reachtube_reach::Hyperrectangle;
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::Robot;

/// Returns the joints of the LWA 4P at rest that may come to rest under U of `radius`, and the
/// position that it rests at.
fn at_rest(torque: Torque, radius: f64) -> (Vec<Stiction>, Vec<f64>) {
    let q = [0.3, 0.9, -0.4, 0.2, -0.7, 0.5];
    let states = [q, [0.0; 6]].concat().repeat(3);
    let robot = Robot::lwa4p();
    let run = Run::new(6, vec![0.0, 0.004, 0.008], states, vec![0.0; 18]).unwrap();
    let mut runs = MemoryRuns::default();
    runs.push("rest", Some("A"), None, run);
    let setup = Setup::new(robot, Settings::new(torque, 6)).unwrap();
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::All, &Silent).unwrap();
    let set = |n, radius| Hyperrectangle { centre: vec![0.0; n], radius: vec![radius; n] };
    let sets =
        UncertaintySets { initial_set: set(12, 1e-3), input_set: set(6, radius), noise_set: None };
    let tube = Tube::new(&problem, sets.clone()).unwrap();
    (stiction(&problem, &sets, &reach(&problem, &tube).unwrap()), q.to_vec())
}

#[test]
fn friction_at_rest_is_covered_by_a_wide_u_only() {
    let robot = Robot::lwa4p();
    let (narrow, q) = at_rest(Torque::Compensated, 0.5);
    assert_eq!(narrow.len(), 6);
    let load = robot.gravity_torque(&q);
    for rest in &narrow {
        // Both limits of standstill, at the load of the recorded position.
        let friction = &robot.joints()[rest.joint].friction;
        let limit = |sign: f64| friction.dry_torque(load[rest.joint], sign * 1e-9);
        let apart = (limit(1.0) - limit(-1.0)).abs();
        assert!(apart > 1.0 && rest.torque >= apart && rest.torque < 1.2 * apart, "{rest:?}");
        assert!(!rest.is_covered() && rest.steps == 2 && rest.room == 0.5, "{rest:?}");
    }
    let (wide, _) = at_rest(Torque::Compensated, 50.0);
    assert!(wide.len() == 6 && wide.iter().all(Stiction::is_covered), "{wide:?}");
    assert!(at_rest(Torque::Link, 0.5).0.is_empty());
}
