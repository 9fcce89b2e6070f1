//! Evaluation of a model on motions that were left out: each is left out of the identification, the
//! fit and the sets.

use std::collections::BTreeSet;

use reachtube_conform::next_motion::LeftOut;
use reachtube_conform::{Answer, FitSettings, carry_over};
use reachtube_robot::Robot;

use crate::error::{Error, Result};
use crate::fold::Fold;
use crate::robot::{Evidence, Nominal};
use crate::trial::Trial;
use crate::windows::Prepared;

/// Number of further identifications at most. With more motions, some are left out together.
const FOLDS: usize = 8;

/// Most motions that are left out in turn. One of more motions hardly changes a robot.
const MOST_MOTIONS: usize = 60;

/// A motion beside a model that has not seen it.
#[derive(Debug, Clone)]
pub(crate) struct Unseen {
    /// Its position relative to the sets of the others.
    pub left_out: LeftOut,
    /// The factor of the allowance's shape with which these sets enclose it; `None` if none does.
    pub factor: Option<f64>,
}

impl Evidence<'_> {
    /// Identifies the robot without each of the motions, or without several at a time. Parts of a
    /// single motion are not left out of the identification, and neither is a motion without which
    /// there is none.
    ///
    /// # Errors
    ///
    /// A job that was cancelled.
    pub(crate) fn folds(&self, described: &Robot) -> Result<Vec<Fold>> {
        let mut motions: Vec<&str> = Vec::new();
        for recording in self.motions {
            if !motions.contains(&&*recording.motion) {
                motions.push(&recording.motion);
            }
        }
        let count = motions.len();
        if !(2..=MOST_MOTIONS).contains(&count) {
            return Ok(Vec::new());
        }
        let mut folds = Vec::new();
        for fold in 0..count.min(FOLDS) {
            let own: Vec<&str> = motions.iter().copied().skip(fold).step_by(FOLDS).collect();
            match self.identified_without(described, &own) {
                Ok(Nominal { robot, logs, .. }) => {
                    let motions = own.into_iter().map(String::from).collect();
                    folds.push(Fold { motions, robot, logs });
                }
                Err(error) if self.trial.progress.is_cancelled() => return Err(error),
                Err(_) => {}
            }
        }
        Ok(folds)
    }
}

impl Trial<'_> {
    /// Returns how each motion lies to the sets of the others, as the answer has it; for motions of
    /// a fold and of a fit, beside a model that has not seen them.
    ///
    /// # Errors
    ///
    /// As [`carry_over`].
    pub(crate) fn carried_over(
        &self,
        answer: &Answer,
        recordings: &Prepared,
        horizon: f64,
    ) -> Result<Vec<Unseen>> {
        let mut all = unseen(answer);
        let Some(shape) = answer.found.allowance_needed.as_ref().map(|needed| &needed.shape) else {
            return Ok(all);
        };
        // With the weight and the groups that were chosen for all motions.
        let taken = answer.model.fit.as_ref().filter(|fit| fit.taken);
        let fit = self.fit.as_ref().zip(taken).map(|(settings, record)| {
            let groups = settings.groups.iter().filter(|group| !record.dropped.contains(group));
            FitSettings { pull: Some(record.pull), groups: groups.copied().collect() }
        });
        // Without one of two motions there is nothing to fit to.
        if fit.is_some() && all.len() < 3 {
            return Ok(all);
        }
        for fold in self.folds {
            let wanted: BTreeSet<&str> = fold.motions.iter().map(String::as_str).collect();
            let Fold { robot, logs, .. } = fold;
            let trial = Trial { robot: robot.clone(), ..self.clone() };
            let recordings = Prepared { logs, ..*recordings };
            let name = |motion: &str| {
                format!("{motion} left out, {horizon} s, {shape:?}, {}", trial.name())
            };
            // Windows are cut and read once for the motions of a fold.
            let mut problem = None;
            for unseen in &mut all {
                let motion = unseen.left_out.motion.clone();
                if !wanted.contains(&*motion) {
                    continue;
                }
                let (left_out, factor) = self.journal.step(&name(&motion), || {
                    if problem.is_none() {
                        problem = Some(trial.read(recordings.cut(horizon, usize::MAX)?)?);
                    }
                    let problem = problem.as_ref().expect("it was read");
                    let observer = trial.observer(Some(&motion));
                    carry_over(problem, &motion, fit.as_ref(), shape, &observer)
                        .map_err(Error::from)
                })?;
                *unseen = Unseen { left_out, factor };
            }
        }
        Ok(all)
    }
}

/// Returns how each motion lies to the sets of the others, as the answer has it.
pub(crate) fn unseen(answer: &Answer) -> Vec<Unseen> {
    let factors = answer.found.allowance_needed.as_ref().map(|needed| &needed.factors);
    let factor = |motion: usize| factors.and_then(|factors| factors[motion]);
    let all = answer.found.left_out.iter().cloned().enumerate();
    all.map(|(motion, left_out)| Unseen { left_out, factor: factor(motion) }).collect()
}
