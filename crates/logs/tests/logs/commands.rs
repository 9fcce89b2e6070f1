//! Commanded and actual positions of MCAP and rosbag2 logs.

use std::path::Path;

use reachtube_logs::{Commands, Error, read_commands};
use reachtube_recordings::{
    GapLimit, LogSettings, LogTime, Logged, LoggedOptions, Wanted, parse_logged,
};

use crate::support::*;

const CONTROLLER: &str = "control_msgs/msg/JointTrajectoryControllerState";
const START: i64 = 1_700_000_000 * SECOND;

/// Encodes the state of a controller with commanded and actual positions, and what follows them in
/// the newer versions of the message.
fn controller_state(stamp: i64, names: &[&str], positions: [&[f64]; 2]) -> Vec<u8> {
    let mut out = Encoder::new(false)
        .u32((stamp / SECOND) as u32)
        .u32((stamp % SECOND) as u32)
        .string("")
        .u32(names.len() as u32);
    for name in names {
        out = out.string(name);
    }
    for positions in positions.into_iter().chain([&[][..], &[]]) {
        out = out.doubles(positions).doubles(&[0.5]).doubles(&[]).doubles(&[]).u32(7).u32(9);
    }
    out.u32(0).end()
}

/// Returns states of a controller of the joints a and b, which follow `a = k`, `b = -k` in
/// milliradians, and lag by 1 mrad.
fn states(topic: &str, count: i64) -> Vec<Message> {
    let message = |k: i64| {
        let stamp = START + k * 10_000_000;
        let [a, b] = [1e-3, -1e-3].map(|rate| rate * k as f64);
        let turned = k % 2 == 1;
        let data = match turned {
            false => controller_state(stamp, &["a", "b"], [&[a, b], &[a - 1e-3, b + 1e-3]]),
            true => controller_state(stamp, &["b", "a"], [&[b, a], &[b + 1e-3, a - 1e-3]]),
        };
        Message::new(topic, CONTROLLER, stamp + 500_000, data)
    };
    (0..count).map(message).collect()
}

/// Returns joint states with a position of the joint a.
fn positions(topic: &str, samples: &[(i64, f64)]) -> Vec<Message> {
    let message = |(stamp, a): &(i64, f64)| {
        let state = State::new(START + stamp, &["a"], [&[*a], &[], &[]]);
        Message::new(topic, JOINT_STATE, state.stamp, state.encode(false))
    };
    samples.iter().map(message).collect()
}

fn parsed(path: &Path, commands: Commands) -> Logged {
    let options = LoggedOptions {
        robot: None,
        joints: &[],
        columns: &commands.columns,
        gains: false,
        wanted: Wanted::Commands,
        gap_limit: GapLimit::Seconds(f64::INFINITY),
        until: None,
    };
    parse_logged(path, commands.text, &options).unwrap()
}

fn read(path: &Path, settings: &LogSettings, joints: &[&str]) -> Result<Commands, Error> {
    let joints: Vec<String> = joints.iter().map(|joint| (*joint).into()).collect();
    read_commands(path, settings, &joints, Wanted::Commands)
}

#[test]
fn a_controllers_state_has_both_positions() {
    let folder = tempfile::tempdir().unwrap();
    let mut messages = states("/arm_controller/state", 50);
    // A log may have a message twice, and one later than it was sent.
    messages.insert(7, messages[6].clone());
    for path in [mcap(folder.path(), "zstd", &messages), bag(folder.path(), &messages)] {
        let commands = read(&path, &LogSettings::default(), &[]).unwrap();
        assert!(commands.notes[0].contains("/arm_controller/state"), "{:?}", commands.notes);
        assert!(commands.notes[1].contains("1 messages were sorted"), "{:?}", commands.notes);
        assert_eq!(commands.joints, ["a", "b"]);
        let logged = parsed(&path, commands);
        assert_eq!((logged.run.len(), logged.run.start), (50, 1.7e9));
        for k in 0..50 {
            let a = 1e-3 * k as f64;
            assert_eq!(logged.run.times[k], (10 * k) as f64 / 1e3);
            assert_eq!(logged.command[2 * k..][..2], [a, -a]);
            assert_eq!(logged.run.q(k), [a - 1e-3, -a + 1e-3]);
        }
    }
}

