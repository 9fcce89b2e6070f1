//! Whether links stay clear of obstacles up to a stop and until standstill.

use reachtube::verify::StopCase;
use serde_json::Value;

use crate::fixture::Lab;
use crate::output_schema::fits;
use crate::verify::{FAR, lab, obstacle, verify};

const BRAKES: &str = "torque = [[5, 8], [5, 8]]\ndelay = [0.0, 0.01]\ndeceleration = [4, 4]\n";

#[test]
fn a_stop_may_begin_at_any_sample() {
    let lab = lab();
    lab.write("brakes.toml", BRAKES);
    let stop = "[stop]\nbrakes = \"brakes.toml\"";
    let it = format!("{}{stop}\n", obstacle(FAR));
    let run = verify(&lab, "suites = [\"A\"]", &it, "").exits(0);
    assert!(run.stdout.starts_with("safe: up to a stop of category 0 from any"), "{}", run.stdout);
    assert!(run.stdout.contains("trigger at [m]"), "{}", run.stdout);
    let json = verify(&lab, "suites = [\"A\"]", &it, "--json").exits(0).json();
    fits("verify", &json);
    let stops = &json["motions"][0]["stops"];
    assert_eq!(stops["proved"], stops["samples"]);
    // Each distance to trigger at is the way of the link, and 1.6 m/s for the time of the stop.
    for link in stops["trigger"].as_array().unwrap() {
        let [distance, way, time] = ["distance", "way", "time"].map(|k| link[k].as_f64().unwrap());
        assert!((distance - way - 1.6 * time).abs() < 1e-9 && time > 0.01, "{link}");
        // The first link turns about the axis of its capsule, so that this stays where it is.
        assert_eq!(way > 0.0, link["link"] == "axis2", "{link}");
    }
    // Without brakes that hold there is no standstill.
    lab.write("brakes.toml", format!("{BRAKES}error = [9, 9]\n"));
    let run = verify(&lab, "suites = [\"A\"]", &it, "").exits(3);
    assert!(run.stdout.contains("no standstill is proved"), "{}", run.stdout);
    fits("verify", &verify(&lab, "suites = [\"A\"]", &it, "--json").exits(3).json());
}

/// Joint 2 continues for some time after a stop. Its link then touches this, which it does not
/// reach on the motion until 0.2 s.
const BEYOND: &str = "sphere = { centre = [0.479, -0.143, 1], radius = 0.01 }";

#[test]
fn a_stop_that_touches_is_a_witness() {
    let lab = lab();
    lab.write("brakes.toml", "torque = [[8, 8], [0.4, 0.5]]\ndelay = [0.0, 0.05]\n");
    let head = "suites = [\"A\"]\nuntil = 0.2";
    verify(&lab, head, &obstacle(BEYOND), "").exits(0);
    let it = format!("{}[stop]\nbrakes = \"brakes.toml\"\n", obstacle(BEYOND));
    let run = verify(&lab, head, &it, "").exits(1);
    assert!(
        run.stdout.starts_with("unsafe: after a stop of category 0 at 0.200 s, the link of axis2"),
        "{}",
        run.stdout
    );
    let json = verify(&lab, head, &it, "--json").exits(1).json();
    fits("verify", &json);
    let closest = &json["motions"][0]["closest"];
    let rows = rows(&lab);
    // The stop, simulated again from the state at which it begins, ends where the file ends.
    let numbers = |key: &str| -> Vec<f64> {
        let all = closest["stop"][key].as_array().unwrap();
        all.iter().map(|x| x.as_f64().unwrap()).collect()
    };
    let first = at(&rows, &closest["stop"]["from"]);
    let case = StopCase {
        q: first[1..3].to_vec(),
        qd: first[3..5].to_vec(),
        brake: numbers("brake"),
        delay: closest["stop"]["delay"].as_f64().unwrap(),
        error: numbers("error"),
        drive: Vec::new(),
    };
    assert_eq!((&case.brake[..], case.delay), (&[8.0, 0.4][..], 0.05));
    let robot = reachtube::Robot::load(lab.path("arm.toml").to_str().unwrap()).unwrap();
    let again = case.simulate(&robot, 20).unwrap();
    let end = &again.states[again.states.len() - 4..];
    assert_eq!(end, &rows[rows.len() - 1][1..5]);
    assert_touches(&rows, closest);
    assert!(lab.read("cell/verify.html").contains("Unsafe"));
}

