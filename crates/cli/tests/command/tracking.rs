//! Models of an arm under its controller, from logs of commanded and actual positions.

use crate::fixture::{Lab, Run};
use crate::monitor::fed;
use crate::output_schema::fits;
use crate::servo::log;

const MODEL: &str = "model --data logs --out arm";

/// Writes logs of the servo with the plans 1 to `count` into a folder, with errors times `factor`.
fn write_logs(lab: &Lab, folder: &str, count: u64, factor: f64) {
    std::fs::create_dir_all(lab.path(folder)).unwrap();
    for number in 1..=count {
        let log = log(number);
        let mut text = String::from("timestamp,target_q_0,target_q_1,actual_q_0,actual_q_1\n");
        for (k, time) in log.times.iter().enumerate() {
            let [r, y] = [log.command[k], log.actual[k]];
            let actual = [0, 1].map(|joint| r[joint] + factor * (y[joint] - r[joint]));
            text += &format!("{time},{},{},{},{}\n", r[0], r[1], actual[0], actual[1]);
        }
        lab.write(&format!("{folder}/motion_{number}.csv"), text);
    }
}

fn lab(count: u64) -> Lab {
    let lab = Lab::new();
    write_logs(&lab, "logs", count, 1.0);
    lab
}

fn words(run: &Run) -> String {
    run.stdout.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_model_of_good_logs_is_useful() {
    let lab = lab(6);
    let run = lab.run(MODEL).exits(0);
    let said = words(&run);
    assert!(run.stdout.starts_with("conformant and useful: "), "{}", run.stdout);
    for part in ["joint late by half-width", "joint_0 9.", "joint_1 14 ms", "new motions: "] {
        assert!(said.contains(part), "{part} is not in\n{}", run.stdout);
    }
    assert!(said.contains("wrote: arm/model.json"), "{}", run.stdout);
    assert!(said.contains("`reachtube check --model arm/model.json"), "{}", run.stdout);
    assert!(run.stdout.lines().count() <= 18, "{}", run.stdout);
    let text = lab.read("arm/model.json");
    let answer = lab.run(&format!("{MODEL} --json")).exits(0).json();
    fits("model_tracking", &answer);
    assert_eq!((&answer["useful"], &answer["findings"]), (&true.into(), &serde_json::json!([])));
    let number = |name: &str| answer[name].as_f64().unwrap();
    assert!(number("mean_half_width") < number("mean_largest_error"), "{answer}");
    let late = answer["model"]["joints"][1]["speed"].as_f64().unwrap();
    assert!((late + 14e-3).abs() < 1e-4, "{late}");
    // The same logs give the same file, which is the model that was printed.
    assert_eq!(lab.read("arm/model.json"), text);
    assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), answer["model"]);
}

#[test]
fn a_check_holds_the_same_logs_and_names_what_leaves() {
    let lab = lab(6);
    lab.run(MODEL).exits(0);
    let check = |folder: &str| format!("check --model arm/model.json --data {folder}");
    let run = lab.run(&check("logs")).exits(0);
    assert!(run.stdout.starts_with("conformant: 0 of 7200 positions"), "{}", run.stdout);
    let answer = lab.run(&format!("{} --json", check("logs"))).exits(0).json();
    fits("check_tracking", &answer);
    assert_eq!((&answer["conformant"], &answer["outside"]), (&true.into(), &0.into()));
    // The errors of one log are five times as large.
    write_logs(&lab, "far", 1, 5.0);
    let run = lab.run(&check("far")).exits(1);
    assert!(run.stdout.starts_with("not conformant: "), "{}", run.stdout);
    let answer = lab.run(&format!("{} --json", check("far"))).exits(1).json();
    fits("check_tracking", &answer);
    let motion = &answer["motions"][0];
    assert_eq!((&answer["conformant"], &motion["name"]), (&false.into(), &"motion_1".into()));
    let joint = motion["joint"].as_str().unwrap();
    let own = answer["joints"].as_array().unwrap().iter().find(|of| of["name"] == joint).unwrap();
    assert!(own["outside"].as_u64().unwrap() > 0 && own["needed"] == motion["needed"], "{answer}");
    assert!(motion["needed"].as_f64().unwrap() > 2.0, "{motion}");
    let said = words(&run);
    let row = said.split("at motion_1 ").nth(1).unwrap();
    let time = format!("{:.3} s", motion["time"].as_f64().unwrap());
    assert!(row.contains(&format!(" times {joint} {time}")), "{}", run.stdout);
}

