//! Whether links stay clear of obstacles.

use reachtube::verify::StopCase;
use serde_json::Value;

use crate::fixture::{Lab, Run, cell};
use crate::output_schema::fits;

const CAPSULES: &str = "[[capsule]]\nlink = \"axis1\"\nfrom = [0, 0, 0]\nto = [0, 0, 0.5]\n\
                        radius = 0.05\n[[capsule]]\nlink = 2\nfrom = [0, 0, 0]\n\
                        to = [0.6, 0, 0]\nradius = 0.04\n";

/// A laboratory with a model of suites A and B, and capsules.
fn lab() -> Lab {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    lab.write("capsules.toml", CAPSULES);
    lab
}

fn verify(lab: &Lab, head: &str, obstacles: &str, more: &str) -> Run {
    let text = format!(
        "model = \"model.json\"\ndata = \"data\"\ncapsules = \"capsules.toml\"\n{head}\n{obstacles}"
    );
    lab.write("cell.toml", text);
    lab.run(&format!("verify cell.toml --out cell --force {more}"))
}

fn obstacle(shape: &str) -> String {
    format!("[[obstacle]]\nname = \"it\"\n{shape}\n")
}

/// The motions of the second link lie in the plane z = 1, within 0.6 m of the axis.
const FAR: &str = "sphere = { centre = [1, 1, 1], radius = 0.1 }";

/// Covers the tip at the start of each motion.
const IN_THE_WAY: &str = "sphere = { centre = [0.597, -0.06, 1], radius = 0.03 }";

#[test]
fn a_far_obstacle_is_safe_with_a_proved_distance_and_a_picture() {
    let lab = lab();
    let run = verify(&lab, "", &obstacle(FAR), "").exits(0);
    assert!(run.stdout.starts_with("safe: on every motion of the model"), "{}", run.stdout);
    assert!(run.stdout.contains("margin [m]"), "{}", run.stdout);
    assert_eq!(lab.names("cell"), ["A.svg", "B.svg", "verify.html"]);
    let picture = lab.read("cell/A.svg");
    assert!(picture.starts_with("<svg") && picture.contains("Written by reachtube"));
    let json = verify(&lab, "", &obstacle(FAR), "--json").exits(0).json();
    fits("verify", &json);
    // The tip starts at (0.597, -0.06), 1.134 m from the sphere's centre.
    let distance = json["motions"][0]["clearances"][0]["distance"].as_f64().unwrap();
    assert!((0.9..1.1).contains(&distance), "{distance}");
    assert_eq!(json["motions"][0]["clearances"].as_array().unwrap().len(), 2);
}

#[test]
fn a_motion_that_touches_is_a_witness() {
    let lab = lab();
    let run = verify(&lab, "suites = [\"A\"]", &obstacle(IN_THE_WAY), "").exits(1);
    assert!(
        run.stdout.starts_with("unsafe: on a motion of the model, the link of axis2"),
        "{}",
        run.stdout
    );
    assert_eq!(lab.names("cell"), ["A.svg", "A_closest.csv", "verify.html"]);
    let json = verify(&lab, "suites = [\"A\"]", &obstacle(IN_THE_WAY), "--json").exits(1).json();
    fits("verify", &json);
    let closest = &json["motions"][0]["closest"];
    // The witness, as the file has it, touches: by plane geometry at the time that is printed.
    let text = lab.read("cell/A_closest.csv");
    let time = closest["time"].as_f64().unwrap();
    let row = text.lines().skip(1).find(|row| cell(row, 0) >= time).unwrap();
    let angle = cell(row, 1) + cell(row, 2);
    let (x, y) = (0.597, -0.06);
    let along = (x * angle.cos() + y * angle.sin()).clamp(0.0, 0.6);
    let distance = (x - along * angle.cos()).hypot(y - along * angle.sin()) - 0.07;
    assert!(
        (distance - closest["distance"].as_f64().unwrap()).abs() < 1e-9,
        "{distance} {closest}"
    );
    assert!(distance < 0.0);
}

#[test]
fn a_link_that_need_not_stay_clear_is_left_out() {
    let lab = lab();
    let it = obstacle(&format!("{IN_THE_WAY}\nlinks = [\"axis1\"]"));
    let json = verify(&lab, "", &it, "--json").exits(0).json();
    assert_eq!(json["motions"][0]["clearances"].as_array().unwrap().len(), 1);
}