/// The controller slows the arm down clear of the obstacle. The arm then falls until late brakes
/// hold.
#[test]
fn a_controlled_stop_that_touches_is_unsafe() {
    let lab = lab();
    lab.write("brakes.toml", BRAKES.replace("[0.0, 0.01]", "[0.0, 0.4]"));
    let head = "suites = [\"A\"]\nuntil = 0.4";
    verify(&lab, head, &obstacle(BEYOND), "").exits(0);
    let it = format!("{}[stop]\nbrakes = \"brakes.toml\"\ncategory = 1\n", obstacle(BEYOND));
    let run = verify(&lab, head, &it, "").exits(1);
    assert!(
        run.stdout.starts_with("unsafe: after a stop of category 1 at 0.310 s"),
        "{}",
        run.stdout
    );
    let json = verify(&lab, head, &it, "--json").exits(1).json();
    let closest = &json["motions"][0]["closest"];
    assert_eq!(closest["stop"]["delay"], 0.4);
    let rows = rows(&lab);
    assert_touches(&rows, closest);
    // The drives slow the arm down before they are off.
    let from = closest["stop"]["from"].as_f64().unwrap();
    let driven = rows.iter().filter(|row| row[0] >= from && row[5..7] != [0.0; 2]).count();
    let speed = |row: &[f64]| row[3].abs().max(row[4].abs());
    let first = rows.iter().position(|row| row[0] >= from - 1e-9).unwrap();
    assert!(driven > 10 && speed(&rows[first + driven]) < 0.3 * speed(&rows[first]), "{driven}");
}

/// Returns the rows of the closest motion: time, positions, velocities and torques.
fn rows(lab: &Lab) -> Vec<Vec<f64>> {
    let text = lab.read("cell/A_closest.csv");
    let row = |row: &str| row.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip(1).map(row).collect()
}

/// Returns the row at a time.
fn at<'a>(rows: &'a [Vec<f64>], time: &Value) -> &'a [f64] {
    let time = time.as_f64().unwrap();
    rows.iter().find(|row| row[0] >= time - 1e-9).unwrap()
}

/// Checks by plane geometry that a motion touches the sphere [`BEYOND`], as far as it says.
fn assert_touches(rows: &[Vec<f64>], closest: &Value) {
    let row = at(rows, &closest["time"]);
    let angle = row[1] + row[2];
    let (x, y) = (0.479, -0.143);
    let along = (x * angle.cos() + y * angle.sin()).clamp(0.0, 0.6);
    let distance = (x - along * angle.cos()).hypot(y - along * angle.sin()) - 0.05;
    let printed = closest["distance"].as_f64().unwrap();
    assert!(distance < -1e-4 && (distance - printed).abs() < 1e-9, "{distance} {closest}");
}

