//! Recordings that were read in a wrong way give an answer, and the answer says what is wrong.

use crate::common::{Random, grid};
use reachtube_arm::{ArmSettings, Equations, setup};
use reachtube_conform::settings::{Method, NominalStart};
use reachtube_conform::{
    Code, Conformance, Keep, Model, Noise, Problem, Settings, Silent, conform,
};
use reachtube_finding::Finding;
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::Robot;

const JOINTS: usize = 6;

/// The embedded arm without limits, which would refuse some of the wrong readings.
fn arm() -> Robot {
    let mut description = Robot::lwa4p().description().clone();
    for joint in &mut description.joints {
        joint.position_limits = None;
        joint.velocity_limit = None;
    }
    Robot::from_description(&description).unwrap()
}

/// Numbers as a user may have written them.
struct Written {
    time: f64,
    angle: f64,
    torque: f64,
    /// Samples by which the torques are late.
    late: usize,
    swapped: Option<(usize, usize)>,
    /// Samples to either side over which the torques are averaged.
    filtered: usize,
    /// The position about which joint 2 moves, rad.
    about: f64,
    /// What the sensor of joint 1 adds to its torque, N m.
    offset: f64,
}

const RIGHT: Written = Written {
    time: 1.0,
    angle: 1.0,
    torque: 1.0,
    late: 0,
    swapped: None,
    filtered: 0,
    about: 0.0,
    offset: 0.0,
};

/// Motions of the arm with the motor torques that its dynamics need, written in some way.
fn recorded(robot: &Robot, written: &Written) -> MemoryRuns {
    let (times, n) = (grid(0.004, 400), robot.joint_count());
    let (mut runs, mut random) = (MemoryRuns::default(), Random(9));
    for (suite, phase) in [("A", 0.0), ("B", 1.0)] {
        for run in 0..2 {
            let (mut states, mut torques) = (Vec::new(), Vec::new());
            for &t in &times {
                let wave = |j: usize| (3.0 + 0.5 * j as f64, 2.0 * j as f64 + phase);
                let value = |f: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
                    (0..n).map(wave).map(|(w, p)| 0.25 * f(w, w * t + p)).collect()
                };
                let mut q = value(&|_, x| x.sin());
                q[1] += written.about;
                let qd = value(&|w, x| w * x.cos());
                let qdd = value(&|w, x| -w * w * x.sin());
                let inertia = robot.mass_matrix(&q) * nalgebra::DVector::from_vec(qdd);
                let u = inertia
                    + robot.motion_torque(&q, &qd, &vec![0.0; q.len()])
                    + robot.viscous_torque(&qd);
                let motor = robot.motor_torque_from_input(&q, &qd, u.as_slice());
                let noisy = |x: &f64| written.angle * (x + 1e-5 * random.signed());
                states.extend(q.iter().chain(&qd).map(noisy).collect::<Vec<_>>());
                torques.extend(motor.iter().map(|x| written.torque * x));
            }
            if let Some((i, j)) = written.swapped {
                torques.chunks_exact_mut(n).for_each(|row| row.swap(i, j));
            }
            torques.iter_mut().step_by(n).for_each(|torque| *torque += written.offset);
            torques.rotate_right(n * written.late);
            let torques = averaged(&torques, n, written.filtered);
            let times = times.iter().map(|t| t * written.time).collect();
            let recording = Run::new(n, times, states, torques).unwrap();
            runs.push(&format!("{suite}{run}"), Some(suite), None, recording);
        }
    }
    runs
}

/// Averages each column of `values`, samples x n, over `reach` samples to either side.
fn averaged(values: &[f64], n: usize, reach: usize) -> Vec<f64> {
    let samples = values.len() / n;
    let mean = |k: usize, j: usize| {
        let around = k.saturating_sub(reach)..(k + reach + 1).min(samples);
        let count = around.len() as f64;
        around.map(|at| values[at * n + j]).sum::<f64>() / count
    };
    (0..samples * n).map(|at| mean(at / n, at % n)).collect()
}

fn motor(joints: usize) -> ArmSettings {
    ArmSettings::new(Torque::Motor, joints)
}

fn found(written: &Written, settings: Settings) -> (Problem, Conformance) {
    found_for(arm(), written, motor(JOINTS), settings)
}