#[test]
fn finer_steps_or_smaller_sets_decide_what_is_open() {
    let lab = lab();
    let wall = obstacle("half-space = { normal = [-1, 0, 0], offset = -0.7 }");
    let head = |clearance: f64, refine: u32| {
        format!("suites = [\"A\"]\nrefine = {refine}\nclearance = {clearance}")
    };
    let smallest = |json: &Value| json["motions"][0]["clearances"][0]["distance"].as_f64().unwrap();
    let coarse = smallest(&verify(&lab, &head(0.0, 1), &wall, "--json").exits(0).json());
    // No finer step is needed, so none is taken; one is needed just above.
    let run = verify(&lab, &head(coarse + 1e-9, 1), &wall, "").exits(3);
    assert!(run.stdout.starts_with("undecided: no distance more than"), "{}", run.stdout);
    assert!(run.stdout.contains("`refine = 64` in the scenario proves"), "{}", run.stdout);
    let json = verify(&lab, &head(coarse + 1e-9, 1), &wall, "--json").exits(3).json();
    fits("verify", &json);
    assert_eq!(json["motions"][0]["advice"]["refine"], 64);
    let found = json["motions"][0]["closest"]["distance"].as_f64().unwrap();
    let fine = smallest(&verify(&lab, &head(coarse + 1e-9, 64), &wall, "--json").exits(0).json());
    assert!(coarse < fine && fine <= found, "{coarse} {fine} {found}");
}

#[test]
fn a_person_comes_closer_with_time() {
    let lab = lab();
    let person = |speed: &str| {
        format!(
            "[[person]]\nname = \"p\"\n{speed}\n\
             capsule = {{ from = [1.5, 0, 0], to = [1.5, 0, 1.7], radius = 0.2 }}\n"
        )
    };
    let distance =
        |run: Run| run.json()["motions"][0]["clearances"][0]["distance"].as_f64().unwrap();
    let still = distance(verify(&lab, "suites = [\"A\"]", &person("speed = 0"), "--json").exits(0));
    let slow =
        distance(verify(&lab, "suites = [\"A\"]", &person("speed = 0.8"), "--json").exits(0));
    // 0.5 s at 0.8 m/s.
    assert!((still - slow - 0.4).abs() < 0.05, "{still} {slow}");
    // At the 1.6 m/s of ISO 13855 the person is there.
    verify(&lab, "suites = [\"A\"]", &person(""), "").exits(1);
}

#[test]
fn a_wrong_scenario_is_refused_with_its_line() {
    let lab = lab();
    let fails = |head: &str, obstacles: &str, parts: &[&str]| {
        verify(&lab, head, obstacles, "").fails_with(parts);
    };
    let it = obstacle(FAR);
    fails("", "", &["cell.toml:1: there is nothing to stay clear of", "[[obstacle]]"]);
    fails("clearance = -1", &it, &["cell.toml:4: -1 is no number here", "not below 0"]);
    fails("refine = 0", &it, &["cell.toml:4: refine = 0", "1 to 4096"]);
    fails("margin = 1", &it, &["unknown field `margin`", "docs/verify.md"]);
    fails("", &obstacle(""), &["cell.toml:5: obstacle `it`: it has no shape", "exactly one"]);
    fails(
        "",
        &obstacle("sphere = { centre = [1, 1, 1], radius = 0 }"),
        &["a length is not above 0"],
    );
    fails(
        "",
        &obstacle(&format!("{FAR}\nlinks = [\"hand\"]")),
        &["no joint is named `hand`", "`axis1`, `axis2`"],
    );
    fails("", &obstacle(&format!("{FAR}\nspeed = -1")), &["speed = -1"]);
    fails("", &format!("{it}{it}"), &["obstacle `it`: the name occurs twice"]);
    lab.write(
        "capsules.toml",
        "[[capsule]]\nlink = 3\nfrom = [0, 0, 0]\nto = [0, 0, 0]\nradius = 1.0\n",
    );
    fails("", &it, &["capsules.toml:2: capsule 1: there is no link 3", "`axis1`, `axis2`"]);
    let run = lab.run("verify none.toml");
    run.fails_with(&["none.toml", "write a scenario"]);
    lab.write("cell.toml", format!("model = \"model.json\"\ndata = \"data\"\n{it}"));
    lab.run("verify cell.toml")
        .fails_with(&["no capsules are known for the links of robot `two axes`"]);
}