#[test]
fn fewer_than_3_motions_are_vacuous() {
    let lab = lab(2);
    let run = lab.run(MODEL).exits(3);
    let said = words(&run);
    assert!(said.contains("describes these recordings only"), "{}", run.stdout);
    assert!(said.contains("With fewer than 3 motions"), "{}", run.stdout);
    let answer = lab.run(&format!("{MODEL} --json")).exits(3).json();
    fits("model_tracking", &answer);
    assert_eq!(answer["findings"][0]["code"], "few-motions");
    lab.run("check --model arm/model.json --data logs").exits(3);
}

#[test]
fn logs_that_are_no_measurement_are_refused() {
    let lab = lab(2);
    lab.edit("logs/motion_2.csv", |lines| {
        for k in (2..lines.len()).rev() {
            let before: Vec<String> = lines[k - 1].split(',').map(String::from).collect();
            let own: Vec<&str> = lines[k].split(',').collect();
            lines[k] = [own[0], own[1], own[2], &before[1], &before[2]].join(",");
        }
    });
    lab.run(MODEL).fails_with_last(&["logs/motion_2.csv", "1 sample before", "no measurement"]);
    assert!(!lab.path("arm/model.json").exists());
}

#[test]
fn logs_without_a_command_are_refused_with_a_remedy() {
    let lab = lab(1);
    lab.edit("logs/motion_1.csv", |lines| lines[0] = "timestamp,a,b,actual_q_0,actual_q_1".into());
    lab.run(MODEL).fails_with_last(&[
        "logs/motion_1.csv",
        "no column is a commanded position",
        "log the commanded positions too, such as target_q_0",
    ]);
    let run = lab.run(&format!("{MODEL} --json")).exits(2);
    fits("error", &serde_json::from_str(run.stderr.lines().last().unwrap()).unwrap());
    // The columns are named by the option that the remedy gives.
    lab.edit("logs/motion_1.csv", |lines| lines[0] = "timestamp,a1,a2,b1,b2".into());
    let named = lab.run(&format!("{MODEL} --columns r=a{{}},q=b{{}}")).exits(3);
    assert!(words(&named).contains("describes these recordings only"), "{named:?}");
    // A check reads the columns that the model names.
    let check = lab.run("check --model arm/model.json --data logs").exits(3);
    assert!(check.stdout.starts_with("conformant: 0 of 1200 positions"), "{check:?}");
}

#[test]
fn options_of_torques_need_torques() {
    let lab = lab(3);
    for option in ["--fit viscous", "--horizon 0.3", "--held-out motion_1", "--gains 1,1"] {
        lab.run(&format!("{MODEL} {option}")).fails_with(&["--torque"]);
    }
    assert!(!lab.path("arm").exists());
    lab.run(MODEL).exits(0);
    for option in ["--torque motor", "--suites A", "--notion hull", "--max-gap 1"] {
        let check = format!("check --model arm/model.json --data logs {option}");
        lab.run(&check).fails_with(&["under its controller", "leave --torque"]);
    }
}

#[test]
fn a_model_of_others_is_overwritten_with_force_only() {
    let lab = lab(3);
    std::fs::create_dir(lab.path("arm")).unwrap();
    lab.write("arm/model.json", "mine\n");
    lab.run(MODEL).fails_with(&["arm/model.json: a file of this name exists"]);
    assert_eq!(lab.read("arm/model.json"), "mine\n");
    lab.run(&format!("{MODEL} --force")).exits(0);
    assert!(lab.read("arm/model.json").contains("reachtube-tracking-model"));
    // An own file is replaced.
    lab.run(MODEL).exits(0);
}

#[test]
fn a_changed_model_is_refused() {
    let lab = lab(3);
    lab.run(MODEL).exits(0);
    let mut model: serde_json::Value = serde_json::from_str(&lab.read("arm/model.json")).unwrap();
    model["joints"][0]["radius"] = 1.0.into();
    lab.write("arm/model.json", model.to_string());
    let check = "check --model arm/model.json --data logs";
    lab.run(check).fails_with(&["arm/model.json", "was changed after it was written"]);
}

