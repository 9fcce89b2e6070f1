//! Tests of the recordings as a user reads them, and of campaigns that were stopped.

use reachtube_arm::{ArmSettings, setup};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use reachtube_conform::{Keep, Problem, Settings, Silent, conform};
use reachtube_recordings::{DataSet, ReadOptions, RunSource, Torque};
use reachtube_robot::Robot;

use super::options::CampaignOptions;
use super::record::{RecordedCampaign, record};
use crate::error::Result;
use crate::virtual_robot::VirtualRobotParameters;

fn small(seed: u64) -> CampaignOptions {
    CampaignOptions {
        seed,
        motions: 2,
        start_points: 2,
        runs: 3,
        longest: 0.5,
        rest: 27,
        one_joint: 1,
        excitation: 1,
        validation: 1,
        ..CampaignOptions::default()
    }
}

fn suites(seed: u64) -> CampaignOptions {
    let few = CampaignOptions { motions: 2, held_out_motions: 1, ..small(1) };
    CampaignOptions { seed, duration: Some(2.0), longest: 5.0, runs: 5, ..few.suites_only() }
}

fn run(options: &CampaignOptions, folder: &Path) -> Result<RecordedCampaign> {
    record(&Robot::lwa4p(), options, folder, &|_, _| ())
}

fn recorded(options: &CampaignOptions) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    run(options, folder.path()).unwrap();
    folder
}

fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = PathBuf::from(path.file_name().unwrap());
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(file, bytes)| (name.join(file), bytes)));
        } else {
            found.insert(name, std::fs::read(&path).unwrap());
        }
    }
    found
}

#[test]
fn the_folder_is_a_data_set_of_all_recordings() {
    let folder = recorded(&small(1));
    let data = DataSet::open(folder.path()).unwrap();
    assert!(data.notes().is_empty(), "{:?}", data.notes());
    assert_eq!(data.suites().len(), 4);
    let kinds =
        |kind: &str| data.runs().iter().filter(|run| run.kind.as_deref() == Some(kind)).count();
    let counts = ["test_suite", "rest", "one-joint", "excitation", "validation"].map(kinds);
    assert_eq!(counts, [12, 2, 6, 1, 1]);
    for (index, entry) in data.runs().iter().enumerate() {
        let run = data.read(index, &ReadOptions::default()).unwrap();
        assert_eq!(entry.sha256.as_ref(), Some(&run.sha256), "{}", entry.file);
        assert!(entry.simulated, "{}", entry.file);
        assert_eq!(run.temperatures.len(), run.torques.len(), "{}", entry.file);
        match &entry.suite {
            Some(suite) => {
                assert!(suite.starts_with(entry.motion.as_ref().unwrap()));
                assert_eq!(run.len(), 126, "0.5 s, both ends included");
            }
            None => assert!(run.len() > 200, "{}", entry.file),
        }
    }
    for suite in data.suites() {
        let temperature: Vec<f64> =
            suite.runs.iter().map(|run| data.runs()[*run].temperature.unwrap()).collect();
        assert!(temperature.windows(2).all(|pair| pair[0] < pair[1]), "{temperature:?} °C");
    }
}

/// A demo has nothing but logs, of motor torques, 125 samples per second.
#[test]
fn a_demo_has_logs_alone() {
    let few = CampaignOptions { excitation: 1, validation: 1, ..CampaignOptions::demo() };
    let folder = recorded(&few);
    let data = DataSet::open(folder.path()).unwrap();
    let kinds: Vec<_> = data.runs().iter().map(|run| run.kind.as_deref().unwrap()).collect();
    assert_eq!((kinds, data.suites().len()), (vec!["excitation", "validation"], 0));
    let run = data.read(0, &ReadOptions::default()).unwrap();
    assert_eq!((run.len(), run.times[1], run.duration()), (2501, 0.008, 20.0));
    let readme = std::fs::read_to_string(folder.path().join("README.md")).unwrap();
    assert!(readme.contains("4 ms apart, 8 ms in exciting motions.\n"), "{readme}");
    assert!(readme.contains("reachtube model --robot lwa4p") && !readme.contains("suites/"));
}

#[test]
fn a_seed_gives_the_same_bytes_and_another_seed_others() {
    let [once, again, other] =
        [3, 3, 4].map(|seed| files(recorded(&CampaignOptions { rest: 2, ..small(seed) }).path()));
    assert_eq!(once, again);
    let differing = once.iter().filter(|(file, bytes)| other.get(*file) != Some(bytes)).count();
    // Only truth.toml does not depend on the seed.
    assert_eq!((other.len(), differing), (once.len(), once.len() - 1));
}

#[test]
fn more_recordings_of_one_kind_leave_the_others_as_they_are() {
    let small = CampaignOptions { rest: 2, one_joint: 0, ..small(5) };
    let (few, more) = (
        files(recorded(&small).path()),
        files(recorded(&CampaignOptions { excitation: 2, ..small }).path()),
    );
    let same = |file: &str| few[Path::new(file)] == more[Path::new(file)];
    assert!(same("suites/M2b/M2b_03.csv") && same("excitation/excitation_001.csv"));
    assert!(same("validation/validation_001.csv") && same("rest/rest_001.csv"));
    assert!(!same("runs.csv"));
}

