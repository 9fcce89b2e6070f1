//! Messages out of order, topics with stamps of their own, and the topic that is found.

use crate::support::*;
use reachtube_logs::{Cutting, Log, LogOptions, convert};
use reachtube_recordings::{GapLimit, ReadOptions, Run, RunSource};

fn run_of(log: Log) -> Run {
    let logs = [log];
    let cuts = Cutting::Whole.runs(&logs).unwrap();
    let runs = convert(&logs, &cuts, GapLimit::Usual).unwrap().into_runs();
    runs.read(0, &ReadOptions::default()).unwrap()
}

#[test]
fn messages_out_of_order_are_sorted_by_the_times_of_receipt() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(40);
    let mut shuffled = messages(&states);
    shuffled.swap(3, 4);
    shuffled[20..30].reverse();
    let paths = [mcap(folder.path(), "zstd", &shuffled), bag(folder.path(), &shuffled)];
    for path in paths {
        let log = read(&path).unwrap();
        let notes = log.notes().join("\n");
        assert!(notes.contains("10 messages of /joint_states stand after later ones"), "{notes}");
        let run = run_of(log);
        assert_eq!(run.len(), states.len());
        for (k, state) in states.iter().enumerate() {
            assert_eq!([run.state(k), run.torque(k)].concat(), expected(state), "{k}");
        }
    }
}

/// Returns messages of two topics: positions and velocities, and efforts `shift` ns later. Every
/// value is a line of the time of its own message, with another slope for each joint.
fn two_topics(shift: i64, missing: Option<usize>) -> Vec<Message> {
    let names = ["a", "b", "c"];
    let line = |stamp: i64, slope: f64| slope * stamp as f64 / 1e9;
    let mut all = vec![];
    for k in 0..50 {
        let stamp = 10_000_000 * k as i64 + SECOND;
        let rows = |stamp: i64, from: f64| names.map(|_| 0).map(|_| line(stamp, from));
        let state = State::new(stamp, &names, [&rows(stamp, 1.0), &rows(stamp, 2.0), &[]]);
        all.extend(messages(&[state]));
        let late = stamp + shift;
        let effort = State::new(late, &names, [&[], &[], &rows(late, 3.0)]);
        if missing != Some(k) {
            let message = messages(&[effort]).remove(0);
            all.push(Message { topic: "/efforts".into(), ..message });
        }
    }
    all
}

fn both(folder: &tempfile::TempDir, messages: &[Message]) -> Log {
    let topics = vec![TOPIC.into(), "/efforts".into()];
    Log::read(&mcap(folder.path(), "lz4", messages), &LogOptions { topics, ..options() }).unwrap()
}

#[test]
fn topics_whose_stamps_differ_by_less_than_half_a_sample_are_interpolated() {
    let folder = tempfile::tempdir().unwrap();
    for shift in [4_000_000, -4_900_000] {
        let log = both(&folder, &two_topics(shift, None));
        let notes = log.notes().join("\n");
        let words = format!("its own differ by up to {:.3} ms", shift.abs() as f64 / 1e6);
        assert!(notes.contains(&words), "{notes}");
        assert!(notes.contains("the values of /efforts were interpolated at"), "{notes}");
        let run = run_of(log);
        assert_eq!(run.len(), 49);
        for k in 0..run.len() {
            // Interpolation gives a line back: efforts belong to the stamps of the positions.
            assert!((run.torque(k)[1] - 3.0 * run.q(k)[1]).abs() < 1e-12, "{k}");
        }
    }
}

