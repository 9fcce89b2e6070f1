//! The recorded points of a part of a fleet's recordings, for the notions that need them.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::sync::OnceLock;

use reachtube_recordings::{Defect, ReadOptions, Run, RunEntry};
use serde::{Deserialize, Serialize};

use crate::claim::points::{KnownLists, Points};
use crate::claim::remote::{SentReply, question_from_bytes};
use crate::claim::sample_points::{AllPoints, SamplePoints, nominals};
use crate::data::fold::context::Context;
use crate::data::fold::fold::Fold;
use crate::data::fold::of_fold::OnDefect;
use crate::data::problem::Problem;
use crate::data::setup::Setup;
use crate::data::tree::{Leaf, Tree};
use crate::error::{Error, Result};
use crate::tube::deviation::Nominal;
use crate::tube::linear::Linear;

/// What every part of a fleet needs to find its points: the problem of the whole fold, and the
/// nominal motions of its suites, which are computed when they are first needed.
#[derive(Debug)]
pub struct FleetProblem {
    problem: Problem,
    context: Context,
    suites: HashMap<String, usize>,
    nominals: Vec<OnceLock<SuiteNominals>>,
}

/// The nominal motions of a suite, with the run where it belongs to one run.
type SuiteNominals = Vec<(Nominal, Option<usize>)>;

/// The recorded points of a part of a fleet's recordings: 24 n bytes for each sample of a recording
/// with n joints. It goes between machines in bytes.
///
/// The cutting planes of the notions phase-plane and exact, and the proof of every point, ask all
/// parts in rounds ([`PointServer`](crate::fleet::PointServer)). Each answer is small, and the
/// merged answer depends on the points alone: neither their grouping nor their order changes a bit
/// of it.
#[derive(Debug, Serialize, Deserialize)]
pub struct PartPoints {
    tree: Tree,
    points: Vec<SamplePoints>,
    /// Files by their places in the manifest.
    files: BTreeMap<u32, String>,
    #[serde(skip)]
    lists: KnownLists,
}

/// Takes the recordings of a part one by one.
#[derive(Debug)]
pub struct PartReader<'a> {
    fleet: &'a FleetProblem,
    tree: Tree,
    points: AllPoints,
    files: BTreeMap<u32, String>,
}

impl FleetProblem {
    /// Makes the problem of the fold of all recordings.
    ///
    /// # Errors
    ///
    /// As [`Problem::of_fold`]; [`Error::NotLinear`] for a model that is not linear.
    pub fn new(setup: Setup, whole: Fold) -> Result<Self> {
        let context = Context::new(&setup)?;
        let problem = Problem::of_fold(setup, whole, OnDefect::Report)?;
        problem.grids()?;
        let suites = problem.recordings().suites.iter();
        let suites: HashMap<String, usize> =
            suites.enumerate().map(|(index, suite)| (suite.entry.name.clone(), index)).collect();
        let nominals = (0..suites.len()).map(|_| OnceLock::new()).collect();
        Ok(Self { problem, context, suites, nominals })
    }

    /// Returns the nominal motion of a run of a suite.
    fn nominal(&self, suite: usize, run: u32) -> Result<&Nominal> {
        if self.nominals[suite].get().is_none() {
            let found = nominals(&self.problem, suite)?;
            // Another thread may have been faster; it has found the same.
            let _ = self.nominals[suite].set(found);
        }
        let known = self.nominals[suite].get().into_iter().flatten();
        let of_run = |(_, own): &&(Nominal, Option<usize>)| own.is_none_or(|r| r == run as usize);
        known.into_iter().find(of_run).map(|(nominal, _)| nominal).ok_or_else(other_recordings)
    }
}

impl<'a> PartReader<'a> {
    /// Returns the reader of a part that has no recording yet.
    ///
    /// # Errors
    ///
    /// If the solution of the system cannot be enclosed over a grid.
    pub fn new(fleet: &'a FleetProblem) -> Result<Self> {
        let points = AllPoints::new(&fleet.problem)?;
        Ok(Self { fleet, tree: Tree::default(), points, files: BTreeMap::new() })
    }

