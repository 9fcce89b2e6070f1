//! A page in a headless browser, driven through its DevTools protocol.
//!
//! The browser reads commands and writes answers and events on two pipes, as JSON that ends with a
//! zero byte (`--remote-debugging-pipe`).

use serde_json::{Value, json};
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};
use std::{env, fs, thread};
use tempfile::TempDir;

const BROWSERS: [&str; 4] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
/// Time that an answer may take.
const PATIENCE: Duration = Duration::from_secs(120);
const QUIET: [&str; 12] = [
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
    "--remote-debugging-pipe",
    "about:blank",
];

/// A page in a browser of its own.
#[derive(Debug)]
pub struct Tab {
    browser: Child,
    commands: File,
    answers: Receiver<Value>,
    session: Option<String>,
    count: u64,
    /// Messages on the console, violated policies and exceptions.
    pub messages: Vec<String>,
    folder: TempDir,
}

impl Tab {
    /// Starts a browser with an empty page of a size \[px\], dark or light.
    ///
    /// # Panics
    ///
    /// Panics without a browser on the PATH.
    pub fn new(width: u32, height: u32, dark: bool) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let pipes = ["commands", "answers"].map(|name| folder.path().join(name));
        assert!(Command::new("mkfifo").args(&pipes).status().unwrap().success());
        // The shell gives the browser the pipes at the numbers 3 and 4.
        let browser = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<\"$COMMANDS\" 4>\"$ANSWERS\""])
            .arg(browser())
            .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
            .args(QUIET)
            .envs([("COMMANDS", &pipes[0]), ("ANSWERS", &pipes[1])])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let commands = File::options().write(true).open(&pipes[0]).unwrap();
        let answers = listen(&pipes[1]);
        let (session, messages) = (None, Vec::new());
        let mut tab = Self { browser, commands, answers, session, count: 0, messages, folder };
        let target = tab.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = tab.call("Target.attachToTarget", attach);
        tab.session = session["sessionId"].as_str().map(String::from);
        for domain in ["Page", "Runtime", "Log"] {
            tab.call(&format!("{domain}.enable"), json!({}));
        }
        let size = json!({
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600
        });
        tab.call("Emulation.setDeviceMetricsOverride", size);
        let scheme = json!({
            "name": "prefers-color-scheme", "value": if dark { "dark" } else { "light" }
        });
        tab.call("Emulation.setEmulatedMedia", json!({ "features": [scheme] }));
        tab
    }

    /// Returns the folder whose files the page may have beside it.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Opens a page and waits until its figure is interactive.
    ///
    /// # Errors
    ///
    /// As [`open_until`](Self::open_until).
    pub fn open(&mut self, html: &[u8]) -> Result<(), String> {
        let ready = "document.documentElement?.dataset.ready";
        self.open_until(html, |tab| tab.script(ready) == "yes")
    }

    /// Opens a page and waits until `is_done`, which runs a script in the page each time.
    ///
    /// # Errors
    ///
    /// The messages of a page that hangs.
    pub fn open_until(
        &mut self,
        html: &[u8],
        mut is_done: impl FnMut(&mut Self) -> bool,
    ) -> Result<(), String> {
        let path = self.folder.path().join("page.html");
        fs::write(&path, html).unwrap();
        self.call("Page.navigate", json!({ "url": format!("file://{}", path.display()) }));
        let start = Instant::now();
        while !is_done(self) {
            if start.elapsed() > PATIENCE {
                return Err(format!("the page hangs: {:?}", self.messages));
            }
            thread::sleep(Duration::from_millis(50));
        }
        Ok(())
    }

    /// Returns the value of an expression in the page, or of a promise once it is kept.
    ///
    /// # Panics
    ///
    /// Panics if the expression throws.
    pub fn script(&mut self, expression: &str) -> Value {
        let answer = self.call(
            "Runtime.evaluate",
            json!({ "expression": expression, "returnByValue": true, "awaitPromise": true }),
        );
        assert!(answer["exceptionDetails"].is_null(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    /// Moves the mouse to places in the window \[px\], with the button pressed from the first on
    /// where it drags.
    pub fn mouse(&mut self, places: &[[f64; 2]], drags: bool) {
        let (buttons, button) = if drags { (1, "left") } else { (0, "none") };
        for (k, [x, y]) in places.iter().enumerate() {
            let mut send = |kind: &str, buttons: i32, button: &str| {
                let event = json!({
                    "type": kind, "x": x, "y": y, "button": button, "buttons": buttons,
                    "clickCount": 1
                });
                self.call("Input.dispatchMouseEvent", event);
            };
            send(
                "mouseMoved",
                if k > 0 { buttons } else { 0 },
                if k > 0 { button } else { "none" },
            );
            if drags && k == 0 {
                send("mousePressed", 1, "left");
            }
            if drags && k + 1 == places.len() {
                send("mouseReleased", 0, "left");
            }
        }
        // Plotly answers a moved mouse after up to 50 ms.
        self.script("new Promise(done => setTimeout(done, 300))");
    }

    fn call(&mut self, method: &str, params: Value) -> Value {
        self.count += 1;
        let mut command = json!({ "id": self.count, "method": method, "params": params });
        if let Some(session) = &self.session {
            command["sessionId"] = json!(session);
        }
        self.commands.write_all(format!("{command}\0").as_bytes()).unwrap();
        loop {
            let answer = self.answers.recv_timeout(PATIENCE).expect("the browser answers");
            if answer["id"] == self.count {
                assert!(answer["error"].is_null(), "{method}: {answer}");
                return answer["result"].clone();
            }
            let method = answer["method"].as_str().unwrap_or_default();
            let noisy = ["Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"];
            if noisy.contains(&method) {
                self.messages.push(answer["params"].to_string());
            }
        }
    }
}

impl Drop for Tab {
    fn drop(&mut self) {
        let _ = self.browser.kill();
        let _ = self.browser.wait();
    }
}

fn browser() -> PathBuf {
    let path = env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = env::split_paths(&path).collect();
    BROWSERS
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
        .find(|path| path.is_file())
        .unwrap_or_else(|| panic!("none of {BROWSERS:?} is on the PATH"))
}

/// Reads the answers of the browser in a thread of their own, so that waiting for one can end.
fn listen(pipe: &Path) -> Receiver<Value> {
    let answers = BufReader::new(File::open(pipe).unwrap());
    let (sender, receiver) = channel();
    thread::spawn(move || {
        for answer in answers.split(0).map_while(Result::ok) {
            if sender.send(serde_json::from_slice(&answer).unwrap_or_default()).is_err() {
                return;
            }
        }
    });
    receiver
}
