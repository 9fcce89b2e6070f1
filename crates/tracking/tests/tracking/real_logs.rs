//! Recordings of a real arm, which are ignored unless requested.

use std::path::Path;

use reachtube_recordings::{ColumnSettings, LogSettings};
use reachtube_tracking::Reading;

use crate::common::made;

#[test]
#[ignore = "needs the recordings in ../shared"]
fn a_ur3e_follows_its_command_within_a_third_of_a_milliradian() {
    let logs =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/raw_logs/ur3e_rtde");
    let names = [
        "torqueData_05f_allJoints.csv",
        "torqueData_100v_40a.csv",
        "wave_torqueData_100v_40a.csv",
        "wave_currentData_100v_40a.head.csv",
    ];
    let (columns, log) = (ColumnSettings::default(), LogSettings::default());
    let reading = Reading { axes: None, columns: &columns, log: &log, until: None };
    let (recordings, _) = reading.read(&names.map(|name| logs.join(name))).unwrap();
    let made = made(&recordings);
    let model = &made.model;
    assert_eq!((model.joints.len(), model.left_out.motions), (6, 20));
    assert!(made.is_useful() && model.verified, "{:?}", made.findings);
    assert!(model.mean_half_width() <= 0.37e-3, "{}", model.mean_half_width());
    let without = model.mean_without_model();
    assert!((0.75e-3..0.9e-3).contains(&without), "{without}");
    assert!(model.check(&recordings).unwrap().conformant);
}