fn found_for(
    robot: Robot,
    written: &Written,
    arm: ArmSettings,
    settings: Settings,
) -> (Problem, Conformance) {
    let runs = recorded(&robot, written);
    let setup = setup(robot, arm, settings).unwrap();
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap();
    let found = conform(&problem, &Silent, None).unwrap();
    (problem, found)
}

/// Returns the cause among warnings with its remedy.
fn cause(warnings: &[Finding]) -> Option<String> {
    let is_cause = |warning: &&Finding| warning.code == Code::Cause;
    warnings.iter().find(is_cause).map(|warning| warning.to_string())
}

#[test]
fn a_right_reading_has_no_warning_and_is_explained() {
    let (problem, found) = found(&RIGHT, Settings::default());
    assert_eq!(found.warnings, []);
    let parts: Vec<f64> = found.nominal_explains.iter().flatten().copied().collect();
    assert!(parts.len() == 2 * JOINTS && parts.iter().all(|part| *part > 0.7), "{parts:?}");
    let noise = &problem.sensor_noise().radius;
    // Uniform noise in ±1e-5 has the standard deviation 5.8e-6; the radius is five of them.
    assert!(noise.iter().all(|radius| (1e-5..6e-5).contains(radius)), "{noise:?}");
}

#[test]
fn the_cause_of_a_wrong_reading_is_named() {
    let wrong = [
        (Written { torque: 1e3, ..RIGHT }, Torque::Motor, "in N mm"),
        (Written { torque: -1.0, ..RIGHT }, Torque::Motor, "the opposite sign"),
        (RIGHT, Torque::Compensated, "--torque motor"),
        (Written { angle: 180.0 / std::f64::consts::PI, ..RIGHT }, Torque::Motor, "in degrees"),
        (Written { late: 25, ..RIGHT }, Torque::Motor, "lags the motion by 100 ms"),
        (
            Written { swapped: Some((1, 2)), ..RIGHT },
            Torque::Motor,
            "joint2 and joint3 are swapped",
        ),
    ];
    for (written, torque, words) in wrong {
        let of_torque = ArmSettings::new(torque, JOINTS);
        let (problem, found) = found_for(arm(), &written, of_torque, Settings::default());
        assert!(found.verdict.conformant, "{words}: the sets enclose the recordings all the same");
        let cause = cause(&found.warnings).unwrap_or_else(|| panic!("{words}: no warning"));
        assert!(cause.contains(words), "{words} is not in {cause}; {:?}", found.warnings);
        assert_eq!(Model::new(&problem, &found).warnings, found.warnings);
    }
}

#[test]
fn times_in_milliseconds_are_refused() {
    let (robot, written) = (arm(), Written { time: 1e3, ..RIGHT });
    let runs = Box::new(recorded(&robot, &written));
    let setup = setup(robot, motor(JOINTS), Settings::default()).unwrap();
    let refused = Problem::read(setup, runs, &[], Keep::Needed, &Silent).unwrap_err().to_string();
    assert!(refused.contains("the times look like milliseconds"), "{refused}");
}

#[test]
fn filtered_torques_of_joints_that_turn_are_named() {
    let mut description = folding().description().clone();
    for joint in &mut description.joints {
        joint.friction.coulomb = [5.0, 0.0, -5.0, 0.0, -5.0, 0.0, 5.0, 0.0];
    }
    let robot = Robot::from_description(&description).unwrap();
    let own = Settings { nominal: NominalStart::Own, ..Settings::default() };
    let cause_of = |filtered: usize| {
        let written = Written { filtered, about: 2.0, ..RIGHT };
        let (_, found) = found_for(robot.clone(), &written, motor(2), own.clone());
        cause(&found.warnings)
    };
    let named = cause_of(12).expect("the sets are wide");
    assert!(named.contains("`reachtube prepare --compensate`"), "{named}");
    assert!(cause_of(0).is_none_or(|cause| !cause.contains("--compensate")));
}

