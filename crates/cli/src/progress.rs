//! A progress bar on a terminal, for jobs of over a second.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// A job that takes less shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Progress of one job; hidden unless standard error is a terminal.
pub struct Progress {
    start: Instant,
    what: &'static str,
    bar: OnceLock<ProgressBar>,
}

impl Progress {
    pub fn new(what: &'static str) -> Self {
        Self { start: Instant::now(), what, bar: OnceLock::new() }
    }

    pub fn show(&self, done: usize, total: usize) {
        if self.start.elapsed() < PATIENCE {
            return;
        }
        let bar = self.bar.get_or_init(|| {
            let style = ProgressStyle::with_template("{msg} [{bar:32}] {pos}/{len} {eta}").unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::new(total as u64).with_style(style.progress_chars("=> ")).with_message(self.what)
        });
        bar.set_position(done as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = self.bar.get() {
            bar.finish_and_clear();
        }
    }
}
