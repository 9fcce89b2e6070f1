use crate::prepare::resample::median_step;
use reachtube_recordings::Run;
use reachtube_scalar::number::counted;
use std::path::PathBuf;

/// A time between samples is a gap above this multiple of the usual time.
const GAP: f64 = 1.9;

/// A recording as read, with its columns in the order of the robot's joints.
#[derive(Debug, Clone, PartialEq)]
pub struct RawLog {
    /// Name of the file.
    pub name: String,
    /// The file.
    pub file: PathBuf,
    /// The motion that it shows, where the log or an index names it.
    pub motion: Option<String>,
    /// Number of the recording since the robot's start, from 1, if it is known.
    pub order: Option<u64>,
    /// The samples.
    pub run: Run,
    /// Notes for the user about changes and oddities, one sentence each.
    pub notes: Vec<String>,
    /// Contradictions to other recordings, one sentence each: positions that are whole turns away,
    /// and were moved.
    pub moved: Vec<String>,
    /// Samples that are missing or wrong; empty if they were not looked for.
    pub flaws: Vec<Flaw>,
}

/// Samples of a recording that are missing or wrong.
#[derive(Debug, Clone, PartialEq)]
pub struct Flaw {
    /// The recorded time of the first, or in the middle of a gap \[s\]; `None` if it is about all.
    pub time: Option<f64>,
    /// The file, with the line if it is known.
    pub place: String,
    /// What is wrong, as a clause with its place and time.
    pub text: String,
    /// What follows.
    pub outcome: FlawOutcome,
}

/// What follows from samples that are missing or wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlawOutcome {
    /// They are left out, and no window crosses their time.
    LeftOut,
    /// They make the recording contradict the robot.
    Contradiction,
    /// They are named, and change nothing.
    Named,
}

impl RawLog {
    /// Returns a run as the log of a file, without motion, order, notes and flaws.
    #[must_use]
    pub fn new(name: impl Into<String>, file: impl Into<PathBuf>, run: Run) -> Self {
        Self {
            name: name.into(),
            file: file.into(),
            motion: None,
            order: None,
            run,
            notes: Vec::new(),
            moved: Vec::new(),
            flaws: Vec::new(),
        }
    }

    /// Returns one column as a function of the sample: the values of `joint` in `which`.
    pub(super) fn column<'a>(
        &'a self,
        which: fn(&'a Run, usize) -> &'a [f64],
        joint: usize,
    ) -> impl Fn(usize) -> f64 + 'a {
        move |k| which(&self.run, k)[joint]
    }

    /// Returns a note on the gaps that `max_gap` \[s\] admits, if it is given: resampling fills
    /// them.
    pub(super) fn filled_gaps(&self, max_gap: Option<f64>) -> Option<String> {
        let usual = median_step(&self.run.times).filter(|_| max_gap.is_some())?;
        let steps = self.run.times.windows(2).map(|pair| pair[1] - pair[0]);
        let gaps: Vec<f64> = steps.filter(|step| *step > GAP * usual).collect();
        let longest = gaps.iter().copied().fold(0.0, f64::max);
        let text = format!(
            "{}: {} of up to {longest:.3} s filled by linear interpolation; samples proved there \
                were not recorded",
            self.name,
            counted(gaps.len(), "gap")
        );
        (!gaps.is_empty()).then_some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_that_are_filled_are_noted() {
        let log = |times: Vec<f64>| {
            let (states, torques) = (vec![0.0; 2 * times.len()], vec![0.0; times.len()]);
            let run = Run::new(1, times, states, torques).unwrap();
            RawLog::new("a", "a.csv", run)
        };
        let gap = log(vec![0.0, 0.01, 0.02, 0.52, 0.53, 0.54]);
        let note = gap.filled_gaps(Some(1.0)).unwrap();
        assert!(note.starts_with("a: 1 gap of up to 0.500 s filled"), "{note}");
        assert_eq!(gap.filled_gaps(None), None);
        assert_eq!(log(vec![0.0, 0.01, 0.02]).filled_gaps(Some(1.0)), None);
    }
}
