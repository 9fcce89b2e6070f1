//! The margins of the LWA 4P on its recordings, beside the 0.02 m that a safety shield assumes.

use std::path::Path;

use reachtube_arm::{ArmSettings, setup};
use reachtube_conform::{Keep, Problem, Settings, Silent, SuiteReach, Tube, conform, reach};
use reachtube_reach::StepBounds;
use reachtube_recordings::{DataSet, Torque};
use reachtube_robot::Robot;
use reachtube_verify::{Body, Capsules};

#[test]
#[ignore = "needs ../shared/data/schunk_lwa4p"]
fn the_margins_of_the_paper_suites() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/schunk_lwa4p");
    let robot = Robot::lwa4p();
    let arm = ArmSettings::new(Torque::Compensated, robot.joint_count());
    let setup = setup(robot.clone(), arm, Settings::default()).unwrap();
    let data = Box::new(DataSet::open(&folder).unwrap());
    let problem = Problem::read(setup, data, &[], Keep::Needed, &Silent).unwrap();
    let conformance = conform(&problem, &Silent, None).unwrap();
    let tube = Tube::new(&problem, conformance.sets).unwrap();
    let body = Body::new(&robot, &Capsules::embedded(&robot).unwrap());
    for suite in reach(&problem, &tube).unwrap() {
        for horizon in [0.1, 0.25, 0.5, 1.0, f64::INFINITY] {
            let margins = body.margins(&until(&suite, horizon));
            let millimetres: Vec<_> =
                margins.iter().map(|m| format!("{:.1}", 1e3 * m.distance)).collect();
            println!("{} {horizon} s: {} mm", suite.suite, millimetres.join(", "));
            // The shield's 0.02 m holds for the links up to the elbow, and for the hand for less
            // than 0.1 s.
            let [upper_arm, hand] = [1, 5].map(|joint: usize| margins[joint].distance);
            if horizon == 0.1 {
                assert!(upper_arm < 0.01 && (0.018..0.03).contains(&hand), "{margins:?}");
            }
            assert!(horizon < 0.2 || hand > 0.04, "{margins:?}");
        }
    }
}

/// The reachable sets of the samples up to a time.
fn until(suite: &SuiteReach, horizon: f64) -> SuiteReach {
    let mut cut = suite.clone();
    let samples = suite.times.iter().filter(|t| **t <= horizon).count();
    cut.times.truncate(samples);
    let steps = (0..samples - 1).flat_map(|k| suite.tube.bounds(k).to_vec()).collect();
    cut.tube = StepBounds::from_boxes(suite.dimension, steps);
    cut
}
