//! From logs to a model in one command.

use std::path::Path;

use serde_json::Value;

use crate::fixture::Lab;
use crate::identify::lab as pendulum_lab;
use crate::output_schema::fits;
use crate::provenance::names_what_it_is_of;
use crate::robot_logs::{JOINT_STATE, Message, SECOND, State, bag, mcap_bytes};
use crate::short::is_short;

/// A lab with `pendulum.toml`, whose mass is wrong, and four logs in `logs`.
pub(super) fn lab() -> Lab {
    let lab = pendulum_lab();
    std::fs::create_dir(lab.path("logs")).unwrap();
    for name in ["a", "b", "c"] {
        let (from, to) = (lab.path(&format!("{name}.csv")), lab.path(&format!("logs/{name}.csv")));
        std::fs::rename(from, to).unwrap();
    }
    lab
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn logs_become_a_useful_model_that_takes_other_logs() {
    let lab = lab();
    let run =
        lab.run("model --robot pendulum.toml --data logs --torque motor --out arm --json").exits(0);
    let answer = json(&run.stdout);
    fits("model", &answer);
    names_what_it_is_of(&answer, &json(&lab.read("arm/model.json")), None);
    assert_eq!((&answer["useful"], &answer["conformant"]), (&true.into(), &true.into()));
    // The description misses half of the mass, so that the robot is identified.
    let choice = |key: &str| {
        let choices = answer["choices"].as_array().unwrap().iter();
        choices.clone().find(|choice| choice["key"] == key).unwrap()["value"].clone()
    };
    assert_eq!((choice("identify"), choice("held-out")), ("true".into(), "c".into()));
    let ratio = answer["joints"][0]["ratio"].as_f64().unwrap();
    let horizon = answer["horizon"].as_f64().unwrap();
    assert!(ratio <= 0.5 && horizon >= 0.1, "{ratio} after {horizon} s");
    for file in ["model.json", "robot.toml", "choices.toml", "page/report.html"] {
        assert!(lab.path("arm").join(file).is_file(), "{file}");
    }
    assert!(!lab.path("arm/progress.json").exists(), "the job is done");
    let page = lab.read("arm/page/report.html");
    for part in [
        ">Conformant and useful",
        "and useful up to",
        "each sample proved",
        "Half the set of",
        "../held-out/report.html",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(lab.read("arm/held-out/report.html").contains("../page/report.html"));
    assert!(!page.contains("class=\"badge\""), "nothing says that the logs are simulated");
    // Nothing that the model was made of lies outside, prepared again from the logs.
    let check = lab.run("check --model arm/model.json --data logs/a.csv --json").exits(0);
    assert_eq!(json(&check.stdout)["violations"]["count"], 0);
    let other = lab.run("check --model arm/model.json --data logs --torque link");
    assert!(other.exits(2).stderr.contains("motor"), "the torque is another");
}

#[test]
fn the_same_choices_give_the_same_bytes() {
    let lab = lab();
    let run = lab.run("model --robot pendulum.toml --data logs --torque motor --out arm").exits(0);
    is_short(&run.stdout, "conformant and useful up to ");
    for part in
        ["\nheld out: ", "\nwrote to arm: model.json, robot.toml, ", "\nnext: open arm/page"]
    {
        assert!(run.stdout.contains(part), "{part} is not in\n{}", run.stdout);
    }
    lab.run("model --settings arm/choices.toml --out again").exits(0);
    let read = |path: &str| std::fs::read_to_string(lab.path(path)).unwrap();
    // Reasons are dropped if a value was edited: they may be about the value before.
    let edited = read("arm/choices.toml").replace("held-out = [\"c\"]", "held-out = [\"b\"]");
    lab.write("edited.toml", edited);
    let run = lab.run("model --settings edited.toml --out other").exits(0);
    assert!(run.stderr.contains("held-out: b (given)"), "{}", run.stderr);
    let pages = ["page/report.html", "held-out/report.html"];
    for file in ["model.json", "robot.toml", "choices.toml"].into_iter().chain(pages) {
        assert_eq!(read(&format!("arm/{file}")), read(&format!("again/{file}")), "{file}");
    }
}

#[test]
fn choices_that_are_given_are_taken_and_called_so() {
    let lab = lab();
    let given = "robot = \"pendulum.toml\"\ndata = [\"logs\"]\ntorque = \"motor\"\n\
                 gains = [1.0]\nheld-out = [\"b\"]\ncut-off = 9.0\nidentify = true\n\
                 equations = \"model\"\nexpansion = [0.25]\nsensor-noise = [0.0003, 0.006]\n\
                 horizon = 0.2\nallowance = [0.0, 0.0, 0.25]\n";
    lab.write("given.toml", given);
    let run = lab.run("model --settings given.toml --out arm");
    assert!(run.code != 2, "{run:#?}");
    let first = ["held-out", "cut-off", "expansion", "sensor-noise", "identify", "equations"];
    for key in first.into_iter().chain(["horizon", "allowance"]) {
        let own = run.stderr.lines().find(|line| line.contains(&format!("note: {key}: ")));
        assert!(own.is_some_and(|line| line.contains("(given")), "{key}: {}", run.stderr);
    }
    let written = lab.read("arm/choices.toml");
    for line in given.lines().filter(|line| !line.starts_with("robot") && !line.starts_with("data"))
    {
        assert!(written.lines().any(|own| own == line), "{line} is not in\n{written}");
    }
}

#[test]
fn the_horizon_that_was_given_is_no_remedy() {
    let lab = lab();
    lab.run("model --robot pendulum.toml --data logs --torque motor --out arm").exits(0);
    let choices = lab.read("arm/choices.toml");
    let horizon = choices.lines().find_map(|line| line.strip_prefix("horizon = ")).unwrap();
    let horizon: f64 = horizon.parse().unwrap();
    // An allowance far above the torques makes every set too wide.
    let wide = choices.lines().map(|line| match line.starts_with("allowance = ") {
        true => "allowance = [0.0, 0.0, 50.0]",
        false => line,
    });
    lab.write("wide.toml", wide.collect::<Vec<_>>().join("\n"));
    let run = lab.run("model --settings wide.toml --out wide").exits(3);
    let text = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(!text.contains(&format!("`horizon = {horizon}`")), "{text}");
}

/// Returns a log of the pendulum as messages of a topic; `rename` names the joint.
fn messages(csv: &str, topic: &str, rename: &str) -> Vec<Message> {
    let message = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let stamp = SECOND + (1e3 * cells[0]).round() as i64 * 1_000_000;
        let values = [&cells[1..2], &cells[2..3], &cells[3..4]];
        let data = State::new(stamp, &[rename], values).encode(false);
        Message::new(topic, JOINT_STATE, stamp + 1000, data)
    };
    csv.lines().skip(1).map(message).collect()
}

#[test]
fn logs_of_messages_give_the_model_of_their_csv_files() {
    let lab = lab();
    let csv = |name: &str| lab.read(&format!("logs/{name}.csv"));
    std::fs::create_dir_all(lab.path("mixed/c")).unwrap();
    lab.write("mixed/a.csv", csv("a"));
    lab.write("mixed/b.mcap", mcap_bytes("zstd", &messages(&csv("b"), "/states", "hinge")));
    lab.write("mixed/c/metadata.yaml", "");
    bag(&lab.path("mixed/c"), &messages(&csv("c"), "/states", "hinge"));
    let model = "model --robot pendulum.toml --torque motor --json --force";
    let of_csv = json(&lab.run(&format!("{model} --data logs --out arm")).exits(0).stdout);
    let mixed = lab.run(&format!("{model} --data mixed --out mix")).exits(0);
    let of_logs = json(&mixed.stdout);
    fits("model", &of_logs);
    for key in ["joints", "horizon", "horizons", "held_out", "useful"] {
        assert_eq!(of_logs[key], of_csv[key], "{key}");
    }
    mixed.notes("joints of /states are matched by name: q1 = hinge (place 1)");
    lab.run("check --model mix/model.json --data mixed/b.mcap").exits(0);
    let found = lab.run("inspect --robot pendulum.toml --data mixed --json").exits(0).json();
    fits("inspect_logs", &found);
    assert_eq!((&found["runs"], &found["logs"][0]["joints"][0]), (&3.into(), &"hinge".into()));
    let found = lab.run("inspect --robot pendulum.toml --data mixed/b.mcap").exits(0);
    assert!(found.stdout.contains("in messages\n  time    header.stamp"), "{}", found.stdout);
}

#[test]
fn a_topic_and_names_are_choices_that_other_logs_are_read_with() {
    let lab = lab();
    for name in ["a", "b", "c"] {
        let csv = lab.read(&format!("logs/{name}.csv"));
        let mut all = messages(&csv, "/arm", "axis_7");
        all.extend(messages(&csv, "/copy", "axis_7"));
        std::fs::remove_file(lab.path(&format!("logs/{name}.csv"))).unwrap();
        lab.write(&format!("logs/{name}.mcap"), mcap_bytes("lz4", &all));
    }
    let model = "model --robot pendulum.toml --data logs --torque motor --out arm";
    let names = lab.run(model).exits(2);
    assert!(
        names.stderr.contains("but these are named: axis_7; give the log's names"),
        "{names:?}"
    );
    let several = lab.run(&format!("{model} --joints axis_7")).exits(2);
    let words = "a.mcap: 2 topics name joints of the robot: /arm, /copy; choose one with --topic";
    assert!(several.stderr.contains(words), "{several:?}");
    lab.run(&format!("{model} --joints axis_7 --topic /arm")).exits(0);
    let choices = lab.read("arm/choices.toml");
    assert!(choices.contains("[log]\ntopic = [\"/arm\"]\njoints = [\"axis_7\"]"), "{choices}");
    lab.run("check --model arm/model.json --data logs/a.mcap").exits(0);
    lab.run("model --settings arm/choices.toml --out again").exits(0);
    assert_eq!(lab.read("arm/model.json"), lab.read("again/model.json"));
    assert_eq!(choices, lab.read("again/choices.toml"));
}

#[test]
fn columns_whose_names_do_not_tell_are_choices() {
    let lab = lab();
    for name in ["a", "b", "c"] {
        lab.edit(&format!("logs/{name}.csv"), |lines| lines[0] = "clock,alpha1,omega1,m1".into());
    }
    let model = "model --robot pendulum.toml --data logs --torque motor --out arm";
    lab.run(model).exits(2);
    lab.run(&format!("{model} --columns q=alpha{{}},qd=omega{{}},tau=m{{}},time=clock")).exits(0);
    let choices = lab.read("arm/choices.toml");
    assert!(choices.contains("[columns]\nq = \"alpha{}\""), "{choices}");
    lab.run("check --model arm/model.json --data logs/a.csv").exits(0);
    lab.run("model --settings arm/choices.toml --out again").exits(0);
    assert_eq!(lab.read("arm/model.json"), lab.read("again/model.json"));
}

#[test]
fn a_horizon_cuts_logs_for_conform_and_for_what_follows() {
    let lab = lab();
    // The pendulum of the logs.
    let robot = lab.read("pendulum.toml").replace("mass = 1.0", "mass = 2.0");
    let robot = robot.replace("[0.0, 0.0, -0.3]", "[0.0, 0.0, -0.4]");
    let robot = robot.replace("0.02, 0.0, 0.0, 0.02", "0.18, 0.0, 0.0, 0.18");
    let friction = "coulomb = [1, 0, -1, 0, -1, 0, 1, 0], viscous = [0.8, 0, 0]";
    lab.write("pendulum.toml", format!("{robot}friction = {{ {friction} }}\n"));
    let run = lab
        .run(
            "conform --robot pendulum.toml --data logs --torque motor --horizon 0.2 --noise fitted \
             --nominal own --equations robot --out model.json --report page",
        )
        .exits(0);
    assert!(run.stderr.contains("cut 3 recordings into "), "{}", run.stderr);
    let model = json(&lab.read("model.json"));
    let preparation = &model["preparation"];
    assert_eq!((&preparation["window"], &preparation["torque"]), (&0.2.into(), &"motor".into()));
    assert!(preparation["cut_off"].as_f64().unwrap() > 1.0, "{preparation}");
    assert_eq!(model["drive"]["settings"]["torque"], "compensated");
    let check = lab.run("check --model model.json --data logs --torque motor --json").exits(0);
    let check = json(&check.stdout);
    assert_eq!((&check["conformant"], &check["rows"]), (&true.into(), &model["proof"]["rows"]));
    lab.run("report --model model.json --data logs --out again").exits(0);
    lab.run("export --model model.json --data logs/a.csv --to cora --out cora").exits(0);
    let data = "--robot pendulum.toml --data logs --torque motor";
    for (wrong, problem) in [
        ("--horizon 0", "above 0"),
        ("--horizon 0.2 --until 1", "cannot be used with"),
        ("--horizon 900", "no recording is as long"),
        ("--horizon 0.001", "a window of 0.001 s is shorter than the time between samples, 0.0"),
        ("--horizon 0.2 --suites a", "windows of logs: there is no suite \"a\""),
    ] {
        let run = lab.run(&format!("conform {data} {wrong}")).exits(2);
        assert!(run.stderr.contains(problem), "{wrong}: {}", run.stderr);
    }
    lab.run(&format!("conform {data} --horizon 0.2 --suites b*")).notes("windows of logs are used");
}

#[test]
fn choices_that_cannot_be_are_refused_with_their_file() {
    let lab = lab();
    let given = "robot = \"pendulum.toml\"\ndata = [\"logs\"]\n";
    for (choices, problem) in [
        ("torque = \"motor\"\nhorizon = -1.0", "given.toml: horizon = -1; give a finite"),
        ("torque = \"motor\"\nallowance = [0.1]", "given.toml: allowance = [0.1]; give 3 radii"),
        ("torque = \"compensated\"\nidentify = true", "given.toml: identify = true; give false"),
        ("torque = \"compensated\"\ncut-off = 5.0", "given.toml: cut-off = 5; give none with"),
        ("torque = \"motor\"\ngains = [1.0, 2.0]", "gains: 2 given; give one for each of the 1"),
        ("torque = \"motor\"\ngains = [nan]", "gains: gain 1 is NaN"),
    ] {
        lab.write("given.toml", format!("{given}{choices}\n"));
        let run = lab.run("model --settings given.toml --out arm").exits(2);
        assert!(run.stderr.contains(problem), "{choices}: {}", run.stderr);
    }
}

#[test]
fn what_is_missing_is_named() {
    let lab = lab();
    let wrong = [
        ("--data logs --torque motor", "--robot"),
        ("--robot pendulum.toml --torque motor", "--data"),
        ("--robot pendulum.toml --data logs", "--torque motor, link or compensated"),
        (
            "--robot pendulum.toml --data logs --torque motor --held-out z",
            "the motions are a, b, c",
        ),
    ];
    for (arguments, part) in wrong {
        let run = lab.run(&format!("model {arguments} --out arm")).exits(2);
        assert!(run.stderr.contains(part), "{arguments}: {}", run.stderr);
        assert!(!Path::new(&lab.path("arm/model.json")).exists());
    }
}

/// Adds logs of a pendulum at rest to a lab, in `rest`.
fn add_rest(lab: &Lab) {
    std::fs::create_dir(lab.path("rest")).unwrap();
    for q in [0.1, 0.2] {
        let line = |k: u32| format!("{:.3},{q},0,{}\n", 0.005 * f64::from(k), 2.0 * q);
        let rest: String = (0..2000).map(line).collect();
        lab.write(&format!("rest/{q}.csv"), format!("t,q1,qd1,tau1\n{rest}"));
    }
}

#[test]
fn poses_at_rest_give_no_bound_for_new_motions() {
    let lab = lab();
    lab.run("model --robot pendulum.toml --data logs --torque motor --out arm").exits(0);
    add_rest(&lab);
    let run = lab.run("check --model arm/model.json --data rest");
    let text = "new motions: no guarantee: the robot rests in all recordings";
    assert!(run.stdout.contains(text), "{run:#?}");
    run.notes("the robot rests; a bound for new motions does not count them");
}

#[test]
fn a_log_of_standstill_is_refused() {
    let lab = lab();
    add_rest(&lab);
    let run = lab.run("model --robot pendulum.toml --data rest --torque motor --out arm").exits(2);
    assert!(run.stderr.contains("2 at rest"), "{}", run.stderr);
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn logs_of_three_arms_become_useful_models() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let data = data.canonicalize().unwrap();
    let lab = Lab::new();
    let shared = data.display();
    let pendulum = format!("{shared}/double_pendulum/acrobot.urdf");
    let arms = [
        (format!("{shared}/ur10e/ur10e.urdf"), "ur10e/excitation", "motor", 0.3),
        (pendulum, "double_pendulum/openloop", "motor", 0.1),
        ("lwa4p".into(), "schunk_lwa4p", "compensated", 0.2),
    ];
    for (robot, logs, torque, horizon) in arms {
        let logs = data.join(logs);
        let shown = logs.display();
        let line =
            format!("model --robot {robot} --data {shown} --torque {torque} --out arm --force");
        let answer = json(&lab.run(&format!("{line} --json")).exits(0).stdout);
        assert!(answer["horizon"].as_f64().unwrap() >= horizon, "{}", answer["horizon"]);
        let held_out = &answer["held_out"];
        let part = held_out["outside"].as_f64().unwrap() / held_out["rows"].as_f64().unwrap();
        assert!(part < 0.01, "{part}");
        let narrower = answer["joints"].as_array().unwrap().iter().map(|joint| &joint["narrower"]);
        let gain: f64 = narrower.map(|factor| factor.as_f64().unwrap().ln()).sum();
        assert!(gain > 0.0, "no narrower than without a model");
        // The windows of all logs, prepared again: only what was held out may lie outside. One log
        // of the pendulum moves a single joint, and is neither among the windows nor held out.
        if logs.ends_with("ur10e/excitation") {
            let check = lab.run(&format!("check --model arm/model.json --data {shown} --json"));
            assert_eq!(json(&check.stdout)["violations"]["count"], held_out["outside"]);
        }
    }
}

/// Behind torque sensors, a wrist has hardly any inertia, and its acceleration is better known from
/// the motion before.
#[test]
#[ignore = "needs the recordings in ../shared"]
fn an_arm_that_is_better_known_without_its_robot_is_said_to_be() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/panda/excitation");
    let panda = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/identify/panda-robot.toml");
    let lab = Lab::new();
    let [robot, data] = [panda, data].map(|path| path.canonicalize().unwrap());
    let (robot, data) = (robot.display(), data.display());
    let line = format!("model --robot {robot} --data {data} --torque link --out arm");
    let run = lab.run(&line).exits(3);
    let said = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["without a model the sets are no wider", "would help: ", "`equations = \""] {
        assert!(said.contains(part), "{part} is not in\n{said}");
    }
    assert!(run.stderr.contains("is not used: torques behind the gears"), "{}", run.stderr);
}

#[test]
fn a_vacuous_model_is_called_so_on_its_page_and_by_its_exit_code() {
    let lab = Lab::new();
    // A measurement noise of 10 rad hides every motion.
    let run = lab.conform("--noise 10,10 --out model.json --report page").exits(3);
    assert!(run.stdout.starts_with("conformant, but vacuous"), "{}", run.stdout);
    assert!(run.stdout.contains("\nvacuous for joints 1, 2: "), "{}", run.stdout);
    assert!(lab.read("page/report.html").contains("Conformant, but vacuous"));
    lab.check("").exits(3);
}

#[test]
fn recordings_that_are_used_in_part_are_said_to_be() {
    let lab = Lab::new();
    let model = "model --robot arm.toml --data data --torque compensated --out made";
    let run = lab.run(&format!("{model} --horizon 0.2"));
    assert!(run.stdout.contains("each sample up to 0.2 s proved"), "{}", run.stdout);
    assert_eq!(json(&lab.read("made/model.json"))["settings"]["until"], 0.2);
    let check = lab.run("check --model made/model.json --data data --until 0.5");
    let said = check.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("suites, up to 0.2 s"), "{said}");
}
