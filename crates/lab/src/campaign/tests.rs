//! Tests of the recordings as a user reads them, and of campaigns that were stopped.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use reachtube_recordings::{DataSet, ReadOptions, RunSource};
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
        poses: 27,
        friction: 1,
        excitation: 1,
        validation: 1,
        robot: VirtualRobotParameters::default(),
    }
}

fn run(options: &CampaignOptions, folder: &Path) -> Result<RecordedCampaign> {
    record(&Robot::lwa4p(), options, folder, &|_, _| ())
}

fn recorded(options: &CampaignOptions) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    run(options, folder.path()).unwrap();
    folder
}

/// Returns each file below a folder with its bytes.
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
    let counts = ["test_suite", "poses", "friction", "excitation", "validation"].map(kinds);
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
}

#[test]
fn a_seed_gives_the_same_bytes_and_another_seed_others() {
    let [once, again, other] =
        [3, 3, 4].map(|seed| files(recorded(&CampaignOptions { poses: 2, ..small(seed) }).path()));
    assert_eq!(once, again);
    let differing = once.iter().filter(|(file, bytes)| other.get(*file) != Some(bytes)).count();
    // Only truth.toml does not depend on the seed.
    assert_eq!((other.len(), differing), (once.len(), once.len() - 1));
}

#[test]
fn more_recordings_of_one_kind_leave_the_others_as_they_are() {
    let small = CampaignOptions { poses: 2, friction: 0, ..small(5) };
    let (few, more) = (
        files(recorded(&small).path()),
        files(recorded(&CampaignOptions { excitation: 2, ..small }).path()),
    );
    let same = |file: &str| few[Path::new(file)] == more[Path::new(file)];
    assert!(same("suites/M2b/M2b_03.csv") && same("excitation/excitation_001.csv"));
    assert!(same("validation/validation_001.csv") && same("poses/poses_001.csv"));
    assert!(!same("runs.csv"));
}

/// Whatever a stop leaves, the next start gives the bytes of a campaign without a stop.
#[test]
fn a_stopped_campaign_goes_on_to_the_same_bytes() {
    let options = CampaignOptions { poses: 2, friction: 0, ..small(7) };
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

    let few = CampaignOptions { poses: 0, friction: 0, excitation: 0, validation: 0, ..small(1) };
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
    for (options, words) in [
        (CampaignOptions { motions: 0, ..small(1) }, "motions: 0 is not in 1"),
        (CampaignOptions { start_points: 27, ..small(1) }, "27 is not in 1 to 26"),
        (CampaignOptions { runs: 0, ..small(1) }, "runs: 0 is not in 1"),
        (CampaignOptions { longest: f64::NAN, ..small(1) }, "NaN s; give 0.1 to 3600 s"),
    ] {
        let error = run(&options, folder.path()).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    assert!(files(folder.path()).is_empty());
}
