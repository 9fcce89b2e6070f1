//! The report page in a headless browser: its script runs to the end without an error.

use reachtube_testing::Tab;
use serde_json::json;

use crate::fixture::Lab;

#[test]
fn the_page_and_its_figures_are_written() {
    let lab = Lab::new();
    let run = lab.conform("--out model.json --report report").exits(0);
    assert!(run.stdout.contains("wrote: model.json, report/report.html\n"), "{}", run.stdout);
    let figures = ["A_deviation.svg", "A_motion.svg", "B_deviation.svg", "B_motion.svg"];
    assert_eq!(lab.names("report"), [&figures[..], &["report.html"]].concat());
    for name in figures {
        let svg = lab.read(&format!("report/{name}"));
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}");
    }
    let html = lab.read("report/report.html");
    assert!(!html.contains("http://") || !html.contains("src=\"http"), "the page works offline");
    lab.run("report --model model.json --data data --torque compensated --out again").exits(0);
    assert_eq!(lab.read("again/report.html"), html);
}

#[test]
fn the_library_lies_beside_the_page_on_request() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    let report = "report --model model.json --data data --torque compensated";
    lab.run(&format!("{report} --out beside --assets beside")).exits(0);
    assert!(lab.names("beside").contains(&"plotly.js".to_string()));
    assert!(lab.read("beside/plotly.js").contains("plotly.js v3"));
    assert!(!lab.read("beside/report.html").contains("id=\"library\""));
    // The command replaces its own file.
    lab.run(&format!("{report} --out beside --assets beside")).exits(0);
    lab.run(&format!("{report} --out inside")).exits(0);
    assert!(lab.read("inside/report.html").contains("id=\"library\""));
    assert!(!lab.names("inside").contains(&"plotly.js".to_string()));
}

#[test]
#[ignore = "needs a browser"]
fn the_page_opens() {
    let lab = Lab::new();
    lab.conform("--report report").exits(0);
    let mut tab = Tab::new(1400, 900, false);
    tab.open(lab.read("report/report.html").as_bytes()).unwrap();
    assert!(tab.messages.is_empty(), "{:?}", tab.messages);
    assert_eq!(tab.script("document.querySelectorAll('figure').length"), json!(5));
}
