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
