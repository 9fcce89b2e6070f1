//! Logs cut into runs: by intervals, by markers and by repeats.

use std::path::Path;

use crate::support::*;
use reachtube_logs::{Cut, Cutting, Intervals, Log, LogOptions, convert, find_repeats};
use reachtube_recordings::{DataSet, GapLimit, RunSource};

/// Returns a log of 100 states, 1 s long.
fn log(folder: &Path) -> Log {
    read(&mcap(folder, "zstd", &messages(&states(100)))).unwrap()
}

/// Returns the first and the last sample, and the suite, of each run.
fn named(cuts: &[Cut]) -> Vec<(usize, usize, &str)> {
    let parts =
        |cut: &Cut| (cut.samples.start, cut.samples.end - 1, cut.suite.clone().unwrap_or_default());
    let parts = cuts.iter().map(parts);
    parts.map(|(first, last, suite)| (first, last, &*Box::leak(suite.into_boxed_str()))).collect()
}

#[test]
fn intervals_count_from_the_start_or_are_stamps() {
    let folder = tempfile::tempdir().unwrap();
    let logs = [log(folder.path())];
    let list = folder.path().join("list.csv");
    let runs = |text: &str| {
        std::fs::write(&list, text).unwrap();
        Intervals::read(&list).and_then(|list| list.runs(&logs))
    };
    let cuts = runs("start,end,suite,motion\n0,0.2,A,m\n0.5, 0.6 ,B,\n0.9,,,\n").unwrap();
    assert_eq!(named(&cuts), [(0, 19, "A"), (50, 59, "B"), (90, 99, "")]);
    assert_eq!(cuts[0].motion.as_deref(), Some("m"));
    let cuts = runs("log,start_stamp,end_stamp\nzstd.mcap,1700000000.1,1700000000.3\n").unwrap();
    assert_eq!(named(&cuts), [(10, 29, "")]);
    let refused = |text: &str| runs(text).unwrap_err().to_string();
    for (text, words) in [
        ("begin,end\n0,1\n", "list.csv:1: \"begin,end\" is no header of it"),
        ("start,end\n", "list.csv:1: no interval is listed"),
        ("start,end\n0,0.1\nx,1\n", "list.csv:3: \"x\" is not a number of seconds"),
        ("start,end\n0.5,0.5\n", "list.csv:2: the interval ends before it starts"),
        ("start,end\n0.5,1.5\n", "list.csv:2: the interval reaches 1.5 s, but the last sample of"),
        ("start,end\n0.101,0.102\n", "list.csv:2: no sample of"),
        ("start_stamp,end_stamp\n5,6\n", "list.csv:2: the interval is in no log"),
        ("start,end,log\n0,0.1,other.mcap\n", "list.csv:2: the interval is in no log"),
        ("start,end,suite,motion\n0,0.1,A,m\n0.2,0.3,A,n\n", "list.csv:3: suite A has another"),
        ("start,end\n0\n", "list.csv"),
    ] {
        assert!(refused(text).contains(words), "{text}: {}", refused(text));
    }
}

#[test]
fn intervals_leave_out_samples_that_cannot_be_used() {
    let folder = tempfile::tempdir().unwrap();
    let mut states = states(100);
    states[3].values[0][0] = f64::NAN;
    let logs = [read(&mcap(folder.path(), "zstd", &messages(&states))).unwrap()];
    let list = folder.path().join("list.csv");
    std::fs::write(&list, "start,end\n0.05,0.9\n").unwrap();
    let cuts = Intervals::read(&list).unwrap().runs(&logs).unwrap();
    let written = convert(&logs, &cuts, GapLimit::Usual).unwrap().write(folder.path()).unwrap();
    assert_eq!((written[0].samples, written[0].file.as_str()), (85, "0001_zstd.csv"));
}

/// Returns the runs that markers mark, in a log of [`states`].
fn marked(markers: &[Message]) -> Vec<Cut> {
    let folder = tempfile::tempdir().unwrap();
    let mut all = messages(&states(100));
    all.extend(markers.iter().cloned());
    all.sort_by_key(|message| message.received);
    let path = bag(folder.path(), &all);
    let options = LogOptions { marker: Some("/marker".into()), ..options() };
    Cutting::Marked.runs(&[Log::read(&path, &options).unwrap()]).unwrap_or_default()
}

/// Returns a time after the first state, ns.
fn at(milliseconds: i64) -> i64 {
    1_700_000_000 * SECOND + milliseconds * 1_000_000
}

#[test]
fn markers_name_runs_by_their_text() {
    let markers = [(100, "A"), (150, "A"), (300, ""), (400, "B"), (500, "A"), (600, " ")];
    let cuts = marked(&markers.map(|(time, text)| Message::string(at(time), text)));
    assert_eq!(named(&cuts), [(10, 29, "A"), (40, 49, "B"), (50, 59, "A")]);
    let open = marked(&[Message::string(at(900), "last")]);
    assert_eq!(named(&open), [(90, 99, "last")]);
    assert!(marked(&[Message::string(at(5000), "late")]).is_empty());
}

