//! Ten logs that are wrong: `model` refuses each, or names the cause in the first line.

use std::cell::RefCell;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use reachtube_robot::Robot;

use crate::fixture::Lab;
use crate::output_schema::fits;

/// Two links in a vertical plane. The factor is of their masses.
pub(crate) fn arm(factor: f64) -> String {
    let joint = |name: &str, height: f64, mass: f64, inertia: f64| {
        let (mass, inertia) = (factor * mass, factor * inertia);
        format!(
            "[[joint]]\nname = \"{name}\"\nplacement = {{ translation = [0.0, 0.0, {height}] }}\n\
             axis = [0.0, 1.0, 0.0]\nmass = {mass}\ncom = [0.0, 0.0, -0.2]\n\
             inertia = [{inertia}, 0.0, 0.0, {inertia}, 0.0, {inertia}]\n\
             position_limits = [-3.1, 3.1]\nfriction = {{ viscous = [0.3, 0.0, 0.0] }}\n"
        )
    };
    let joints = [joint("shoulder", 1.0, 3.0, 0.05), joint("elbow", -0.4, 2.0, 0.02)].concat();
    format!("schema_version = 1\nname = \"arm\"\n{joints}")
}

/// Columns of a log: the time, and positions, velocities and torques of both joints.
pub(crate) type Row = [f64; 7];

/// Returns a log of 10 s at 100 Hz. The links are a little heavier than described, and torques have
/// noise.
fn log(robot: &Robot, number: usize) -> Vec<Row> {
    let seed = 0.3 * number as f64;
    let mut state = 1 + number as u64;
    let mut noise = |size: f64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        size * ((state >> 40) as f64 / f64::from(1 << 24) - 0.5)
    };
    let waves = |joint: usize| {
        let shift = seed + 1.7 * joint as f64;
        [(0.5, 1.3 + 0.2 * seed, 0.0), (0.25, 2.9, shift), (0.1, 5.3 - 0.4 * seed, shift)]
    };
    let row = |k: usize| {
        let t = 0.01 * k as f64;
        let part = |joint: usize, order: i32| -> f64 {
            let phase = TAU / 4.0 * f64::from(order);
            let sum = waves(joint).map(|(a, w, p)| a * w.powi(order) * (w * t + p + phase).sin());
            sum.iter().sum()
        };
        let [q, qd, qdd] = [0, 1, 2].map(|order| [part(0, order), part(1, order)]);
        let torque = robot.inverse_dynamics(&q, &qd, &qdd);
        let tau = [0, 1].map(|joint| 1.05 * torque[joint] + 0.3 * qd[joint] + noise(0.2));
        [t, q[0], q[1], qd[0] + noise(1e-3), qd[1] + noise(1e-3), tau[0], tau[1]]
    };
    (0..1000).map(row).collect()
}

/// Writes four logs into the folder `logs`, each row changed by `change` with its number and the
/// number of its log. Rows without a time are lost.
pub(crate) fn write(lab: &Lab, change: &dyn Fn(&mut Row, usize, usize)) {
    write_logs(lab, 4, change);
}

/// Does what [`write`] does for `count` logs.
pub(crate) fn write_logs(lab: &Lab, count: usize, change: &dyn Fn(&mut Row, usize, usize)) {
    let robot = Robot::from_toml(&arm(1.0), "arm").unwrap();
    std::fs::create_dir_all(lab.path("logs")).unwrap();
    for number in 0..count {
        let mut text = String::from("t,q1,q2,qd1,qd2,tau1,tau2\n");
        for (k, mut row) in log(&robot, number).into_iter().enumerate() {
            change(&mut row, k, number);
            if row[0].is_nan() {
                continue;
            }
            let cells =
                row.map(|cell| if cell.is_nan() { String::new() } else { cell.to_string() });
            writeln!(text, "{}", cells.join(",")).unwrap();
        }
        lab.write(&format!("logs/log_{number}.csv"), text);
    }
}

pub(crate) const MODEL: &str =
    "model --robot arm.toml --data logs --torque motor --out made --quiet --force";

pub(crate) fn lab() -> Lab {
    let lab = Lab::new();
    lab.write("arm.toml", arm(1.0));
    lab
}