/// Whatever a stop leaves, the next start gives the bytes of a campaign without a stop.
#[test]
fn a_stopped_campaign_goes_on_to_the_same_bytes() {
    let options = CampaignOptions { rest: 2, one_joint: 0, ..small(7) };
    let whole = files(recorded(&options).path());
    let folder = tempfile::tempdir().unwrap();
    let after_run = |files: &BTreeMap<PathBuf, Vec<u8>>| {
        let mut kept: Vec<&PathBuf> =
            files.keys().filter(|file| file.ends_with("runs.csv")).collect();
        kept.extend(files.keys().filter(|file| file.starts_with("suites/M2a")));
        kept.into_iter().cloned().collect::<Vec<_>>()
    };
    run(&options, folder.path()).unwrap();
    // A stop in the middle of a suite and of a file, before the index.
    for file in after_run(&whole).iter().filter(|file| !file.ends_with("M2a_01.csv")) {
        std::fs::remove_file(folder.path().join(file)).unwrap();
    }
    std::fs::write(folder.path().join("suites/M2a/.reachtube-AbC123.tmp"), "0.1,0.").unwrap();
    std::fs::write(folder.path().join(".reachtube-AbC124.tmp"), "").unwrap();
    let again = run(&options, folder.path()).unwrap();
    assert_eq!(again.kept, again.recordings - 3);
    assert_eq!(files(folder.path()), whole);
    // A stop before the mark was written.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(".reachtube-00zzZZ.tmp"), "{").unwrap();
    run(&options, folder.path()).unwrap();
    assert_eq!(files(folder.path()), whole);
}

#[test]
fn foreign_folders_and_other_campaigns_are_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mine = folder.path().join(".tmp-notes");
    std::fs::write(&mine, "mine").unwrap();
    let error = run(&small(1), folder.path()).unwrap_err().to_string();
    assert!(error.contains("no campaign has written"), "{error}");
    assert_eq!(files(folder.path()).len(), 1);

    let few = small(1).suites_only();
    let folder = recorded(&few);
    let before = files(folder.path());
    let payload = VirtualRobotParameters { payload_mass: 1.0, ..few.robot.clone() };
    for other in [
        CampaignOptions { seed: 2, ..few.clone() },
        CampaignOptions { robot: payload, ..few.clone() },
    ] {
        let error = run(&other, folder.path()).unwrap_err().to_string();
        assert!(error.contains("with other options") && error.contains("campaign.json"), "{error}");
    }
    // A file of the user beside the recordings stays.
    std::fs::write(folder.path().join("notes.txt"), "mine").unwrap();
    run(&few, folder.path()).unwrap();
    assert_eq!(files(folder.path()).len(), before.len() + 1);
}

#[test]
fn options_out_of_range_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let endless =
        VirtualRobotParameters { delay_cycles: f64::INFINITY, ..VirtualRobotParameters::default() };
    for (options, words) in [
        (CampaignOptions { motions: 0, ..suites(1) }, "motions: 0 is not in 1"),
        (CampaignOptions { start_points: 27, ..small(1) }, "27 is not in 1 to 26"),
        (CampaignOptions { runs: 0, ..small(1) }, "runs: 0 is not in 1"),
        (
            CampaignOptions { longest: f64::NAN, ..small(1) },
            "longest run in s: NaN is not in 0.1 to 3600",
        ),
        (
            CampaignOptions { duration: Some(f64::NAN), ..suites(1) },
            "a motion in s: NaN is not in 0.5 to 60",
        ),
        (CampaignOptions { held_out_motions: 2, ..suites(1) }, "2 are held out"),
        (CampaignOptions { robot: endless, ..suites(1) }, "delay_cycles = inf is outside"),
    ] {
        let error = run(&options, folder.path()).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    assert!(files(folder.path()).is_empty());
}

#[test]
fn a_demo_holds_out_its_last_motions_and_conformance_of_the_others_is_verified() {
    let folder = tempfile::tempdir().unwrap();
    let recorded = run(&suites(1), folder.path()).unwrap();
    assert_eq!((&recorded.training, &recorded.check), (&names("M1"), &names("M2")));
    assert_eq!(recorded.runs, 20);
    let text = std::fs::read_to_string(folder.path().join("M1a/M1a_01.csv")).unwrap();
    let header = "t,q1,q2,q3,q4,q5,q6,qd1,qd2,qd3,qd4,qd5,qd6,tau1,tau2,tau3,tau4,tau5,tau6,\
                  temp1,temp2,temp3,temp4,temp5,temp6";
    assert_eq!(text.lines().next(), Some(header));
    assert_eq!(text.lines().count(), 1 + 451, "from a tenth of 2 s to their end, both included");
    let setup =
        setup(Robot::lwa4p(), ArmSettings::new(Torque::Compensated, 6), Settings::default())
            .unwrap();
    let source = Box::new(DataSet::open(folder.path()).unwrap());
    let problem = Problem::read(setup, source, &recorded.training, Keep::Needed, &Silent).unwrap();
    let result = conform(&problem, &Silent, None).unwrap();
    assert!(result.verdict.conformant);
    assert_eq!(result.verdict.runs, 10);
    assert!(problem.recordings().suites.iter().all(|suite| suite.shared.is_some()));
    assert!(problem.recordings().notes.iter().all(|note| !note.contains("SHA-256")));
    let input_radius = result.sets.input_set.radius;
    assert!(input_radius.iter().all(|r| (0.01..8.0).contains(r)), "{input_radius:?} N m");
}

fn names(motion: &str) -> Vec<String> {
    ["a", "b"].map(|start| format!("{motion}{start}")).to_vec()
}
