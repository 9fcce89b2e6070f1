//! Tests of the page in a headless browser: its script runs to the end, and the console stays
//! empty.
//!
//! The tests need Chromium or Chrome on the PATH; they are ignored unless asked
//! for.

use super::html::write_html;
use super::sample;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs, thread};

const BROWSERS: [&str; 4] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
/// Time that a browser may take.
const PATIENCE: Duration = Duration::from_secs(120);
const QUIET: [&str; 13] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--enable-logging=stderr",
    "--timeout=20000",
    "--dump-dom",
];

fn browser() -> PathBuf {
    let path = env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = env::split_paths(&path).collect();
    BROWSERS
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
        .find(|path| path.is_file())
        .unwrap_or_else(|| panic!("none of {BROWSERS:?} is on the PATH"))
}

/// Opens a page and returns the document that its script leaves, or a message about what went
/// wrong.
fn open(browser: &Path, html: &str) -> Result<String, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let at = |name: &str| folder.path().join(name);
    fs::write(at("page.html"), html).map_err(|error| error.to_string())?;
    let pipe =
        |name: &str| fs::File::create(at(name)).map(Stdio::from).map_err(|error| error.to_string());
    let child = Command::new(browser)
        .args(QUIET)
        .arg(format!("--user-data-dir={}", at("profile").display()))
        .arg(format!("file://{}", at("page.html").display()))
        .stdout(pipe("dom")?)
        .stderr(pipe("log")?)
        .spawn()
        .map_err(|error| error.to_string())?;
    let ended = wait(child);
    let log = String::from_utf8_lossy(&fs::read(at("log")).unwrap_or_default()).into_owned();
    ended.map_err(|error| format!("{error}\n{log}"))?;
    if let Some(line) = log.lines().find(|line| line.contains(":CONSOLE")) {
        return Err(line.to_string());
    }
    let dom = String::from_utf8_lossy(&fs::read(at("dom")).unwrap_or_default()).into_owned();
    if dom.contains("data-ready=\"yes\"") {
        Ok(dom)
    } else {
        Err(format!("the script did not end\n{log}"))
    }
}

fn wait(mut child: Child) -> Result<(), String> {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        match child.try_wait() {
            Ok(Some(status)) if status.success() => return Ok(()),
            Ok(Some(status)) => return Err(format!("the browser ended with {status}")),
            Ok(None) => thread::sleep(Duration::from_millis(50)),
            Err(error) => return Err(error.to_string()),
        }
    }
    let _ = child.kill();
    let _ = child.wait();
    Err(format!("the browser did not end within {PATIENCE:?}"))
}

fn page() -> String {
    let mut html = Vec::new();
    write_html(&sample::page(), &mut html).unwrap();
    String::from_utf8(html).unwrap()
}

#[test]
#[ignore = "needs a browser"]
fn the_page_opens_without_a_message_and_shows_one_figure() {
    let browser = browser();
    let dom = open(&browser, &page()).unwrap();
    assert_eq!(dom.matches("<svg").count(), 4);
    let hidden = |start: &str| dom.split(start).skip(1).filter(|tag| has_hidden(tag)).count();
    assert_eq!(hidden("<section class=\"suite\""), 1, "one of two suites is open");
    assert_eq!(hidden("<figure"), 2, "one view of each suite is open");
    assert_eq!(hidden("<div class=\"choice\""), 0, "the buttons are shown");
}

#[test]
#[ignore = "needs a browser"]
fn the_buttons_choose_the_suite_the_view_and_the_run() {
    let browser = browser();
    let click = "<script>for (const b of \
                 ['#suites [value=\"1\"]', '#views [value=deviation]', '#suite-1 .runs button']) \
                 document.querySelector(b).click();</script></body>";
    let dom = open(&browser, &page().replace("</body>", click)).unwrap();
    let shown = |start: &str| -> Vec<bool> {
        dom.split(start).skip(1).map(|tag| !has_hidden(tag)).collect()
    };
    assert_eq!(shown("<section class=\"suite\""), [false, true]);
    assert_eq!(shown("<figure"), [false, true, false, true]);
    assert!(dom.contains("#suite-1 polyline[stroke=\"#1246C8\"] { stroke-width: 13; }"));
}

fn has_hidden(tag: &str) -> bool {
    tag.split_once('>').is_some_and(|(attributes, _)| attributes.contains("hidden"))
}

#[test]
#[ignore = "needs a browser"]
fn a_message_or_a_broken_script_is_reported() {
    let browser = browser();
    let planted = page().replace("</body>", "<script>console.error(\"planted\")</script></body>");
    assert!(open(&browser, &planted).unwrap_err().contains("planted"));
    let fetching =
        page().replace("</main>", "<img src=\"https://example.invalid/x.png\" alt=\"\"></main>");
    assert!(open(&browser, &fetching).unwrap_err().contains("Content Security Policy"));
    let cut = page().replace("root.dataset.ready = \"yes\";", "");
    assert!(open(&browser, &cut).unwrap_err().contains("did not end"));
}
