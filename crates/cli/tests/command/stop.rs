//! How far a robot moves after its brakes were applied.

use crate::fixture::Lab;
use crate::output_schema::fits;

const STOP: &str = "stop --model model.json --data data --brakes brakes.toml --every 10";

/// A laboratory with a model, and brakes of 5 N m on joints of 1 and 0.5 kg m².
fn lab(torque: &str, more: &str) -> Lab {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    lab.write("brakes.toml", format!("torque = {torque}\ndelay = [0.0, 0.01]\n{more}"));
    lab
}

#[test]
fn the_way_of_each_joint_is_close_to_that_of_a_mass_under_a_brake() {
    let lab = lab("[[5, 5], [5, 5]]", "");
    let run = lab.run(STOP).exits(0);
    assert!(run.stdout.starts_with("stands: from each of 12 samples"), "{}", run.stdout);
    let json = lab.run(&format!("{STOP} --json")).exits(0).json();
    fits("stop", &json);
    let stops = json["stops"].as_array().unwrap();
    assert_eq!(stops.len(), 4);
    for stop in stops {
        let (way, time) = (stop["way"].as_f64().unwrap(), stop["time"].as_f64().unwrap());
        let (inertia, damping) = if stop["joint"] == "axis1" { (1.0, 2.0) } else { (0.5, 1.0) };
        // The fastest recorded sample, with the brake from 0.01 s on at the latest.
        let suite = stop["suite"].as_str().unwrap();
        let column = if stop["joint"] == "axis1" { 3 } else { 4 };
        let mut speed = 0.0f64;
        for run in 1..=3 {
            let text = lab.read(&format!("data/{suite}_{run}.csv"));
            let cells = text.lines().skip(1).step_by(10).map(|l| crate::fixture::cell(l, column));
            speed = cells.fold(speed, |speed, qd| speed.max(qd.abs()));
        }
        // m v' = -b - d v from v on: t = m/d ln(1 + d v/b), and the way m/d (v - b t / m).
        let braking = inertia / damping * (1.0 + damping * speed / 5.0).ln();
        let exact = inertia / damping * (speed - 5.0 * braking / inertia);
        let late = exact + 0.01 * speed;
        assert!((exact..1.2 * late + 1e-3).contains(&way), "{stop} {speed} {exact}");
        assert!((braking..braking + 0.02).contains(&time), "{stop} {braking}");
    }
}

#[test]
fn a_torque_error_above_the_brakes_leaves_the_stop_open() {
    let lab = lab("[[5, 5], [5, 5]]", "error = [6, 0]\n");
    let run = lab.run(STOP).exits(3);
    assert!(run.stdout.starts_with("not proved: from 12 of 12 samples"), "{}", run.stdout);
    fits("stop", &lab.run(&format!("{STOP} --json")).exits(3).json());
}

#[test]
fn wrong_brakes_are_refused_with_their_line() {
    for (torque, more, parts) in [
        ("[[5, 5]]", "", ["brakes.toml:1", "torque has 1 entries, but the robot has 2 joints"]),
        ("[[5, 4], [5, 5]]", "", ["brakes.toml:1", "0 <= least <= greatest"]),
        ("[[5, 5], [5, 5]]", "error = [1]", ["brakes.toml:3", "for each joint"]),
        ("[[5, 5], [5, 5]]", "holding = 1", ["unknown field `holding`", "docs/verify.md"]),
    ] {
        lab(torque, more).run(STOP).fails_with(&parts);
    }
}
