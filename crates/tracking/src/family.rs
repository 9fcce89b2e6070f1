//! Families of nominal errors, and the one that carries over best to motions that are left out.

use std::ops::Range;

use rayon::prelude::*;

use crate::basis::TERMS;
use crate::error::Result;
use crate::fit::{Centred, Rows};
use crate::motion::Motion;
use crate::recording::Recording;

/// What a nominal error depends on: the number of its terms, and the words for it.
pub(crate) const FAMILIES: [(usize, &str); TERMS] =
    [(1, "an offset"), (2, "an offset and a lag"), (3, "an offset, a lag and the acceleration")];

/// A family is chosen over a simpler one if its sets are smaller by this part.
const BETTER: f64 = 0.05;

/// From this number of recordings on, every second one is kept for the factor alone.
pub(crate) const FOR_SPLIT: usize = 20;

/// Largest number of motions for which the factor is found again without each of them.
const MOST_NESTED: usize = 24;

/// The rows of all joints, and the motions that they belong to.
pub(crate) struct Evidence {
    /// Joint by joint, the rows of all recordings one after the other.
    pub joints: Vec<Rows>,
    /// The rows of each motion.
    pub motions: Vec<Range<usize>>,
    /// Whether each motion is kept for the factor alone.
    pub is_kept: Vec<bool>,
}

/// A family with its sets.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tried {
    /// Its place among the families.
    pub family: usize,
    /// The smallest sets of the motions that fit them.
    pub joints: Vec<Centred>,
    /// For each motion: the factor by which the sets of the others have to grow to hold it.
    pub needed: Vec<f64>,
    /// The factor of all sets: the largest that a motion needed, at least 1.
    pub factor: f64,
}

impl Evidence {
    pub(crate) fn new(recordings: &[Recording], motions: &[Motion]) -> Self {
        let n = recordings[0].joint_count();
        let of_joint = |joint: usize| {
            let rows = recordings.iter().flat_map(|of| (0..of.times.len()).map(move |k| (of, k)));
            Rows {
                error: rows.clone().map(|(of, k)| of.error(k, joint)).collect(),
                terms: rows.map(|(of, k)| of.terms(k, joint)).collect(),
            }
        };
        let sizes = recordings.iter().map(|of| of.times.len());
        let firsts: Vec<usize> = sizes
            .scan(0, |sum, size| {
                *sum += size;
                Some(*sum - size)
            })
            .collect();
        let shifted = |motion: &Motion| {
            let first = firsts[motion.recording];
            first + motion.rows.start..first + motion.rows.end
        };
        let is_split = recordings.len() >= FOR_SPLIT;
        Self {
            joints: (0..n).into_par_iter().map(of_joint).collect(),
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
    fn sets(&self, motions: &[usize], used: usize, near: &[Centred]) -> Result<Vec<Centred>> {
        let rows = motions.iter().flat_map(|motion| self.motions[*motion].clone());
        let of = |(joint, of_joint): (usize, &Rows)| {
            let near = near.get(joint).map_or([0.0; TERMS], |known| known.factors);
            of_joint.centred(rows.clone(), used, &near)
        };
        self.joints.iter().enumerate().map(of).collect()
    }

    /// Returns the factor by which sets have to grow to hold a motion.
    fn needed(&self, sets: &[Centred], motion: usize) -> f64 {
        let of = |(own, set): (&Rows, &Centred)| {
            own.furthest(self.motions[motion].clone(), &set.factors) / set.radius
        };
        self.joints.iter().zip(sets).map(of).filter(|ratio| !ratio.is_nan()).fold(0.0, f64::max)
    }

    /// Returns what each of some motions needs: of the sets of the others among them.
    fn left_out(&self, motions: &[usize], used: usize, near: &[Centred]) -> Result<Vec<f64>> {
        let without = |out: &usize| {
            let others: Vec<usize> = motions.iter().copied().filter(|of| of != out).collect();
            Ok(self.needed(&self.sets(&others, used, near)?, *out))
        };
        motions.par_iter().map(without).collect()
    }

    /// Tries a family on motions that are left out in turn, or on the motions that are kept.
    fn tried(&self, family: usize) -> Result<Tried> {
        let used = FAMILIES[family].0;
        let fitted = self.fitted();
        let joints = self.sets(&fitted, used, &[])?;
        let kept = (0..self.motions.len()).filter(|motion| self.is_kept[*motion]);
        let needed = match (self.is_split(), fitted.len()) {
            (true, _) => kept.map(|motion| self.needed(&joints, motion)).collect(),
            (false, 1) => vec![],
            (false, _) => self.left_out(&fitted, used, &joints)?,
        };
        let factor = needed.iter().copied().fold(1.0, f64::max);
        Ok(Tried { family, joints, needed, factor })
    }

    /// Returns all families, and the place of the simplest whose sets with their factor are about
    /// the smallest.
    pub(crate) fn choose(&self) -> Result<(Vec<Tried>, usize)> {
        let all = (0..FAMILIES.len()).map(|family| self.tried(family));
        let all: Vec<Tried> = all.collect::<Result<_>>()?;
        let least = all.iter().map(Tried::mean_width).fold(f64::INFINITY, f64::min);
        let is_good = |tried: &Tried| tried.mean_width() <= least / (1.0 - BETTER);
        let chosen = all.iter().position(is_good).unwrap_or_default();
        Ok((all, chosen))
    }

    /// Returns how many motions lie inside the sets with their factor, if both are found without
    /// them, and of how many.
    pub(crate) fn inside(&self, chosen: &Tried) -> Result<Option<(usize, usize)>> {
        let fitted = self.fitted();
        if self.is_split() || !(3..=MOST_NESTED).contains(&fitted.len()) {
            return Ok(None);
        }
        let used = FAMILIES[chosen.family].0;
        let is_inside = |(out, needed): (&usize, &f64)| {
            let others: Vec<usize> = fitted.iter().copied().filter(|of| of != out).collect();
            let of_others = self.left_out(&others, used, &chosen.joints)?;
            Ok(*needed <= of_others.into_iter().fold(1.0, f64::max))
        };
        let found = fitted.par_iter().zip(&chosen.needed).map(is_inside);
        let found: Vec<bool> = found.collect::<Result<_>>()?;
        Ok(Some((found.iter().filter(|inside| **inside).count(), found.len())))
    }
}

impl Tried {
    /// Returns the mean half-width of the joints' sets with their factor, rad.
    pub(crate) fn mean_width(&self) -> f64 {
        let sum: f64 = self.joints.iter().map(|joint| joint.radius).sum();
        self.factor * sum / self.joints.len() as f64
    }
}
