//! Families of sets, and the one that carries over best to motions that are left out.

use std::ops::Range;

use rayon::prelude::*;

use crate::basis::direction;
use crate::error::Result;
use crate::fit::{JointErrors, SetForm, TrackedSet};
use crate::motion::MotionRows;
use crate::noise::at_rest;
use crate::recording::TrackedRun;

/// A family of sets: their form, and words for the nominal error.
pub(crate) struct Family {
    pub form: SetForm,
    pub words: &'static str,
}

/// All families, the simplest first.
pub(crate) const FAMILIES: [Family; 8] = [
    family(&[0], false, "an offset"),
    family(&[0, 1], false, "an offset and a lag"),
    family(&[0, 1], true, "an offset and a lag"),
    family(&[0, 1, 2], false, "an offset, a lag and the acceleration"),
    family(&[0, 1, 3], false, "an offset, a lag and the direction"),
    family(&[0, 1, 2], true, "an offset, a lag and the acceleration"),
    family(&[0, 1, 3], true, "an offset, a lag and the direction"),
    family(&[0, 1, 2, 3], true, "an offset, a lag, the acceleration and the direction"),
];

/// A family is chosen over a simpler one if its sets are smaller by more than this part.
pub(crate) const BETTER: f64 = 0.05;

/// From this number of recordings on, every second one is kept for the factor alone.
pub(crate) const FOR_SPLIT: usize = 20;

/// Largest number of motions for which the factor is found again without each of them.
const MOST_NESTED: usize = 24;

const fn family(terms: &'static [usize], grows: bool, words: &'static str) -> Family {
    Family { form: SetForm { terms, grows }, words }
}

/// The rows of all joints, and the motions that they belong to.
pub(crate) struct TrackedRows {
    /// Joint by joint, the rows of all recordings one after the other.
    joints: Vec<JointErrors>,
    /// The least half-width of each joint's set at rest: its noise there.
    least: Vec<f64>,
    /// The rows of each motion.
    motions: Vec<Range<usize>>,
    /// Whether each motion is kept for the factor alone.
    pub is_kept: Vec<bool>,
}

/// A family with its sets.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FittedFamily {
    /// Its place among the families.
    pub family: usize,
    /// The smallest sets of the motions that fit them, joint by joint.
    pub sets: Vec<TrackedSet>,
    /// For each motion: the factor by which the sets of the others have to grow to hold it.
    pub needed: Vec<f64>,
    /// The factor of all sets: the largest that a motion needed, at least 1.
    pub factor: f64,
    /// The mean over samples and joints of the half-widths with their factor, rad.
    pub mean_half_width: f64,
}

impl TrackedRows {
    /// Returns the rows of recordings with their commands of a delay before; `used` are these
    /// recordings as they are, whose speeds the model's sets are for.
    pub(crate) fn new(
        recordings: &[TrackedRun],
        used: &[TrackedRun],
        motions: &[MotionRows],
    ) -> Self {
        let n = recordings[0].joint_count();
        let of_joint = |joint: usize| {
            let rows = || rows_of(recordings);
            let rates: Vec<[f64; 2]> = rows().map(|(of, k)| of.rates(k, joint)).collect();
            let speeds = rows_of(used).map(|(of, k)| of.rates::<f64>(k, joint)[0].abs());
            let largest = speeds.fold(0.0, f64::max);
            let terms = |[speed, acceleration]: &[f64; 2]| {
                [1.0, *speed, *acceleration, direction(*speed, largest)]
            };
            JointErrors {
                error: rows().map(|(of, k)| of.error(k, joint)).collect(),
                command: rows().map(|(of, k)| of.command[k * n + joint]).collect(),
                terms: rates.iter().map(terms).collect(),
            }
        };
        let sizes = recordings.iter().map(|of| of.times.len());
        let firsts: Vec<usize> = sizes
            .scan(0, |sum, size| {
                *sum += size;
                Some(*sum - size)
            })
            .collect();
        let shifted = |motion: &MotionRows| {
            let first = firsts[motion.recording];
            first + motion.rows.start..first + motion.rows.end
        };
        let is_split = recordings.len() >= FOR_SPLIT;
        Self {
            joints: (0..n).into_par_iter().map(of_joint).collect(),
            least: (0..n).map(|joint| at_rest(recordings, joint)).collect(),
            motions: motions.iter().map(shifted).collect(),
            is_kept: motions.iter().map(|of| is_split && of.recording % 2 == 1).collect(),
        }
    }

    fn is_split(&self) -> bool {
        self.is_kept.contains(&true)
    }

