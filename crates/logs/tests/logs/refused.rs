//! Refused contents of a log that is whole, and their messages.

use crate::support::*;
use reachtube_logs::{Cutting, Log, LogOptions, LogTime, convert};
use reachtube_recordings::GapLimit;

/// Returns the message of the error that converting these states gives.
fn refused(states: &[State]) -> String {
    refused_messages(&messages(states))
}

fn refused_messages(messages: &[Message]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let logs = match read(&mcap(folder.path(), "zstd", messages)) {
        Ok(log) => [log],
        Err(error) => return error.to_string(),
    };
    convert(&logs, &Cutting::Whole.runs(&logs).unwrap(), GapLimit::Usual).unwrap_err().to_string()
}

/// Returns 20 good states after a change.
fn changed(change: impl FnOnce(&mut Vec<State>)) -> Vec<State> {
    let mut states = states(20);
    change(&mut states);
    states
}

fn contains(text: &str, words: &[&str]) {
    words.iter().for_each(|words| assert!(text.contains(words), "{words}: {text}"));
}

#[test]
fn values_that_are_missing_are_refused_by_name() {
    let text = refused(&changed(|states| states[4].values[2].clear()));
    contains(
        &text,
        &["zstd.mcap: message 5 of /joint_states: its effort is empty; let the driver"],
    );
    let text = refused(&changed(|states| states.iter_mut().for_each(|s| s.values[1].clear())));
    contains(&text, &["message 1 of", "its velocity is empty (and 19 more messages likewise); "]);
    assert_eq!(text.lines().count(), 1, "{text}");
    let text = refused(&changed(|states| states[0].names[1] = "elbow".into()));
    contains(
        &text,
        &["joint 2: message 1 of /joint_states: it does not name the joint b; ", "--joints"],
    );
    let text = refused(&changed(|states| states[0].names[3] = "b".into()));
    contains(&text, &["joint 2: message 1 of /joint_states: it names the joint b twice"]);
    let text = refused(&changed(|states| states[1].values[0].truncate(3)));
    contains(&text, &["message 2 of /joint_states: its position has 3 values for 4 names"]);
}

#[test]
fn values_that_are_not_finite_are_refused_by_name() {
    let mut states = states(3);
    let place = states[2].names.iter().position(|name| name == "c").unwrap();
    states[2].values[1][place] = f64::INFINITY;
    states[2].values[0][place] = f64::NAN;
    let text = refused(&states);
    contains(&text, &["joint 3: message 3 of /joint_states: the velocity of c is inf, not a"]);
    contains(&text, &["the position of c is NaN, not a finite number; every value must be"]);
}

#[test]
fn times_that_do_not_increase_are_refused() {
    let text = refused(&changed(|states| states[7].stamp = states[6].stamp));
    contains(
        &text,
        &["message 8 of /joint_states: t = 1700000000.06", "s is the time of the message before"],
    );
    // The times of receipt follow the file, so that they cannot put the stamps in order.
    let mut swapped = messages(&states(20));
    let data = swapped[3].data.clone();
    swapped[3].data = std::mem::replace(&mut swapped[4].data, data);
    let text = refused_messages(&swapped);
    contains(&text, &["message 5 of", "is earlier than the message before", "times must increase"]);
    let text = refused(&changed(|states| drop(states.drain(5..9))));
    contains(&text, &["run from 1700000000.000000000 s: there is a gap of 0.05", "--max-gap"]);
}

#[test]
fn stamps_that_are_all_zero_have_a_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(20);
    let mut zero = messages(&states);
    for (message, state) in zero.iter_mut().zip(&states) {
        message.data = State { stamp: 0, ..state.clone() }.encode(false);
    }
    let path = mcap(folder.path(), "lz4", &zero);
    contains(&error(&path), &["all stamps in the headers of /joint_states are 0", "--time log"]);
    let options = LogOptions { time: LogTime::Receipt, ..options() };
    let logs = [Log::read(&path, &options).unwrap()];
    assert!(logs[0].notes()[0].contains("at which the log received the messages"));
    let cuts = Cutting::Whole.runs(&logs).unwrap();
    let run = convert(&logs, &cuts, GapLimit::Usual).unwrap().write(folder.path()).unwrap();
    assert_eq!(run[0].start, "1700000000.001000000");
}

