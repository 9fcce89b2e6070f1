//! The logs that a model was made of.

use reachtube_recordings::Run;

use crate::model::file::Model;
use crate::model::records::LogRecord;

impl Model {
    /// Returns the model with the logs that it was made of, or that were held out from it.
    #[must_use]
    pub fn with_logs(self, logs: Vec<LogRecord>) -> Self {
        Self { logs, ..self }.sealed()
    }

    /// Returns the SHA-256 of the log that the model was made of and that `run` is or shares
    /// samples with; `None` if there is none.
    #[must_use]
    pub fn log_with_samples_of(&self, run: &Run) -> Option<&str> {
        let mut rows = run.moving_rows();
        rows.sort_unstable();
        let own = || self.logs.iter().filter(|log| !log.held_out);
        let same = own().find(|log| log.sha256 == run.sha256);
        let log = same.or_else(|| own().find(|log| log.rows.shares_samples(run, &rows)));
        log.map(|log| log.sha256.as_str())
    }
}
