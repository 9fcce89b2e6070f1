//! What was understood of logs of all formats.

use std::path::Path;

use crate::support::*;
use reachtube_logs::inspect_logs;
use reachtube_recordings::{ColumnSettings, GapLimit, LogSettings, LoggedOptions, Wanted};

fn options(columns: &ColumnSettings) -> LoggedOptions<'_> {
    LoggedOptions {
        robot: None,
        joints: &[],
        columns,
        gains: false,
        wanted: Wanted::AnyTorques,
        gap_limit: GapLimit::Usual,
        until: None,
    }
}

#[test]
fn logs_of_all_formats_in_a_folder_are_summarised() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(40);
    mcap(folder.path(), "zstd", &messages(&states));
    bag(folder.path(), &messages(&states));
    let rows: String = (0..40).map(|k| format!("{}.0,0,0,0,1,1,1,5,5,5\n", k)).collect();
    let header = "t_ms,q_a,q_b,q_c,qd_a,qd_b,qd_c,tau_a,tau_b,tau_c\n";
    std::fs::write(folder.path().join("log.csv"), format!("{header}{rows}")).unwrap();
    let columns = ColumnSettings::default();
    let joints = ["a", "b", "c"].map(String::from).to_vec();
    let settings = LogSettings { joints, ..LogSettings::default() };
    let found = inspect_logs(folder.path(), &options(&columns), &settings).unwrap();
    assert!(found.inspection.refused.is_empty(), "{:?}", found.inspection.refused);
    assert_eq!((found.inspection.runs, found.inspection.joints), (3, 3));
    let of = |index: usize| (found.logs[index].separator, found.logs[index].samples);
    // In the order of their names.
    assert_eq!([of(0), of(1), of(2)], [("messages", 40), ("commas", 40), ("messages", 40)]);
    let log = &found.logs[2];
    assert_eq!(
        (log.tau[1].as_str(), log.time.as_str()),
        ("/joint_states/b/effort", "header.stamp")
    );
    assert_eq!(log.unused, ["gripper"]);
    let settings = LogSettings::default();
    let error = inspect_logs(folder.path(), &options(&columns), &settings).unwrap_err();
    assert!(error.to_string().contains("--robot"), "{error}");
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn logs_of_robots_are_understood() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/raw_logs");
    let columns = ColumnSettings::default();
    let options = options(&columns);
    let settings = LogSettings::default();
    let found = inspect_logs(&root.join("tiago"), &options, &settings).unwrap();
    let [log] = &found.logs[..] else { panic!("{:?}", found.inspection.refused) };
    assert_eq!((log.samples, log.files.len(), log.q.len(), log.tau.len()), (8022, 3, 8, 8));
    assert_eq!(log.joints[0], "torso_lift_joint");
    // One of them has lost single samples.
    let options = LoggedOptions { gap_limit: GapLimit::Seconds(0.1), ..options };
    let found = inspect_logs(&root.join("ur3e_rtde"), &options, &settings).unwrap();
    assert_eq!((found.inspection.refused.len(), found.logs.len()), (1, 4));
    assert!(found.inspection.refused[0].first.problem.contains("targets only"));
    let torques: Vec<&str> = found.logs.iter().map(|log| log.torque).collect();
    assert_eq!(torques, ["demanded", "demanded", "current", "demanded"]);
    assert!(found.logs.iter().all(|log| log.ratio.is_some_and(|r| (r - 1.0).abs() < 0.05)));
}
