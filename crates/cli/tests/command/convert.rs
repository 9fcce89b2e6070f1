//! `convert`: logs of a robot as a data set, and `identify` on logs.

use serde_json::Value;

use crate::fixture::{Lab, SAMPLES};
use crate::output_schema::fits;
use crate::robot_logs::{JOINT_STATE, Message, SECOND, State, bag, mcap_bytes};

/// Returns the recordings of the lab as messages, 10 s apart. The joints change places, and the
/// topic `/run` names the suites.
fn messages(lab: &Lab) -> Vec<Message> {
    let mut all = vec![];
    let mut start = 1_700_000_000 * SECOND;
    for suite in ["A", "B"] {
        for run in 1..=3 {
            let marker =
                |time, text| Message { topic: "/run".into(), ..Message::string(time, text) };
            all.push(marker(start - SECOND, suite));
            for (k, line) in
                lab.read(&format!("data/{suite}_{run}.csv")).lines().skip(1).enumerate()
            {
                let cells: Vec<f64> =
                    line.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect();
                let [mut q, mut qd, mut tau] = [0, 2, 4].map(|at| cells[at..at + 2].to_vec());
                let mut names = ["axis1", "axis2"];
                if k % 3 == 1 {
                    names.reverse();
                    for values in [&mut q, &mut qd, &mut tau] {
                        values.reverse();
                    }
                }
                let stamp = start + 10_000_000 * k as i64;
                let data = State::new(stamp, &names, [&q, &qd, &tau]).encode(false);
                all.push(Message::new("/joint_states", JOINT_STATE, stamp + 1000, data));
            }
            all.push(marker(start + 2 * SECOND, ""));
            start += 10 * SECOND;
        }
    }
    all
}

/// Returns a lab with its recordings as `run.mcap` and `bag.db3`.
fn lab() -> Lab {
    let lab = Lab::new();
    let messages = messages(&lab);
    lab.write("run.mcap", mcap_bytes("zstd", &messages));
    bag(&lab.path(""), &messages);
    lab
}

const CONVERT: &str = "convert --robot arm.toml --out logged --data";

/// Returns a model without what depends on names and digests of files.
fn numbers(text: &str) -> Value {
    let mut model: Value = serde_json::from_str(text).unwrap();
    fn strip(value: &mut Value) {
        match value {
            Value::Object(map) => {
                for key in ["sha256", "file", "run", "motion", "basis"] {
                    map.remove(key);
                }
                map.values_mut().for_each(strip);
            }
            Value::Array(list) => list.iter_mut().for_each(strip),
            _ => {}
        }
    }
    strip(&mut model);
    // Runs of a log name their motions, and the index of the CSV files does not.
    model["trust"].as_object_mut().unwrap().remove("kind");
    model
}

#[test]
fn a_log_gives_the_model_of_its_csv_files() {
    let lab = lab();
    lab.conform("--out csv.json").exits(0);
    for log in ["run.mcap", "bag.db3"] {
        let run = lab.run(&format!("{CONVERT} {log} --marker /run --force --json")).exits(0);
        let run = run.notes("times are the stamps in the headers").notes(
            "joints of /joint_states are matched by name: q1 = axis1 (place 1), q2 = axis2 (place \
             2); the order of the names changes",
        );
        let json = run.json();
        fits("convert", &json);
        let suites: Vec<&str> =
            (0..6).map(|run| json["recordings"][run]["suite"].as_str().unwrap()).collect();
        assert_eq!(suites, ["A", "A", "A", "B", "B", "B"]);
        assert_eq!(json["recordings"][5]["samples"], SAMPLES);
        lab.run("conform --robot arm.toml --data logged --torque compensated --out log.json")
            .exits(0);
        let [from_csv, from_log] = ["csv.json", "log.json"].map(|file| numbers(&lab.read(file)));
        assert!(from_csv["cost"].is_number(), "{from_csv}");
        assert_eq!(from_csv, from_log, "{log}");
    }
}

#[test]
fn what_was_written_is_printed_and_kept() {
    let lab = lab();
    let run = lab.run(&format!("{CONVERT} run.mcap --marker /run")).exits(0);
    let run = run.notes("wrote 6 recordings and runs.csv to logged");
    assert!(run.stdout.contains("  A          3       153"), "{}", run.stdout);
    assert_eq!(lab.names("logged")[..2], ["0001_run.csv", "0002_run.csv"]);
    let index = lab.read("logged/runs.csv");
    assert!(index.starts_with("file,suite,motion,sha256,log,start\n0001_run.csv,A,,"), "{index}");
    lab.run(&format!("{CONVERT} bag.db3")).fails_with(&["runs.csv: a file of this name exists"]);
    assert_eq!(lab.read("logged/runs.csv"), index);
    lab.run("inspect --data logged").exits(0);
}

