//! A progress bar on a terminal, for jobs of over a second.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::output;

/// A job that takes less shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Time between two pictures of the bar.
const REFRESH: Duration = Duration::from_millis(100);

/// What is done so far, and how much there is.
struct Count {
    doing: &'static str,
    done: AtomicUsize,
    total: AtomicUsize,
    /// Lines that wait to be written above the bar.
    told: Mutex<Vec<String>>,
}

/// Progress of one job; nothing is shown unless standard error is a terminal. The bar has a thread
/// of its own, so that it moves on while recordings have been read and the sets are computed.
pub struct Progress {
    count: Arc<Count>,
    watcher: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Of recordings that are read.
    pub fn new() -> Self {
        Self::of("reading recordings")
    }

    pub fn of(doing: &'static str) -> Self {
        let (done, total, told) = Default::default();
        let count = Arc::new(Count { doing, done, total, told });
        let watcher = std::io::stderr().is_terminal().then(|| {
            let (stop, stopped) = channel();
            let watched = Arc::clone(&count);
            (stop, std::thread::spawn(move || watch(&watched, &stopped)))
        });
        Self { count, watcher }
    }

    pub fn show(&self, done: usize, total: usize) {
        self.count.total.store(total, Relaxed);
        self.count.done.fetch_max(done, Relaxed);
    }

    /// What was finished, a line on standard error, above the bar where there is one.
    pub fn tell(&self, words: &str) {
        match &self.watcher {
            Some(_) => self.count.told().push(words.into()),
            None => output::note(words),
        }
    }
}

impl Count {
    fn told(&self) -> MutexGuard<'_, Vec<String>> {
        self.told.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.watcher.take() {
            drop(stop);
            let _ = thread.join();
        }
        self.count.told().drain(..).for_each(|words| output::note(&words));
    }
}

/// Draws until the other end of `stopped` is dropped.
fn watch(count: &Count, stopped: &Receiver<()>) {
    if stopped.recv_timeout(PATIENCE) != Err(RecvTimeoutError::Timeout) {
        return;
    }
    let bar = ProgressBar::no_length();
    loop {
        let (done, total) = (count.done.load(Relaxed), count.total.load(Relaxed));
        if done < total {
            bar.set_style(style(&format!("{} [{{bar:32}}] {{pos}}/{{len}}", count.doing)));
            bar.set_length(total as u64);
            bar.set_position(done as u64);
        } else {
            bar.set_style(style("{spinner} computing, {elapsed}"));
        }
        count.told().drain(..).for_each(|words| bar.println(format!("note: {words}")));
        bar.tick();
        if stopped.recv_timeout(REFRESH) != Err(RecvTimeoutError::Timeout) {
            return bar.finish_and_clear();
        }
    }
}

fn style(template: &str) -> ProgressStyle {
    let style =
        ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    style.progress_chars("=> ")
}