#[test]
fn topics_further_apart_and_missing_messages_are_not_interpolated() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |messages: &[Message]| {
        let logs = [both(&folder, messages)];
        convert(&logs, &Cutting::Whole.runs(&logs).unwrap(), GapLimit::Usual)
            .unwrap_err()
            .to_string()
    };
    let text = refused(&two_topics(4_000_000, Some(20)));
    assert!(text.contains("/efforts has no message with its stamp"), "{text}");
    assert!(text.contains("differ by at most half a sample"), "{text}");
    // Every second effort alone: the stamps between are a whole sample away.
    let mut count = 0;
    let mut slow = two_topics(4_000_000, None);
    slow.retain(|message| {
        count += usize::from(message.topic == "/efforts");
        message.topic != "/efforts" || count % 2 == 0
    });
    assert!(refused(&slow).contains("/efforts has no message with its stamp"));
}

#[test]
fn the_only_topic_with_joints_of_the_robot_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(10);
    let any = LogOptions { topics: vec![], ..options() };
    let mut all = messages(&states);
    let foreign = State::new(5, &["finger"], [&[1.0], &[0.0], &[0.0]]);
    let gripper = messages(&[foreign]).remove(0);
    all.insert(0, Message { topic: "/gripper".into(), ..gripper });
    for path in [mcap(folder.path(), "zstd", &all), bag(folder.path(), &all)] {
        let log = Log::read(&path, &any).unwrap();
        assert_eq!(log.len(), 10);
        assert_eq!(run_of(log).torque(3), &expected(&states[3])[6..]);
    }
    let copy = Message { topic: "/copy".into(), ..all[1].clone() };
    all.push(copy);
    let several = Log::read(&mcap(folder.path(), "none", &all), &any).unwrap_err().to_string();
    assert!(several.contains("2 topics name joints of the robot: "), "{several}");
    assert!(several.contains("/joint_states") && several.contains("/copy"), "{several}");
    assert!(several.contains("--topic"), "{several}");
}

#[test]
fn messages_that_are_compressed_by_themselves_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let (states, mut all) = (states(40), messages(&states(40)));
    for message in &mut all {
        message.data = zstd::encode_all(&*message.data, 3).unwrap();
    }
    let run = run_of(read(&bag(folder.path(), &all)).unwrap());
    assert_eq!((run.len(), run.torque(39)), (40, &expected(&states[39])[6..]));
    let half = all[7].data.len() / 2;
    all[7].data.truncate(half);
    let damaged = tempfile::tempdir().unwrap();
    let text = error(&bag(damaged.path(), &all));
    assert!(text.contains("message 8") && text.contains("compression by zstd is dam"), "{text}");
}

#[test]
fn files_that_are_compressed_as_a_whole_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(40);
    for (name, path) in [
        ("day.mcap.zstd", mcap(folder.path(), "none", &messages(&states))),
        ("bag_0.db3.zstd", bag(folder.path(), &messages(&states))),
    ] {
        let plain = std::fs::read(path).unwrap();
        let compressed = zstd::encode_all(&*plain, 3).unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, &compressed).unwrap();
        let run = run_of(read(&path).unwrap());
        assert_eq!((run.len(), run.torque(39)), (40, &expected(&states[39])[6..]));
        std::fs::write(&path, &compressed[..compressed.len() / 2]).unwrap();
        let text = error(&path);
        assert!(text.contains(name) && text.contains("its compression by zstd is dam"), "{text}");
        // A frame of which a part is missing gives nothing back.
        let recover = || Log::read(&path, &LogOptions { recover: true, ..options() });
        let nothing = recover().unwrap_err().to_string();
        assert!(nothing.contains("the file is empty, so nothing can be recovered"), "{nothing}");
        // The frames before it give their part of the log.
        let (first, second) = plain.split_at(plain.len() / 2);
        let [first, mut second] = [first, second].map(|part| zstd::encode_all(part, 3).unwrap());
        second.truncate(second.len() / 2);
        std::fs::write(&path, [first, second].concat()).unwrap();
        let run = run_of(recover().unwrap());
        assert!((5..35).contains(&run.len()), "{name}: {}", run.len());
        assert_eq!(run.torque(4), &expected(&states[4])[6..]);
    }
}
