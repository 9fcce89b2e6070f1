use reachtube_recordings::Run;
use std::path::PathBuf;

/// A recording as read, with its columns in the order of the robot's joints.
#[derive(Debug, Clone, PartialEq)]
pub struct RawLog {
    /// Name of the file.
    pub name: String,
    /// The file.
    pub file: PathBuf,
    /// The motion that it shows, where the log or an index names it.
    pub motion: Option<String>,
    /// Number of the recording since the robot's start, from 1, where it is known.
    pub order: Option<u64>,
    /// The samples.
    pub run: Run,
    /// What was changed or is worth a look, one sentence each.
    pub notes: Vec<String>,
    /// What contradicts other recordings, one sentence each: positions that are whole turns away,
    /// and were moved.
    pub moved: Vec<String>,
}

impl RawLog {
    /// Returns one column as a function of the sample: the values of `joint` in `which`.
    pub(super) fn column<'a>(
        &'a self,
        which: fn(&'a Run, usize) -> &'a [f64],
        joint: usize,
    ) -> impl Fn(usize) -> f64 + 'a {
        move |k| which(&self.run, k)[joint]
    }
}
