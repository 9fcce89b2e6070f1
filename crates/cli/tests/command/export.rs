//! Exports: the files of each tool, and what is refused.

use crate::fixture::Lab;

const TOOLS: [(&str, &[&str]); 6] = [
    (
        "cora",
        &["cora_reach.m", "cora_data.m", "cora_dynamics.m", "cora_compare.m", "check_points.csv"],
    ),
    ("spaceex", &["spaceex.xml", "spaceex.cfg"]),
    ("flowstar", &["flowstar.model"]),
    ("hylaa", &["hylaa_reach.py"]),
    ("xspeed", &["xspeed.xml", "xspeed.cfg"]),
    ("juliareach", &["juliareach.jl"]),
];

/// Returns a lab with model.json, model 1 of order 1 unless `more` says otherwise.
fn lab(more: &str) -> Lab {
    let lab = Lab::new();
    lab.conform(&format!("--suites A --out model.json {more}")).exits(0);
    lab
}

const EXPORT: &str = "export --model model.json --data data --suites A --out out";

#[test]
fn each_tool_gets_its_files_and_ours() {
    let lab = lab("");
    for (tool, own) in TOOLS {
        let out = format!("export --model model.json --data data --to {tool} --out {tool}");
        let result = lab.run(&format!("{out} --json")).exits(0).json();
        assert_eq!(result["cases"].as_array().unwrap().len(), 2);
        let mut expected = [own, &["bounds.csv", "inputs.csv", "tube.csv"]].concat();
        expected.sort();
        assert_eq!(lab.names(tool), ["A", "B"]);
        assert_eq!(lab.names(&format!("{tool}/A")), expected);
        for name in own.iter().filter(|name| !name.ends_with(".csv") && !name.contains("compare")) {
            let text = lab.read(&format!("{tool}/A/{name}"));
            assert!(text.contains("Written by reachtube"), "{name}");
            assert!(text.contains("model 1 of order 1 of two axes, suite A"), "{name}");
        }
        // The tables carry no mark. The same ones stay, and others are kept.
        lab.run(&out).exits(0);
        lab.edit(&format!("{tool}/B/bounds.csv"), |lines| lines[1] += "0");
        lab.run(&out).fails_with_last(&["B/bounds.csv", "--force"]);
        lab.run(&format!("{out} --force")).exits(0);
    }
}

#[test]
fn our_bounds_are_those_of_reach() {
    let lab = lab("");
    lab.run(&format!("{EXPORT} --to hylaa")).exits(0);
    lab.run("reach --model model.json --data data --suites A --torque compensated --out reach")
        .exits(0);
    assert_eq!(lab.read("out/A/bounds.csv"), lab.read("reach/A.csv"));
    assert_eq!(lab.read("out/A/tube.csv"), lab.read("reach/A_tube.csv"));
    let inputs = lab.read("out/A/inputs.csv");
    let recorded = lab.read("data/A_1.csv");
    assert_eq!(inputs.lines().count(), recorded.lines().count());
    for (row, recorded) in inputs.lines().zip(recorded.lines()).skip(1) {
        let torques: Vec<&str> = recorded.split(',').skip(5).collect();
        assert!(row.ends_with(&torques.join(",")), "{row} is not {recorded}");
    }
}

#[test]
fn runs_with_motions_of_their_own_get_folders_of_their_own() {
    let lab = lab("--nominal own");
    lab.run(&format!("{EXPORT} --to cora")).exits(0);
    assert_eq!(lab.names("out"), ["A_A_1", "A_A_2", "A_A_3"]);
}

#[test]
fn a_model_that_a_tool_cannot_mean_is_refused_and_writes_nothing() {
    let lab = Lab::new();
    let cubic = lab.read("arm.toml").replace(", 0.0, 0.0] }", ", 0.0, 0.1] }");
    lab.write("arm.toml", cubic);
    lab.conform("--suites A --paper-model 1 --order 3 --until 0.05 --out model.json").exits(0);
    let run = |more: &str| lab.run(&format!("{EXPORT} {more}"));
    run("--to hylaa").fails_with_last(&["HyLAA takes affine systems only", "model 1 of order 3"]);
    run("--to cora --input deviation").fails_with_last(&["--input recorded"]);
    assert!(!lab.path("out").exists());
    run("--to juliareach").fails_with_last(&["JuliaReach has no input", "cora or flowstar"]);
    assert!(!lab.path("out").exists());
    run("--to flowstar").exits(0);
    assert!(lab.read("out/A/flowstar.cpp").contains("ODE<Interval>"));
}

#[test]
fn wrong_options_are_refused() {
    let lab = lab("");
    let run = |arguments: &str| lab.run(&format!("export {arguments}"));
    run("--model model.json --to cora --out out").fails_with(&["export to CORA needs", "--data"]);
    assert!(run("--to cora --out out").exits(2).stderr.contains("--model <FILE>"));
    run("--robot arm.toml --to cora --out out").fails_with(&["--model"]);
    let unknown = run("--model model.json --to ariadne --out out").exits(2).stderr;
    assert!(["ariadne", "cora", "urdf"].iter().all(|part| unknown.contains(part)), "{unknown}");
    run("--model arm.toml --to mjcf --out out").fails_with(&["arm.toml"]);
    run("--robot lwa4p --to mjcf --out out").fails_with(&["Schunk LWA 4P", "physical"]);
    run("--robot none.toml --to urdf --out out").fails_with(&["none.toml"]);
    lab.run(&format!("{EXPORT} --to hylaa --input recorded"))
        .fails_with_last(&["HyLAA has no input", "--input deviation"]);
    lab.run("export --model model.json --data data --suites C --to cora --out out")
        .fails_with(&["C"]);
    lab.run("export --model model.json --to cora --out out --json").fails_in_json("setting", &[]);
    assert!(!lab.path("out").exists());
    lab.write("out", "in the way");
    lab.run(&format!("{EXPORT} --to cora")).fails_with(&["out"]);
}

