//! The pool of threads that computes, and processes that do not have it.

use std::sync::atomic::{AtomicU32, Ordering};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// The process in which the pool was used first; 0 before.
static OWNER: AtomicU32 = AtomicU32::new(0);

/// Checks, before the pool is used, that its threads run in this process. A process that was forked
/// after the first use has none of them, and would wait for them for ever.
///
/// # Errors
///
/// `RuntimeError` in such a process.
pub(crate) fn check() -> PyResult<()> {
    let own = std::process::id();
    match OWNER.compare_exchange(0, own, Ordering::Relaxed, Ordering::Relaxed) {
        Err(owner) if owner != own => Err(PyRuntimeError::new_err(
            "this process was forked after reachtube had computed in its parent, and has no \
             threads that compute; start processes with multiprocessing.get_context(\"spawn\") or \
             \"forkserver\"",
        )),
        _ => Ok(()),
    }
}
