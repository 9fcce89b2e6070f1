//! How far a robot moves after its brakes were applied.

use crate::fixture::{Lab, robot_toml};
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
    assert!(!run.stdout.contains("delay"), "it changes nothing: {}", run.stdout);
    fits("stop", &lab.run(&format!("{STOP} --json")).exits(3).json());
}

#[test]
fn a_span_of_the_delay_that_leaves_stops_open_is_named() {
    let lab = Lab::new();
    // A heavy link couples the joints, whose brakes may hold or not.
    let heavy = "armature = 0.5\nmass = 30.0\ncom = [0.3, 0.0, 0.0]";
    lab.write("arm.toml", robot_toml().replace("armature = 0.5", heavy));
    lab.conform("--out model.json").exits(0);
    let stop = |delay: &str, code: i32| {
        lab.write("brakes.toml", format!("torque = [[100, 100], [100, 100]]\ndelay = {delay}\n"));
        lab.run(STOP).exits(code).stdout
    };
    let text = stop("[0.0, 0.05]", 3);
    let expected = "not proved: from 12 of 12 samples no standstill is proved; with `delay = \
                    [0.05, 0.05]` one is proved from 12 of them: give `delay` a shorter span than \
                    0 to 0.05 s.\n";
    assert!(text.starts_with(expected), "{text}");
    assert!(stop("[0.05, 0.05]", 0).starts_with("stands: "));
}

#[test]
fn a_controlled_deceleration_ends_at_the_planned_way() {
    let lab = lab("[[5, 5], [5, 5]]", "deceleration = [2.0, 2.0]\n");
    let json = lab.run(&format!("{STOP} --category 1 --json")).exits(0).json();
    fits("stop", &json);
    assert_eq!(json["category"], 1);
    for stop in json["stops"].as_array().unwrap() {
        let (way, time) = (stop["way"].as_f64().unwrap(), stop["time"].as_f64().unwrap());
        let count = |key: &str| stop[key].as_u64().unwrap();
        // The last samples have no path left.
        assert_eq!(count("samples") + count("skipped"), 6, "{stop}");
        assert!(count("skipped") > 0 && count("samples") > 0, "{stop}");
        // No joint is faster than 1 rad/s, so that it stands after 0.5 s and 0.25 rad, and the
        // error of the drives (0.1 N m) and the brakes add little.
        assert!(way > 0.0 && way < 0.35 && time > 0.0 && time < 0.6, "{stop}");
    }
    let text = lab.run(&format!("{STOP} --category 1")).exits(0).stdout;
    assert!(text.contains("left out, since the deceleration"), "{text}");
    let lab = self::lab("[[5, 5], [5, 5]]", "");
    lab.run(&format!("{STOP} --category 1")).fails_with(&["brakes.toml", "deceleration = ["]);
}

#[test]
fn the_page_has_the_table_of_iso_10218_and_no_script() {
    let more = "deceleration = [2.0, 2.0]\npayload = { mass = 0.5, centre = [0.3, 0, 0] }\n";
    let lab = lab("[[5, 5], [5, 5]]", more);
    let json = lab.run(&format!("{STOP} --out stops --json")).exits(0).json();
    fits("stop", &json);
    let rows = json["annex_b"]["rows"].as_array().unwrap();
    // Two joints: category 0 at full speed, and 27 combinations in category 1.
    assert_eq!(rows.len(), 2 + 2 * 27);
    let number = |row: &serde_json::Value, key: &str| row[key].as_f64().unwrap();
    for row in rows {
        // All speeds are parts of the 3 rad/s of the description.
        let parts = number(row, "velocity") - 3.0 * number(row, "speed");
        assert!(parts.abs() < 1e-12 && number(row, "way") > 0.0, "{row}");
        if row["category"] == 1 {
            let planned = number(row, "velocity").powi(2) / (2.0 * 2.0);
            let (way, time) = (number(row, "way"), number(row, "time"));
            assert!((planned..1.3 * planned + 0.1).contains(&way), "{row} {planned}");
            assert!(time >= number(row, "velocity") / 2.0, "{row}");
        }
    }
    // On the screen, full extension and load only.
    let text = lab.run(&format!("{STOP} --out stops")).exits(0).stdout;
    let full = text.lines().filter(|line| line.matches("100 %").count() > 1).count();
    assert_eq!(full, 2 + 2 * 3, "{text}");
    let page = lab.read("stops/stop.html");
    assert!(page.contains("ISO 10218-1, Annex B") && page.contains("two axes"));
    assert!(!page.contains("<script") && page.matches("<svg").count() == 4, "{}", page.len());
    assert!(page.contains("0.5 kg at 0.3, 0, 0 m"), "{page}");
    lab.write("stops/stop.html", "mine");
    lab.run(&format!("{STOP} --out stops")).fails_with_last(&["stop.html", "--force"]);
    assert_eq!(lab.read("stops/stop.html"), "mine");
}

