//! The recordings of the paper's own robot, which are ignored unless requested.

use std::time::{Duration, Instant};

use crate::fixture::{Lab, Run};

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/schunk_lwa4p");

#[test]
#[ignore = "needs the recordings in ../shared"]
fn the_recordings_of_the_paper_are_enclosed() {
    let (lab, start) = (Lab::new(), Instant::now());
    let with = format!("--data {DATA} --suites A,B,D,E --torque compensated");
    let run = |arguments: String| -> Run { lab.run(&arguments).exits(0) };
    let model = run(format!("conform --robot lwa4p {with} --out model.json --json")).json();
    let check = run(format!("check --model model.json {with} --json")).json();
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
    assert_eq!((&model["verified"], &check["conformant"]), (&true.into(), &true.into()));
    // 937 + 703 + 234 + 1088 samples of 12 states.
    assert_eq!((&model["proof"]["rows"], &model["proof"]["runs"]), (&35_544.into(), &73.into()));
    assert_eq!((&check["rows"], &check["violations"]["count"]), (&35_544.into(), &0.into()));
}
