use std::collections::BTreeMap;

use reachtube_recordings::Run;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::data::fold::context::Context;
use crate::data::input::RunInput;

/// The runs of a suite that stay whole in its fold.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum WholeRuns {
    /// All: each is a case of its own, or there is only one.
    All(BTreeMap<u32, WholeRun>),
    /// The first of the manifest alone.
    First(u32, WholeRun),
}

/// A run with its input, which follows from the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct WholeRun {
    #[serde(with = "stored_run")]
    pub run: Run,
    #[serde(skip, default = "RunInput::none")]
    pub input: RunInput,
}

/// A run by its numbers.
mod stored_run {
    use super::*;

    type Numbers = (f64, [Vec<f64>; 3], [Vec<f64>; 2], String);

    pub(super) fn serialize<S: Serializer>(run: &Run, out: S) -> Result<S::Ok, S::Error> {
        let Run { start, times, states, torques, temperatures, before, sha256, .. } = run;
        (start, [times, states, torques], [temperatures, before], sha256).serialize(out)
    }

    pub(super) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Run, D::Error> {
        let (start, [times, states, torques], [temperatures, before], sha256) =
            Numbers::deserialize(from)?;
        let inputs = torques.len() / times.len().max(1);
        let run = Run::new(inputs, times, states, torques).map_err(D::Error::custom)?;
        Ok(Run { start, temperatures, before, sha256, ..run })
    }
}

impl Serialize for WholeRuns {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        (self.are_all(), self.iter().collect::<Vec<_>>()).serialize(out)
    }
}

impl<'a> Deserialize<'a> for WholeRuns {
    fn deserialize<D: Deserializer<'a>>(from: D) -> Result<Self, D::Error> {
        match <(bool, Vec<(u32, WholeRun)>)>::deserialize(from)? {
            (true, runs) if !runs.is_empty() => Ok(Self::All(runs.into_iter().collect())),
            (false, mut runs) if runs.len() == 1 => {
                let (place, run) = runs.remove(0);
                Ok(Self::First(place, run))
            }
            _ => Err(D::Error::custom("a suite has a run that is whole")),
        }
    }
}

impl WholeRun {
    fn bytes(&self) -> usize {
        let Run { times, states, torques, temperatures, .. } = &self.run;
        let values = times.len() + states.len() + torques.len() + temperatures.len();
        values * size_of::<f64>()
    }
}

impl WholeRuns {
    pub(super) fn one(place: u32, run: WholeRun) -> Self {
        Self::All([(place, run)].into())
    }

    /// Merges the runs of another part. All stay whole if no two share their input, or where all
    /// are cases of their own anyway, up to `most_bytes`. Both depend on the runs only, and what
    /// holds for all holds for every part, so that the order makes no difference.
    pub(super) fn merge(self, other: Self, context: &Context, most_bytes: usize) -> Self {
        let inputs = context.shape.inputs;
        match (self, other) {
            (Self::All(mut own), Self::All(other)) => {
                let shares = |a: &WholeRun, b: &WholeRun| a.input.shares(&b.input, inputs);
                let any_shares = || own.values().any(|a| other.values().any(|b| shares(a, b)));
                let bytes: usize = own.values().chain(other.values()).map(WholeRun::bytes).sum();
                let stay = bytes <= most_bytes && (context.is_own || !any_shares());
                own.extend(other);
                let all = Self::All(own);
                if stay { all } else { all.first() }
            }
            (own, other) => match (own.first(), other.first()) {
                (Self::First(a, run), Self::First(b, _)) if a < b => Self::First(a, run),
                (_, other) => other,
            },
        }
    }

    pub(super) fn iter(&self) -> Box<dyn Iterator<Item = (u32, &WholeRun)> + '_> {
        match self {
            Self::All(runs) => Box::new(runs.iter().map(|(place, run)| (*place, run))),
            Self::First(place, run) => Box::new(std::iter::once((*place, run))),
        }
    }

    /// Computes the inputs of runs that were read from bytes; `None` if a run is none.
    pub(super) fn with_inputs(mut self, context: &Context) -> Option<Self> {
        let complete = |WholeRun { run, input }: &mut WholeRun| {
            *input = context.input("", run).ok()?;
            Some(())
        };
        match &mut self {
            Self::All(runs) => runs.values_mut().try_for_each(complete)?,
            Self::First(_, run) => complete(run)?,
        }
        Some(self)
    }

    pub(super) fn are_all(&self) -> bool {
        matches!(self, Self::All(_))
    }

    fn first(self) -> Self {
        match self {
            Self::All(mut runs) => {
                let (place, run) = runs.pop_first().expect("a suite has one run at least");
                Self::First(place, run)
            }
            first => first,
        }
    }
}