/// Writes recordings of a stop of the first joint from 1 rad/s, with a brake torque in N m that
/// holds after 5 ms.
fn record_stop(lab: &Lab, folder: &str, brake: f64) {
    std::fs::create_dir(lab.path(folder)).unwrap();
    let (mut q, mut v, mut text) = (0.0, 1.0f64, String::from("t,q1,q2,qd1,qd2,tau1,tau2\n"));
    for k in 0..100 {
        text += &format!("{},{q},0,{v},0,0,0\n", 0.005 * f64::from(k));
        for part in 0..50 {
            let held = if k == 0 && part < 50 { 0.0 } else { brake };
            let next = (v - 1e-4 * (2.0 * v + held)).max(0.0);
            q += 1e-4 * 0.5 * (v + next);
            v = next;
        }
    }
    lab.write(&format!("{folder}/stop_1.csv"), text);
    lab.write(&format!("{folder}/runs.csv"), "file,suite,motion\nstop_1.csv,stop,stop\n");
}

#[test]
fn recorded_stops_are_set_beside_the_proved_ones() {
    let lab = lab("[[5, 6], [5, 6]]", "");
    record_stop(&lab, "good", 5.5);
    record_stop(&lab, "weak", 4.0);
    let json = lab.run(&format!("{STOP} --stops good --json")).exits(0).json();
    fits("stop", &json);
    let first = &json["recorded"][0];
    assert_eq!((&first["joint"], &first["is_within"]), (&"axis1".into(), &true.into()), "{first}");
    let text = lab.run(&format!("{STOP} --stops good")).exits(0).stdout;
    assert!(text.contains("recorded stops, measured and proved"), "{text}");
    let text = lab.run(&format!("{STOP} --stops weak")).exits(1).stdout;
    assert!(text.starts_with("not covered: stop_1.csv: axis1 moves 0.09"), "{text}");
    assert!(text.contains("the brakes may be weaker or slower"), "{text}");
    lab.run(&format!("{STOP} --stops nowhere")).fails_with(&["nowhere", "runs.csv"]);
}

#[test]
fn wrong_brakes_are_refused_with_their_line() {
    for (torque, more, parts) in [
        ("[[5, 5]]", "", ["brakes.toml:1", "torque has 1 entries, but the robot has 2 joints"]),
        ("[[5, 4], [5, 5]]", "", ["brakes.toml:1", "0 <= least <= greatest"]),
        ("[[5, 5], [5, 5]]", "error = [1]", ["brakes.toml:3", "for each joint"]),
        ("[[5, 5], [5, 5]]", "deceleration = [1, 0]", ["brakes.toml:3", "above 0, in rad/s²"]),
        (
            "[[5, 5], [5, 5]]",
            "payload = { mass = -1, centre = [0, 0, 0] }",
            ["brakes.toml:3: payload of -1 kg", "a mass above 0 kg"],
        ),
        ("[[5, 5], [5, 5]]", "holding = 1", ["unknown field `holding`", "docs/verify.md"]),
    ] {
        lab(torque, more).run(STOP).fails_with(&parts);
    }
}
