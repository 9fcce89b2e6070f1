//! Identification from the command line, on a pendulum with a motor whose torque is known in closed
//! form.

use std::fmt::Write;

use crate::fixture::Lab;

/// A pendulum about a horizontal axis: (m l² + J) q̈ + v q̇ + f sign(q̇) + m g l sin q.
const PENDULUM: &str = r#"schema_version = 1
name = "pendulum"

[[joint]]
name = "hinge"
placement = { translation = [0.0, 0.0, 1.0] }
axis = [0.0, 1.0, 0.0]
mass = 1.0
com = [0.0, 0.0, -0.3]
inertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.01]
"#;

fn motion(t: f64, seed: f64) -> [f64; 3] {
    let waves = [(0.6, 1.1 + seed, 0.0), (0.3, 2.3, seed), (0.1, 4.1 - seed, 1.0)];
    let sum = |part: &dyn Fn(&(f64, f64, f64)) -> f64| waves.iter().map(part).sum();
    [
        sum(&|(a, w, p)| a * (w * t + p).sin()),
        sum(&|(a, w, p)| a * w * (w * t + p).cos()),
        sum(&|(a, w, p)| -a * w * w * (w * t + p).sin()),
    ]
}

fn recording(seed: f64) -> String {
    let mut text = String::from("t,q1,qd1,tau1\n");
    for k in 0..4000 {
        let t = 0.005 * k as f64;
        let [q, qd, qdd] = motion(t, seed);
        // 2 kg at 0.4 m, total inertia 0.5 kg m², friction 1 N m and 0.8 N m s/rad.
        let tau = 0.5 * qdd + 0.8 * qd + qd.signum() + 2.0 * 9.81 * 0.4 * q.sin();
        writeln!(text, "{t:.3},{q:.9},{qd:.9},{tau:.9}").unwrap();
    }
    text
}

pub(crate) fn lab() -> Lab {
    let lab = Lab::new();
    lab.write("pendulum.toml", PENDULUM);
    for (name, seed) in [("a", 0.1), ("b", 0.4), ("c", 0.7)] {
        lab.write(&format!("{name}.csv"), recording(seed));
    }
    lab
}

#[test]
fn a_pendulum_is_found_and_its_file_is_a_robot() {
    let lab = lab();
    let run = lab
        .run(
            "identify --robot pendulum.toml --excitation a.csv b.csv --validate c.csv --cut-off 15 \
             --out found.toml --report report --json",
        )
        .exits(0)
        .notes("wrote found.toml")
        .notes("were filtered forward and backward");
    let found = run.json();
    crate::output_schema::fits("identify", &found);
    assert_eq!(found["held_out"], true);
    // The low-pass filter smooths the steps of Coulomb friction where the joint reverses: 1 % of
    // the torque.
    assert!(found["validation"][0]["joints"][0]["relative"].as_f64().unwrap() < 0.02, "{found}");
    let viscous = found["robot"]["joint"][0]["friction"]["viscous"][0].as_f64().unwrap();
    assert!((viscous - 0.8).abs() < 1e-3, "{viscous}");
    let moment =
        found["parameters"].as_array().unwrap().iter().find(|p| p["name"] == "mz1").unwrap();
    assert!((moment["value"].as_f64().unwrap() + 0.8).abs() < 1e-3, "{moment}");
    let html = lab.read("report/identify.html");
    assert!(html.contains("pendulum: identified") && html.contains("id=\"the-robot\""));
    // Two views of the robot, torque and residual, and the parameters of three units.
    assert_eq!(html.matches("<svg").count(), 2 + 2 + 2);
    lab.run("robot show found.toml").exits(0);
}

