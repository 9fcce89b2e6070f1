//! The notions of enclosure: recorded points in the reachable set itself.

use crate::fixture::{Lab, set_cell, text_of};

#[test]
fn points_are_proved_and_certified() {
    let lab = Lab::new();
    let run = lab.conform("--notion exact --out exact.json --certificate points.jsonl");
    let run = run.exits(0);
    assert!(run.stdout.contains("wrote: exact.json, points.jsonl\n"), "{}", run.stdout);
    let points = "recorded points (all states together) proved to lie in the reachable set";
    assert!(run.stdout.contains(points), "{}", run.stdout);
    let certificate = lab.read("points.jsonl");
    assert!(certificate.starts_with("{\"format\":\"reachtube-certificate\""), "{certificate}");
    lab.run("check --model exact.json --data data --torque compensated").exits(0);
    lab.run("report --model exact.json --data data --torque compensated --out page").exits(0);
    let page = text_of(&lab.read("page/report.html"));
    for part in [points, "Phase planes", "notion is exact"] {
        assert!(page.contains(part), "{part} is not on the page");
    }
}

#[test]
fn a_point_outside_is_named_with_the_states_that_show_it() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    // A position that nothing explains.
    lab.edit("data/A_1.csv", |lines| {
        let middle = lines.len() / 2;
        set_cell(&mut lines[middle], 1, "10");
    });
    let check = "check --model model.json --data data --torque compensated --suites A";
    let run = lab.run(&format!("{check} --notion exact --verbose")).exits(1);
    for part in ["recorded points (all states together) proved", "Furthest outside: A_1.csv", "q1"]
    {
        assert!(run.stdout.contains(part), "{part} is not in\n{}", run.stdout);
    }
    let answer = lab.run(&format!("{check} --notion exact --json")).exits(1).json();
    let findings = answer["findings"].as_array().unwrap();
    let of = |code: &str| findings.iter().find(|finding| finding["code"] == code).unwrap();
    assert_eq!(of("not-conformant")["severity"], "failure");
    assert!(of("points")["numbers"]["outside"].as_f64().unwrap() >= 1.0, "{findings:?}");
    assert_eq!(of("furthest-outside")["place"], "A_1.csv");
    let run = lab.run(&format!("{check} --notion phase-plane")).exits(1);
    assert!(run.stdout.contains("each position and its velocity"), "{}", run.stdout);
    // By default a model is checked in its own notion, the hull.
    assert!(!lab.run(check).exits(1).stdout.contains("recorded points"));
}

#[test]
fn what_is_not_built_is_refused_with_a_remedy() {
    let lab = Lab::new();
    lab.conform("--certificate points.jsonl").fails_with(&["certificate", "--notion exact"]);
    assert!(lab.conform("--notion nearly").exits(2).stderr.contains("phase-plane, exact"));
    assert!(!lab.path("points.jsonl").exists());
}

/// The cost counts velocities also where only positions have to be enclosed, and so does the page.
#[test]
fn the_shares_of_the_cost_are_of_all_states_and_add_up() {
    let lab = Lab::new();
    lab.conform("--states positions --nominal own --report page");
    let page = lab.read("page/report.html");
    let table = page.split("over the drawn suites\"><table").nth(1).unwrap();
    let cells = table
        .split("</table>")
        .next()
        .unwrap()
        .split(" %<")
        .map(|before| before.rsplit('>').next().unwrap().parse::<f64>().ok());
    // Position, velocity and both of each joint; the rest after the last cell is no number.
    let shares: Vec<f64> = cells.flatten().collect();
    assert!(!shares.is_empty() && shares.len().is_multiple_of(3), "{shares:?}");
    assert!(shares.chunks(3).all(|joint| joint[1] > 0.0), "{shares:?}");
    let all: f64 = shares.chunks(3).map(|joint| joint[2]).sum();
    assert!((all - 100.0).abs() < 0.1 * shares.len() as f64, "{shares:?}");
}

#[test]
fn a_claim_about_positions_says_so() {
    let lab = Lab::new();
    let run = lab.conform("--states positions --notion exact --out model.json").exits(0);
    assert!(run.stdout.contains("rows of positions proved"), "{}", run.stdout);
    assert!(run.stdout.contains("recorded points (all positions together)"), "{}", run.stdout);
    let check = lab.run("check --model model.json --data data").exits(0);
    assert!(check.stdout.contains("rows of positions outside"), "{}", check.stdout);
    // Nothing was asked of the velocities at the start.
    assert!(!check.stderr.contains("starts near the nominal"), "{}", check.stderr);
    let run = lab.conform("--states positions --notion phase-plane").exits(0);
    assert!(run.stdout.contains("recorded points (each position by itself)"), "{}", run.stdout);
}
