//! What is found about recorded points under some sets. It merges: what is found of parts of the
//! points, in any order, gives what is found of all points.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

/// A sample: strand and sample. A strand is a grid of a linear model, a case of any other.
pub(crate) type At = (u32, u32);

/// A point's owner: suite, and run (index in the source).
pub(crate) type Owner = (u32, u32);

/// What was found about recorded points.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Judged {
    /// Number of points that were judged, each counted once for each projection.
    pub points: usize,
    /// The runs with points that were not proved to lie in the set.
    pub unproved: BTreeMap<Owner, UnprovedRun>,
    /// The samples at which a point was not proved.
    pub left: BTreeSet<At>,
    /// How many of these points lie outside, in floating point.
    pub outside: usize,
    /// The point furthest outside, by sample and projection.
    pub furthest: BTreeMap<(At, u32), PointOutside>,
    /// For each direction that was asked, by its index, max lᵀ x over the set without the noise
    /// set; in floating point.
    pub reaches: Vec<(usize, f64)>,
}

/// A run with points that were not proved.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct UnprovedRun {
    pub file: String,
    /// Number of these points.
    pub count: usize,
    /// Sample and projection of the first.
    pub first: (At, u32),
}

/// A point outside a reachable set.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PointOutside {
    pub owner: Owner,
    pub file: String,
    /// The point from the centre of the set, 2n.
    pub deviation: Vec<f64>,
    /// The direction that shows it, 2n.
    pub direction: Vec<f64>,
    /// By which factor the set would have to grow at least.
    pub ratio: f64,
    /// max lᵀ x over the set without the noise set, where the plant's program needs it.
    pub reach: Option<f64>,
}

/// The recorded point that is furthest along a direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Along {
    pub owner: Owner,
    /// The recording.
    pub file: String,
    /// The point as its strand compares it: a deviation of a linear model, a state of any other,
    /// 2n.
    pub point: Vec<f64>,
    /// lᵀ x.
    pub value: f64,
}

impl Judged {
    pub(crate) fn merge(mut self, other: Self) -> Self {
        self.points += other.points;
        self.outside += other.outside;
        merge(&mut self.unproved, other.unproved, UnprovedRun::merge);
        merge(&mut self.furthest, other.furthest, PointOutside::further);
        self.left.extend(other.left);
        self.reaches.extend(other.reaches);
        self
    }

    /// Takes points of one run that were not proved, at one sample in one projection.
    pub(crate) fn leave(&mut self, owner: Owner, file: String, first: (At, u32), count: usize) {
        self.left.insert(first.0);
        let new = UnprovedRun { file, count, first };
        merge(&mut self.unproved, BTreeMap::from([(owner, new)]), UnprovedRun::merge);
    }

    pub(crate) fn unproved_count(&self) -> usize {
        self.unproved.values().map(|run| run.count).sum()
    }
}

impl UnprovedRun {
    fn merge(self, other: Self) -> Self {
        let (count, first) = (self.count + other.count, self.first.min(other.first));
        Self { count, first, ..self }
    }
}

impl PointOutside {
    /// Returns the point that is further outside; of two as far, the lower owner's.
    fn further(self, other: Self) -> Self {
        let is_first =
            self.ratio > other.ratio || self.ratio == other.ratio && self.owner <= other.owner;
        if is_first { self } else { other }
    }
}

/// Merges two maps; `join` makes one value of two.
fn merge<K: Ord, V>(own: &mut BTreeMap<K, V>, other: BTreeMap<K, V>, join: fn(V, V) -> V) {
    for (key, value) in other {
        let value = match own.remove(&key) {
            Some(known) => join(known, value),
            None => value,
        };
        own.insert(key, value);
    }
}