#[test]
fn markers_may_be_numbers_and_truth_values() {
    let int = |(time, number): (i64, i32)| {
        let data = Encoder::new(false).u32(number.cast_unsigned()).end();
        Message::new("/marker", "std_msgs/msg/Int32", at(time), data)
    };
    let cuts = marked(&[(100, 3), (200, -1), (300, 0)].map(int));
    assert_eq!(named(&cuts), [(10, 19, "3"), (20, 29, "-1")]);
    let bool = |(time, byte): (i64, u8)| {
        let data = Encoder::new(false).byte(byte).end();
        Message::new("/marker", "std_msgs/msg/Bool", at(time), data)
    };
    let cuts = marked(&[(100, 1), (200, 0), (300, 1), (400, 0)].map(bool));
    assert_eq!(named(&cuts), [(10, 19, ""), (30, 39, "")]);
}

/// Returns states at 100 Hz in which joint a moves by the amounts given, each in 1 s with 1 s of
/// rest before it.
fn moving(amounts: &[f64]) -> Vec<State> {
    let mut from = 0.0;
    let mut states = vec![];
    let mut time = 1_000 * SECOND;
    for (number, amount) in amounts.iter().enumerate() {
        // Motions start between samples, each at another place.
        let late = 0.003 * (number % 3) as f64;
        for k in 0..200 {
            let t = (0.01 * f64::from(k) - 1.0 - late).clamp(0.0, 1.0);
            let turn = std::f64::consts::TAU * t;
            let q = from + amount * (t - turn.sin() / std::f64::consts::TAU);
            let qd = amount * (1.0 - turn.cos());
            let values: [&[f64]; 3] = [&[q, 0.5, 0.0], &[qd, 0.0, 0.0], &[qd, 1.0, 2.0]];
            states.push(State::new(time, &["a", "b", "c"], values));
            time += SECOND / 100;
        }
        from += amount;
    }
    states
}

#[test]
fn motions_that_repeat_become_suites() {
    let folder = tempfile::tempdir().unwrap();
    // There and back three times, and once somewhere else.
    let states = moving(&[1.0, -1.0, 1.0, -1.0, 0.6, -0.6, 1.0, -1.0]);
    let logs = [read(&mcap(folder.path(), "zstd", &messages(&states))).unwrap()];
    let mut cuts = Cutting::Motions(0.01).runs(&logs).unwrap();
    assert_eq!(cuts.len(), 8);
    let found = find_repeats(&logs, &mut cuts, true);
    let suites: Vec<&str> = named(&cuts).into_iter().map(|(_, _, suite)| suite).collect();
    let [out, back] = ["repeat_1", "repeat_2"];
    assert_eq!(suites, [out, back, out, back, "", "", out, back]);
    for repeats in &found {
        assert!(repeats.runs == 3 && repeats.correlation > 0.999, "{repeats:?}");
        assert!(repeats.start_spread < 1e-3 && repeats.lag <= 0.011, "{repeats:?}");
    }
    convert(&logs, &cuts, GapLimit::Usual).unwrap().write(folder.path()).unwrap();
    let data = DataSet::open(folder.path()).unwrap();
    let runs: Vec<_> = data.suites()[0]
        .runs
        .iter()
        .map(|run| data.read(*run, &Default::default()).unwrap())
        .collect();
    for k in 0..100 {
        let apart = (runs[0].q(k)[0] - runs[1].q(k)[0]).abs();
        assert!(apart < 0.02, "sample {k}: {apart}");
    }
    let none = Cutting::Motions(5.0).runs(&logs).unwrap_err().to_string();
    assert!(none.contains("no joint is as fast as 5 rad/s"), "{none}");
}

#[test]
fn marked_runs_are_grouped_where_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let states = moving(&[1.0, -1.0, 1.0, -1.0]);
    let logs = [read(&mcap(folder.path(), "lz4", &messages(&states))).unwrap()];
    let list = folder.path().join("list.csv");
    std::fs::write(&list, "start,end,suite\n0.9,2.1,\n4.9,6.1,\n2.9,4.1,given\n").unwrap();
    let mut cuts = Intervals::read(&list).unwrap().runs(&logs).unwrap();
    let before: Vec<_> = cuts.iter().map(|cut| cut.samples.clone()).collect();
    let found = find_repeats(&logs, &mut cuts, false);
    assert_eq!((found.len(), found[0].runs), (1, 2));
    let suites: Vec<&str> = named(&cuts).into_iter().map(|(_, _, suite)| suite).collect();
    assert_eq!(suites, ["repeat_1", "repeat_1", "given"]);
    assert_eq!(before, cuts.iter().map(|cut| cut.samples.clone()).collect::<Vec<_>>());
}