#[test]
fn two_topics_are_joined_at_the_slower_one() {
    let folder = tempfile::tempdir().unwrap();
    // Commands every 20 ms, states every 2 ms and 0.5 ms beside them, with a gap.
    let commands: Vec<(i64, f64)> = (0..40).map(|k| (k * 20_000_000, 2e-2 * k as f64)).collect();
    let state = |k: i64| (k * 2_000_000 - 500_000, 1e-3 * (2.0 * k as f64 - 0.5));
    let states: Vec<_> = (0..400).filter(|k| !(95..105).contains(k)).map(state).collect();
    let mut messages = positions("/joint_states", &states);
    messages.extend(positions("/joint_commands", &commands));
    let path = mcap(folder.path(), "none", &messages);
    let found = read(&path, &LogSettings::default(), &[]).unwrap();
    assert!(found.notes[0].contains("/joint_commands, /joint_states"), "{:?}", found.notes);
    assert!(found.notes[1].contains("1 samples have no partner"), "{:?}", found.notes);
    let logged = parsed(&path, found);
    assert_eq!(logged.run.len(), 39);
    for k in 0..39 {
        let expected = logged.run.times[k];
        assert!((logged.run.q(k)[0] - expected).abs() < 1e-12, "{k}");
        assert!((logged.command[k] - expected).abs() < 1e-12, "{k}");
    }
    // A plan has the commands alone, at their own stamps.
    let plan = read_commands(&path, &LogSettings::default(), &[], Wanted::Plan).unwrap();
    let text = String::from_utf8(plan.text).unwrap();
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!((rows.len(), rows[0]), (41, "t,commanded_position_0"));
    assert_eq!(rows[40], format!("{},{}", START + 39 * 20_000_000, 2e-2 * 39.0));
    // Names of topics that do not tell are given, the commands last.
    let swapped = [("/joint_states", "/x"), ("/joint_commands", "/y")];
    for message in &mut messages {
        let (_, name) = swapped.iter().find(|(old, _)| message.topic == *old).unwrap();
        message.topic = (*name).into();
    }
    let path = mcap(folder.path(), "lz4", &messages);
    let error = read(&path, &LogSettings::default(), &[]).unwrap_err().to_string();
    assert!(error.contains("no topic has commanded positions"), "{error}");
    assert!(error.contains("--topic STATE COMMAND") && error.contains("/x"), "{error}");
    let settings = LogSettings { topic: vec!["/x".into(), "/y".into()], ..LogSettings::default() };
    let named = parsed(&path, read(&path, &settings, &[]).unwrap());
    assert_eq!((named.run.states, named.command), (logged.run.states, logged.command));
}

