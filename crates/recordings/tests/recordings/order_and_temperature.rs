//! Runs know their place in the order of recording and the temperatures of their joints.

use std::fs::write;
use std::path::Path;

use reachtube_recordings::{DataSet, GapLimit, ReadOptions, RunSource, inspect, read_csv};

const HEADER: &str = "t,q1,q2,qd1,qd2,tau1,tau2";

/// Writes a recording with further columns, given as header and values of two samples.
fn recording(folder: &Path, name: &str, header: &str, values: [&str; 2]) {
    let line = |t: f64, values: &str| format!("{t},0.1,0.2,0,0,1,2{values}\n");
    let text = format!("{HEADER}{header}\n{}{}", line(0.0, values[0]), line(0.1, values[1]));
    write(folder.join(name), text).unwrap();
}

/// Returns the temperatures that are read with these columns, or the defects as text.
fn temperatures(header: &str, values: [&str; 2]) -> Result<Vec<f64>, String> {
    let folder = tempfile::tempdir().unwrap();
    recording(folder.path(), "run.csv", header, values);
    read_csv(&folder.path().join("run.csv"), &ReadOptions::default())
        .map(|run| run.temperatures)
        .map_err(|defects| defects.iter().map(|defect| format!("{defect}\n")).collect())
}

#[test]
fn temperatures_are_read_wherever_they_stand_after_the_torques() {
    let read = temperatures(",temp1,temp2", [",20.5,30", ",21,31"]).unwrap();
    assert_eq!(read, [20.5, 30.0, 21.0, 31.0]);
    let read = temperatures(",note,temp1,temp2", [",x,20.5,30", ",y,21,31"]).unwrap();
    assert_eq!(read, [20.5, 30.0, 21.0, 31.0]);
    assert_eq!(temperatures(",temperature", [",x", ",y"]).unwrap().capacity(), 0);
}

#[test]
fn temperatures_that_are_missing_or_impossible_are_defects() {
    let one = temperatures(",temp1", [",20", ",20"]).unwrap_err();
    let expected = "column 9 of the header is missing, expected \"temp2\"; give one temperature";
    assert!(one.contains(expected), "{one}");
    let empty = temperatures(",temp1,temp2", [",20,30", ",20,"]).unwrap_err();
    assert!(empty.contains("run.csv:3: joint 2: temp2 is empty; every value"), "{empty}");
    let nan = temperatures(",temp1,temp2", [",nan,30", ",20,30"]).unwrap_err();
    assert!(nan.contains("run.csv:2: joint 1: temp1 is \"nan\", not a finite number"), "{nan}");
    let kelvin = temperatures(",temp1,temp2", [",300,30", ",301,30"]).unwrap_err();
    let expected = "run.csv:2: joint 1: temp1 is 300, which no joint has in °C; give temp";
    assert!(kelvin.contains(expected) && kelvin.lines().count() == 1, "{kelvin}");
}

#[test]
fn an_inspection_shows_order_temperatures_and_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let header = ",temp1,temp2";
    recording(folder.path(), "a.csv", header, [",20,30", ",21,30"]);
    recording(folder.path(), "b.csv", header, [",25,30", ",24,30"]);
    recording(folder.path(), "c.csv", "", ["", ""]);
    let index = "file,suite,repeat,order\na.csv,A,1,4\nb.csv,A,2,3\nc.csv,A,3,9\n";
    write(folder.path().join("runs.csv"), index).unwrap();
    let data = DataSet::open(folder.path()).unwrap();
    let orders: Vec<u64> = data.runs().iter().map(|run| run.order).collect();
    assert_eq!(orders, [4, 3, 9]);
    let inspection = inspect(&data, GapLimit::Usual);
    let group = &inspection.groups[0];
    assert_eq!((group.runs, group.order), (3, [3, 9]));
    assert_eq!(group.joints[0].temperature, Some([20.0, 25.0]));
    let note = "suite A: 1 of 3 recordings have no temperatures, for example c.csv";
    assert!(inspection.notes.iter().any(|found| found.starts_with(note)), "{inspection:?}");
}

#[test]
fn drift_follows_the_order_of_recording() {
    let folder = tempfile::tempdir().unwrap();
    let mut index = String::from("file,suite,order\n");
    for (order, end) in [(3, 0.3), (1, 0.1), (2, 0.2)] {
        let text = format!("t,q1,qd1,tau1\n0,0,0,0\n0.1,{end},0,{order}\n");
        write(folder.path().join(format!("{order}.csv")), text).unwrap();
        index += &format!("{order}.csv,A,{order}\n");
    }
    write(folder.path().join("runs.csv"), index).unwrap();
    let inspection = inspect(&DataSet::open(folder.path()).unwrap(), GapLimit::Usual);
    let drift = inspection.groups[0].joints[0].drift.unwrap();
    assert!((drift - 1.0).abs() < 1e-12, "{drift}");
}
