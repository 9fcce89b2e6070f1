//! Tables of the paper.

use crate::fixture::Lab;

#[test]
fn table_1_is_printed_beside_the_papers() {
    let lab = Lab::new();
    let command = "reproduce table1 --motions 2 --orders 1,6 --model3-up-to 1";
    let text = lab.run(&format!("{command} --out table1.csv")).exits(0).stdout;
    for part in [
        "2 random point-to-point motions (seed 1) within 1.5708 rad of 0",
        "0.0408",
        "-: not simulated",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    assert_eq!(lab.read("table1.csv").lines().count(), 1 + (3 + 2) * 2 * 2);
    let table = lab.run(&format!("{command} --json")).exits(0).json();
    assert_eq!(table["cells"].as_array().unwrap().len(), (3 + 2) * 2);
    assert_eq!(table["cells"][0]["paper"]["error"], 0.004);
}

/// The paper has no numbers for another robot.
#[test]
fn table_1_of_another_robot() {
    let lab = Lab::new();
    let table = lab
        .run("reproduce table1 --robot arm.toml --motions 1 --orders 1,3 --json")
        .exits(0)
        .json();
    assert!(table["cells"].as_array().unwrap().iter().all(|cell| cell["paper"].is_null()));
    lab.run("reproduce table1 --motions 0").fails_with(&["no motions", "give at least 1"]);
    lab.run("reproduce table1 --range -1").fails_with(&["joint1", "choose a wider range"]);
    lab.run("reproduce table1 --orders 0").fails_with(&["order 1 at least"]);
}

/// Sets of both halves of the table, for recordings of a virtual arm, beside the paper's.
#[test]
fn table_2_is_printed_beside_the_papers() {
    let lab = Lab::new();
    let few = "--motions 2 --start-points 1 --runs 3 --longest 0.4 --poses 0 --friction 0 \
               --excitation 0 --validation 0";
    lab.run(&format!("campaign --out out {few}")).exits(0);
    let text = lab.run("reproduce table2 --data out --notions hull,exact").exits(0).stdout;
    for part in [
        "6 recordings in 2 suites",
        "velocity conformant, each state by itself: proved",
        "position conformant, all states together: proved",
        "[-0.6586, 0.2550]",
        "[-0.5366, 0.5187]",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let table = lab.run("reproduce table2 --data out --notions hull,exact --json").exits(0).json();
    let cost = |case: usize| table["cases"][case]["cost"].as_f64().unwrap();
    // Positions ask for less than all states, and the hull for less than the set itself.
    assert!(cost(1) < cost(0) && cost(0) <= cost(2) && cost(1) <= cost(3) && cost(3) < cost(2));
    // The sets contain the origin.
    let sets = &table["cases"][0]["sets"]["input_set"];
    for joint in 0..6 {
        let [centre, radius] = ["centre", "radius"].map(|name| sets[name][joint].as_f64().unwrap());
        assert!(centre.abs() <= radius * (1.0 + 1e-9), "{centre} {radius}");
    }
    lab.run("reproduce table2 --data nowhere").fails_with(&["nowhere"]);
    lab.run("reproduce table2 --data out --suites X9").fails_with(&["X9"]);
    lab.run("reproduce table2 --data data").fails_with(&["joint"]);
}