#[test]
fn logs_that_cannot_be_read_are_refused_with_the_cause() {
    let lab = lab();
    type Case<'a> = (&'a str, &'a dyn Fn(&mut Row, usize, usize));
    let cases: [Case; 6] = [
        ("the times look like milliseconds", &|row, _, _| row[0] *= 1e3),
        ("it may be in degrees: give q in rad", &|row, _, _| {
            row[1..5].iter_mut().for_each(|cell| *cell *= 360.0 / TAU);
        }),
        ("log_1.csv: joint 2: tau is 1e300 N m", &|row, k, number| {
            if (k, number) == (100, 1) {
                row[6] = 1e300;
            }
        }),
        ("log_1.csv:102: joint 1: q1 is 1e300, which no joint has", &|row, k, number| {
            if (k, number) == (100, 1) {
                row[1] = 1e300;
            }
        }),
        ("if no velocity was measured, delete the columns of qd", &|row, _, _| {
            row[3..5].fill(f64::NAN)
        }),
        ("none of the 4 recordings shows a motion of several joints: 4 at rest", &|row, _, _| {
            row[1..5].iter_mut().for_each(|cell| *cell *= 1e-3);
        }),
    ];
    for (cause, change) in cases {
        write(&lab, change);
        let run = lab.run(MODEL);
        let first = run.stderr.lines().next().unwrap_or_default();
        assert!(run.code == 2 && first.contains(cause), "{cause}: {run:#?}");
    }
}

#[test]
fn logs_that_contradict_the_robot_give_no_acceptable_model() {
    let lab = lab();
    type Case<'a> = (&'a str, f64, &'a dyn Fn(&mut Row, usize, usize));
    let cases: [Case; 5] = [
        ("The torque of elbow is opposite to what the description needs", 1.0, &|row, _, _| {
            row[6] *= -1.0;
        }),
        ("shoulder and elbow are probably swapped", 1.0, &|row, _, _| row.swap(5, 6)),
        ("The recorded torques of shoulder, elbow are 0.07", 1.0, &|row, _, _| {
            row[5..].iter_mut().for_each(|cell| *cell /= 15.0);
        }),
        ("The recorded torques of shoulder, elbow are 0.1", 9.0, &|_, _, _| ()),
        ("swapped", 1.0, &|row, _, _| [1, 3, 5].iter().for_each(|at| row.swap(*at, at + 1))),
    ];
    for (cause, masses, change) in cases {
        lab.write("arm.toml", arm(masses));
        write(&lab, change);
        let run = lab.run(MODEL);
        let first = run.stdout.lines().take(4).collect::<String>();
        assert!(run.code == 3 && first.starts_with("not acceptable: "), "{cause}: {run:#?}");
        assert!(first.contains(cause), "{cause}: {run:#?}");
    }
    // The user knows better: the factors say that the torques are in N m.
    lab.write("arm.toml", arm(9.0));
    write(&lab, &|_, _, _| ());
    let run = lab.run(&format!("{MODEL} --gains 1,1 --json")).exits(0);
    let answer = run.json();
    fits("model", &answer);
    assert_eq!(answer["findings"][0]["code"], "contradiction");
    assert_eq!(answer["findings"][0]["severity"], "warning");
}

#[test]
fn inspect_knows_the_limits_that_model_knows() {
    let lab = lab();
    lab.write("arm.toml", arm(1.0));
    write(&lab, &|row, _, _| row[1..=4].iter_mut().for_each(|cell| *cell = cell.to_degrees()));
    let words = "but the joint's limits are -3.1 and 3.1 rad";
    for command in [MODEL, "inspect --robot arm.toml --data logs --quiet"] {
        let run = lab.run(command).exits(2);
        assert!(run.stderr.contains(words), "{run:#?}");
    }
    // The unit may be stated.
    let stated = lab.run("inspect --robot arm.toml --data logs --columns angle=deg").exits(0);
    assert!(stated.stderr.contains("positions are in degrees"), "{stated:#?}");
}

#[test]
fn copies_are_left_out_and_a_log_that_ended_at_once_changes_nothing() {
    let lab = lab();
    lab.write("arm.toml", arm(1.0));
    write(&lab, &|_, _, _| ());
    let alone = lab.run(&format!("{MODEL} --json")).json();
    std::fs::copy(lab.path("logs/log_1.csv"), lab.path("logs/log_9.csv")).unwrap();
    let text = std::fs::read_to_string(lab.path("logs/log_1.csv")).unwrap();
    let short: String = text.lines().take(2).map(|line| format!("{line}\n")).collect();
    lab.write("logs/short.csv", short);
    let answer = lab.run(&format!("{MODEL} --json")).json();
    fits("model", &answer);
    let finding = answer["findings"].as_array().unwrap().iter().find(|f| f["code"] == "recordings");
    let text = finding.expect("the copy is named")["text"].as_str().unwrap();
    assert!(text.contains("log_9.csv is a copy of") && text.contains("log_1.csv"), "{text}");
    for key in ["useful", "horizon", "joints", "held_out"] {
        assert_eq!(answer[key], alone[key], "{key}");
    }
}

