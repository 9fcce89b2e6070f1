//! Validation recordings must be held out of every fit.

use crate::error::{Error, Result};
use crate::prepare::raw_log::RawLog;

/// Checks that no validation recording shares times with a recording of the fits that has the same
/// content.
///
/// # Errors
///
/// [`Error::NotHeldOut`] names the first such pair.
pub fn check_held_out<'a>(
    validate: &[RawLog],
    fitted: impl Iterator<Item = &'a RawLog> + Clone,
) -> Result<()> {
    for log in validate {
        if let Some(fitted) = fitted.clone().find(|other| overlap(log, other)) {
            return Err(Error::NotHeldOut {
                validate: log.file.clone(),
                fitted: fitted.file.clone(),
            });
        }
    }
    Ok(())
}

/// Returns whether two logs have the same content and share more than one sample of it.
fn overlap(a: &RawLog, b: &RawLog) -> bool {
    let ends = |log: &RawLog| log.run.times.first().copied().zip(log.run.times.last().copied());
    a.run.sha256 == b.run.sha256
        && ends(a).zip(ends(b)).is_some_and(|((a0, a1), (b0, b1))| a0.max(b0) < a1.min(b1))
}
