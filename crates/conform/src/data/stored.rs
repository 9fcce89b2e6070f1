//! How fields are written in the bytes of a fold: fields that have no form in serde, and fields
//! whose form skips parts, which a format without names of fields does not allow.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Exact sums, by their words.
pub(super) mod sums {
    use super::*;
    use reachtube_scalar::ExactSum;
    use serde::de::Error;

    pub(crate) fn serialize<S: Serializer>(sums: &[ExactSum], out: S) -> Result<S::Ok, S::Error> {
        out.collect_seq(sums.iter().map(ExactSum::to_words))
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Vec<ExactSum>, D::Error> {
        let words = Vec::<Vec<u64>>::deserialize(from)?;
        let sums = words.iter().map(|words| ExactSum::from_words(words)).collect::<Option<_>>();
        sums.ok_or_else(|| D::Error::custom("no sum has these words"))
    }
}

/// A grid: its times, or the step and the number of samples of a uniform one.
pub(super) mod grid {
    use super::*;
    use reachtube_reach::TimeGrid;
    use serde::de::Error;
    use std::sync::Arc;

    #[derive(Serialize, Deserialize)]
    enum StoredGrid {
        Uniform(f64, usize),
        Times(Vec<f64>),
    }

    pub(crate) fn serialize<S: Serializer>(grid: &TimeGrid, out: S) -> Result<S::Ok, S::Error> {
        let stored = match grid.step() {
            Some(step) => StoredGrid::Uniform(step, grid.len()),
            None => StoredGrid::Times(grid.times().to_vec()),
        };
        stored.serialize(out)
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Arc<TimeGrid>, D::Error> {
        let grid = match StoredGrid::deserialize(from)? {
            StoredGrid::Uniform(step, count) => {
                let is_sound = step > 0.0 && step.is_finite() && count < 1 << 32;
                is_sound.then(|| TimeGrid::uniform(step, count))
            }
            StoredGrid::Times(times) => TimeGrid::from_times(&times).ok(),
        };
        grid.map(Arc::new).ok_or_else(|| D::Error::custom("no grid has these times"))
    }
}

/// Numbers that are shared.
pub(super) mod values {
    use super::*;
    use std::sync::Arc;

    pub(crate) fn serialize<S: Serializer>(values: &[f64], out: S) -> Result<S::Ok, S::Error> {
        values.serialize(out)
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Arc<[f64]>, D::Error> {
        Ok(Vec::deserialize(from)?.into())
    }
}

/// Runs that have bounds, which envelopes share.
pub(super) mod owners {
    use super::*;
    use std::sync::Arc;

    pub(crate) fn serialize<S: Serializer>(runs: &[u32], out: S) -> Result<S::Ok, S::Error> {
        runs.serialize(out)
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Arc<Vec<u32>>, D::Error> {
        Ok(Arc::new(Vec::deserialize(from)?))
    }
}

/// A condition with all of its fields.
pub(super) mod condition {
    use super::*;
    use crate::data::condition::Condition;

    pub(crate) fn serialize<S: Serializer>(of: &Condition, out: S) -> Result<S::Ok, S::Error> {
        (of.place, &of.temperatures).serialize(out)
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Condition, D::Error> {
        let (place, temperatures) = Deserialize::deserialize(from)?;
        Ok(Condition { place, temperatures })
    }
}