#[test]
fn a_log_that_is_a_turn_away_is_moved_and_named() {
    let lab = lab();
    // The logs start at the same position.
    write(&lab, &|row, _, number| {
        if number == 2 {
            row[1] += TAU;
        }
    });
    let run = lab.run(MODEL);
    // Held-out motions may leave sets of so few: that is another answer, no error.
    let text = run.stdout.lines().next().unwrap_or_default();
    assert!(run.code != 2 && text.contains("log_2.csv: shoulder is a turn away"), "{run:#?}");
    let answer = lab.run(&format!("{MODEL} --json")).json();
    fits("model", &answer);
    assert_eq!(answer["findings"][0]["code"], "turns-moved", "{answer}");
}

/// Writes the first recordings of a folder, by their names, into `logs`, each row changed by
/// `change` with the number of the recording, and the number of joints.
fn rewrite(lab: &Lab, (folder, count): (&Path, usize), change: &dyn Fn(&mut [f64], usize, usize)) {
    std::fs::create_dir_all(lab.path("logs")).unwrap();
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = files.filter(|file| file.extension().unwrap() == "csv").collect();
    files.sort();
    for (number, file) in files.iter().take(count).enumerate() {
        let text = std::fs::read_to_string(file).unwrap();
        let (header, rows) = text.split_once('\n').unwrap();
        let joints = header.split(',').filter(|name| name.starts_with("qd")).count();
        let mut written = format!("{header}\n");
        for row in rows.lines() {
            let mut cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            change(&mut cells, number, joints);
            let cell = |cell: &f64| if cell.is_nan() { String::new() } else { cell.to_string() };
            let cells: Vec<String> = cells.iter().map(cell).collect();
            writeln!(written, "{}", cells.join(",")).unwrap();
        }
        let name = file.file_name().unwrap().to_str().unwrap();
        lab.write(&format!("logs/{name}"), written);
    }
}

/// Changes one row of a recording, with its number and the number of joints.
type Change<'a> = &'a dyn Fn(&mut [f64], usize, usize);

/// How many recordings of the UR10e last less than 40 seconds. They come first.
const SHORT: usize = 5;

/// What is wrong with recordings that are otherwise right: the cause that is named, the
/// exit code, and the change.
const WRONG: [(&str, i32, Change); 9] = [
    ("the times look like milliseconds", 2, &|row, _, _| row[0] *= 1e3),
    ("give q in rad", 2, &|row, _, n| {
        row[1..=2 * n].iter_mut().for_each(|cell| *cell *= 360.0 / TAU);
    }),
    ("at rest", 2, &|row, _, n| row[1..=2 * n].iter_mut().for_each(|cell| *cell *= 1e-3)),
    ("sign", 3, &|row, _, n| row[2 * n + 2] *= -1.0),
    ("swapped", 3, &|row, _, n| {
        let first = (n - 1).min(2);
        [0, n, 2 * n].iter().for_each(|at| row.swap(first + at, first + at + 1));
    }),
    ("times what the description needs", 3, &|row, _, n| {
        row[2 * n + 1..=3 * n].iter_mut().for_each(|cell| *cell /= 12.0);
    }),
    ("is a turn away from other recordings", 0, &|row, number, _| {
        row[1] += if number == 2 { TAU } else { 0.0 };
    }),
    ("is 1e300, which no joint has", 2, &|row, number, _| {
        if number == 1 && row[0] > 5.0 {
            row[2] = 1e300;
        }
    }),
    ("if no velocity was measured, delete the columns of qd", 2, &|row, _, n| {
        row[n + 1..=2 * n].fill(f64::NAN);
    }),
];

