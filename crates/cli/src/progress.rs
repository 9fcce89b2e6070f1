//! A progress bar on a terminal, for jobs that take longer than a second.

use std::fmt::Write;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};

use crate::global::global;
use crate::output;

/// Jobs shorter than this show no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Time between two drawings of the bar.
const REFRESH: Duration = Duration::from_millis(100);

/// Length of the bar in characters.
const BAR: u64 = 32;

/// Progress of one job. Nothing is drawn unless standard error is a terminal.
pub(crate) struct Progress {
    bar: ProgressBar,
    job: &'static str,
    started: Instant,
}

impl Progress {
    pub(crate) fn new() -> Self {
        Self::with("reading recordings", "the job")
    }

    /// Shows progress in the job that `doing` names.
    pub(crate) fn of(doing: &'static str) -> Self {
        Self::with(doing, doing)
    }

    /// Shows progress in the first part of a job; `job` names all of it.
    fn with(doing: &'static str, job: &'static str) -> Self {
        let line = move |state: &ProgressState, out: &mut dyn Write| draw(doing, state, out);
        let style = ProgressStyle::default_bar().template("{line}").expect("one placeholder");
        let bar = if global().quiet { ProgressBar::hidden() } else { ProgressBar::no_length() };
        let bar = bar.with_style(style.with_key("line", line));
        if !bar.is_hidden() {
            bar.enable_steady_tick(REFRESH);
        }
        Self { bar, job, started: Instant::now() }
    }

    /// Reports that `done` of `total` parts are finished; parallel parts may report out of order.
    pub(crate) fn show(&self, done: usize, total: usize) {
        self.bar.update(|state| {
            state.set_len(total as u64);
            state.set_pos(state.pos().max(done as u64));
        });
    }

    pub(crate) fn note(&self, text: &str) {
        self.bar.suspend(|| output::note(text));
    }
}

impl reachtube::conform::Progress for Progress {
    fn recordings_read(&self, done: usize, total: usize) {
        self.show(done, total);
    }

    fn finished(&self, what: &str) {
        self.note(what);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
        let seconds = self.started.elapsed().as_secs_f64();
        output::detail(&format!("{} took {seconds:.2} s", self.job));
    }
}

/// Writes the bar's line: the parts finished, or the time where the parts are not counted.
fn draw(doing: &str, state: &ProgressState, out: &mut dyn Write) {
    if state.elapsed() < PATIENCE {
        return;
    }
    // A closed terminal is no reason to stop the job.
    let _ = match (state.pos(), state.len()) {
        (done, Some(total)) if done < total => {
            let filled = "=".repeat((BAR * done / total) as usize) + ">";
            write!(out, "{doing} [{filled:<width$}] {done}/{total}", width = BAR as usize)
        }
        _ => write!(out, "computing for {}", HumanDuration(state.elapsed())),
    };
}
