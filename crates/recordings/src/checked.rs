//! Runs in memory, checked as files are.

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::defect::{Defect, DefectKind};
use crate::run::Run;
use crate::source::ReadOptions;

impl Run {
    /// Returns the run as it is used under `options`, without the samples after their end; `name`
    /// names it in messages.
    ///
    /// # Errors
    ///
    /// A defect where the number of joints differs, or one for each gap.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_recordings::{ReadOptions, Run};
    ///
    /// let run = Run::new(1, vec![0.0, 0.1, 0.2], vec![0.0; 6], vec![0.0; 3])?;
    /// let options = ReadOptions { until: Some(0.1), ..ReadOptions::default() };
    /// assert_eq!(run.clone().checked("run".as_ref(), &options).unwrap().len(), 2);
    /// let other = ReadOptions { joints: Some(2), ..options };
    /// assert!(run.checked("run".as_ref(), &other).is_err());
    /// # Ok::<(), reachtube_recordings::RunError>(())
    /// ```
    pub fn checked(mut self, name: &Path, options: &ReadOptions) -> Result<Self, Vec<Defect>> {
        let sized = options.joints.map_or(Ok(()), |joints| self.check_size(name, joints));
        sized.map_err(|defect| vec![defect])?;
        let steps = self.times.windows(2).map(|pair| (None, pair[1] - pair[0]));
        let gaps = options.gap_limit.gaps(name, steps.collect());
        if !gaps.is_empty() {
            return Err(gaps);
        }
        self.truncate(options.until);
        Ok(self)
    }

    /// Checks that the run has samples, and that they are of `joints` joints.
    ///
    /// # Errors
    ///
    /// The defect where they are not.
    pub fn check_size(&self, name: &Path, joints: usize) -> Result<(), Defect> {
        let (lengths, samples) = ([self.states.len(), 2 * self.torques.len()], self.len());
        if samples > 0 && self.joints == joints && lengths == [2 * joints * samples; 2] {
            return Ok(());
        }
        let own = format!("{samples} samples of {} joints", self.joints);
        let problem = format!("the run has {own}, but the robot has {joints}");
        let remedy = "give the robot of the recordings, and one sample at least";
        Err(Defect::new(name, None, problem, remedy).of_kind(DefectKind::Joints))
    }

    /// Returns the run with the SHA-256 of its numbers, if it has none yet.
    #[must_use]
    pub fn with_digest(mut self) -> Self {
        if self.sha256.is_empty() {
            let mut digest = Sha256::new();
            let Self { times, states, torques, temperatures, before, .. } = &self;
            let numbers = [times, states, torques, temperatures, before];
            numbers.into_iter().flatten().for_each(|value| digest.update(value.to_le_bytes()));
            self.sha256 = reachtube_files::hex(&digest.finalize());
        }
        self
    }
}