/// Makes a model of recordings that were changed, and asserts that the first sentence of the answer
/// names the cause.
fn names_the_cause(robot: &str, logs: (&Path, usize), (cause, code, change): (&str, i32, Change)) {
    let lab = Lab::new();
    rewrite(&lab, logs, change);
    let run = lab.run(&MODEL.replace("arm.toml", robot));
    let answer = if run.code == 2 { &run.stderr } else { &run.stdout };
    // A sentence may take a few lines.
    let first = answer.lines().take(4).collect::<Vec<_>>().join(" ");
    let first = first.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(run.code == code && first.contains(cause), "{cause}: {run:#?}");
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn raw_logs_of_strangers_end_with_a_reason() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let raw = data.canonicalize().unwrap().join("raw_logs");
    let lab = Lab::new();
    let model = |robot: &Path, logs: &str, more: &str, code: i32, cause: &str| {
        let (robot, logs) = (robot.display(), raw.join(logs));
        let line = format!("model --robot {robot} --data {} --torque motor", logs.display());
        let run = lab.run(&format!("{line} --out arm --force {more}")).exits(code);
        let answer = if code == 2 { &run.stderr } else { &run.stdout };
        let answer = answer.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(answer.contains(cause), "{cause}: {answer}");
    };
    let tiago = raw.join("tiago/tiago_no_hand.urdf");
    model(&tiago, "tiago", "", 2, "the robot branches");
    let joints = ["wheel_right_joint", "wheel_left_joint", "head_1_joint", "head_2_joint"];
    let locks: String = joints.iter().map(|joint| format!(" --lock {joint}=0")).collect();
    let cause = "times what the description needs: they may be currents in A";
    model(&tiago, "tiago", &locks, 3, cause);
    // Any robot of six joints: the logs are refused before it counts.
    let arm = data.join("ur10e/ur10e.urdf");
    model(&arm, "ur3e_rtde", "", 2, "AllJoints_MoveJ_Target.csv:1: the positions are targets only");
    let currents = "ur3e_rtde/wave_currentData_100v_40a.head.csv";
    model(&arm, currents, "", 2, "there is no torque, but there are motor currents");
    let gains = "--gains 10,10,10,9,9,9";
    model(&arm, currents, gains, 2, "1 of one joint at a time");
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn inertias_that_no_body_has_are_named_and_identified() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/ur10e");
    let mut urdf = std::fs::read_to_string(data.join("ur10e.urdf")).unwrap();
    // A body's moments of inertia fulfil the triangle inequality.
    for own in ["0.0314743125769", "0.42307374077", "0.110590365764", "0.0051082479567"] {
        urdf = urdf.replace(&format!("ixx=\"{own}\""), "ixx=\"0.0001\"");
    }
    let lab = Lab::new();
    lab.write("arm.urdf", urdf);
    rewrite(&lab, (&data.join("excitation"), SHORT), &|_, _, _| ());
    let answer = lab.run(&format!("{MODEL} --json").replace("arm.toml", "arm.urdf"));
    let answer = answer.exits(0).json();
    let first = &answer["findings"][0];
    let links =
        "shoulder_pan_joint, shoulder_lift_joint, elbow_joint, wrist_1_joint, wrist_2_joint";
    assert_eq!((&first["place"], &first["severity"]), (&links.into(), &"warning".into()));
    assert!(first["text"].as_str().unwrap().contains("only the geometry"), "{first}");
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn recordings_of_two_arms_that_are_made_wrong_are_not_accepted() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let data = data.canonicalize().unwrap();
    let of = |path: &str| data.join(path).display().to_string();
    let arms = [
        (of("ur10e/ur10e.urdf"), "ur10e/excitation", SHORT),
        (of("double_pendulum/acrobot.urdf"), "double_pendulum/openloop", usize::MAX),
    ];
    for (robot, logs, count) in arms {
        let logs = data.join(logs);
        WRONG.into_iter().for_each(|wrong| names_the_cause(&robot, (&logs, count), wrong));
    }
    // The description of another arm with as many joints.
    let other = ("it may be of another robot", 3, &(|_: &mut [f64], _, _| ()) as Change);
    names_the_cause("lwa4p", (&data.join("ur10e/excitation"), SHORT), other);
}

#[test]
fn torques_that_come_late_are_named_with_their_lag() {
    let lab = lab();
    for samples in [4, 8] {
        let past = RefCell::new(Vec::new());
        write(&lab, &|row, k, _| {
            let mut past = past.borrow_mut();
            past.truncate(k);
            past.push([row[5] + 1.5 * row[3].signum(), row[6] + row[4].signum()]);
            row[5..].copy_from_slice(&past[k.saturating_sub(samples)]);
        });
        let run = lab.run(&format!("{MODEL} --json")).json();
        let lags = run["findings"].as_array().unwrap().iter();
        let lag = lags.filter_map(|finding| finding["numbers"]["lag"].as_f64()).next();
        let expected = 0.01 * samples as f64;
        let is_near = |lag: f64| (lag - expected).abs() < 0.1 * expected;
        assert!(lag.is_some_and(is_near), "{samples}: {lag:?}");
    }
}

#[test]
fn a_check_names_the_payload_by_which_logs_differ() {
    let lab = lab();
    lab.write("any.toml", "largest-outside = 0.1\n");
    write(&lab, &|_, _, _| ());
    lab.run(&format!("{MODEL} --settings any.toml")).exits(0);
    let loaded = arm(1.0).replace("mass = 2\n", "mass = 2.8\n");
    let [loaded, robot] = [loaded, arm(1.0)].map(|text| Robot::from_toml(&text, "arm").unwrap());
    write(&lab, &|row, _, _| {
        let q = &row[1..3];
        let added = loaded.gravity_torque(q) - robot.gravity_torque(q);
        row[5..].iter_mut().zip(&added).for_each(|(torque, added)| *torque += added);
    });
    let run = lab.run("check --model made/model.json --data logs");
    assert_eq!(run.code, 1, "{run:#?}");
    let said = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("kg more than the robot's: that explains"), "{said}");
    assert!(!said.contains("make the model again"), "{said}");
}