#[test]
fn an_open_stop_has_advice() {
    let lab = lab();
    let head = |clearance: f64| format!("suites = [\"A\"]\nuntil = 0.2\nclearance = {clearance}");
    let it = format!("{}[stop]\nbrakes = \"brakes.toml\"\n", obstacle(BEYOND));
    lab.write("brakes.toml", BRAKES);
    // Sets of some width cost distance, so that slightly smaller ones prove a little more.
    let json = verify(&lab, &head(0.0), &it, "--json").exits(0).json();
    let proved = json["motions"][0]["stops"]["clearances"][0]["distance"].as_f64().unwrap();
    let json = verify(&lab, &head(proved + 1e-5), &it, "--json").exits(3).json();
    fits("verify", &json);
    let factor = json["motions"][0]["advice"]["smaller-sets"].as_f64().unwrap();
    assert!((0.8..1.0).contains(&factor), "{json}");
    let closest = &json["motions"][0]["closest"];
    assert!(closest["distance"].as_f64().unwrap() > proved, "{closest}");
    // Brakes that do not hold are named.
    lab.write("brakes.toml", format!("{BRAKES}error = [9, 9]\n"));
    let it = format!("{}[stop]\nbrakes = \"brakes.toml\"\n", obstacle(FAR));
    let json = verify(&lab, &head(0.0), &it, "--json").exits(3).json();
    assert_eq!(json["motions"][0]["advice"], "brakes");
    fits("verify", &json);
    let codes: Vec<&str> = json["findings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|finding| finding["code"].as_str().unwrap())
        .collect();
    assert_eq!(codes, ["undecided", "brake-weak"]);
}

#[test]
fn a_stop_of_category_1_follows_the_path() {
    let lab = lab();
    lab.write("brakes.toml", BRAKES);
    let stop = "[stop]\nbrakes = \"brakes.toml\"\ncategory = 1\n";
    let run = verify(&lab, "suites = [\"A\"]", &format!("{}{stop}", obstacle(FAR)), "").exits(0);
    assert!(run.stdout.starts_with("safe: up to a stop of category 1 from any"), "{}", run.stdout);
    assert!(run.stdout.contains("they end after the motion does"), "{}", run.stdout);
    let it = format!("{}{stop}", obstacle(FAR));
    let json = verify(&lab, "suites = [\"A\"]", &it, "--json").exits(0).json();
    fits("verify", &json);
    let stops = &json["motions"][0]["stops"];
    assert_eq!((&stops["category"], &stops["proved"]), (&1.into(), &stops["samples"]));
    let [samples, skipped] = ["samples", "skipped"].map(|key| stops[key].as_u64().unwrap());
    assert!(samples > 20 && skipped > 0 && samples + skipped == 51, "{stops}");
    // The claim ends where stops are left out.
    let covered = stops["covered_until"].as_f64().unwrap();
    assert!((0.2..0.5).contains(&covered), "{stops}");
    assert!(run.stdout.contains(&format!("any sample up to {covered:.3} s")), "{}", run.stdout);
    // A slower deceleration takes longer, and fewer stops end before the motion does.
    lab.write("brakes.toml", BRAKES.replace("[4, 4]", "[2, 2]"));
    let slow = verify(&lab, "suites = [\"A\"]", &it, "--json").exits(0).json();
    assert!(slow["motions"][0]["stops"]["skipped"].as_u64().unwrap() > skipped, "{slow}");
}

#[test]
fn a_stop_that_is_triggered_early_enough_is_safe() {
    let lab = lab();
    lab.write("brakes.toml", BRAKES);
    let person = "[[person]]\nname = \"p\"\n\
                  capsule = { from = [1.5, 0, 0], to = [1.5, 0, 1.7], radius = 0.2 }\n";
    let scene = |distance: f64| {
        format!("{person}[stop]\nbrakes = \"brakes.toml\"\ndistance = {distance}\n")
    };
    let head = "suites = [\"A\"]";
    // A person who is seen too late is reached, on a stop that is simulated.
    let json = verify(&lab, head, &scene(0.01), "--json").exits(1).json();
    assert!(json["motions"][0]["closest"]["stop"]["from"].as_f64().unwrap() > 0.3, "{json}");
    let links = json["motions"][0]["stops"]["trigger"].as_array().unwrap();
    let needed = links.iter().map(|link| link["distance"].as_f64().unwrap()).fold(0.0, f64::max);
    verify(&lab, head, &scene(0.5 * needed), "").exits(1);
    let run = verify(&lab, head, &scene(needed + 0.001), "").exits(0);
    assert!(run.stdout.contains("that is triggered at"), "{}", run.stdout);
}

#[test]
fn a_wrong_stop_is_refused_with_its_line() {
    let lab = lab();
    lab.write("brakes.toml", BRAKES.replace("deceleration = [4, 4]\n", ""));
    let fails = |stop: &str, parts: &[&str]| {
        let text = format!("{}[stop]\nbrakes = \"brakes.toml\"\n{stop}\n", obstacle(FAR));
        verify(&lab, "", &text, "").fails_with(parts);
    };
    fails("category = 1", &["cell.toml:8: stop: the brakes' file has no", "deceleration = ["]);
    fails("category = 2", &["category = 2", "0 or 1"]);
    fails("distance = 0", &["distance = 0", "above 0, in m"]);
    fails("speed = 1", &["unknown field `speed`", "docs/verify.md"]);
}
