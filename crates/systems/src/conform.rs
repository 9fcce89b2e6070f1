use crate::arx;
use crate::description::SystemKind;
use crate::error::Result;
use crate::make::MadeSystem;
use crate::run::SystemRun;
use crate::system::OutputSystem;

impl OutputSystem {
    /// Finds the smallest sets that hold all recordings, and proves them. The factors of an arx
    /// system are found first.
    ///
    /// # Guarantee
    ///
    /// If the model is verified: at each sample, each recorded output by itself lies in the hull of
    /// the reachable set, which is taken from inside; directed rounding.
    ///
    /// # Errors
    ///
    /// Recordings that do not fit, outputs that no set reaches, and a program that the solver gives
    /// up on.
    pub fn conform(&self, runs: &[SystemRun]) -> Result<MadeSystem> {
        if self.description.kind == SystemKind::Arx {
            return arx::conform(self, runs);
        }
        let runs = self.with_past(runs)?;
        let has_halves = !self.description.parameters.is_empty() && runs.len() > 1;
        let half = |runs: &[SystemRun]| self.fitted(runs)?.half_left_out(runs);
        let left_out = has_halves.then(|| half(&runs)).transpose()?.map(|(of, _)| of);
        self.fitted(&runs)?.made(&runs, left_out)
    }
}
