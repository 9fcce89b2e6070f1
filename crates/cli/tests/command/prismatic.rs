//! A SCARA and a gantry through the commands: `robot show`, `inspect`, `identify`, `abstract`,
//! `conform`, `check` and `report`.

use std::fmt::Write;

use reachtube_ode::RungeKutta4;
use reachtube_robot::{DrivenBy, Robot, RobotField};

use crate::fixture::Lab;
use crate::output_schema::{complaints, validator};

const SCARA: &str = r#"
schema_version = 1
name = "SCARA"

[[joint]]
name = "shoulder"
dh = { a = 0.3, alpha = 0.0, theta = 0.0, d = 0.4 }
mass = 6.0
com = [-0.12, 0.0, 0.05]
inertia = [0.02, 0.0, 0.0, 0.06, 0.0, 0.07]
armature = 0.2
friction = { viscous = [3.0, 0.0, 0.0] }

[[joint]]
name = "elbow"
dh = { a = 0.25, alpha = 3.141592653589793, theta = 0.0, d = 0.0 }
mass = 4.0
com = [-0.1, 0.0, -0.03]
inertia = [0.02, 0.0, 0.0, 0.03, 0.0, 0.04]
armature = 0.1
friction = { viscous = [2.0, 0.0, 0.0] }

[[joint]]
name = "spindle"
type = "prismatic"
dh = { a = 0.0, alpha = 0.0, theta = 0.0, d = 0.05 }
mass = 1.5
inertia = [0.004, 0.0, 0.0, 0.004, 0.0, 0.0006]
armature = 2.0
position_limits = [0.0, 0.2]
velocity_limit = 1.1
friction = { viscous = [40.0, 0.0, 0.0] }
"#;

const GANTRY: &str = r#"
schema_version = 1
name = "gantry"

[[joint]]
name = "x"
type = "prismatic"
placement = {}
axis = [1.0, 0.0, 0.0]
mass = 40.0
position_limits = [-3.0, 3.0]

[[joint]]
name = "z"
type = "prismatic"
placement = {}
axis = [0.0, 0.0, 1.0]
mass = 8.0
position_limits = [-1.0, 1.0]
"#;

/// Returns a motion (q, q̇, q̈) of joint `j` (from 0) at a time \[s\].
fn motion(j: usize, t: f64, size: f64, seed: f64) -> [f64; 3] {
    let (a, w, p) = (size, 1.7 + 0.6 * j as f64 + seed, seed + j as f64);
    let slow = |k: f64| [(k * w * t + p).sin(), (k * w * t + p).cos()];
    let ([s1, c1], [s2, c2]) = (slow(1.0), slow(2.3));
    [a * s1 + 0.3 * a * s2, a * w * (c1 + 0.69 * c2), -a * w * w * (s1 + 0.3 * 2.3 * 2.3 * s2)]
}

fn header(joints: usize) -> String {
    let names = |name: &str| (1..=joints).map(|i| format!(",{name}{i}")).collect::<String>();
    format!("t{}{}{}\n", names("q"), names("qd"), names("tau"))
}

/// Reproducible numbers in [-1, 1].
struct Noise(u64);

