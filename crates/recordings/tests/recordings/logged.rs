//! Logs as robots and drivers write them: dialects, names, units, turns, and what is refused.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::PathBuf;

use reachtube_recordings::{
    Axis, ColumnSettings, GapLimit, Logged, LoggedOptions, Wanted, group_files, read_logged,
    table_files,
};
use tempfile::TempDir;

const SAMPLES: usize = 200;

/// Returns six joints with the limits of the Schunk LWA 4P.
fn arm() -> Vec<Axis> {
    let axis = |number: usize| Axis {
        name: format!("joint{number}"),
        is_revolute: true,
        units: ["rad", "rad/s", "N m"],
        position_limits: None,
        velocity_limit: Some(1.2),
    };
    (1..=6).map(axis).collect()
}

fn options<'a>(robot: Option<&'a [Axis]>, columns: &'a ColumnSettings) -> LoggedOptions<'a> {
    LoggedOptions {
        robot,
        joints: &[],
        columns,
        gains: false,
        wanted: Wanted::Torques,
        gap_limit: GapLimit::Usual,
        until: None,
    }
}

/// Returns position and velocity of a joint (from 0) at a time, rad and rad/s.
fn motion(joint: usize, t: f64) -> [f64; 2] {
    let phase = t + joint as f64;
    [phase.sin(), phase.cos()]
}

/// A log of six joints: its header, how its cells are joined, and its units.
struct Dialect<'a> {
    header: &'a str,
    separator: &'a str,
    between: &'a str,
    per_second: f64,
    start: f64,
    per_radian: f64,
}

const PLAIN: Dialect = Dialect {
    header: "",
    separator: ",",
    between: "\n",
    per_second: 1.0,
    start: 0.0,
    per_radian: 1.0,
};

impl Dialect<'_> {
    /// Writes time, positions, velocities, and torques of joint + 1 N m.
    fn text(&self) -> String {
        let mut text = format!("{}{}", self.header, self.between);
        for k in 0..SAMPLES {
            let t = 0.01 * k as f64;
            let mut cells =
                vec![format!("{}", self.start + (1e6 * t).round() / 1e6 * self.per_second)];
            for at in 0..2 {
                let cell = |joint| (motion(joint, t)[at] * self.per_radian).to_string();
                cells.extend((0..6).map(cell));
            }
            cells.extend((1..=6).map(|joint| joint.to_string()));
            write!(text, "{}{}", cells.join(self.separator), self.between).unwrap();
        }
        text
    }
}

fn names(pattern: &str, from: usize) -> Vec<String> {
    (from..from + 6).map(|joint| pattern.replace("{}", &joint.to_string())).collect()
}

/// Returns a header of time, positions, velocities and torques.
fn header(time: &str, patterns: [&str; 3], from: usize, separator: &str) -> String {
    let columns = patterns.iter().flat_map(|pattern| names(pattern, from));
    std::iter::once(time.to_string()).chain(columns).collect::<Vec<_>>().join(separator)
}

