//! Recordings written as CSV are read back as they were.

use std::fmt::Write as _;

use proptest::prelude::*;
use reachtube_recordings::{GapLimit, ReadOptions, Run, column_names, read_csv};

/// Returns the file of a recording with these times, ms, since `seconds`.
fn csv(run: &Run, milliseconds: &[u32], seconds: u64) -> String {
    let names: Vec<String> = column_names(run.joints).collect();
    let mut text = format!("t,{}\n", names.join(","));
    for (k, time) in milliseconds.iter().enumerate() {
        let _ = write!(text, "{}.{:03}", seconds + u64::from(time / 1000), time % 1000);
        for value in run.state(k).iter().chain(run.torque(k)) {
            let _ = write!(text, ",{value:?}");
        }
        text.push('\n');
    }
    text
}

/// Returns a run of up to 3 joints and 20 samples, and its times, ms, from 0.
fn recording() -> impl Strategy<Value = (Run, Vec<u32>)> {
    let value = -1e3..1e3;
    (1usize..4, prop::collection::vec(1u32..5000, 0..20)).prop_flat_map(move |(joints, steps)| {
        let count = (steps.len() + 1) * joints;
        let values = prop::collection::vec(value.clone(), 3 * count);
        values.prop_map(move |mut values| {
            let torques = values.split_off(2 * count);
            let mut times = vec![0];
            steps.iter().for_each(|step| times.push(times[times.len() - 1] + step));
            let seconds = times.iter().map(|time| f64::from(*time) / 1e3).collect();
            (Run::new(joints, seconds, values, torques).unwrap(), times)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn files_hold_runs_exactly_whenever_they_start(
        (run, times) in recording(),
        start in prop::sample::select(vec![0, 1, 1_700_000_000]),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        std::fs::write(&path, csv(&run, &times, start)).unwrap();
        let gap_limit = GapLimit::Seconds(5.0);
        let options = ReadOptions { gap_limit, ..ReadOptions::default() };
        let read = read_csv(&path, &options).unwrap();
        prop_assert_eq!(&read.times, &run.times);
        prop_assert_eq!((read.joints, read.states), (run.joints, run.states));
        prop_assert_eq!(read.torques, run.torques);
        prop_assert_eq!(read.start, start as f64);
    }
}
