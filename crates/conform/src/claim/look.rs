//! How recorded points are looked at. Looks and what they find go between machines in bytes.

use reachtube_reach::Hyperrectangle;
use serde::{Deserialize, Serialize};

use crate::sets::UncertaintySets;
use crate::tube::judged::{Along, At, Judged};

/// Points outside the reachable set of `sets` shrunk by the factor `margin`, or close to its
/// boundary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Near {
    #[serde(with = "stored_sets")]
    pub sets: UncertaintySets,
    pub margin: f64,
}

/// How points are looked at under some sets.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) enum Look {
    /// In floating point: among the points that are in one of the lists `near`, the one furthest
    /// outside at each sample and in each projection, where the set must grow by more than
    /// 1 + `tolerance`.
    Search { tolerance: f64, near: Vec<Near> },
    /// With directed rounding: every point, or the points at the samples `at` alone. Also how far
    /// the sets reach in the directions `asked`.
    Proof { at: Option<Vec<At>>, asked: Vec<(At, Vec<f64>)> },
}

impl Look {
    /// Returns the look at every point that proves.
    pub(crate) fn proof() -> Self {
        Self::Proof { at: None, asked: Vec::new() }
    }
}

/// What is asked of points that other processes have.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) enum Question {
    Judge {
        #[serde(with = "stored_sets")]
        sets: UncertaintySets,
        look: Look,
    },
    /// The point furthest along each direction, of all at its sample.
    Furthest { directions: Vec<(At, Vec<f64>)> },
}

/// The answer to a question.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Reply {
    Judged(Judged),
    /// One for each direction, where its sample has points.
    Furthest(Vec<Option<Along>>),
}

impl Reply {
    /// Merges the answer of other points to the same question; `None` where it is one to another
    /// question.
    #[must_use]
    pub(crate) fn merge(self, other: Self) -> Option<Self> {
        match (self, other) {
            (Self::Judged(own), Self::Judged(other)) => Some(Self::Judged(own.merge(other))),
            (Self::Furthest(own), Self::Furthest(other)) if own.len() == other.len() => {
                let later = |pair| match pair {
                    (Some(own), Some(other)) => Some(Along::further(own, other)),
                    (own, other) => own.or(other),
                };
                Some(Self::Furthest(own.into_iter().zip(other).map(later).collect()))
            }
            _ => None,
        }
    }
}

/// Sets in a format without names of fields, in which none may be left out.
mod stored_sets {
    use serde::{Deserializer, Serializer};

    use super::{Deserialize, Hyperrectangle, Serialize, UncertaintySets};

    type StoredSets = (Hyperrectangle, Hyperrectangle, Option<Hyperrectangle>);

    pub(super) fn serialize<S: Serializer>(
        sets: &UncertaintySets,
        out: S,
    ) -> Result<S::Ok, S::Error> {
        (&sets.initial_set, &sets.input_set, &sets.noise_set).serialize(out)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<UncertaintySets, D::Error> {
        let (initial_set, input_set, noise_set) = StoredSets::deserialize(from)?;
        Ok(UncertaintySets { initial_set, input_set, noise_set })
    }
}