#[test]
fn files_of_others_are_not_overwritten() {
    let lab = lab();
    verify(&lab, "", &obstacle(IN_THE_WAY), "").exits(1);
    lab.write("cell/A_closest.csv", "mine\n");
    let run = lab.run("verify cell.toml --out cell");
    run.fails_with_last(&["A_closest.csv", "--force"]);
    assert_eq!(lab.read("cell/A_closest.csv"), "mine\n");
}

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

/// Joint 2 goes on for some time after a stop. Its link then touches this, which it does not reach
/// on the motion until 0.2 s.
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
    let text = lab.read("cell/A_closest.csv");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let at = |time: &Value| {
        let time = time.as_f64().unwrap();
        rows.iter().find(|row| row[0] >= time - 1e-9).unwrap()
    };
    // The stop, simulated again from the state at which it begins, ends where the file ends.
    let numbers = |key: &str| -> Vec<f64> {
        let all = closest["stop"][key].as_array().unwrap();
        all.iter().map(|x| x.as_f64().unwrap()).collect()
    };
    let first = at(&closest["stop"]["from"]);
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
    // It touches, by plane geometry.
    let row = at(&closest["time"]);
    let angle = row[1] + row[2];
    let (x, y) = (0.479, -0.143);
    let along = (x * angle.cos() + y * angle.sin()).clamp(0.0, 0.6);
    let distance = (x - along * angle.cos()).hypot(y - along * angle.sin()) - 0.05;
    let printed = closest["distance"].as_f64().unwrap();
    assert!(distance < -1e-4 && (distance - printed).abs() < 1e-9, "{distance} {closest}");
    assert!(lab.read("cell/verify.html").contains("Unsafe"));
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
    // A slower deceleration takes longer, and fewer stops end before the motion does.
    lab.write("brakes.toml", BRAKES.replace("[4, 4]", "[2, 2]"));
    let slow = verify(&lab, "suites = [\"A\"]", &it, "--json").exits(0).json();
    assert!(slow["motions"][0]["stops"]["skipped"].as_u64().unwrap() > skipped, "{slow}");
}

#[test]
fn a_mesh_is_an_obstacle_as_the_box_around_it() {
    let lab = lab();
    let corner = |x: f64, y: f64| format!("vertex {x} {y} -50\nvertex {y} {x} 250\n");
    let facet =
        |vertices: String| format!("facet normal 0 0 1\nouter loop\n{vertices}endloop\nendfacet\n");
    let facets = facet(corner(-100.0, 100.0) + "vertex 0 0 0\n");
    lab.write("part.stl", format!("solid part\n{facets}endsolid part\n"));
    let place = "position = [0.9, 0.3, 1.1], rpy = [0, 0, 0.3]";
    let mesh = obstacle(&format!("mesh = {{ file = \"part.stl\", scale = 0.001, {place} }}"));
    let cuboid = "box = { centre = [0.9, 0.3, 1.2], size = [0.2, 0.2, 0.3], rpy = [0, 0, 0.3] }";
    let distance = |it: &str| {
        let json = verify(&lab, "suites = [\"A\"]", it, "--json").exits(0).json();
        json["motions"][0]["clearances"][0]["distance"].as_f64().unwrap()
    };
    let (mesh_distance, box_distance) = (distance(&mesh), distance(&obstacle(cuboid)));
    let lost = box_distance - mesh_distance;
    assert!((0.0..1e-9).contains(&lost) && mesh_distance > 0.0, "{mesh_distance} {box_distance}");
    lab.write("part.stl", "solid part\n");
    verify(&lab, "", &mesh, "").fails_with(&[
        "cell.toml:5: obstacle `it`: the mesh `part.stl` is not a complete STL file",
        "export the mesh as STL again",
    ]);
    verify(&lab, "", &mesh.replace("part.stl", "part.obj"), "")
        .fails_with(&["the mesh `part.obj` is a file of the format `obj`"]);
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

#[test]
fn a_planned_motion_is_one_file() {
    let lab = lab();
    let recorded = lab.names("data").into_iter().find(|name| name.starts_with("A")).unwrap();
    lab.write("plan.csv", lab.read(&format!("data/{recorded}")));
    let it = obstacle(FAR);
    lab.write(
        "cell.toml",
        format!("model = \"model.json\"\ndata = \"plan.csv\"\ncapsules = \"capsules.toml\"\n{it}"),
    );
    let json = lab.run("verify cell.toml --out cell --force --json").exits(0).json();
    assert_eq!(json["motions"].as_array().unwrap().len(), 1);
    assert!(json["motions"][0]["case"].as_str().unwrap().contains("plan"), "{json}");
}