    /// Returns the options with which recordings are to be read.
    #[must_use]
    pub fn read_options(&self) -> ReadOptions {
        self.fleet.context.options
    }

    /// Takes the recording at place `index` of the manifest, as [`Fold::take`] did.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] where the fold has not taken it, or another recording there.
    pub fn take(
        &mut self,
        index: u64,
        entry: &RunEntry,
        read: Result<Run, Vec<Defect>>,
    ) -> Result<()> {
        let (file, suite) = (entry.file.as_str(), entry.suite.as_deref().unwrap_or_default());
        let place = u32::try_from(index).map_err(|_| other_recordings())?;
        let sound = read.map(Run::with_digest).ok().filter(|run| {
            let defects = self.fleet.context.input(file, run);
            defects.is_ok()
        });
        let sha256 = sound.as_ref().map_or("", |run| &run.sha256);
        if !self.tree.insert(place, Leaf { file, suite, sha256 }) {
            return Err(other_recordings());
        }
        let Some(run) = sound else { return Ok(()) };
        let suite = *self.fleet.suites.get(suite).ok_or_else(other_recordings)?;
        let nominal = self.fleet.nominal(suite, place)?;
        self.points.take((suite as u32, place), nominal, &run);
        self.files.insert(place, file.into());
        Ok(())
    }

    /// Ends the reading.
    #[must_use]
    pub fn finish(self) -> PartPoints {
        let Self { tree, points, files, .. } = self;
        PartPoints { tree, points: points.into_samples(), files, lists: KnownLists::default() }
    }
}

impl PartPoints {
    /// Answers a question about the points.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] for bytes that are no question; if the solution of the
    /// system cannot be enclosed over a grid.
    pub fn answer(&self, fleet: &FleetProblem, question: &[u8]) -> Result<Vec<u8>> {
        let question = question_from_bytes(question)?;
        let file = |run: u32| self.files.get(&run).cloned().unwrap_or_default();
        let (samples, lists) = (Cow::Borrowed(&*self.points), KnownLists::clone(&self.lists));
        let settings = (fleet.problem.settings(), fleet.problem.joints());
        let points = Points::of(samples, settings, lists, Box::new(file));
        let answer = points.answer(&Linear::new(&fleet.problem)?, &question)?;
        Ok(SentReply::new(self.tree.clone(), answer).to_bytes())
    }

    /// Merges the answers of parts to one question, in any order.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] for no answers, answers to different questions, and two answers of one part.
    pub fn merge<'b>(answers: impl IntoIterator<Item = &'b [u8]>) -> Result<Vec<u8>> {
        let mut answers = answers.into_iter().map(SentReply::from_bytes);
        let first = answers.next().ok_or_else(|| Error::Fold("there is no answer".into()))??;
        let merged = answers.try_fold(first, |all, part| all.merge(part?))?;
        Ok(merged.to_bytes())
    }

    /// Returns the number of bytes in memory, about.
    #[must_use]
    pub fn size(&self) -> usize {
        let of_sample = |at: &SamplePoints| {
            8 * at.values.len() + 4 * at.errors.len() + 8 * at.owners.len() + 128
        };
        self.points.iter().map(of_sample).sum()
    }

    /// Returns the points in bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        postcard::to_stdvec(self).expect("every part can be written")
    }

    /// Reads the bytes of points.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] for other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let read: Option<Self> = postcard::from_bytes(bytes).ok();
        read.filter(|points| points.tree.is_valid() && points.points.iter().all(SamplePoints::fits))
            .ok_or_else(|| Error::Fold("the bytes are not points".into()))
    }
}

fn other_recordings() -> Error {
    Error::Fold(
        "the recordings of this part are not the ones that were folded; fold them again".into(),
    )
}