impl Noise {
    fn step(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Returns an exciting motion with the motor torques of the robot, its viscous friction and
/// noise of up to 0.1 N m or N.
fn excited(robot: &Robot, centres: &[f64], sizes: &[f64], seed: f64) -> String {
    let n = robot.joint_count();
    let (mut text, mut noise) = (header(n), Noise(1));
    for k in 0..4000 {
        let t = 0.005 * f64::from(k);
        let state: Vec<_> = (0..n).map(|j| motion(j, t, sizes[j], seed)).collect();
        let [mut q, qd, qdd] = [0, 1, 2].map(|i| state.iter().map(|x| x[i]).collect::<Vec<_>>());
        q.iter_mut().zip(centres).for_each(|(q, centre)| *q += centre);
        let mut tau = robot.inverse_dynamics(&q, &qd, &qdd) + robot.viscous_torque(&qd);
        tau.iter_mut().for_each(|tau| *tau += 0.1 * noise.step());
        write!(text, "{t:.3}").unwrap();
        q.iter().chain(&qd).chain(tau.iter()).for_each(|x| write!(text, ",{x:.10}").unwrap());
        text.push('\n');
    }
    text
}

/// Returns a simulated run under a motor torque with a disturbance of `deviation` (-1, 0, 1) of
/// 0.2 N m for the revolute joints and 2 N for the slide, and a start that deviates with it.
fn disturbed(robot: &Robot, amplitude: f64, deviation: f64) -> String {
    let (n, step) = (robot.joint_count(), 0.01);
    let torque = |k: u32, j: usize| {
        amplitude * [6.0, 4.0, 30.0][j] * (0.05 * f64::from(k) + j as f64).sin()
            + robot.gravity_torque(&[0.0, 0.0, 0.1])[j]
    };
    let radius = [0.2, 0.2, 2.0];
    let applied: Vec<Vec<f64>> =
        (0..60).map(|k| (0..n).map(|j| torque(k, j) + deviation * radius[j]).collect()).collect();
    let start: Vec<f64> = [0.1, -0.2, 0.1].iter().map(|q| q + 0.001 * deviation).collect();
    let (mut field, mut method) = (RobotField::new(robot, DrivenBy::Motor), RungeKutta4::new(6));
    let mut x = [start, vec![0.0; 3]].concat();
    let mut text = header(n);
    for k in 0..=60 {
        write!(text, "{:.3}", step * f64::from(k)).unwrap();
        x.iter().for_each(|x| write!(text, ",{x:?}").unwrap());
        (0..n).for_each(|j| write!(text, ",{:?}", torque(k, j)).unwrap());
        text.push('\n');
        if let Some(torques) = applied.get(k as usize) {
            method.integrate(&mut field, [0.0, step], 8, &mut x, torques);
        }
    }
    text
}

/// Returns a folder with the SCARA and two suites of three disturbed runs.
fn scara_lab() -> Lab {
    let lab = Lab::new();
    lab.write("scara.toml", SCARA);
    let robot = Robot::from_toml(SCARA, "scara.toml").unwrap();
    std::fs::create_dir(lab.path("runs")).unwrap();
    let mut index = String::from("file,suite,motion\n");
    for (suite, amplitude) in [("A", 1.0), ("B", -0.7)] {
        for run in 1..=3 {
            let name = format!("{suite}_{run}.csv");
            lab.write(&format!("runs/{name}"), disturbed(&robot, amplitude, f64::from(run) - 2.0));
            writeln!(index, "{name},{suite},{suite}").unwrap();
        }
    }
    lab.write("runs/runs.csv", index);
    lab
}

#[track_caller]
fn contains(text: &str, parts: &[&str]) {
    parts.iter().for_each(|part| assert!(text.contains(part), "{part:?} is not in\n{text}"));
}

#[track_caller]
fn fits_the_schema(file: &str, of: &str) {
    let found = complaints(&validator(of), &serde_json::from_str(file).unwrap());
    assert_eq!(found, Vec::<String>::new());
}

#[test]
fn a_scara_is_shown_and_inspected_in_its_own_units() {
    let lab = scara_lab();
    let text = lab.run("robot show scara.toml --expansion 0,0.5,0.1").exits(0).stdout;
    contains(
        &text,
        &[
            "SCARA: 2 revolute joints and 1 prismatic joint, gravity",
            "[-3.142, 3.142] rad",
            "[0.000, 0.200] m",
            "1.1 m/s",
            "2.00000 kg",
            "0.20000 kg m^2",
            "prismatic, a 0 alpha 0.0000",
            "M(q_a) with motors [kg m^2, kg m, kg], q_a = [0.0, 0.5, 0.1] (rad, rad, m):",
            "g(q_a) [N m, N m, N]:",
            "no joint has less than 2.300e-1 kg m^2 or kg",
        ],
    );
    let text = lab.run("inspect --data runs --robot scara.toml").exits(0).stdout;
    contains(&text, &["] rad ", "] m ", " m/s ", " N ", " N m "]);
    assert!(!text.contains("q [rad]"), "{text}");
    lab.run("inspect --data data --robot scara.toml")
        .fails_with(&["robot scara.toml has 3 joints, but the recordings have 2"]);
    let gantry = lab.run("robot show scara.toml --lock shoulder=0.3 --lock elbow=-0.2").exits(0);
    contains(
        &gantry.stdout,
        &["SCARA: 1 prismatic joint", "locked: shoulder = 0.3 rad, elbow = -0.2 rad", "g(q_a) [N]"],
    );
}

#[test]
fn a_scara_conforms() {
    let lab = scara_lab();
    let run = lab
        .run(
            "conform --robot scara.toml --data runs --torque motor --expansion 0.1,-0.2,0.1 \
             --out scara.json --report report --verbose",
        )
        .exits(0);
    contains(&run.stdout, &["conformant: 6 recordings", "] rad ", "] m ", "] m/s ", "] N\n"]);
    fits_the_schema(&lab.read("scara.json"), "model");
    let check = "check --model scara.json --data runs --torque motor";
    contains(&lab.run(check).exits(0).stdout, &["conformant: 6 recordings"]);
    // A value beyond the set is named with the unit of its joint.
    lab.edit("runs/A_1.csv", |lines| crate::fixture::set_cell(&mut lines[20], 3, "0.19"));
    let outside = lab.run(&format!("{check} --verbose")).exits(1);
    contains(&outside.stdout, &["joint 3, q3 is 0.0", " m beyond the upper bound"]);
    let page = lab.read("report/report.html");
    contains(&page, &["spindle [m, m/s]", "shoulder [rad, rad/s]", "] N<", "] m<"]);
}

#[test]
fn a_nonlinear_model_of_a_scara_conforms() {
    let lab = scara_lab();
    let made = lab
        .run(
            "abstract --robot scara.toml --paper-model 2 --order 4 --expansion 0.1,-0.2,0.1 \
             --out two.json",
        )
        .exits(0);
    contains(
        &made.stdout,
        &["expanded about q = [0.1, -0.2, 0.1] (rad, rad, m), qd = 0 (rad/s, rad/s, m/s), \
             u = 0 (N m, N m, N)"],
    );
    fits_the_schema(&lab.read("two.json"), "abstraction");
    let run = lab
        .run("conform --abstraction two.json --data runs --torque motor --out scara.json -v")
        .exits(0);
    contains(&run.stdout, &["conformant: 6 recordings", "[-0.00101, 0.00101] m "]);
    fits_the_schema(&lab.read("scara.json"), "model");
    lab.run("check --model scara.json --data runs --torque motor").exits(0);
    let both = lab
        .run("conform --abstraction two.json --lock elbow=0 --data runs --torque motor")
        .exits(2);
    contains(&both.stderr, &["cannot be used with '--lock"]);
}

/// Recordings in mm beside m/s, and far beyond the limits.
#[test]
fn other_units_of_a_slide_are_found() {
    let lab = scara_lab();
    let scaled = |text: String, factor: f64| {
        let line = |line: &str| {
            let mut line = line.to_string();
            let value = crate::fixture::cell(&line, 3);
            crate::fixture::set_cell(&mut line, 3, &format!("{}", factor * value));
            line
        };
        let mut lines: Vec<String> = text.lines().map(String::from).collect();
        lines[1..].iter_mut().for_each(|text| *text = line(text));
        lines.join("\n")
    };
    lab.write("runs/A_2.csv", scaled(lab.read("runs/A_2.csv"), 1000.0));
    lab.run("conform --robot scara.toml --data runs --torque motor").fails_with(&[
        "A_2.csv: joint 3: q moves",
        "q looks like mm and qd like m/s; give q in m and qd in m/s",
        "the joint's limits are 0 and 0.2 m",
    ]);
}

#[test]
fn a_gantry_and_a_scara_are_identified() {
    let lab = Lab::new();
    let cases = [
        ("gantry", GANTRY, vec![0.0, 0.0], vec![0.5, 0.2], vec![40.0 + 8.0, 8.0]),
        ("scara", SCARA, vec![0.0, 0.3, 0.1], vec![0.6, 0.7, 0.05], Vec::new()),
    ];
    for (name, toml, centres, sizes, diagonal) in cases {
        let truth = Robot::from_toml(toml, name).unwrap();
        for (file, seed) in [("a", 0.1), ("b", 0.4), ("c", 0.7)] {
            lab.write(&format!("{file}.csv"), excited(&truth, &centres, &sizes, seed));
        }
        // The description that identification starts from has other masses.
        let start = toml.replace("mass = 8.0", "mass = 5.0").replace("mass = 4.0", "mass = 2.0");
        lab.write("start.toml", start.replace("mass = 1.5", "mass = 1.0"));
        let run = lab.run(
            "identify --robot start.toml --excitation a.csv b.csv --validate c.csv --cut-off 15 \
             --out found.toml --report report",
        );
        let run = run.exits(0);
        if name == "gantry" {
            contains(
                &run.stdout,
                &["torque, rms [N]", "position error at the end [m]", "velocity error [m/s]"],
            );
        } else {
            contains(&run.stdout, &[" N m ", " N ", " m ", " rad ", " rad/s\n", " m/s\n"]);
        }
        let found = Robot::load(&lab.path("found.toml").display().to_string()).unwrap();
        let q: Vec<f64> = centres.iter().map(|q| q + 0.05).collect();
        let (mass, expected) = (found.mass_matrix(&q), truth.mass_matrix(&q));
        let scale = expected.diagonal();
        for (i, j) in (0..q.len()).flat_map(|i| (0..q.len()).map(move |j| (i, j))) {
            let error = (mass[(i, j)] - expected[(i, j)]).abs();
            assert!(error < 0.01 * (scale[i] * scale[j]).sqrt(), "{name}: {mass} {expected}");
        }
        // The weight of a vertical slide looks like a constant force: their sum counts.
        let (qd, qdd) = (vec![0.1; q.len()], vec![0.3; q.len()]);
        let total = |robot: &Robot| {
            robot.inverse_dynamics(&q, &qd, &qdd)
                + robot.viscous_torque(&qd)
                + robot.coulomb_torque(&q, &qd)
        };
        let error = total(&found) - total(&truth);
        assert!(error.amax() < 0.01 * total(&truth).amax(), "{name}: {error}");
        diagonal.iter().enumerate().for_each(|(i, m)| {
            assert!((mass[(i, i)] - m).abs() < 0.01 * m, "{name}: {mass}");
        });
        contains(&lab.read("report/identify.html"), &["torque [N]"]);
    }
}
