//! What the rounds of cutting planes and the proof ask of the recorded points, and the answers,
//! which merge: answers of parts of the points, in any order, give the answer of all points.

use std::collections::BTreeMap;

use reachtube_reach::Hyperrectangle;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::sets::UncertaintySets;

/// A sample: grid and sample of the grid.
pub(crate) type At = (u32, u32);

/// A point's owner: suite, and run (index in the source).
pub(crate) type Owner = (u32, u32);

/// Points outside the reachable set of `sets` shrunk by the factor `margin`, or close to its
/// boundary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Near {
    #[serde(with = "stored_sets")]
    pub sets: UncertaintySets,
    pub margin: f64,
}

/// What is asked.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) enum Question {
    /// Among the points that are in one of the lists `near`, the one furthest outside at each
    /// sample and in each projection, where the set must grow by more than 1 + `tolerance`.
    Outside {
        #[serde(with = "stored_sets")]
        sets: UncertaintySets,
        tolerance: f64,
        near: Vec<Near>,
    },
    /// The point furthest along each direction, of all at its sample.
    Furthest { directions: Vec<(At, Vec<f64>)> },
    /// The samples at which a point could not be proved, among `at` or of all.
    Unproved {
        #[serde(with = "stored_sets")]
        sets: UncertaintySets,
        at: Option<Vec<At>>,
    },
    /// The verdict.
    Judge {
        #[serde(with = "stored_sets")]
        sets: UncertaintySets,
    },
}

/// The answer to a question.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Answer {
    /// By sample and projection.
    Outside(BTreeMap<(At, u32), PointOutside>),
    /// One for each direction, where its sample has points.
    Furthest(Vec<Option<PointAlong>>),
    /// The samples, in their order.
    Unproved(Vec<At>),
    Judge(PartVerdict),
}

/// A recorded point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct RecordedPoint {
    pub owner: Owner,
    /// The recording.
    pub file: String,
    /// The deviation from the nominal solution, 2n.
    pub deviation: Vec<f64>,
}

/// A point outside a reachable set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PointOutside {
    pub point: RecordedPoint,
    /// The direction that shows it, 2n.
    pub direction: Vec<f64>,
    /// By which factor the set would have to grow at least.
    pub ratio: f64,
}

/// The point furthest along a direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PointAlong {
    pub point: RecordedPoint,
    /// lᵀ d.
    pub value: f64,
}

/// What a verdict says of some points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct PartVerdict {
    /// Number of points, each counted once for each projection.
    pub points: usize,
    /// The runs with points that were not proved.
    pub unproved: BTreeMap<Owner, UnprovedRun>,
    /// How many of these points lie outside.
    pub outside: usize,
    /// The points outside, as in [`Answer::Outside`].
    pub furthest: BTreeMap<(At, u32), PointOutside>,
}

/// A run with points that were not proved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct UnprovedRun {
    pub file: String,
    /// Number of these points.
    pub count: usize,
    /// Sample and projection of the first.
    pub first: (At, u32),
}

/// Points that can be asked: here, or with the workers of a fleet.
pub(crate) trait Points {
    /// Answers a question.
    ///
    /// # Errors
    ///
    /// Returns the errors of the way to the points.
    fn ask(&self, question: &Question) -> Result<Answer>;
}

/// The error for an answer to another question.
pub(crate) fn other_answer() -> Error {
    Error::Fold("the points gave an answer to another question; report this".into())
}

impl Answer {
    /// Merges the answer of other points to the same question; `None` if it answers another
    /// question.
    #[must_use]
    pub(crate) fn merge(self, other: Self) -> Option<Self> {
        match (self, other) {
            (Self::Outside(own), Self::Outside(other)) => {
                Some(Self::Outside(merged(own, other, further)))
            }
            (Self::Furthest(own), Self::Furthest(other)) if own.len() == other.len() => {
                let pairs = own.into_iter().zip(other);
                let later = |pair| match pair {
                    (Some(own), Some(other)) => Some(more(own, other)),
                    (own, other) => own.or(other),
                };
                Some(Self::Furthest(pairs.map(later).collect()))
            }
            (Self::Unproved(mut own), Self::Unproved(other)) => {
                own.extend(other);
                own.sort_unstable();
                own.dedup();
                Some(Self::Unproved(own))
            }
            (Self::Judge(own), Self::Judge(other)) => Some(Self::Judge(PartVerdict {
                points: own.points + other.points,
                unproved: merged(own.unproved, other.unproved, UnprovedRun::merge),
                outside: own.outside + other.outside,
                furthest: merged(own.furthest, other.furthest, further),
            })),
            _ => None,
        }
    }
}

impl UnprovedRun {
    /// Merges what another part of the points says of the same run.
    fn merge(self, other: Self) -> Self {
        let (count, first) = (self.count + other.count, self.first.min(other.first));
        Self { count, first, ..self }
    }
}

/// Merges two maps; `join` makes one value of two.
fn merged<K: Ord, V>(
    mut own: BTreeMap<K, V>,
    other: BTreeMap<K, V>,
    join: fn(V, V) -> V,
) -> BTreeMap<K, V> {
    for (key, value) in other {
        let value = match own.remove(&key) {
            Some(known) => join(known, value),
            None => value,
        };
        own.insert(key, value);
    }
    own
}

/// Returns the point that is further outside; of two as far, the one of the lower owner.
fn further(a: PointOutside, b: PointOutside) -> PointOutside {
    let is_first = a.ratio > b.ratio || a.ratio == b.ratio && a.point.owner <= b.point.owner;
    if is_first { a } else { b }
}

/// Returns the point that is further along; of two as far, the one of the lower owner.
fn more(a: PointAlong, b: PointAlong) -> PointAlong {
    let is_first = a.value > b.value || a.value == b.value && a.point.owner <= b.point.owner;
    if is_first { a } else { b }
}

/// Sets in a format without names of fields, in which none may be left out.
mod stored_sets {
    use serde::{Deserializer, Serializer};

    use super::{Deserialize, Hyperrectangle, Serialize, UncertaintySets};

    type Stored = (Hyperrectangle, Hyperrectangle, Option<Hyperrectangle>);

    pub(super) fn serialize<S: Serializer>(
        sets: &UncertaintySets,
        out: S,
    ) -> Result<S::Ok, S::Error> {
        (&sets.initial_set, &sets.input_set, &sets.noise_set).serialize(out)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<UncertaintySets, D::Error> {
        let (initial_set, input_set, noise_set) = Stored::deserialize(from)?;
        Ok(UncertaintySets { initial_set, input_set, noise_set })
    }
}
