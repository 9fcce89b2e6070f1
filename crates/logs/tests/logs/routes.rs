//! A log gives the same runs as CSV files of it, to the last bit.

use std::path::Path;

use crate::support::*;
use reachtube_logs::{Cutting, Log, LogOptions, convert};
use reachtube_recordings::{DataSet, GapLimit, ReadOptions, Run, RunSource};

/// Converts a log and returns its run from memory and from the CSV file.
fn both_routes(path: &Path, options: &LogOptions) -> [Run; 2] {
    let logs = [Log::read(path, options).unwrap()];
    let cuts = Cutting::Whole.runs(&logs).unwrap();
    let recorded = convert(&logs, &cuts, GapLimit::Usual).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let written = recorded.write(folder.path()).unwrap();
    let data = DataSet::open(folder.path()).unwrap();
    assert_eq!(data.runs()[0].sha256.as_ref(), Some(&written[0].sha256));
    let from_csv = data.read(0, &ReadOptions::default()).unwrap();
    assert_eq!(from_csv.sha256, written[0].sha256);
    assert!(data.notes().is_empty());
    let from_memory = recorded.into_runs().read(0, &ReadOptions::default()).unwrap();
    [from_memory, from_csv]
}

/// Checks that numbers are equal to the last bit.
fn equal_bits(found: &[f64], expected: &[f64]) {
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(found), bits(expected));
}

/// Checks a run against the states that were logged.
fn is_of(run: &Run, states: &[State]) {
    assert_eq!(run.len(), states.len());
    for (k, state) in states.iter().enumerate() {
        let values = expected(state);
        equal_bits(run.state(k), &values[..6]);
        equal_bits(run.torque(k), &values[6..]);
        let picoseconds = 1000 * i128::from(state.stamp - states[0].stamp);
        equal_bits(&run.times[k..=k], &[picoseconds as f64 / 1e12]);
    }
    equal_bits(&[run.start], &[states[0].stamp as f64 / 1e9]);
}

/// Returns states with the edges of the numbers.
fn edges() -> Vec<State> {
    let mut states = states(40);
    states[3].values[0] = vec![-0.0, 5e-324, f64::MAX, f64::MIN_POSITIVE];
    states[4].values[1] = vec![0.1 + 0.2, 1e22, 1e23, -1.0 / 3.0];
    states
}

#[test]
fn every_format_gives_the_logged_bits_by_both_routes() {
    let folder = tempfile::tempdir().unwrap();
    let states = edges();
    let mut paths: Vec<_> = ["none", "zstd", "lz4", "unchunked"]
        .map(|compression| mcap(folder.path(), compression, &messages(&states)))
        .into();
    paths.push(bag(folder.path(), &messages(&states)));
    for path in paths {
        both_routes(&path, &options()).iter().for_each(|run| is_of(run, &states));
    }
}

#[test]
fn big_endian_messages_give_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let states = edges();
    let mut big = messages(&states);
    big.iter_mut().zip(&states).for_each(|(message, state)| message.data = state.encode(true));
    let path = mcap(folder.path(), "zstd", &big);
    both_routes(&path, &options()).iter().for_each(|run| is_of(run, &states));
}

#[test]
fn the_parts_of_a_bag_are_one_log() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(40);
    let parts = [&states[..25], &states[25..]];
    for (number, part) in parts.into_iter().enumerate() {
        let path = mcap(folder.path(), "lz4", &messages(part));
        std::fs::rename(path, folder.path().join(format!("bag_{}.mcap", number + 9))).unwrap();
    }
    both_routes(folder.path(), &options()).iter().for_each(|run| is_of(run, &states));
}

#[test]
fn topics_complement_each_other_at_equal_stamps() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(40);
    let mut split = vec![];
    for (k, state) in states.iter().enumerate() {
        let motion = State {
            values: [&state.values[0], &state.values[1], &vec![]].map(Vec::clone),
            ..state.clone()
        };
        let effort =
            State { values: [&vec![], &vec![], &state.values[2]].map(Vec::clone), ..state.clone() };
        split.extend(messages(&[motion]));
        // The second topic begins later and ends earlier.
        if (3..38).contains(&k) {
            let [message] = <[Message; 1]>::try_from(messages(&[effort])).unwrap();
            split.push(Message { topic: "/efforts".into(), ..message });
        }
    }
    let path = mcap(folder.path(), "zstd", &split);
    let topics = vec![TOPIC.into(), "/efforts".into()];
    let options = LogOptions { topics, ..options() };
    both_routes(&path, &options).iter().for_each(|run| is_of(run, &states[3..38]));
    let log = Log::read(&path, &options).unwrap();
    assert!(log.notes().iter().any(|note| note.contains("5 samples at the start and the end")));
}

#[test]
fn the_notes_say_which_times_and_where_joints_were_found() {
    let folder = tempfile::tempdir().unwrap();
    let mut all = messages(&states(5));
    let foreign = State::new(1, &["wheel"], [&[1.0], &[], &[]]);
    all.extend(messages(&[foreign]));
    let log = read(&mcap(folder.path(), "zstd", &all)).unwrap();
    let notes = log.notes().join("\n");
    for words in [
        "times are the stamps in the headers; the log received the messages 0.001000000 s to \
         0.001000000 s later",
        "joints of /joint_states are matched by name: q1 = a (place 1), q2 = b (place 2), q3 = c \
         (place 3); the order of the names changes 4 times; not used: gripper, wheel",
        "1 of 6 messages of /joint_states name no joint of the robot and are not used",
    ] {
        assert!(notes.contains(words), "{notes}");
    }
    assert_eq!((log.len(), log.losses().len()), (5, 0));
}