/// The same pendulum as URDF, with a mesh that identification must leave unchanged.
const URDF: &str = r#"<robot name="pendulum">
  <link name="base"/>
  <joint name="hinge" type="revolute">
    <parent link="base"/>
    <child link="arm"/>
    <origin xyz="0 0 1"/>
    <axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" velocity="5" effort="50"/>
  </joint>
  <link name="arm">
    <inertial>
      <origin xyz="0 0 -0.3"/>
      <mass value="1"/>
      <inertia ixx="0.02" iyy="0.02" izz="0.01" ixy="0" ixz="0" iyz="0"/>
    </inertial>
    <visual><geometry><mesh filename="arm.stl"/></geometry></visual>
  </link>
</robot>
"#;

#[test]
fn a_urdf_gets_the_identified_values_and_keeps_the_rest() {
    let lab = lab();
    lab.write("arm.urdf", URDF);
    let job = "identify --robot arm.urdf --excitation a.csv b.csv --cut-off 15";
    lab.run(&format!("{job} --out found.toml --urdf new.urdf")).exits(0).notes("wrote new.urdf");
    assert!(
        lab.read("new.urdf")
            .contains(r#"<visual><geometry><mesh filename="arm.stl"/></geometry></visual>"#)
    );
    let shown = |robot: &str| {
        lab.run(&format!("robot show {robot} --expansion 0.5 --json")).exits(0).json()
    };
    let (new, found) = (shown("new.urdf"), shown("found.toml"));
    for part in ["mass_matrix", "gravity_torque"] {
        let value = |of: &serde_json::Value| {
            of[part].to_string().trim_matches(['[', ']']).parse::<f64>().unwrap()
        };
        assert!((value(&new) - value(&found)).abs() < 1e-9, "{part}: {new} {found}");
    }
    let gravity = new["gravity_torque"][0].as_f64().unwrap();
    assert!((gravity - 2.0 * 9.81 * 0.4 * 0.5f64.sin()).abs() < 0.01, "{gravity}");
    // The companion of new.urdf, with motor and friction, would overwrite the robot file.
    lab.run(&format!("{job} --out new.toml --urdf new.urdf"))
        .fails_with(&["--out new.toml", "another name"]);
    lab.run("identify --robot pendulum.toml --excitation a.csv --urdf new.urdf")
        .fails_with(&["pendulum.toml is not a URDF file"]);
}

#[test]
fn a_settings_file_holds_every_option_and_its_mistakes_are_reported() {
    let lab = lab();
    let settings = r#"robot = "pendulum.toml"
excitation = ["a.csv", { path = "b.csv", from = 2.0 }]
validate = ["c.csv"]
[prepare]
cut_off = 8.0
"#;
    lab.write("job.toml", settings);
    let words = lab.run("identify --settings job.toml").exits(0).stdout;
    for part in
        ["Inertial parameters:", "combinations determined: ", "recordings: held out", "Simulated"]
    {
        assert!(words.contains(part), "{part} is not in\n{words}");
    }
    lab.write("job.toml", settings.replace("cut_off", "cutoff"));
    lab.run("identify --settings job.toml").fails_with(&["job.toml", "line 5", "cutoff"]);
    lab.run("identify --robot pendulum.toml").fails_with(&["--excitation"]);
    lab.run("identify --excitation a.csv").fails_with(&["--robot"]);
    lab.run("identify --robot pendulum.toml --excitation nowhere.csv")
        .fails_with(&["nowhere.csv", "give a log"]);
    lab.run("identify --robot pendulum.toml --excitation a.csv --gains 1,2")
        .fails_with(&["gains: 2 given", "each of the 1 joints"]);
}

#[test]
fn recordings_that_cannot_serve_their_purpose_are_named() {
    let lab = lab();
    let job = "identify --robot pendulum.toml --cut-off 15 --excitation b.csv";
    lab.write("copy.csv", lab.read("b.csv"));
    lab.run(&format!("{job} --validate copy.csv")).fails_with(&[
        "copy.csv",
        "not held out",
        "b.csv, which has the same content",
    ]);
    // A rest predicts no torque.
    let rest: String = (0..800).map(|k| format!("{:.3},0.4,0,3.1\n", 0.005 * k as f64)).collect();
    lab.write("rest.csv", format!("t,q1,qd1,tau1\n{rest}"));
    let run = lab.run(&format!("{job} --validate rest.csv c.csv")).exits(0);
    assert!(run.stderr.contains("no joint moves in the validation recordings rest:"), "{run:?}");
    assert!(run.stdout.contains("  rest        at rest"), "{}", run.stdout);
    // The remedy of a gap is an option of this command.
    let with_gap: Vec<String> = lab.read("a.csv").lines().map(String::from).collect();
    let with_gap = [&with_gap[..2000], &with_gap[2010..]].concat().join("\n");
    lab.write("gap.csv", with_gap + "\n");
    lab.run(&format!("{job} gap.csv")).fails_with(&["gap.csv:2001", "--max-gap SECONDS"]);
    lab.run(&format!("{job} gap.csv --max-gap 0.1")).exits(0);
    lab.write(
        "job.toml",
        "robot = \"pendulum.toml\"\nexcitation = [\"a.csv\"]\n[model]\nseparate_gravity = true\n",
    );
    lab.run("identify --settings job.toml").fails_with(&["separate_gravity", "--rest"]);
}

#[test]
fn windows_of_recordings_are_suites_and_motions_are_designed() {
    let lab = lab();
    lab.run("prepare --robot pendulum.toml --data a.csv b.csv --window 2 --out windows")
        .exits(0)
        .notes("to windows");
    let inspected = lab.run("inspect --data windows").exits(0).stdout;
    assert!(inspected.contains("a_w01"), "{inspected}");
    lab.run("excite --robot pendulum.toml --period 4 --harmonics 2 --out motion.csv")
        .exits(0)
        .notes("wrote motion.csv");
    let motion = lab.read("motion.csv");
    assert!(motion.starts_with("t,q1,qd1,qdd1\n") && motion.lines().count() == 402);
}

#[test]
fn windows_free_of_friction_have_smaller_sets() {
    let lab = lab();
    lab.run(
        "identify --robot pendulum.toml --excitation a.csv b.csv --cut-off 15 --out found.toml",
    )
    .exits(0);
    let prepare = "prepare --robot found.toml --data a.csv b.csv --window 0.5 --cut-off 5";
    lab.run(&format!("{prepare} --out recorded")).exits(0);
    lab.run(&format!("{prepare} --compensate --out free"))
        .exits(0)
        .notes("gravity and dry friction of pendulum")
        .notes("--torque compensated");
    lab.run(&format!("{} --compensate --out light", prepare.replace("found", "pendulum")))
        .exits(0)
        .notes("there is no dry friction in its description");
    lab.write(
        "massless.toml",
        PENDULUM.replace("mass = 1.0\n", "").replace("inertia", "# inertia"),
    );
    lab.run(&format!("{} --compensate --out none", prepare.replace("found", "massless")))
        .fails_with(&["robot `pendulum`", "must be positive"]);
    let cost = |of: &str| {
        let job = "conform --robot found.toml --nominal own --noise fitted --json";
        lab.run(&format!("{job} {of}")).exits(0).json()["cost"].as_f64().unwrap()
    };
    let recorded = cost("--data recorded --torque motor");
    let free = cost("--data free --torque compensated");
    let nonlinear = cost("--data free --torque compensated --equations robot");
    // The inertia of a pendulum is the same everywhere; its viscous friction is linear.
    assert!(free < 0.5 * recorded, "{free} {recorded}");
    assert!((nonlinear / free - 1.0).abs() < 0.01, "{nonlinear} {free}");
    // The model file and the page say whose equations count.
    let job = "conform --robot found.toml --nominal own --data free --torque compensated";
    let run = lab.run(&format!("{job} --equations robot --out robot.json --report page -v"));
    let run = run.exits(0);
    assert!(run.stdout.contains("motions, by the robot's own equations:"), "{}", run.stdout);
    assert!(lab.read("page/report.html").contains("about nominal motions by the robot"));
    lab.run("check --model robot.json --data free --torque compensated").exits(0);
}