/// An arm of two links of 0.5 m that turns in a plane, as a URDF with collision shapes.
const ARM: &str = r#"<robot name="two"><link name="base"/>
<link name="upper"><inertial><origin xyz="0.25 0 0"/><mass value="2"/>
  <inertia ixx="0.01" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><origin xyz="0.25 0 0" rpy="0 1.5707963 0"/>
  <geometry><cylinder length="0.5" radius="0.04"/></geometry></collision></link>
<link name="fore"><inertial><origin xyz="0.25 0 0"/><mass value="2"/>
  <inertia ixx="0.01" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><origin xyz="0.25 0 0" rpy="0 1.5707963 0"/>
  <geometry><cylinder length="0.5" radius="0.03"/></geometry></collision></link>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/>
  <axis xyz="0 0 1"/></joint>
<joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/>
  <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></joint></robot>"#;

/// Makes a model of the arm, and writes the command of the first log as a plan.
fn planned() -> Lab {
    let lab = lab(8);
    lab.write("arm.urdf", ARM);
    lab.run(&format!("{MODEL} --robot arm.urdf")).exits(0);
    let log = log(1);
    let row = |(time, [a, b]): (&f64, &[f64; 2])| format!("{time},{a},{b}\n");
    let rows: String = log.times.iter().zip(&log.command).map(row).collect();
    lab.write("plan.csv", format!("time,shoulder_pos,elbow_pos\n{rows}"));
    lab
}

#[test]
fn a_plan_has_a_tube_in_radians_and_millimetres() {
    let lab = planned();
    let reach = "reach --model arm/model.json --plan plan.csv --out reach";
    let run = lab.run(&format!("{reach} --robot arm.urdf")).exits(0);
    for part in [
        "plan: 600 samples, 5.990 s",
        "shoulder ",
        "elbow ",
        " mrad ",
        " mm ",
        "reach/plan_tube.csv",
    ] {
        assert!(run.stdout.contains(part), "{part} is not in\n{}", run.stdout);
    }
    let answer = lab.run(&format!("{reach} --robot arm.urdf --json")).exits(0).json();
    fits("reach_plan", &answer);
    let number = |kind: &str, at: usize| answer["plans"][0][kind][at]["distance"].as_f64().unwrap();
    // The forearm's end is 0.5 m from the elbow and at most 1 m from the shoulder.
    let joints = [number("joints", 0), number("joints", 1)];
    assert!(number("links", 1) <= joints[0] + 0.5 * joints[1] + 1e-3, "{answer}");
    assert!(number("links", 1) > 0.3 * joints[1] && joints[1] > 5e-3, "{answer}");
    assert_eq!(lab.read("reach/plan.csv").lines().count(), 601);
    assert_eq!(lab.read("reach/plan_tube.csv").lines().count(), 600);
    // The header may be the joints' names alone, and a long step is noted.
    let text = lab.read("plan.csv").replacen("shoulder_pos,elbow_pos", "shoulder,elbow", 1);
    lab.write("plain.csv", &text);
    let plain = lab.run("reach --model arm/model.json --plan plain.csv --out plain").exits(0);
    assert!(plain.stdout.contains("plain: 600 samples"), "{}", plain.stdout);
    let few = text.lines().enumerate().filter(|(at, _)| !(300..320).contains(at));
    let few: String = few.map(|(_, line)| format!("{line}\n")).collect();
    lab.write("few.csv", few);
    let run = lab.run("reach --model arm/model.json --plan few.csv --out few").exits(0);
    run.notes("few.csv: the step of 0.21 s at 2.980 s is 21 times as long");
    // A log is a plan too, and without a robot there are no millimetres.
    let run = lab.run("reach --model arm/model.json --data logs --out all").exits(0);
    assert!(run.stdout.contains("motion_8: ") && !run.stdout.contains(" mm "), "{}", run.stdout);
}