#[test]
fn the_joints_decide_among_several_controllers() {
    let folder = tempfile::tempdir().unwrap();
    let mut messages = states("/arm/state", 20);
    let gripper = |k: i64| {
        let data = controller_state(START + k, &["finger"], [&[0.0], &[0.1]]);
        Message::new("/gripper/state", CONTROLLER, START + k, data)
    };
    messages.extend((1..20).map(gripper));
    let path = mcap(folder.path(), "zstd", &messages);
    let read = |settings: &LogSettings, joints: &[&str]| read(&path, settings, joints);
    let none = LogSettings::default();
    let error = read(&none, &[]).unwrap_err();
    assert!(matches!(&error, Error::SeveralTopics { topics, .. } if topics.len() == 2), "{error}");
    let of_robot = read(&none, &["b", "a"]).unwrap();
    assert_eq!(of_robot.joints, ["b", "a"]);
    assert_eq!(parsed(&path, of_robot).command[2..4], [-1e-3, 1e-3]);
    let by_topic = LogSettings { topic: vec!["/gripper/state".into()], ..none.clone() };
    assert_eq!(read(&by_topic, &[]).unwrap().joints, ["finger"]);
    let both =
        LogSettings { topic: vec!["/arm/state".into(), "/gripper/state".into()], ..none.clone() };
    assert!(matches!(read(&both, &["a", "b"]), Err(Error::Setting(_))));
    // The log's names in the robot's order.
    let renamed = LogSettings { joints: vec!["b".into(), "a".into()], ..none.clone() };
    assert_eq!(read(&renamed, &["j1", "j2"]).unwrap().joints, ["b", "a"]);
    let absent = read(&none, &["elbow"]).unwrap_err();
    assert!(matches!(absent, Error::NoCommands { .. }), "{absent}");
    let marked = LogSettings { marker: Some("/run".into()), ..none };
    assert!(matches!(read(&marked, &[]), Err(Error::Setting(_))));
}

#[test]
fn times_may_be_those_of_receipt() {
    let folder = tempfile::tempdir().unwrap();
    let mut messages = states("/state", 5);
    for (k, message) in (0..).zip(&mut messages) {
        message.received = START + 1_000_000 * k;
        message.data[4..12].fill(0);
    }
    let path = mcap(folder.path(), "none", &messages);
    let error = read(&path, &LogSettings::default(), &[]).unwrap_err();
    assert!(matches!(error, Error::ZeroStamps { .. }), "{error}");
    let settings = LogSettings { time: LogTime::Receipt, ..LogSettings::default() };
    let logged = parsed(&path, read(&path, &settings, &[]).unwrap());
    assert_eq!(logged.run.times, [0.0, 0.001, 0.002, 0.003, 0.004]);
    // A cut message, and one with too few positions.
    messages[3].data.truncate(40);
    let path = mcap(folder.path(), "none", &messages);
    assert!(matches!(read(&path, &settings, &[]), Err(Error::Damaged(_))));
    messages[3].data = controller_state(START, &["a", "b"], [&[0.0, 0.0], &[0.0]]);
    let path = mcap(folder.path(), "none", &messages);
    let commands = read(&path, &settings, &[]).unwrap();
    assert!(commands.notes[1].contains("1 messages have no position"), "{:?}", commands.notes);
}

#[test]
fn what_is_not_used_is_counted_and_what_cannot_be_joined_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let samples: Vec<(i64, f64)> = (0..20).map(|k| (k * 10_000_000, 0.1)).collect();
    let mut messages = positions("/joint_states", &samples);
    let commands = |stamps: &dyn Fn(i64) -> i64| -> Vec<Message> {
        let state = |k: i64| State::new(START + stamps(k), &["a", "x"], [&[0.1, 0.2], &[], &[]]);
        let message =
            |state: State| Message::new("/joint_commands", JOINT_STATE, START, state.encode(false));
        (0..20).map(|k| message(state(k))).collect()
    };
    messages.extend(commands(&|k| 10_000_000 * k + 1));
    let twice = State::new(START, &["a", "a"], [&[0.1, 0.2], &[], &[]]).encode(false);
    messages.push(Message::new("/joint_states", JOINT_STATE, START, twice));
    let path = mcap(folder.path(), "none", &messages);
    let notes = read(&path, &LogSettings::default(), &[]).unwrap().notes.join("\n");
    for part in ["1 messages have no position", "x are in one topic only"] {
        assert!(notes.contains(part), "{notes}");
    }
    messages.truncate(20);
    messages.extend(commands(&|k| 10_000_000 * (k % 7) + 1));
    let path = mcap(folder.path(), "none", &messages);
    let error = read(&path, &LogSettings::default(), &[]).unwrap_err().to_string();
    assert!(error.contains("the stamps of /joint_commands do not increase"), "{error}");
}