/// Two links without friction, the second one the heavier: folded they turn easily, stretched not.
fn folding() -> Robot {
    let joint = |name: &str, mass: f64| {
        format!(
            "[[joint]]\nname = \"{name}\"\n\
             dh = {{ a = 0.4, alpha = 0.0, theta = 0.0, d = 0.0 }}\n\
             mass = {mass}\ncom = [-0.1, 0.0, 0.0]\ninertia = [0.01, 0.0, 0.0, 0.02, 0.0, 0.02]\n"
        )
    };
    let text = format!(
        "schema_version = 1\nname = \"folding\"\n{}{}",
        joint("shoulder", 0.5),
        joint("elbow", 3.0)
    );
    Robot::from_toml(&text, "folding").unwrap()
}

#[test]
fn an_expansion_point_far_from_the_motion_is_named_and_a_better_one_proposed() {
    let folded = Written { about: 2.6, ..RIGHT };
    let found_with = |written, arm| found_for(folding(), written, arm, Settings::default()).1;
    let far = found_with(&folded, motor(2));
    let cause = cause(&far.warnings).unwrap();
    assert!(
        cause.starts_with("The robot explains the recordings, and model 1 does not"),
        "{cause}"
    );
    assert!(cause.contains("up to 2.85 rad. About 0.02,2.58, the mean"), "{cause}");
    assert!(cause.ends_with("`--expansion 0.02,2.58` expands the model there."), "{cause}");
    let mut near = motor(2);
    near.expansion_point.q = vec![0.0, 2.6];
    let near = found_with(&folded, near);
    assert!(near.cost < 0.5 * far.cost, "{} for {}", near.cost, far.cost);

    // About the robot's own motions, under torques that are 1.8 times too large.
    let wrong = Written { torque: 1.8, ..folded };
    let far = found_with(&wrong, ArmSettings { equations: Equations::Robot, ..motor(2) });
    let cause = self::cause(&far.warnings).unwrap();
    assert!(cause.starts_with("The nominal motions follow the robot, and deviations"), "{cause}");
    assert!(cause.contains("The mean of the positions is a better point."), "{cause}");
    assert!(cause.ends_with("`--expansion 0.02,2.58` expands the model there."), "{cause}");
}

#[test]
fn noise_and_own_starts_are_limited_by_the_sensors() {
    let cases = [
        (Method::Program, Noise::None, None),
        (Method::Program, Noise::Fitted, None),
        (Method::Bisection, Noise::Fitted, Some(0.1)),
    ];
    for (method, noise, until) in cases {
        let settings =
            Settings { method, noise, until, nominal: NominalStart::Own, ..Settings::default() };
        let (problem, found) = found(&RIGHT, settings);
        assert!(found.verdict.conformant);
        for (i, limit) in problem.sensor_noise().radius.iter().enumerate() {
            let (low, high) = found.sets.initial_set.bounds(i);
            assert!(high.max(-low) <= limit * (1.0 + 1e-6), "X0 {low} to {high} for {limit}");
            assert!(found.sets.noise_radius(i) <= limit * (1.0 + 1e-6));
        }
    }
}

#[test]
fn a_constant_torque_that_the_model_does_not_have_is_remarked() {
    let of = |offset: f64| {
        let settings = Settings { nominal: NominalStart::Own, ..Settings::default() };
        let by_robot = ArmSettings { equations: Equations::Robot, ..motor(JOINTS) };
        let (_, found) = found_for(arm(), &Written { offset, ..RIGHT }, by_robot, settings);
        let offsets = found.warnings.iter().find(|w| w.code == Code::InputSetOffset);
        offsets.map(|warning| (warning.place.clone().unwrap(), found.sets.input_set.centre[0]))
    };
    let (joints, centre) = of(3.0).unwrap();
    assert!(joints.contains('1') && (centre + 3.0).abs() < 0.5, "{joints:?} {centre}");
    let right = of(0.0);
    assert!(right.as_ref().is_none_or(|(joints, _)| !joints.contains('1')), "{right:?}");
}

#[test]
fn noise_as_wide_as_the_motion_is_remarked() {
    let settings = Settings { noise: Noise::Fixed(vec![1.0; 12]), ..Settings::default() };
    let (_, found) = found(&RIGHT, settings);
    let mut codes = found.warnings.iter().map(|warning| &warning.code);
    assert!(codes.any(|code| *code == Code::NoiseSetSize), "{:?}", found.warnings);
}