#[test]
fn a_plan_stays_clear_of_what_it_does_not_reach() {
    let lab = planned();
    let scenario = |x: f64, more: &str| {
        let text = format!(
            "model = \"arm/model.json\"\nplan = \"plan.csv\"\nrobot = \"arm.urdf\"\n{more}\n\
             [[obstacle]]\nname = \"wall\"\nhalf-space = {{ normal = [-1, 0, 0], offset = {} }}\n",
            -x
        );
        lab.write("cell.toml", text);
    };
    scenario(1.1, "");
    let run = lab.run("verify cell.toml --out cell").exits(0);
    assert!(run.stdout.starts_with("safe: "), "{}", run.stdout);
    assert!(run.stdout.contains("up to 5.990 s each link stays clear"), "{}", run.stdout);
    let answer = lab.run("verify cell.toml --out cell --json").exits(0).json();
    fits("verify", &answer);
    let distance = answer["motions"][0]["clearances"][0]["distance"].as_f64().unwrap();
    assert!(lab.read("cell/verify.html").contains("All motions"));
    // The wall is moved beyond what was proved, by less and by more than the sets.
    let nearest = 1.1 - distance;
    scenario(nearest - 2e-3, "");
    let run = lab.run("verify cell.toml --out near").exits(1);
    assert!(
        run.stdout.contains("overlaps `wall`") || run.stdout.contains("m from `wall`"),
        "{}",
        run.stdout
    );
    assert!(lab.read("near/plan_closest.csv").starts_with("t,q1,q2,qd1,qd2\n0,"));
    scenario(nearest - 0.2, "");
    let run = lab.run("verify cell.toml --out far").exits(1);
    assert!(
        run.stdout.contains("without any uncertainty no distance is proved either"),
        "{}",
        run.stdout
    );
    scenario(1.1, "[stop]\nbrakes = \"brakes.toml\"\n");
    lab.run("verify cell.toml --out cell").fails_with_last(&["cell.toml:", "[stop]", "leave"]);
}

#[test]
fn plans_that_the_model_is_not_for_are_refused() {
    let lab = planned();
    let text = lab.read("plan.csv");
    let fast: String = text
        .lines()
        .enumerate()
        .map(|(at, line)| match line.split_once(',') {
            Some((time, rest)) if at > 0 => {
                format!("{},{rest}\n", time.parse::<f64>().unwrap() / 3.0)
            }
            _ => format!("{line}\n"),
        })
        .collect();
    lab.write("fast.csv", fast);
    let reach = "reach --model arm/model.json --out reach";
    lab.run(&format!("{reach} --plan fast.csv")).fails_with_last(&[
        "fast.csv",
        "was made of commands up to",
        "% of its speed",
    ]);
    lab.run(&format!("{reach} --plan none.csv")).fails_with_last(&["none.csv"]);
    lab.write("short.csv", "time,shoulder_pos,elbow_pos\n0,0,0\n0.01,0,0\n");
    lab.run(&format!("{reach} --plan short.csv")).fails_with_last(&["short.csv", "3 at least"]);
    lab.write("nan.csv", text.replacen("0.02,", "0.02,nan,", 1));
    lab.run(&format!("{reach} --plan nan.csv")).fails_with_last(&["nan.csv"]);
    lab.write("other.csv", text.replace("shoulder", "wrist"));
    lab.run(&format!("{reach} --plan other.csv")).fails_with_last(&["other.csv", "shoulder"]);
    lab.write("other.urdf", ARM.replace("\"shoulder\"", "\"wrist\""));
    lab.run(&format!("{reach} --plan plan.csv --robot other.urdf")).fails_with_last(&[
        "other.urdf",
        "wrist",
        "--robot",
    ]);
    let ball = "[[obstacle]]\nname = \"b\"\nsphere = { centre = [3, 0, 0], radius = 1 }\n";
    lab.write("cell.toml", format!("model = \"arm/model.json\"\nplan = \"plan.csv\"\n{ball}"));
    lab.run("verify cell.toml --out cell").fails_with_last(&["cell.toml", "no `robot`"]);
    lab.edit("cell.toml", |lines| lines[1] = "data = \"logs\"".into());
    lab.run("verify cell.toml --out cell").fails_with_last(&["cell.toml", "no `plan`"]);
}