#[test]
fn a_robot_is_written_for_simulators() {
    let lab = lab("");
    lab.run("export --model model.json --to mjcf --out robot").exits(0);
    assert_eq!(lab.names("robot"), ["check_torques.csv", "robot.xml"]);
    lab.run("export --robot arm.toml --to mjcf --update arm.urdf --out other")
        .fails_with(&["--update", "urdf"]);
    let again = "export --robot arm.toml --to urdf --out robot";
    lab.run(again).exits(0);
    lab.write("robot/check_torques.csv", "mine");
    lab.run(again).fails_with(&["check_torques.csv", "--force"]);
    // The links weigh nothing. Bodies with their torques are read back with the motors.
    let shown = lab.run("robot show robot/robot.urdf --json").exits(0).json();
    let mass_matrix = &shown["mass_matrix"];
    assert!((mass_matrix[0][0].as_f64().unwrap() - 1.0).abs() < 1e-9, "{mass_matrix}");
    assert!((mass_matrix[1][1].as_f64().unwrap() - 0.5).abs() < 1e-9, "{mass_matrix}");
}

#[test]
fn options_without_an_effect_are_refused() {
    let lab = lab("");
    let model = "--model model.json --data data --to cora";
    for (options, option, tool) in [
        ("--robot arm.toml --to mjcf --data data", "--data", "MuJoCo"),
        ("--robot arm.toml --to mjcf --suites A", "--suites", "MuJoCo"),
        ("--model model.json --to mjcf --until 0.1", "--until", "MuJoCo"),
        ("--model model.json --to mjcf --lock axis1=0", "--lock", "MuJoCo"),
        ("--robot arm.toml --to urdf --input range", "--input", "URDF"),
        ("--robot arm.toml --to urdf --capsules arm.toml", "--capsules", "URDF"),
        (&format!("{model} --capsules arm.toml"), "--capsules", "CORA"),
        (&format!("{model} --lock axis1=0"), "--lock", "CORA"),
    ] {
        let refused = format!("{option} has no effect on an export to {tool}; leave it out");
        lab.run(&format!("export {options} --out out")).fails_with(&[&refused]);
    }
    lab.run("export --robot arm.toml --to cora --data data --out out")
        .fails_with(&["only mjcf and urdf take --robot"]);
    assert!(!lab.path("out").exists());
}

#[test]
fn the_shield_gets_a_proved_radius_and_its_own_file_is_changed_in_place() {
    let lab = lab("");
    let capsule = |link: usize| {
        format!("[[capsule]]\nlink = {link}\nfrom = [0, 0, 0]\nto = [0.4, 0, 0]\nradius = 0.05\n")
    };
    lab.write("capsules.toml", capsule(1) + &capsule(2));
    let shield = "export --model model.json --data data --to sara-shield";
    let short = format!("{shield} --until 0.1 --capsules capsules.toml --out shield");
    let first = lab.run(&format!("{short} --json")).exits(0).json();
    assert_eq!(lab.names("shield"), ["robot_parameters.yaml"]);
    let radius = first["secure_radius"].as_f64().unwrap();
    let margins = first["margins"].as_array().unwrap();
    assert!(margins.iter().all(|margin| margin["margin"].as_f64().unwrap() <= radius));
    // Over the whole motions the same model has a larger radius, in the shield's own file.
    let limits = "v_max_allowed: [9, 9]\na_max_allowed: [9, 9]\na_max_ltt: [2, 2]\nj_max: 7\n";
    lab.write("trajectory_parameters_arm.yaml", limits);
    let both = "--update shield/robot_parameters.yaml --update trajectory_parameters_arm.yaml";
    let whole = lab.run(&format!("{shield} {both} --out whole --json")).exits(0).json();
    assert!(whole["secure_radius"].as_f64().unwrap() > radius, "{whole}");
    assert_eq!(lab.names("whole"), ["robot_parameters.yaml", "trajectory_parameters_arm.yaml"]);
    assert!(lab.read("whole/trajectory_parameters_arm.yaml").contains("\nj_max: 7\n"));
    // A file that is there is replaced where it has our mark.
    let text = lab
        .run(&format!("{shield} --until 0.2 --capsules capsules.toml --out shield"))
        .exits(0)
        .stdout;
    assert!(text.contains("is proved") && text.contains("axis2"), "{text}");
    lab.run(&format!("{shield} --out other")).fails_with_last(&["two axes", "capsule"]);
    lab.run(&format!("{short} --update a --update b --update c")).fails_with(&["--update"]);
    // Nothing moves in a single sample.
    let still = format!("{shield} --until 0.005 --capsules capsules.toml --out still");
    lab.run(&still).fails_with_last(&["has a single sample", "two or more"]);
    lab.run(&format!("{shield} --update none.yaml --out other")).fails_with(&["none.yaml"]);
    lab.run("export --model model.json --to sara-shield --out other").fails_with(&["--data"]);
}

#[test]
fn help_names_each_tool_and_what_it_means() {
    let help = Lab::new().run("export --help-all").exits(0).stdout;
    for (tool, _) in TOOLS {
        assert!(help.matches(tool).count() >= 2, "{tool}");
    }
    assert!(help.contains("without a recorded input") && help.contains("mjcf"), "{help}");
}
