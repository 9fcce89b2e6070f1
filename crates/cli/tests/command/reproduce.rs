//! Tables of the paper.

use crate::fixture::Lab;
use crate::output_schema::fits;

#[test]
fn table_1_is_printed_beside_the_papers() {
    let lab = Lab::new();
    let command = "reproduce table1 --motions 2 --orders 1,6 --model3-up-to 1";
    let text = lab.run(command).exits(0).stdout;
    for part in [
        "2 random point-to-point motions (seed 1) within 1.571 rad of 0",
        "0.0408",
        "-: not simulated",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let table = &lab.run(&format!("{command} --json")).exits(0).json()["table1"];
    assert_eq!(table["cells"].as_array().unwrap().len(), (3 + 2) * 2);
    assert_eq!(table["cells"][0]["paper"]["error"], 0.004);
    lab.run("reproduce table1 --motions 0").fails_with(&["no motions", "give at least 1"]);
    lab.run("reproduce table1 --range -1").fails_with(&["joint1", "choose a wider range"]);
    lab.run("reproduce table1 --orders 0").fails_with(&["order 1 at least"]);
}

/// Sets of both halves of the table, for recordings of a virtual arm, beside the paper's.
#[test]
fn table_2_is_printed_beside_the_papers() {
    let lab = Lab::new();
    let few = "--motions 2 --start-points 1 --runs 3 --longest 0.4 --rest 0 --one-joint 0 \
               --excitation 0 --validation 0";
    lab.run(&format!("campaign --out out {few}")).exits(0);
    let text = lab.run("reproduce table2 --data out --notions hull,exact").exits(0).stdout;
    for part in [
        "6 recordings in 2 suites",
        "velocity conformant, each state by itself, constant disturbance: proved",
        "position conformant, all states together, disturbance held over samples: proved",
        "[-0.6586, 0.2550]",
        "[-0.5366, 0.5187]",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let table = lab.run("reproduce table2 --data out --notions hull,exact --json").exits(0).json();
    let table = &table["table2"];
    let cost = |case: usize| table["cases"][case]["cost"].as_f64().unwrap();
    // Positions ask for less than all states, and the hull for less than the set itself.
    assert!(cost(1) < cost(0) && cost(0) <= cost(2) && cost(1) <= cost(3) && cost(3) < cost(2));
    // The sets contain the origin.
    let sets = &table["cases"][0]["sets"]["input_set"];
    for joint in 0..6 {
        let [centre, radius] = ["centre", "radius"].map(|name| sets[name][joint].as_f64().unwrap());
        assert!(centre.abs() <= radius * (1.0 + 1e-9), "{centre} {radius}");
    }
    // X0 starts where the recordings do, unless it may take over.
    let width = |table: &serde_json::Value| {
        table["cases"][1]["sets"]["initial_set"]["radius"][0].as_f64().unwrap()
    };
    let free = "reproduce table2 --data out --initial-limit none --json";
    let free = &lab.run(free).exits(0).json()["table2"];
    assert!(width(free) > 2.0 * width(table), "{} {}", width(free), width(table));
    lab.run("reproduce table2 --data nowhere").fails_with(&["nowhere"]);
    lab.run("reproduce table2 --data out --suites X9").fails_with(&["X9"]);
    lab.run("reproduce table2 --data data").fails_with(&["joint"]);
}

/// Each figure is a file, and says what it shows; the numbers agree with the sets and recordings.
#[test]
fn figures_of_the_paper_are_drawn_of_a_campaign() {
    let lab = Lab::new();
    let few = "--motions 2 --start-points 2 --runs 3 --longest 0.4 --rest 0 --one-joint 0 \
               --excitation 0 --validation 0";
    lab.run(&format!("campaign --out out {few}")).exits(0);
    let draw = "reproduce fig1 fig2 fig3 fig4 --data out --suite M2b --out figures";
    let value = lab.run(&format!("{draw} --json")).exits(0).json();
    fits("reproduce", &value);
    let words = lab.run(&format!("{draw} --force")).exits(0).stdout;
    for (number, figure) in (1..).zip(value["figures"].as_array().unwrap()) {
        assert_eq!(figure["number"], number);
        let svg = lab.read(&format!("figures/fig{number}.svg"));
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(words.contains(&format!("Fig. {number}: ")) && words.contains("M2"), "{words}");
    }
    // The runs spread less than the set that encloses them, and positions ask for less.
    for row in value["figures"][3]["table"]["rows"].as_array().unwrap() {
        let cell = |k: usize| row[k].as_str().unwrap().parse::<f64>().unwrap();
        assert!(cell(1) <= cell(2) && cell(1) <= cell(3) && cell(4) <= cell(5), "{row}");
    }
    assert_eq!(value["figures"][2]["table"]["rows"].as_array().unwrap().len(), 2);
    lab.run("reproduce fig1 --data out --suite X9 --force").fails_with(&["X9"]);
    lab.run("reproduce fig3 --data none").fails_with(&["none"]);
    std::fs::remove_file(lab.path("out/campaign.json")).unwrap();
    lab.run("reproduce fig3 --data out").fails_with(&["campaign.json", "folder of a campaign"]);
}

/// A run that was stopped ends with the same files when it is started again.
#[test]
fn the_whole_experiment_is_one_page() {
    let lab = Lab::new();
    let value = lab.run("reproduce --small --out paper --json").exits(0).json();
    fits("reproduce", &value);
    let page = lab.read("paper/paper.html");
    for part in ["Table I:", "Table II, velocity conformant", "Fig. 4.", "calibration bound"] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(page.matches("<table").count(), page.matches("</table>").count());
    let claims = value["claims"].as_array().unwrap();
    let proved = claims.iter().find(|claim| claim["claim"].as_str().unwrap().contains("enclosed"));
    assert_eq!(proved.unwrap()["ours"], "16 suites, 48 runs, proved");
    // As if it had been stopped: a suite, the index and the page are missing.
    for file in ["campaign/runs.csv", "campaign/suites/M2c/M2c_02.csv", "paper.html"] {
        std::fs::remove_file(lab.path(&format!("paper/{file}"))).unwrap();
    }
    let numbers = lab.read("paper/paper.json");
    assert_eq!(serde_json::from_str::<serde_json::Value>(&numbers).unwrap(), value);
    lab.run("reproduce --small --out paper").exits(0);
    assert_eq!(lab.read("paper/paper.html"), page);
    assert_eq!(lab.read("paper/paper.json"), numbers);
    lab.write("paper/fig2.svg", "mine");
    lab.run("reproduce --small --out paper").fails_with(&["fig2.svg"]);
}
