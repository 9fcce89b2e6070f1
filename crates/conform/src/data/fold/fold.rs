use std::collections::{BTreeMap, HashSet};
use std::fmt;
use std::sync::Arc;

use rayon::prelude::*;
use reachtube_recordings::{Defect, ReadOptions, Run, RunEntry, RunSource};

use crate::data::envelope::Envelope;
use crate::data::fold::context::Context;
use crate::data::fold::defects::Defects;
use crate::data::fold::suite_fold::SuiteFold;
use crate::data::kept::MOST_BYTES;
use crate::data::setup::Setup;
use crate::data::tree::{Leaf, Tree};
use crate::error::{Error, Result};

/// A fold of fewer recordings keeps what a model file lists of each.
const LISTED_BELOW: u64 = 1000;

/// Recordings folded into what a conformance or a check needs of them.
///
/// A fold takes recordings one by one, each with its place in a manifest, and folds of different
/// recordings merge. Its content depends on the recordings alone: neither their order nor their
/// grouping changes a bit of it. It goes between machines in bytes, and
/// [`Problem::of_fold`](crate::Problem::of_fold) makes the problem that [`Problem::read`] makes of
/// the same recordings, up to what needs single recordings again (`docs/fleet.md`).
///
/// Its size grows with the samples of a suite and the number of suites. It does not grow with the
/// recordings of suites whose recordings share their input.
///
/// [`Problem::read`]: crate::Problem::read
#[derive(Clone)]
pub struct Fold {
    pub(super) context: Arc<Context>,
    pub(super) state: FoldState,
    /// The SHA-256 of the recordings that a model was fitted to, where the fold is to check one.
    pub(super) fitted: Option<Arc<HashSet<String>>>,
}

/// What a fold has of its recordings.
#[derive(Debug, Clone)]
pub(super) struct FoldState {
    /// Bytes of whole runs that a suite keeps at most.
    pub most_bytes: usize,
    /// Number of recordings without a defect.
    pub runs: u64,
    pub tree: Tree,
    pub suites: BTreeMap<String, SuiteFold>,
    pub defects: Defects,
    /// The digest of the recordings of the model that the fold is to check, and how many recordings
    /// are among them.
    pub compared: Option<(String, u64)>,
}

impl Fold {
    /// Returns the fold of no recording. The robot, the kind of torque, the end of the runs, the
    /// limit of gaps and the nominal start of `setup` decide how recordings are read.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] for settings that need every recording sample by sample.
    pub fn new(setup: &Setup) -> Result<Self> {
        Self::with_most_bytes(setup, MOST_BYTES)
    }

