//! Reachable sets as files.

use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::fixture::{Lab, Run, SAMPLES, STEP, cell};

const COLUMNS: [&str; 4] = ["q1", "q2", "qd1", "qd2"];

fn reach(lab: &Lab, more: &str) -> Run {
    lab.conform(&format!("--out model.json {more}")).exits(0);
    lab.run("reach --model model.json --data data --torque compensated --out reach")
}

#[test]
fn the_columns_are_named_and_enclose_what_they_should() {
    let lab = Lab::new();
    reach(&lab, "").exits(0);
    for suite in ["A", "B"] {
        let (samples, tube) =
            (lab.read(&format!("reach/{suite}.csv")), lab.read(&format!("reach/{suite}_tube.csv")));
        let bounds = |name: &str, kinds: &[&str]| {
            kinds.iter().map(|kind| format!(",{name}_{kind}")).collect::<String>()
        };
        let header = |kinds: &[&str]| COLUMNS.map(|name| bounds(name, kinds)).concat();
        assert_eq!(
            samples.lines().next().unwrap(),
            format!("t{}", header(&["lower", "nominal", "upper"]))
        );
        assert_eq!(
            tube.lines().next().unwrap(),
            format!("t_from,t_to{}", header(&["lower", "upper"]))
        );
        let samples: Vec<&str> = samples.lines().skip(1).collect();
        let tube: Vec<&str> = tube.lines().skip(1).collect();
        assert_eq!((samples.len(), tube.len()), (SAMPLES, SAMPLES - 1));
        for (k, step) in tube.iter().enumerate() {
            assert_eq!(
                (cell(step, 0), cell(step, 1)),
                (cell(samples[k], 0), cell(samples[k + 1], 0))
            );
        }
        for (k, row) in samples.iter().enumerate() {
            assert!((cell(row, 0) - k as f64 * STEP).abs() < 1e-12);
            (0..4).for_each(|i| encloses(&lab, suite, k, i, row, &tube));
        }
    }
}

#[test]
fn the_record_names_model_settings_recordings_and_files_by_digest() {
    let lab = Lab::new();
    reach(&lab, "").exits(0);
    let json = |path: &str| serde_json::from_str::<Value>(&lab.read(path)).unwrap();
    let (record, model) = (json("reach/reach.json"), json("model.json"));
    assert_eq!(record["format"], "reachtube-reach");
    assert_eq!(record["model_sha256"], model["sha256"]);
    assert_eq!(record["settings"], model["settings"]);
    assert_eq!(record["data"], model["data"]);
    let files = record["files"].as_array().unwrap();
    let names: Vec<&str> = files.iter().map(|file| file["file"].as_str().unwrap()).collect();
    assert_eq!(names, ["A.csv", "A_tube.csv", "B.csv", "B_tube.csv"]);
    for file in files {
        let content = lab.read(&format!("reach/{}", file["file"].as_str().unwrap()));
        let digest = Sha256::digest(content).iter().map(|b| format!("{b:02x}")).collect::<String>();
        assert_eq!(file["sha256"], digest);
    }
}

/// Lower <= nominal and recorded <= upper, and both steps beside a sample contain its bounds.
#[track_caller]
fn encloses(lab: &Lab, suite: &str, k: usize, i: usize, row: &str, tube: &[&str]) {
    let [lower, nominal, upper] = [1, 2, 3].map(|column| cell(row, 3 * i + column));
    assert!(lower <= nominal && nominal <= upper);
    for run in 1..=3 {
        let text = lab.read(&format!("data/{suite}_{run}.csv"));
        let recorded = cell(text.lines().nth(k + 1).unwrap(), i + 1);
        assert!(
            lower <= recorded && recorded <= upper,
            "{suite}_{run}.csv, sample {k}, {}",
            COLUMNS[i]
        );
    }
    for step in [k.checked_sub(1), Some(k)].into_iter().flatten().filter_map(|step| tube.get(step))
    {
        assert!(
            cell(step, 2 + 2 * i) <= lower && cell(step, 3 + 2 * i) >= upper,
            "sample {k}, {}",
            COLUMNS[i]
        );
    }
}

#[test]
fn a_run_with_its_own_nominal_solution_has_its_own_file() {
    let lab = Lab::new();
    let json = |run: Run| run.exits(0).json();
    lab.conform("--nominal own --out model.json").exits(0);
    let found = json(
        lab.run("reach --model model.json --data data --torque compensated --out reach --json"),
    );
    assert_eq!(found["reach"].as_array().unwrap().len(), 6);
    assert_eq!(
        (&found["reach"][1]["run"], &found["reach"][1]["csv"]),
        (&"A_2.csv".into(), &"reach/A_A_2.csv".into())
    );
    assert!(lab.path("reach/B_B_3_tube.csv").is_file());
}

#[test]
fn names_of_suites_do_not_leave_the_folder_and_no_file_is_lost() {
    let lab = Lab::new();
    lab.edit("data/runs.csv", |lines| {
        lines[1..4].iter_mut().for_each(|line| *line = line.replace(",A,", ",../../x/A,"));
        lines[4..].iter_mut().for_each(|line| *line = line.replace(",B,", ",.._.._x_a,"));
    });
    let run = reach(&lab, "").exits(0);
    assert_eq!(lab.names("."), ["arm.toml", "data", "model.json", "reach"]);
    let csv =
        lab.names("reach").into_iter().filter(|name| name.ends_with(".csv")).collect::<Vec<_>>();
    assert_eq!(
        csv,
        ["_._.._x_A.csv", "_._.._x_A_tube.csv", "_._.._x_a_2.csv", "_._.._x_a_2_tube.csv"],
        "{run:?}"
    );
}