#[test]
fn links_are_padded_for_a_planner_and_for_the_shield() {
    let lab = planned();
    let export = "export --model arm/model.json --to moveit --robot arm.urdf --out padding";
    let run = lab.run(export).exits(0);
    let file = lab.read("padding/moveit_padding.yaml");
    assert!(run.stdout.contains("fore ") && run.stdout.contains("from its path"), "{}", run.stdout);
    let number = |text: &str, key: &str| -> f64 {
        let line = text.lines().find(|line| line.trim_start().starts_with(key)).unwrap();
        line.split(':').nth(1).unwrap().split('#').next().unwrap().trim().parse().unwrap()
    };
    assert_eq!(number(&file, "default_robot_padding"), number(&file, "fore"));
    assert!(number(&file, "upper") < number(&file, "fore"), "{file}");
    let answer = lab.run(&format!("{export} --speed 0.25 --json")).exits(0).json();
    fits("export_paddings", &answer);
    let slow = answer["links"][1]["along_the_path"].as_f64().unwrap();
    assert!(slow < number(&file, "fore") && slow > 1e-3, "{answer}");
    assert!(slow <= answer["links"][1]["at_the_same_time"].as_f64().unwrap(), "{answer}");
    lab.run(&export.replace(" --robot arm.urdf", "")).fails_with_last(&["--robot"]);
    let run = lab.run(&format!("{export} --speed 2")).exits(2);
    assert!(run.stderr.contains("above 0 and up to 1"), "{}", run.stderr);
    let shield = "export --model arm/model.json --to sara-shield --robot arm.urdf --data plan.csv \
                  --capsules arm.urdf --out shield";
    let run = lab.run(shield).exits(0);
    assert!(run.stdout.contains("secure_radius 0.0"), "{}", run.stdout);
}

#[test]
fn samples_of_a_running_arm_are_judged_as_they_come() {
    let lab = planned();
    let monitor = "monitor --model arm/model.json";
    let log = log(2);
    let row = |k: usize, far: f64| {
        let ([a, b], [c, d]) = (log.command[k], log.actual[k]);
        format!("{},{a},{b},{c},{}\n", log.times[k], d + far)
    };
    let text = |far: &dyn Fn(usize) -> f64| {
        let rows: String = (0..600).map(|k| row(k, far(k))).collect();
        format!("t,r1,r2,q1,q2\n{rows}")
    };
    let run = fed(&lab, monitor, &text(&|_| 0.0)).exits(0);
    assert!(run.stdout.starts_with("inside: 0 of 600 samples"), "{}", run.stdout);
    let push = |k: usize| if (300..310).contains(&k) { 0.05 } else { 0.0 };
    let run = fed(&lab, monitor, &text(&push)).exits(1);
    assert!(run.stdout.starts_with("3.0000 s: elbow leaves its set: it needs "), "{}", run.stdout);
    assert!(run.stdout.contains("NOT inside: 10 of 600 samples"), "{}", run.stdout);
    let run = fed(&lab, &format!("{monitor} --json"), &text(&push)).exits(1);
    let events: Vec<serde_json::Value> =
        run.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    events.iter().for_each(|event| fits("monitor_tracking", event));
    assert_eq!((&events[0]["event"], &events[0]["joint"]), (&"left".into(), &"elbow".into()));
    assert_eq!(events.last().unwrap()["outside"], 10);
    // One JSON object per line, three times as fast as the logs, with a gap.
    let fast = |k: usize| {
        let ([a, b], [c, d]) = (log.command[3 * k], log.actual[3 * k]);
        format!("{{\"t\":{},\"r\":[{a},{b}],\"q\":[{c},{d}]}}\n", log.times[k])
    };
    let lines: String = (0..100).chain(120..200).map(fast).collect();
    let run = fed(&lab, monitor, &lines).exits(1);
    assert!(run.stdout.contains("is faster than the recorded ones"), "{}", run.stdout);
    assert!(run.stdout.contains("of 180 samples outside the sets; 1 gap,"), "{}", run.stdout);
    fed(&lab, monitor, "t,r1,r2,q1\n").fails_with(&["standard input:1", "no column q2"]);
    fed(&lab, monitor, "t,r1,r2,q1,q2\n0,0,0,0,nan\n").fails_with(&["standard input:2"]);
    fed(&lab, &format!("{monitor} --step 0.1"), "").fails_with(&["--model"]);
}