fn written(text: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

fn read(text: &str, options: &LoggedOptions) -> Result<Logged, String> {
    let (_folder, path) = written(text);
    read_logged(&[path], options)
        .map_err(|defects| defects.iter().map(|d| format!("{d}\n")).collect())
}

fn check(logged: &Logged) {
    let run = &logged.run;
    assert_eq!((run.joints, run.len()), (6, SAMPLES));
    for k in 0..SAMPLES {
        assert!((run.times[k] - 0.01 * k as f64).abs() < 1e-9);
        for joint in 0..6 {
            let [q, qd] = motion(joint, 0.01 * k as f64);
            assert!((run.q(k)[joint] - q).abs() < 1e-9, "{k} {joint}");
            assert!((run.qd(k)[joint] - qd).abs() < 1e-4, "{k} {joint}");
            assert_eq!(run.torque(k)[joint], joint as f64 + 1.0);
        }
    }
}

#[test]
fn dialects_of_many_drivers_are_one_recording() {
    let robot = arm();
    let columns = ColumnSettings::default();
    let rtde = ["actual_q_{}", "actual_dq_{}", "target_moment_{}"];
    let dialects = [
        Dialect { header: &header("timestamp", rtde, 0, ","), between: "\n\n", ..PLAIN },
        Dialect {
            header: &header("timestamp", ["q_{}", "qd_{}", "tau_{}"], 1, " "),
            separator: " ",
            start: 4385.5,
            ..PLAIN
        },
        Dialect {
            header: &header("\"time [ms]\"", ["\"Position{}\"", "Speed{}", "Effort{}"], 1, ";"),
            separator: ";",
            between: "\r\n",
            per_second: 1e3,
            ..PLAIN
        },
        Dialect {
            header: &header("t", ["q_joint_{}", "dq_joint_{}", "tau_joint_{}"], 0, "\t"),
            separator: "\t",
            per_second: 1e6,
            per_radian: 180.0 / PI,
            ..PLAIN
        },
        Dialect {
            header: &header(
                "%time",
                ["/js/joint{}/position", "/js/joint{}/velocity", "/js/joint{}/effort"],
                1,
                ",",
            ),
            per_second: 1e9,
            start: 1_700_000_000e9,
            ..PLAIN
        },
    ];
    for dialect in dialects {
        let logged = read(&dialect.text(), &options(Some(&robot), &columns));
        let logged = logged.unwrap_or_else(|error| panic!("{}: {error}", dialect.header));
        check(&logged);
        let ratio = logged.understood.as_ref().unwrap().ratio.unwrap();
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        let said = logged.notes.concat();
        assert_eq!(said.contains("the positions are in degrees"), dialect.per_radian > 1.0);
        assert_eq!(said.contains("the times are in"), dialect.per_second > 1.0);
        assert_eq!(said.contains("demands, not a measurement"), dialect.header.contains("moment"));
    }
}

#[test]
fn times_keep_their_digits() {
    let columns = ColumnSettings::default();
    let text = "stamp_ns,q1,tau1\n1700000000000000001,0.1,1\n1700000000004000002,0.2,1\n\
                1700000000008000003,0.3,1\n";
    let run = read(text, &options(None, &columns)).unwrap().run;
    assert_eq!(run.times, [0.0, 0.004_000_001, 0.008_000_002]);
    assert!(run.qd(1)[0] > 24.9 && run.qd(1)[0] < 25.1);
    let text = "secs,nsecs,q1,tau1\n1700000000,999000000,0.1,1\n1700000001,1000000,0.2,1\n";
    assert_eq!(read(text, &options(None, &columns)).unwrap().run.times, [0.0, 0.002]);
}

#[test]
fn settings_name_columns_whose_names_do_not_tell() {
    let robot = arm();
    let header = header("clock", ["a{}x", "b{}x", "c{}x"], 3, ",");
    let text = Dialect { header: &header, ..PLAIN }.text();
    let none = ColumnSettings::default();
    let error = read(&text, &options(Some(&robot), &none)).unwrap_err();
    assert!(error.contains("log.csv:1: no column is the time; the header has clock"), "{error}");
    assert!(error.contains("[columns] time = "), "{error}");
    let columns: ColumnSettings = "q=a{}x,qd=b{}x,tau=c{}x,time=clock,first=3".parse().unwrap();
    check(&read(&text, &options(Some(&robot), &columns)).unwrap());
}

#[test]
fn files_of_one_quantity_are_joined() {
    let folder = tempfile::tempdir().unwrap();
    let quantity = |name: &str, value: fn(usize, f64) -> f64| {
        let mut text = format!("t,{}\n", names(&format!("- joint{{}}_{name}"), 1).join(","));
        for k in 0..SAMPLES {
            let t = 0.01 * k as f64;
            let cells: Vec<String> = (0..6).map(|joint| value(joint, t).to_string()).collect();
            writeln!(text, "{},{}", (1e6 * t).round() / 1e6, cells.join(",")).unwrap();
        }
        std::fs::write(folder.path().join(format!("{name}.csv")), text).unwrap();
    };
    quantity("effort", |joint, _| joint as f64 + 1.0);
    quantity("velocity", |joint, t| motion(joint, t)[1]);
    quantity("position", |joint, t| motion(joint, t)[0]);
    let groups = group_files(table_files(folder.path()).unwrap());
    let [files] = &groups[..] else { panic!("{groups:?}") };
    assert!(files[0].ends_with("position.csv"), "{files:?}");
    let columns = ColumnSettings::default();
    check(&read_logged(files, &options(Some(&arm()), &columns)).unwrap());
    let effort = folder.path().join("effort.csv");
    let short = std::fs::read_to_string(&effort).unwrap();
    let short: Vec<&str> = short.lines().take(SAMPLES).collect();
    std::fs::write(&effort, short.join("\n")).unwrap();
    let defects = read_logged(files, &options(None, &columns)).unwrap_err();
    let said = defects[0].to_string();
    assert!(said.contains("effort.csv: there are 199 samples, but 200 in"), "{said}");
}

#[test]
fn turns_within_a_file_are_taken_out_and_named() {
    let columns = ColumnSettings::default();
    let mut text = String::from("t,q1,qd1,tau1\n").replace("qd1", "vel1");
    for k in 0..100 {
        let q = 0.05 * k as f64;
        let wrapped = (q + PI).rem_euclid(2.0 * PI) - PI;
        writeln!(text, "{:.2},{wrapped},5,0", 0.01 * k as f64).unwrap();
    }
    let logged = read(&text, &options(None, &columns)).unwrap();
    assert!((logged.run.q(99)[0] - 4.95).abs() < 1e-9);
    let said = logged.notes.concat();
    assert!(said.contains("log.csv:65: 1 jumps by whole turns at 0.630 s"), "{said}");
}

#[test]
fn joints_and_torques_that_are_missing_are_named_with_the_remedy() {
    let robot = arm();
    let columns = ColumnSettings::default();
    let options = options(Some(&robot), &columns);
    let rows = "\n0,0,0,0,0,0,0\n0.01,0,0,0,0,0,0\n";
    let refused = |header: &str| read(&format!("{header}{rows}"), &options).unwrap_err();
    let five = "t,joint1_pos,joint2_pos,joint3_pos,joint4_pos,joint5_pos,gripper_pos";
    let said = refused(five);
    assert!(said.contains("has no position of joint6, 1 of the robot's 6 joints"), "{said}");
    assert!(said.contains("--lock joint6=0"), "{said}");
    let said = refused(&format!("t,{}", names("target_q_{}", 0).join(",")));
    assert!(said.contains("targets only: target_q_0 to target_q_5"), "{said}");
    let said = refused(&format!("t,{}", names("q{}", 1).join(",")));
    assert!(said.contains("no column is a torque of a joint"), "{said}");
    let both = format!(
        "t,{},{}\n0,{}\n1,{}\n",
        names("actual_q_{}", 0).join(","),
        names("actual_current_{}", 0).join(","),
        ["1"; 12].join(","),
        ["1"; 12].join(",")
    );
    let said = read(&both, &options).unwrap_err();
    assert!(said.contains("motor currents: actual_current_0 to actual_current_5"), "{said}");
    assert!(said.contains("--gains"), "{said}");
    let with_gains = LoggedOptions { gains: true, ..options };
    assert_eq!(read(&both, &with_gains).unwrap().understood.unwrap().torque, "current");
    let optional = LoggedOptions { wanted: Wanted::AnyTorques, ..options };
    assert!(read(&format!("t,{}{rows}", names("q{}", 1).join(",")), &optional).is_ok());
}

#[test]
fn wrong_cells_and_times_are_named_with_line_and_column() {
    let columns = ColumnSettings::default();
    let options = options(None, &columns);
    let cases = [
        ("", "log.csv:1: the file is empty"),
        ("t,pos1,tau1\n", "there is no sample after the header"),
        ("t,pos1,tau1\n0,nan,1\n", "log.csv:2: column \"pos1\" is \"nan\", not a finite number"),
        ("t,pos1,tau1\n0,1,1e300\n", "log.csv:2: column \"tau1\" is 1e300, which no joint has"),
        ("t,pos1,tau1\n\n0,1,on\n", "log.csv:3: column \"tau1\" is \"on\""),
        ("t;pos1;tau1\n0;1,5x;1\n", "log.csv:2: column \"pos1\" is \"1,5x\", not a finite"),
        ("t,pos1,tau1\n0,,1\n", "log.csv:2: column \"pos1\" is empty"),
        ("t,pos1,tau1\n0,1,1\n1,1\n", "log.csv:3: the line has 2 fields, but the header has 3"),
        ("t,pos1,tau1\n1,1,1\n1,1,1\n", "log.csv:3: t = 1 is the time of the line above"),
        ("t,pos1,tau1\n1,1,1\n0.5,1,1\n", "log.csv:3: t = 0.5 is earlier than the line above"),
        ("t,pos1,tau1\n12:30,1,1\n", "log.csv:2: column \"t\" is \"12:30\", not a finite number"),
    ];
    for (text, words) in cases {
        let said = read(text, &options).unwrap_err();
        assert!(said.contains(words), "{words}: {said}");
        assert!(said.trim_end().lines().count() == 1 && said.contains("; "), "{said}");
    }
}

#[test]
fn the_format_of_recordings_is_no_log() {
    let is_recording = |header: &str, columns: &str| {
        let columns = columns.parse().unwrap();
        let read = read(&format!("{header}\n0,0,0,0,20,3\n"), &options(None, &columns));
        read.is_ok_and(|logged| logged.understood.is_none())
    };
    let header = "t,q1,qd1,tau1,temp1,taum1";
    assert!(is_recording(header, ""));
    for key in ["angle=deg", "time_unit=s", "tau=taum{}", "q=q{}", "qd=qd{}", "time=t", "first=1"] {
        assert!(!is_recording(header, key), "{key} would be ignored");
    }
    assert!(!is_recording("t,q1,dq1,tau1,temp1,taum1", ""));
}

#[test]
fn a_unit_that_does_not_fit_is_noted_with_the_ratio_that_it_causes() {
    let columns: ColumnSettings = "time_unit=ms".parse().unwrap();
    let header = header("time", ["q{}", "qd{}", "tau{}"], 1, ",");
    let text = Dialect { header: &header, ..PLAIN }.text();
    let notes = read(&text, &options(None, &columns)).unwrap().notes.concat();
    let words = "with times in ms and angles in rad, the positions move 1.000e3 times as far";
    assert!(notes.contains(words), "{notes}");
}

#[test]
fn a_named_torque_is_read_beside_the_columns_of_a_recording() {
    let columns: ColumnSettings = "tau=taum{}".parse().unwrap();
    let text = "t,q1,qd1,tau1,taum1\n0,0,1,5,7\n0.1,0.1,1,5,7\n0.2,0.2,1,5,7\n";
    assert_eq!(read(text, &options(None, &columns)).unwrap().run.torques, [7.0; 3]);
}