#[test]
fn topics_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut all = messages(&states(3));
    all.push(Message::string(5, "A"));
    let path = mcap(folder.path(), "zstd", &all);
    let with = |topic: &str| LogOptions { topics: vec![topic.into()], ..options() };
    let error = |options: &LogOptions| Log::read(&path, options).unwrap_err().to_string();
    contains(
        &error(&with("/joints")),
        &[
            "there is no topic /joints; give one of /joint_states (sensor_msgs/msg/JointState), ",
            "/marker (std_msgs/msg/String)",
        ],
    );
    contains(&error(&with("/marker")), &["topic /marker has messages of type std_msgs/msg/String"]);
    let any = LogOptions { topics: vec![], ..options() };
    let other = vec![Message::string(5, "A")];
    let none = Log::read(&mcap(folder.path(), "lz4", &other), &any).unwrap_err().to_string();
    contains(&none, &["no topic has sensor_msgs/msg/JointState", "/marker (std_msgs/msg/String)"]);
    let marker = LogOptions { marker: Some("/none".into()), ..options() };
    contains(&error(&marker), &["there is no topic /none"]);
    let marker = LogOptions { marker: Some(TOPIC.into()), ..options() };
    contains(&error(&marker), &["the marker's topic is one of joint states"]);
    let joints = LogOptions { joints: vec!["x".into(), "y".into()], ..options() };
    contains(
        &error(&joints),
        &["names a joint of the robot (x, y), but these are named: a, b, c, gripper", "--joints"],
    );
    let twice = LogOptions { topics: vec![TOPIC.into(); 2], ..options() };
    contains(&error(&twice), &["topic /joint_states is given twice"]);
}

#[test]
fn topics_that_contradict_each_other_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut all = messages(&states(6));
    let copies: Vec<Message> =
        all.iter().map(|message| Message { topic: "/copy".into(), ..message.clone() }).collect();
    all.extend(copies);
    all.remove(8);
    let path = mcap(folder.path(), "zstd", &all);
    let options = LogOptions { topics: vec![TOPIC.into(), "/copy".into()], ..options() };
    let logs = [Log::read(&path, &options).unwrap()];
    let text = convert(&logs, &Cutting::Whole.runs(&logs).unwrap(), GapLimit::Usual)
        .unwrap_err()
        .to_string();
    contains(
        &text,
        &[
            "joint 1: message 1 of /joint_states: several topics have the position of a",
            "message 3 of /joint_states: /copy has no message with its stamp",
        ],
    );
    let receipt = LogOptions { time: LogTime::Receipt, ..options };
    let text = Log::read(&path, &receipt).unwrap_err().to_string();
    contains(&text, &["several topics are joined by the stamps of their headers"]);
}

#[test]
fn files_of_other_formats_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log");
    for (content, words) in [
        (&b"#ROSBAG V2.0\n"[..], "rosbags-convert"),
        (b"\x28\xb5\x2f\xfdxx", "its compression by zstd is damaged"),
        (b"", "the file is empty"),
        (b"t,q1,qd1,tau1\n", "neither MCAP nor SQLite"),
        (b"SQLite format 3\0", "its tables cannot be read"),
    ] {
        std::fs::write(&path, content).unwrap();
        contains(&error(&path), &[words]);
    }
    let other = Message::new(TOPIC, "sensor_msgs/JointState", 1, vec![]);
    contains(&refused_messages(&[other]), &["has messages of type sensor_msgs/JointState"]);
    let cut = Message {
        data: states(1)[0].encode(false)[..50].into(),
        ..messages(&states(1))[0].clone()
    };
    contains(
        &refused_messages(&[cut]),
        &["byte ", "message 1 of /joint_states cannot be read: it is cut short"],
    );
}
