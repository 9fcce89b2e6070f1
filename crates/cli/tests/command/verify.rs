//! Whether links stay clear of obstacles.

use serde_json::Value;

use crate::fixture::{Lab, Run, cell};
use crate::output_schema::fits;

const CAPSULES: &str = "[[capsule]]\nlink = \"axis1\"\nfrom = [0, 0, 0]\nto = [0, 0, 0.5]\n\
                        radius = 0.05\n[[capsule]]\nlink = 2\nfrom = [0, 0, 0]\n\
                        to = [0.6, 0, 0]\nradius = 0.04\n";

/// A laboratory with a model of suites A and B, and capsules.
pub(crate) fn lab() -> Lab {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    lab.write("capsules.toml", CAPSULES);
    lab
}

pub(crate) fn verify(lab: &Lab, head: &str, obstacles: &str, more: &str) -> Run {
    let text = format!(
        "model = \"model.json\"\ndata = \"data\"\ncapsules = \"capsules.toml\"\n{head}\n{obstacles}"
    );
    lab.write("cell.toml", text);
    lab.run(&format!("verify cell.toml --out cell --force {more}"))
}

pub(crate) fn obstacle(shape: &str) -> String {
    format!("[[obstacle]]\nname = \"it\"\n{shape}\n")
}

/// The motions of the second link lie in the plane z = 1, within 0.6 m of the axis.
pub(crate) const FAR: &str = "sphere = { centre = [1, 1, 1], radius = 0.1 }";

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
fn the_limit_of_the_model_is_noted_with_the_key_that_changes_it() {
    let lab = lab();
    lab.conform("--until 0.2 --out model.json").exits(0);
    let run = verify(&lab, "", &obstacle(FAR), "").exits(0);
    run.notes("when the sets were found; until = SECONDS in the scenario changes the limit");
    let run = verify(&lab, "until = 0.1", &obstacle(FAR), "").exits(0);
    assert!(!run.stderr.contains("changes the limit"), "{}", run.stderr);
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
    assert!(run.stdout.contains("the smallest proved distance of each link"), "{}", run.stdout);
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
    fails("", &obstacle(&format!("{FAR}\nlinks = []")), &["cell.toml:5", "name links, or omit"]);
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
fn files_of_others_are_not_overwritten_and_cost_no_verdict() {
    let lab = lab();
    let first = verify(&lab, "", &obstacle(IN_THE_WAY), "").exits(1);
    let again = || lab.run("verify cell.toml --out cell");
    // The same motions are the same files.
    assert_eq!(again().exits(1).stdout, first.stdout);
    lab.write("cell/A_closest.csv", "mine\n");
    let run = again();
    assert_eq!(run.stdout, first.stdout);
    run.fails_after_result(&["A_closest.csv", "--force"]);
    assert_eq!(lab.read("cell/A_closest.csv"), "mine\n");
    // A page of others is found before anything is computed.
    lab.write("cell/verify.html", "mine\n");
    again().fails_with(&["verify.html", "--force"]);
}

#[test]
fn closest_motions_of_another_run_are_named() {
    let lab = lab();
    verify(&lab, "", &obstacle(IN_THE_WAY), "").exits(1);
    let safe = verify(&lab, "", &obstacle(FAR), "").exits(0);
    safe.notes("cell/A_closest.csv is the closest motion of another run");
    assert!(lab.path("cell/A_closest.csv").exists());
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

#[test]
fn a_question_about_nothing_is_refused() {
    let lab = lab();
    let it = obstacle(IN_THE_WAY);
    for until in ["0", "0.001"] {
        let run = verify(&lab, &format!("until = {until}"), &it, "");
        run.fails_with(&["A has a single sample", "a later `until`"]);
    }
    let capsule = CAPSULES.split_once("[[capsule]]\nlink = 2").unwrap().0;
    lab.write("capsules.toml", capsule);
    let run = verify(&lab, "", &obstacle(&format!("{IN_THE_WAY}\nlinks = [\"axis2\"]")), "");
    run.fails_with(&["no obstacle concerns a link that has a capsule"]);
    // The other link is clear, and nothing is proved of the one in the way.
    let run = verify(&lab, "", &it, "").exits(0);
    assert!(run.stderr.contains("warning: The links of axis2 have no capsule"), "{}", run.stderr);
    assert!(lab.read("cell/verify.html").contains("The links of axis2 have no capsule"));
    let json = verify(&lab, "", &it, "--json").exits(0).json();
    fits("verify", &json);
    assert_eq!(json["findings"][1]["code"], "links-left-out");
}

#[test]
fn sets_that_are_used_beyond_their_proof_have_a_warning() {
    let lab = lab();
    let codes = |run: Run| -> Vec<String> {
        let found = run.json()["findings"].as_array().unwrap().clone();
        found.iter().map(|finding| finding["code"].as_str().unwrap().to_string()).collect()
    };
    let it = obstacle(FAR);
    assert_eq!(codes(verify(&lab, "", &it, "--json").exits(0)), ["safe"]);
    // Recordings that last longer than the model's own, which are used up to the model's end.
    lab.conform("--until 0.3 --out model.json").exits(0);
    assert_eq!(codes(verify(&lab, "", &it, "--json").exits(0)), ["safe"]);
    let longer = "until = 0.5";
    assert_eq!(codes(verify(&lab, longer, &it, "--json").exits(0)), ["safe", "beyond-proof"]);
    let run = verify(&lab, longer, &it, "").exits(0);
    assert!(run.stdout.contains("up to 0.500 s each link"), "{}", run.stdout);
    assert!(run.stderr.contains("of up to 0.300 s, and these last 0.500 s"), "{}", run.stderr);
    lab.write("brakes.toml", "torque = [[5, 8], [5, 8]]\ndelay = [0.0, 0.01]\n");
    let of_other = "--model model.json --data data --until 0.5";
    for command in ["stop --brakes brakes.toml", "export --to cora --out exported"] {
        let run = lab.run(&format!("{command} {of_other}")).exits(0);
        assert!(run.stderr.contains("these last 0.500 s"), "{command}: {}", run.stderr);
    }
    // Friction that changes.
    let warming = "warming = { by = \"runs\", reference = 1.0, viscous = 0.1 }";
    let warm = lab.read("arm.toml").replace("0.0, 0.0] }", &format!("0.0, 0.0], {warming} }}"));
    lab.write("arm.toml", warm);
    lab.conform("--out model.json");
    let run = lab.run("stop --brakes brakes.toml --model model.json --data data");
    assert!(run.stderr.contains("changes as the joints warm up"), "{}", run.stderr);
    // Velocities of which nothing was asked.
    lab.conform("--states positions --out model.json");
    let run = verify(&lab, "", &it, "").exits(0);
    assert!(run.stderr.contains("recorded positions only"), "{}", run.stderr);
}

#[test]
fn shapes_of_another_robot_are_refused() {
    let lab = lab();
    let urdf = |elbow: &str, at: f64| {
        let link = "<inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/>\
                    </inertial><collision><geometry><sphere radius=\"0.05\"/></geometry>\
                    </collision>";
        let joint = |name: &str, parent: &str, child: &str, z: f64| {
            format!(
                "<link name=\"{child}\">{link}</link><joint name=\"{name}\" type=\"continuous\">\
                 <parent link=\"{parent}\"/><child link=\"{child}\"/><axis xyz=\"0 0 1\"/>\
                 <origin xyz=\"0 0 {z}\"/></joint>"
            )
        };
        let joints = joint("axis1", "base", "a", 0.5) + &joint(elbow, "a", "b", at);
        format!("<robot name=\"two axes\"><link name=\"base\"/>{joints}</robot>")
    };
    let scenario = |urdf: String| {
        lab.write("arm.urdf", urdf);
        let it = obstacle(FAR);
        let head = "model = \"model.json\"\ndata = \"data\"\ncapsules = \"arm.urdf\"\n";
        lab.write("cell.toml", format!("{head}{it}"));
        lab.run("verify cell.toml --out cell --force")
    };
    scenario(urdf("axis2", 0.5)).exits(0);
    scenario(urdf("elbow", 0.5)).fails_with(&["arm.urdf: its joints are `axis1`, `elbow`, not"]);
    scenario(urdf("axis2", 0.9)).fails_with(&["arm.urdf: the link of `axis2` lies elsewhere"]);
}