    /// Returns the same, with another limit for the recordings of a suite that have a nominal
    /// motion of their own; the usual limit is 256 MiB of samples. Folds merge where their
    /// limits are the same.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn with_most_bytes(setup: &Setup, most_bytes: usize) -> Result<Self> {
        let (tree, suites, defects) = Default::default();
        let state = FoldState { most_bytes, runs: 0, tree, suites, defects, compared: None };
        Ok(Self { context: Arc::new(Context::new(setup)?), state, fitted: None })
    }

    /// Returns the fold of no recording, to compare recordings with a model's: `digest` is the
    /// model's digest of them, and `fitted` has the SHA-256 of each that is listed.
    pub(crate) fn comparing(
        setup: &Setup,
        digest: String,
        fitted: HashSet<String>,
    ) -> Result<Self> {
        let mut fold = Self::with_most_bytes(setup, MOST_BYTES)?;
        fold.fitted = Some(Arc::new(fitted));
        fold.state.compared = Some((digest, 0));
        Ok(fold)
    }

    fn empty(&self) -> Self {
        let (tree, suites, defects) = Default::default();
        let compared = self.state.compared.as_ref().map(|(digest, _)| (digest.clone(), 0));
        let state = FoldState { runs: 0, tree, suites, defects, compared, ..self.state };
        Self { context: Arc::clone(&self.context), state, fitted: self.fitted.clone() }
    }

    /// Takes all recordings of a source that belong to a suite, on all cores. The recording with
    /// index i has place `first` + i in the manifest.
    ///
    /// # Errors
    ///
    /// As [`take`](Self::take). This fold is then as it was.
    pub fn take_source(&mut self, source: &dyn RunSource, first: u64) -> Result<()> {
        let empty = || Ok(self.empty());
        let entries = source.runs().par_iter().enumerate();
        let of_suites = entries.filter(|(_, entry)| entry.suite.is_some());
        let take = |fold: Result<Self>, (index, entry): (usize, &RunEntry)| {
            let mut fold = fold?;
            let read = source.read(index, &fold.context.options);
            fold.take(first.saturating_add(index as u64), entry, read)?;
            Ok(fold)
        };
        let merge = |own: Result<Self>, other: Result<Self>| {
            let mut own = own?;
            own.merge(other?)?;
            Ok(own)
        };
        let taken: Self = of_suites.fold(empty, take).reduce(empty, merge)?;
        self.merge(taken)
    }

    /// Returns the options with which recordings are to be read or [checked](Run::checked).
    #[must_use]
    pub fn read_options(&self) -> ReadOptions {
        self.context.options
    }

    /// Takes the recording at place `index` of the manifest: its entry there, and what was read of
    /// it with [`read_options`](Self::read_options). A recording with defects is left out, and they
    /// are kept.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] where the place is taken or above 4294967294, and where the entry names no
    /// suite. The fold is then as it was.
    pub fn take(
        &mut self,
        index: u64,
        entry: &RunEntry,
        read: Result<Run, Vec<Defect>>,
    ) -> Result<()> {
        let file = entry.file.as_str();
        let place = u32::try_from(index).ok().filter(|place| *place < u32::MAX);
        let place =
            place.ok_or_else(|| {
                Error::Fold(format!(
                "{file} has place {index} in the manifest; a manifest has at most 4294967295 \
                 recordings: split it"
            ).into())
            })?;
        let suite = entry.suite.as_deref().ok_or_else(|| {
            Error::Fold(format!("{file} has no suite; name the suite of each recording").into())
        })?;
        if self.state.compared.is_some() && self.fitted.is_none() {
            return Err(Error::Fold(
                "a fold that is to check a model takes no recordings after it was in bytes, \
                 because the model's recordings are not in them; take them with a new one and \
                 merge it"
                    .into(),
            ));
        }
        let read = read.map(Run::with_digest);
        let sound = read.and_then(|run| Ok((self.context.input(file, &run)?, run)));
        let sha256 = sound.as_ref().map_or("", |(_, run)| &run.sha256);
        if !self.state.tree.insert(place, Leaf { file, suite, sha256 }) {
            return Err(Error::Fold(format!(
                "{file}: place {index} of the manifest is taken already; give each recording once"
            ).into()));
        }
        match sound {
            Err(defects) => self.state.defects.take(place, defects),
            Ok((input, run)) => {
                let is_fitted =
                    self.fitted.as_ref().is_some_and(|fitted| fitted.contains(&run.sha256));
                if let Some((_, count)) = &mut self.state.compared {
                    *count += u64::from(is_fitted);
                }
                let mut own = Envelope::new(run.dimension());
                let known = self.state.suites.get_mut(suite).map(|known| &mut known.envelope);
                known.unwrap_or(&mut own).include(place, &run.states);
                let one = SuiteFold::of(place, entry, run, input, own);
                self.state.runs += 1;
                self.take_suite(suite, one);
            }
        }
        Ok(())
    }

    /// Merges the fold of other recordings.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] where the other fold was made with another setup or limit, or has a
    /// recording at a place that is taken. This fold is then as it was.
    pub fn merge(&mut self, other: Self) -> Result<()> {
        if self.context.digest != other.context.digest
            || self.state.most_bytes != other.state.most_bytes
            || self.state.model() != other.state.model()
        {
            return Err(other_setup());
        }
        let mut tree = self.state.tree.clone();
        if !tree.merge(other.state.tree) {
            return Err(Error::Fold(
                "two folds have a recording at the same place of the manifest; merge each fold \
                 once, and fold each recording once"
                    .into(),
            ));
        }
        self.state.tree = tree;
        self.state.runs += other.state.runs;
        if let (Some((_, own)), Some((_, other))) =
            (&mut self.state.compared, &other.state.compared)
        {
            *own += other;
        }
        self.state.defects.merge(other.state.defects);
        other.state.suites.into_iter().for_each(|(name, suite)| self.take_suite(&name, suite));
        Ok(())
    }

    fn take_suite(&mut self, name: &str, other: SuiteFold) {
        let are_listed = self.state.are_listed();
        match self.state.suites.get_mut(name) {
            Some(own) => {
                own.merge(other, &self.context, self.state.most_bytes);
                own.settle(are_listed, false);
            }
            None => {
                self.state.suites.insert(name.into(), other);
            }
        }
    }

    /// Returns the number of recordings without defects.
    #[must_use]
    pub fn run_count(&self) -> u64 {
        self.state.runs
    }

    /// Returns the number of recordings that are left out because they have defects.
    #[must_use]
    pub fn defect_count(&self) -> u64 {
        self.state.defects.recordings
    }

    /// Returns the defects of the first thousand of these recordings in the order of the manifest,
    /// 20 of each at most.
    #[must_use]
    pub fn defects(&self) -> Vec<Defect> {
        self.state.defects.list()
    }
}

impl FoldState {
    fn model(&self) -> Option<&str> {
        self.compared.as_ref().map(|(digest, _)| digest.as_str())
    }

    pub(super) fn are_listed(&self) -> bool {
        self.runs < LISTED_BELOW
    }

    /// Drops summaries that no later step needs.
    pub(super) fn settle(&mut self) {
        let are_listed = self.are_listed();
        self.suites.values_mut().for_each(|suite| suite.settle(are_listed, true));
    }
}

impl fmt::Debug for Fold {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let FoldState { runs, suites, defects, .. } = &self.state;
        let (suites, defects) = (suites.len(), defects.recordings);
        write!(f, "Fold {{ runs: {runs}, suites: {suites}, defects: {defects} }}")
    }
}

pub(super) fn other_setup() -> Error {
    Error::Fold(
        "a fold was made with another setup: the robot, the kind of torque, the end of the runs, \
         the limit of gaps, the nominal start, the limit of memory and the \
         model to check must be the same; fold all recordings with one setup"
            .into(),
    )
}
