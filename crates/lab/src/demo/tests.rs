//! Tests of the recordings as a user reads them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::options::DemoOptions;
use super::record::{RecordedDemo, record};
use crate::virtual_robot::VirtualRobotParameters;
use reachtube_conform::{Keep, Problem, Settings, Setup, Silent, conform};
use reachtube_recordings::{DataSet, ReadOptions, Run, RunSource, Torque};
use reachtube_robot::Robot;

fn small(seed: u64) -> DemoOptions {
    let few = DemoOptions {
        motions: 2,
        calibration_motions: 0,
        held_out_motions: 1,
        runs: 5,
        ..DemoOptions::default()
    };
    DemoOptions { seed, duration: 2.0, ..few }
}

fn recorded(options: &DemoOptions) -> (tempfile::TempDir, RecordedDemo) {
    let folder = tempfile::tempdir().unwrap();
    let demo = record(&Robot::lwa4p(), options, folder.path()).unwrap();
    (folder, demo)
}

/// Returns each file below the folder with its bytes.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            let below = files(&path).into_iter();
            found.extend(
                below.map(|(file, bytes)| (Path::new(path.file_name().unwrap()).join(file), bytes)),
            );
        } else {
            found.insert(path.file_name().unwrap().into(), std::fs::read(&path).unwrap());
        }
    }
    found
}

fn suites(folder: &Path) -> Vec<Vec<Run>> {
    let data = DataSet::open(folder).unwrap();
    let read = |index: &usize| data.read(*index, &ReadOptions::default()).unwrap();
    data.suites().iter().map(|suite| suite.runs.iter().map(read).collect()).collect()
}

#[test]
fn a_seed_gives_the_same_bytes_and_another_seed_others() {
    let (once, again, other) =
        (recorded(&small(3)).0, recorded(&small(3)).0, recorded(&small(4)).0);
    let bytes = files(once.path());
    assert_eq!(bytes.len(), 4 * 5 + 2);
    assert_eq!(bytes, files(again.path()));
    let run = Path::new("M1a/M1a_01.csv");
    assert_ne!(bytes[run], files(other.path())[run]);
}

#[test]
fn the_folder_is_a_data_set() {
    let (folder, demo) = recorded(&small(1));
    assert_eq!(demo.training, ["M1a", "M1b"]);
    assert_eq!(demo.check, ["M2a", "M2b"]);
    assert_eq!(demo.runs, 20);
    let text = std::fs::read_to_string(folder.path().join("M1a/M1a_01.csv")).unwrap();
    let header = "t,q1,q2,q3,q4,q5,q6,qd1,qd2,qd3,qd4,qd5,qd6,tau1,tau2,tau3,tau4,tau5,tau6,\
                  temp1,temp2,temp3,temp4,temp5,temp6";
    assert_eq!(text.lines().next(), Some(header));
    assert_eq!(text.lines().count(), 1 + 451, "from a tenth of 2 s to their end, both included");
    let data = DataSet::open(folder.path()).unwrap();
    assert!(data.notes().is_empty(), "{:?}", data.notes());
    for (index, entry) in data.runs().iter().enumerate() {
        let run = data.read(index, &ReadOptions::default()).unwrap();
        assert_eq!(entry.sha256.as_ref(), Some(&run.sha256));
        assert!(entry.simulated, "the index marks what was simulated");
        assert!(entry.suite.as_ref().unwrap().starts_with(entry.motion.as_ref().unwrap()));
    }
}

#[test]
fn conformance_of_a_small_demo_is_verified() {
    let (folder, demo) = recorded(&small(1));
    let setup = Setup::new(Robot::lwa4p(), Settings::new(Torque::Compensated, 6)).unwrap();
    let source = Box::new(DataSet::open(folder.path()).unwrap());
    let problem = Problem::read(setup, source, &demo.training, Keep::Needed, &Silent).unwrap();
    let result = conform(&problem, &Silent, None).unwrap();
    assert!(result.verdict.conformant);
    assert_eq!(result.verdict.runs, 10);
    assert!(problem.recordings().suites.iter().all(|suite| suite.shared.is_some()));
    assert!(problem.recordings().notes.iter().all(|note| !note.contains("SHA-256")));
    let input_radius = result.sets.input_set.radius;
    assert!(input_radius.iter().all(|r| (0.01..8.0).contains(r)), "{input_radius:?} N m");
}

#[test]
fn runs_of_a_suite_have_one_input_and_their_temperature_rises() {
    let (folder, _) = recorded(&small(2));
    let all = suites(folder.path());
    assert!(all.iter().all(|suite| suite.iter().all(|run| run.torques == suite[0].torques)));
    assert_ne!(all[0][0].torques, all[2][0].torques);
    let data = DataSet::open(folder.path()).unwrap();
    for suite in data.suites() {
        let temperature: Vec<f64> =
            suite.runs.iter().map(|run| data.runs()[*run].temperature.unwrap()).collect();
        assert!(temperature.windows(2).all(|pair| pair[0] < pair[1]), "{temperature:?} °C");
    }
}

#[test]
fn runs_drift_apart_with_the_order_of_recording() {
    let (folder, _) = recorded(&small(1));
    for suite in suites(folder.path()) {
        let ends = |joint: usize| {
            suite.iter().map(move |run| run.q(run.len() - 1)[joint]).collect::<Vec<f64>>()
        };
        let monotone = (0..6).map(ends).filter(|q| q.is_sorted() || q.iter().rev().is_sorted());
        let spread = monotone.map(|q| (q[4] - q[0]).abs()).fold(0.0, f64::max);
        // Starts differ by 0.003 rad at most.
        assert!((0.01..1.0).contains(&spread), "{spread} rad");
    }
}

#[test]
fn recordings_that_no_demo_has_written_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let index = folder.path().join("runs.csv");
    std::fs::write(&index, "file,suite\n").unwrap();
    let error = record(&Robot::lwa4p(), &small(1), folder.path()).unwrap_err().to_string();
    assert!(
        error.contains("no demo has written") && error.contains("give an empty folder"),
        "{error}"
    );
    assert_eq!(files(folder.path()).len(), 1);
}

#[test]
fn a_demo_may_be_repeated_in_its_folder() {
    let (folder, first) = recorded(&small(1));
    assert_eq!(record(&Robot::lwa4p(), &small(1), folder.path()).unwrap(), first);
}

#[test]
fn options_that_record_nothing_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let defaults = DemoOptions::default;
    let endless =
        VirtualRobotParameters { delay_cycles: f64::INFINITY, ..VirtualRobotParameters::default() };
    for (options, word) in [
        (DemoOptions { motions: 2, held_out_motions: 2, ..defaults() }, "2 are held out"),
        (DemoOptions { start_points: 0, ..defaults() }, "0 start points"),
        (DemoOptions { start_points: 27, ..defaults() }, "1 to 26"),
        (DemoOptions { runs: 0, ..defaults() }, "0 runs"),
        (DemoOptions { robot: endless, ..defaults() }, "delay_cycles = inf is outside"),
        (DemoOptions { duration: f64::NAN, ..defaults() }, "NaN s; give 0.5 to 60 s"),
    ] {
        let error = record(&Robot::lwa4p(), &options, folder.path()).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
    assert!(files(folder.path()).is_empty());
}