    /// Returns the motions that sets are fitted to.
    fn fitted(&self) -> Vec<usize> {
        (0..self.motions.len()).filter(|motion| !self.is_kept[*motion]).collect()
    }

    /// Returns the smallest sets of some motions, joint by joint.
    fn sets(
        &self,
        motions: &[usize],
        form: SetForm,
        near: &[TrackedSet],
    ) -> Result<Vec<TrackedSet>> {
        let rows = motions.iter().flat_map(|motion| self.motions[*motion].clone());
        let of = |(joint, of_joint): (usize, &JointErrors)| {
            let near = near.get(joint).copied().unwrap_or_default();
            of_joint.smallest(rows.clone(), form, self.least[joint], &near)
        };
        self.joints.iter().enumerate().map(of).collect()
    }

    /// Returns the factor by which sets have to grow to hold a motion.
    fn needed(&self, sets: &[TrackedSet], motion: usize) -> f64 {
        let pairs = self.joints.iter().zip(sets);
        let of =
            |(own, set): (&JointErrors, &TrackedSet)| own.needed(self.motions[motion].clone(), set);
        pairs.map(of).fold(0.0, f64::max)
    }

    /// Returns what each of some motions needs of the sets of the others among them.
    fn left_out(&self, motions: &[usize], form: SetForm, near: &[TrackedSet]) -> Result<Vec<f64>> {
        let without = |out: &usize| {
            let others: Vec<usize> = motions.iter().copied().filter(|of| of != out).collect();
            Ok(self.needed(&self.sets(&others, form, near)?, *out))
        };
        motions.par_iter().map(without).collect()
    }

    /// Tries a family on motions that are left out in turn, or on the motions that are kept.
    fn tried(&self, family: usize) -> Result<FittedFamily> {
        let form = FAMILIES[family].form;
        let fitted = self.fitted();
        let sets = self.sets(&fitted, form, &[])?;
        let kept = (0..self.motions.len()).filter(|motion| self.is_kept[*motion]);
        let needed = match (self.is_split(), fitted.len()) {
            (true, _) => kept.map(|motion| self.needed(&sets, motion)).collect(),
            (false, 1) => vec![],
            (false, _) => self.left_out(&fitted, form, &sets)?,
        };
        let factor = needed.iter().copied().fold(1.0, f64::max);
        let mean = |(rows, set): (&JointErrors, &TrackedSet)| rows.mean_half_width(set);
        let sum: f64 = self.joints.iter().zip(&sets).map(mean).sum();
        let mean_half_width = factor * sum / sets.len() as f64;
        Ok(FittedFamily { family, sets, needed, factor, mean_half_width })
    }

    /// Returns all families, and the place of the simplest whose sets with their factor are about
    /// the smallest.
    pub(crate) fn choose(&self) -> Result<(Vec<FittedFamily>, usize)> {
        let all = (0..FAMILIES.len()).map(|family| self.tried(family));
        let all: Vec<FittedFamily> = all.collect::<Result<_>>()?;
        let least = all.iter().map(|tried| tried.mean_half_width).fold(f64::INFINITY, f64::min);
        let is_good = |tried: &FittedFamily| tried.mean_half_width * (1.0 - BETTER) <= least;
        let chosen = all.iter().position(is_good).unwrap_or_default();
        Ok((all, chosen))
    }

    /// Returns how many motions lie inside the sets with their factor, if both are found without
    /// them; `None` if that was not tried.
    pub(crate) fn inside(&self, chosen: &FittedFamily) -> Result<Option<usize>> {
        let fitted = self.fitted();
        if self.is_split() || !(3..=MOST_NESTED).contains(&fitted.len()) {
            return Ok(None);
        }
        let form = FAMILIES[chosen.family].form;
        let is_inside = |(out, needed): (&usize, &f64)| {
            let others: Vec<usize> = fitted.iter().copied().filter(|of| of != out).collect();
            let of_others = self.left_out(&others, form, &chosen.sets)?;
            Ok(*needed <= of_others.into_iter().fold(1.0, f64::max))
        };
        let found = fitted.par_iter().zip(&chosen.needed).map(is_inside);
        let found: Vec<bool> = found.collect::<Result<_>>()?;
        Ok(Some(found.iter().filter(|inside| **inside).count()))
    }
}

/// Returns all samples, recording by recording.
fn rows_of(recordings: &[TrackedRun]) -> impl Iterator<Item = (&TrackedRun, usize)> {
    recordings.iter().flat_map(|of| (0..of.times.len()).map(move |k| (of, k)))
}