#[test]
fn repeats_are_reported() {
    let lab = lab();
    lab.write("list.csv", "start,end\n0,0.5\n10,10.5\n20,20.5\n30,30.5\n");
    let command = format!("{CONVERT} run.mcap --intervals list.csv --repeats");
    let run = lab.run(&format!("{command} --json")).exits(0);
    let json = run.json();
    fits("convert", &json);
    assert_eq!(
        (&json["repeats"][0]["runs"], &json["recordings"][3]["suite"]),
        (&3.into(), &Value::Null)
    );
    assert!(run.stderr.contains("warning: 1 of 4 runs repeat no other"), "{}", run.stderr);
    let text = lab.run(&format!("{command} --force")).exits(0).stdout;
    assert!(text.contains("repeated motion") && text.contains("correlation: lowest"), "{text}");
}

#[test]
fn a_damaged_log_is_an_error_or_is_recovered() {
    let lab = lab();
    let bytes = std::fs::read(lab.path("run.mcap")).unwrap();
    lab.write("cut.mcap", &bytes[..bytes.len() / 2]);
    let command = format!("{CONVERT} cut.mcap --marker /run");
    lab.run(&command).fails_with(&["cut.mcap: byte ", "--recover keeps what is whole"]);
    lab.run(&format!("{command} --json")).fails_in_json("file", &["cut.mcap: byte "]);
    assert!(!lab.path("logged").exists());
    let run = lab.run(&format!("{command} --recover --json")).exits(0);
    assert!(run.stderr.contains("warning: cut.mcap: byte "), "{}", run.stderr);
    assert!(run.stderr.contains(" samples are kept"), "{}", run.stderr);
    let json = run.json();
    fits("convert", &json);
    assert_eq!(json["lost"].as_array().unwrap().len(), 1);
}

#[test]
fn logs_that_do_not_fit_are_refused() {
    let lab = lab();
    lab.write("list.csv", "start,end\n0,0.5\n0.2,x\n");
    for (more, kind, words) in [
        ("run.mcap --topic /joints", "setting", "give one of /joint_states (sensor_msgs/msg/Joint"),
        ("run.mcap --topic /run", "setting", "has messages of type std_msgs/msg/String"),
        ("run.mcap --joints a", "setting", "--joints gives 1 names, but the robot has 2 joints"),
        ("run.mcap --joints a,b", "setting", "names a joint of the robot (a, b), but these are"),
        ("run.mcap --intervals list.csv", "setting", "list.csv:3: \"x\" is not a number"),
        ("run.mcap", "recordings", "there is a gap of 9.5"),
        ("run.mcap --repeats --rest-speed 100", "recordings", "give a lower --rest-speed"),
        ("none.mcap", "file", "none.mcap: cannot read"),
        ("arm.toml", "file", "arm.toml: it is neither MCAP nor SQLite"),
    ] {
        lab.run(&format!("{CONVERT} {more} --json")).fails_in_json(kind, &[words]);
        assert!(!lab.path("logged").exists(), "{more}");
    }
    lab.run(&format!("{CONVERT} run.mcap --joints axis2,axis1 --max-gap 20")).exits(0);
}

#[test]
fn identification_reads_logs() {
    let lab = lab();
    let identify = "identify --robot arm.toml --cut-off 20 --max-gap 20 --json --excitation";
    lab.run(&format!("{CONVERT} run.mcap --max-gap 20")).exits(0);
    let from_csv = lab.run(&format!("{identify} logged/0001_run.csv"));
    let from_log = lab.run(&format!("{identify} run.mcap"));
    assert_eq!(from_csv.code, from_log.code, "{from_csv:?} {from_log:?}");
    assert!(from_log.stderr.contains("matched by name"), "{from_log:?}");
    // Only the log has notes about its messages.
    let same = |run: &crate::fixture::Run| {
        let mut json = run.json();
        let changes = json["changes"].as_array_mut().unwrap();
        changes.retain(|change| !change.as_str().unwrap().contains("run.mcap: "));
        // The files have digests of their own.
        let seen = json["robot"].as_object_mut().unwrap().remove("identified_from").unwrap();
        assert_eq!(seen.as_array().unwrap().len(), 1, "{seen}");
        json.to_string().replace("0001_run", "run")
    };
    assert_eq!(same(&from_csv), same(&from_log));
    assert_eq!(from_log.code, 0, "{from_log:?}");
    let wrong = lab.run(&format!("{identify} run.mcap --topic /none"));
    wrong.fails_in_json("setting", &["there is no topic /none"]);
}
