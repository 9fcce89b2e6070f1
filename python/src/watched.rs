//! Long jobs that Python can watch and interrupt.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use reachtube::Progress;

use crate::failure::{Failure, Result};
use crate::pool;

/// Interval at which interrupts of Python are checked.
const POLL: Duration = Duration::from_millis(50);

/// Time for an interrupted job to end before it is abandoned: a part of a step that nothing
/// interrupts ends by itself, and its result is dropped.
const GRACE: Duration = Duration::from_millis(80);

/// Stack of a job, bytes, as large as a main thread's.
const STACK: usize = 8 << 20;

/// Messages of a job, and its interrupt.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    cancelled: AtomicBool,
    done: AtomicUsize,
    total: AtomicUsize,
    finished: Mutex<Vec<String>>,
}

impl Watch {
    /// Takes how many of `total` parts are done.
    pub(crate) fn count(&self, done: usize, total: usize) {
        self.total.store(total, Ordering::Relaxed);
        self.done.fetch_max(done, Ordering::Relaxed);
    }

    /// Calls `callback(done, total, sentences)` if something is new.
    fn tell(&self, callback: &Bound<'_, PyAny>, told: &mut [usize; 2]) -> PyResult<()> {
        let now = [self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed)];
        let sentences =
            std::mem::take(&mut *self.finished.lock().unwrap_or_else(|lock| lock.into_inner()));
        if now != *told || !sentences.is_empty() {
            *told = now;
            callback.call1((now[0], now[1], sentences))?;
        }
        Ok(())
    }
}

impl Progress for Watch {
    fn recordings_read(&self, done: usize, total: usize) {
        self.count(done, total);
    }

    fn finished(&self, what: &str) {
        self.finished.lock().unwrap_or_else(|lock| lock.into_inner()).push(what.into());
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Runs a job on a thread of its own, without the interpreter, and returns its result. `progress`
/// is called as in [`Watch::tell`]. The job may use the pool.
///
/// # Errors
///
/// As [`watched_alone`] and [`pool::check`].
pub(crate) fn watched<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    job: impl FnOnce(&Watch) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    pool::check()?;
    watched_alone(py, progress, job)
}

/// Does what [`watched`] does for a job that does not use the pool.
///
/// # Errors
///
/// The exception of the job's failure; the exception of a signal, within [`POLL`] and [`GRACE`]:
/// the job is then cancelled, and must have written nothing.
pub(crate) fn watched_alone<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    job: impl FnOnce(&Watch) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let watch = Arc::new(Watch::default());
    let (sender, receiver) = channel();
    let own = Arc::clone(&watch);
    let body = move || {
        // The receiver is gone where the job was interrupted.
        let _ = sender.send(catch_unwind(AssertUnwindSafe(|| job(&own))));
    };
    thread::Builder::new()
        .stack_size(STACK)
        .spawn(body)
        .map_err(|error| PyRuntimeError::new_err(format!("no thread could be started: {error}")))?;
    let receiver = Mutex::new(receiver);
    let wait = |time| {
        py.detach(|| receiver.lock().unwrap_or_else(|lock| lock.into_inner()).recv_timeout(time))
    };
    let mut told = [0; 2];
    loop {
        let result = match wait(POLL) {
            Ok(Ok(result)) => result,
            Ok(Err(panic)) => Err(panicked(&*panic)),
            Err(RecvTimeoutError::Disconnected) => Err(Failure::Other("the job ended".into())),
            Err(RecvTimeoutError::Timeout) => {
                let told = progress.map_or(Ok(()), |callback| watch.tell(callback, &mut told));
                if let Err(signal) = told.and_then(|()| py.check_signals()) {
                    watch.cancelled.store(true, Ordering::Relaxed);
                    let _ = wait(GRACE);
                    return Err(signal);
                }
                continue;
            }
        };
        if let Some(callback) = progress {
            watch.tell(callback, &mut told)?;
        }
        return result.map_err(|failure| failure.raised(py));
    }
}

fn panicked(panic: &(dyn std::any::Any + Send)) -> Failure {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
    Failure::Other(format!("a fault of reachtube itself, please report it: {text}"))
}
