//! Sets of the slower half of the motions put to the test on the faster half.

use std::collections::BTreeMap;

use reachtube_arm::ArmModel;
use reachtube_conform::{CheckJob, Model, Silent};
use reachtube_identify::prepare::PreparedLog;

use crate::allowance::Widened;
use crate::error::{Error, Result};
use crate::horizon::MOST_WINDOWS;
use crate::rounding::rounded_up;
use crate::trial::Trial;
use crate::windows::Prepared;

/// An allowance is found to this part of its largest size.
const STEPS: u32 = 64;

/// The two halves of the motions of some recordings. A motion is as fast as its largest
/// acceleration beside the root mean square of all.
pub(crate) struct Halves<'a> {
    recordings: &'a Prepared<'a>,
    slower: Vec<PreparedLog>,
    faster: Vec<PreparedLog>,
    horizon: f64,
}

impl<'a> Halves<'a> {
    /// Divides recordings, whose windows last `horizon` \[s\]; `None` for a single motion, and for
    /// recordings that repeat the same motions.
    pub(crate) fn new(recordings: &'a Prepared<'a>, horizon: f64) -> Option<Self> {
        let [slower, faster] = by_speed(recordings);
        let is_divided = !slower.is_empty() && !recordings.from_start;
        is_divided.then_some(Self { recordings, slower, faster, horizon })
    }

    /// Returns the part of the rows of the faster motions outside the sets of the slower ones, with
    /// the allowance that these ask for.
    ///
    /// # Errors
    ///
    /// A job that was cancelled.
    pub(crate) fn part_outside(&self, trial: &Trial) -> Result<f64> {
        let part = self.model(trial, None).and_then(|model| self.part_outside_of(model, &[]));
        self.or_all(trial, part)
    }

    /// Returns the least allowance with which no more than the part `most` of the rows of the
    /// faster motions lies outside the sets of the slower ones, and this part: at least the radii
    /// `asked` for already, 3n or none, and a part of `shape`, 3n. `None` if none is enough.
    ///
    /// # Errors
    ///
    /// A job that was cancelled.
    pub(crate) fn allowance(
        &self,
        trial: &Trial,
        (asked, shape): (&[f64], &[f64]),
        most: f64,
    ) -> Result<Option<(Vec<f64>, f64)>> {
        let Ok(model) = self.model(trial, Some(Vec::new())) else { return Ok(None) };
        let tried = |steps: u32| {
            let part = f64::from(steps) / f64::from(STEPS);
            let own = |at: usize| shape.get(at).map_or(0.0, |own| rounded_up(part * own, 3));
            let least = |at: usize| asked.get(at).copied().unwrap_or(0.0);
            let all = 0..shape.len().max(asked.len());
            let radii: Vec<f64> = all.map(|at| own(at).max(least(at))).collect();
            let outside = self.or_all(trial, self.part_outside_of(model.clone(), &radii))?;
            Ok::<_, Error>((outside <= most).then_some((radii, outside)))
        };
        let Some(mut found) = tried(STEPS)? else { return Ok(None) };
        // The least number of steps that is enough lies from the first to the second.
        let [mut least, mut enough] = [0, STEPS];
        while least < enough {
            let middle = (least + enough) / 2;
            match tried(middle)? {
                Some(better) => (found, enough) = (better, middle),
                None => least = middle + 1,
            }
        }
        Ok(Some(found))
    }

    /// Returns the model of the slower motions.
    fn model(&self, trial: &Trial, allowance: Option<Vec<f64>>) -> Result<Model> {
        let trial = Trial { allowance, fit: None, ..trial.clone() };
        let slower = Prepared { logs: &self.slower, ..*self.recordings };
        Ok(Widened::of_some(&trial, &slower, self.horizon, MOST_WINDOWS)?.answer.model)
    }

    /// Returns the part of the rows of the faster motions outside the sets of a model with larger
    /// radii of X0 and U.
    fn part_outside_of(&self, mut model: Model, allowance: &[f64]) -> Result<f64> {
        let faster = Prepared { logs: &self.faster, divides: false, ..*self.recordings };
        let setup = model.setup()?;
        let radii = model.initial_set.radius.iter_mut().chain(&mut model.input_set.radius);
        radii.zip(allowance).for_each(|(radius, more)| *radius += more);
        let check = CheckJob::new(model, setup, faster.cut(self.horizon, MOST_WINDOWS)?);
        let verdict = check.run(&Silent)?.verdict;
        Ok(verdict.violations.count as f64 / verdict.rows.max(1) as f64)
    }

    /// Takes all rows of a motion that cannot be followed to be outside: it is not foretold.
    fn or_all(&self, trial: &Trial, part: Result<f64>) -> Result<f64> {
        match part {
            Err(error) if trial.progress.is_cancelled() => Err(error),
            part => Ok(part.unwrap_or(1.0)),
        }
    }
}

/// Returns the recordings of the slower and of the faster half of the motions; none of a single
/// motion.
fn by_speed(recordings: &Prepared) -> [Vec<PreparedLog>; 2] {
    let Some(n) = recordings.logs.first().map(|log| log.joints) else { return Default::default() };
    let square = |joint: usize| {
        let values =
            recordings.logs.iter().flat_map(move |log| log.qdd.iter().skip(joint).step_by(n));
        values.map(|qdd| qdd * qdd).sum::<f64>().sqrt().max(f64::MIN_POSITIVE)
    };
    let scales: Vec<f64> = (0..n).map(square).collect();
    let peak = |log: &PreparedLog| {
        let rows = log.qdd.chunks_exact(n).flat_map(|row| row.iter().zip(&scales));
        rows.map(|(qdd, scale)| qdd.abs() / scale).fold(0.0, f64::max)
    };
    let logs = recordings.logs.iter().map(|log| (recordings.motion(&log.name), peak(log)));
    let slow = slower_half(logs);
    if slow.is_empty() {
        return Default::default();
    }
    let is_slow = |log: &&PreparedLog| slow.contains(&recordings.motion(&log.name));
    let (slower, faster) = recordings.logs.iter().partition::<Vec<&PreparedLog>, _>(is_slow);
    [slower, faster].map(|logs| logs.into_iter().cloned().collect())
}

/// Returns the slower half of the motions of some logs, each with the speed of a log.
fn slower_half<'a>(logs: impl Iterator<Item = (&'a str, f64)>) -> Vec<&'a str> {
    let mut motions: BTreeMap<&str, f64> = BTreeMap::new();
    for (motion, speed) in logs {
        let fastest = motions.entry(motion).or_insert(speed);
        *fastest = fastest.max(speed);
    }
    let mut motions: Vec<(&str, f64)> = motions.into_iter().collect();
    motions.sort_by(|a, b| a.1.total_cmp(&b.1));
    motions.iter().take(motions.len() / 2).map(|(motion, _)| *motion).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slower_half_of_the_motions_has_the_smaller_accelerations() {
        let logs = [("a", 3.0), ("b", 1.0), ("c", 2.0), ("d", 9.0), ("b", 1.5), ("a", 1.0)];
        assert_eq!(slower_half(logs.into_iter()), ["b", "c"]);
        assert!(slower_half(logs.into_iter().take(1)).is_empty());
    }
}
