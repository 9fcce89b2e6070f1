//! The report page in a headless browser: its script runs to the end without an error.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::fixture::Lab;

const BROWSERS: [&str; 4] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
const PATIENCE: Duration = Duration::from_secs(120);
const OPTIONS: [&str; 9] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--enable-logging=stderr",
    "--timeout=20000",
    // The document is dumped when the page has nothing left to do, not when it is read.
    "--virtual-time-budget=10000",
    "--dump-dom",
];

#[test]
fn the_page_and_its_figures_are_written() {
    let lab = Lab::new();
    lab.conform("--out model.json --report report").exits(0).notes("wrote report/report.html");
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
    let dom = open(&browser(), &lab.path("report/report.html"), &lab.path("browser"));
    assert!(dom.contains("data-ready=\"yes\""), "the script did not end");
    assert_eq!(dom.matches("<figure").count(), 4);
}

fn browser() -> PathBuf {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let all = BROWSERS.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    let found = all.into_iter().find(|path| path.is_file());
    found.unwrap_or_else(|| panic!("none of {BROWSERS:?} is on the PATH"))
}

/// Opens the page and returns the document after its script has run.
fn open(browser: &Path, page: &Path, folder: &Path) -> String {
    std::fs::create_dir(folder).unwrap();
    let at = |name: &str| folder.join(name);
    let file = |name: &str| Stdio::from(std::fs::File::create(at(name)).unwrap());
    let mut child = Command::new(browser)
        .args(OPTIONS)
        .arg(format!("--user-data-dir={}", at("profile").display()))
        .arg(format!("file://{}", page.display()))
        .stdout(file("dom"))
        .stderr(file("log"))
        .spawn()
        .unwrap();
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > PATIENCE {
            let _ = child.kill();
            let _ = child.wait();
            panic!("the browser did not end within {PATIENCE:?}");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let read = |name: &str| String::from_utf8_lossy(&std::fs::read(at(name)).unwrap()).into_owned();
    let log = read("log");
    assert!(!log.contains(":CONSOLE"), "{log}");
    read("dom")
}
