//! Systems that are no robot.

use crate::fixture::Lab;
use crate::output_schema::fits;

const LAG: &str = "kind = \"continuous\"\nstates = [\"v\"]\ninputs = [\"u\"]\n\
                   outputs = [{ name = \"v\", unit = \"m/s\" }]\nA = [[-2.0]]\nB = [[2.0]]\n";

/// Writes drives through a lag of 0.5 s, with an error that repeats every 7 samples.
fn lab() -> Lab {
    let lab = Lab::new();
    lab.write("lag.toml", LAG);
    std::fs::create_dir(lab.path("drives")).unwrap();
    for number in 0..4 {
        let (mut text, mut v) = (String::from("t,u,v\n"), 0.0);
        let decay = (-0.1f64).exp();
        for k in 0..60 {
            let u = f64::from((k / 15 + number) % 3);
            text += &format!("{},{u},{v}\n", f64::from(k) * 0.05);
            v = u + (v - u) * decay + 1e-3 * (f64::from((k + number) % 7) - 3.0);
        }
        lab.write(&format!("drives/drive_{number}.csv"), text);
    }
    lab
}

#[test]
fn a_system_is_found_checked_and_reached() {
    let lab = lab();
    let run = lab.run("conform --system lag.toml --data drives --out model.json").exits(0);
    assert!(run.stdout.starts_with("conformant: "), "{}", run.stdout);
    for part in ["times narrower than without a model", "m/s", "left out: each in turn"] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
    let run = lab.run("check --model model.json --data drives").exits(0);
    assert!(run.stdout.starts_with("conformant: 0 of 240 outputs outside"), "{}", run.stdout);
    let run = lab.run("reach --model model.json --data drives --out reach").exits(0);
    assert!(run.stdout.contains("drive_3.csv"), "{}", run.stdout);
    let csv = std::fs::read_to_string(lab.path("reach/drive_3.csv")).unwrap();
    assert!(csv.starts_with("t,v_low,v_nominal,v_high\n0,") && csv.lines().count() == 61);
    // A recording that is off is not conformant.
    lab.write("off.csv", "t,u,v\n0,0,0\n0.05,0,0\n0.1,0,0.5\n");
    let run = lab.run("check --model model.json --data off.csv").exits(1);
    assert!(run.stdout.starts_with("not conformant: 1 of 3"), "{}", run.stdout);
}

#[test]
fn results_fit_their_schemas() {
    let lab = lab();
    for (command, name) in [
        ("conform --system lag.toml --data drives --out model.json --json", "conform_system"),
        ("check --model model.json --data drives --json", "check_system"),
        ("reach --model model.json --data drives --json", "reach_system"),
    ] {
        fits(name, &lab.run(command).exits(0).json());
    }
    let schema = lab.run("man --schema system").exits(0).stdout;
    assert!(schema.contains("How a system moves on"), "{schema}");
}

#[test]
fn a_system_with_given_sets_needs_no_recordings() {
    let lab = Lab::new();
    let given = LAG.replace("inputs = [\"u\"]\n", "start = { at = [1.0] }\n");
    let given = given.replace("B = [[2.0]]\n", "");
    let sets =
        "[sets]\nX0 = { radius = [0.1], fixed = true }\nW = { radius = [0.4], fixed = true }";
    lab.write("given.toml", format!("{given}{sets}"));
    lab.run("reach --system given.toml --until 3 --step 0.5 --out reach").exits(0);
    let csv = std::fs::read_to_string(lab.path("reach/start.csv")).unwrap();
    // e^{-2t} and, for the sets, 0.1 e^{-2t} + 0.2 (1 - e^{-2t}).
    for (line, t) in csv.lines().skip(1).zip([0.0f64, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0]) {
        let numbers: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let decay = (-2.0 * t).exp();
        let radius = 0.1 * decay + 0.2 * (1.0 - decay);
        for (number, expected) in numbers.iter().zip([t, decay - radius, decay, decay + radius]) {
            assert!((number - expected).abs() < 1e-12, "{line}: {expected}");
        }
    }
    let run = lab.run("reach --system given.toml --out reach2").exits(2);
    assert!(run.stderr.contains("--until"), "{}", run.stderr);
    lab.write("lag.toml", LAG);
    let run = lab.run("reach --system lag.toml --until 1 --step 0.1").exits(2);
    assert!(run.stderr.contains("sets of the system are to be found"), "{}", run.stderr);
}

#[test]
fn a_system_that_adds_nothing_is_vacuous() {
    let lab = lab();
    lab.write("wrong.toml", LAG.replace("-2.0", "0.5").replace("[[2.0]]", "[[-2.0]]"));
    let run = lab.run("conform --system wrong.toml --data drives").exits(3);
    let said = run.stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.starts_with("conformant, but vacuous: "), "{said}");
    assert!(said.contains("so the system adds nothing"), "{said}");
}

#[test]
fn options_of_robots_are_refused() {
    let lab = lab();
    for (command, expected) in [
        ("conform --system lag.toml --data drives --robot lwa4p", "cannot be used with"),
        ("conform --system lag.toml --data drives --notion exact", "cannot be used with"),
        ("conform --system lag.toml --data drives --torque motor", "leave --torque"),
        ("conform --system none.toml --data drives", "none.toml: cannot read"),
        ("conform --system drives/drive_0.csv --data drives", "drive_0.csv: TOML parse error"),
        ("conform --data drives", "--robot <ROBOT>"),
        ("reach --out reach", "--model <FILE>"),
    ] {
        let run = lab.run(command).exits(2);
        assert!(run.stderr.contains(expected), "{command}: {}", run.stderr);
    }
    lab.run("conform --system lag.toml --data drives --out model.json").exits(0);
    let run = lab.run("check --model model.json --data drives --notion hull").exits(2);
    assert!(run.stderr.contains("leave --torque"), "{}", run.stderr);
}
