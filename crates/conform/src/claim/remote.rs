//! Points that other processes have.

use std::fmt::Debug;

use serde::{Deserialize, Serialize};

use crate::claim::claim::{Claim, other_answer};
use crate::claim::look::{Answer, Look, Question};
use crate::data::tree::Tree;
use crate::error::{Error, Result};
use crate::sets::UncertaintySets;
use crate::tube::judged::{Along, At};
use crate::tube::plant::Plant;
use crate::tube::tube::Tube;

/// The version of questions and answers in bytes.
const VERSION: u32 = 2;

/// The way to the points of a fold's recordings, which other processes have in parts
/// ([`PartPoints`](crate::fleet::PartPoints)).
pub trait PointServer: Debug + Send + Sync {
    /// Asks every part a question, and merges the answers
    /// ([`PartPoints::merge`](crate::fleet::PartPoints::merge)) in any order.
    ///
    /// # Errors
    ///
    /// In words, where a part gave no answer.
    fn ask(&self, question: &[u8]) -> Result<Vec<u8>, String>;
}

/// Recorded points that other processes have.
#[derive(Debug)]
pub(crate) struct Remote<'a> {
    pub server: &'a dyn PointServer,
    /// The root of the tree over the recordings of the problem.
    pub root: &'a str,
    /// As [`Claim::tolerance`].
    pub tolerance: f64,
}

/// An answer, with the recordings that it is of.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SentAnswer {
    version: u32,
    tree: Tree,
    answer: Answer,
}

impl Remote<'_> {
    fn ask(&self, question: &Question) -> Result<Answer> {
        let bytes =
            self.server.ask(&question_to_bytes(question)).map_err(|why| Error::Fold(why.into()))?;
        let sent = SentAnswer::from_bytes(&bytes)?;
        if sent.tree.root() != self.root {
            return Err(Error::Fold(
                "the points do not belong to the recordings that were folded: a recording was \
                 changed meanwhile, or the points of a part are missing; fold them again"
                    .into(),
            ));
        }
        Ok(sent.answer)
    }
}

impl Claim for Remote<'_> {
    fn judge(&self, plant: &dyn Plant, sets: &UncertaintySets, look: &Look) -> Result<Tube> {
        let question = Question::Judge { sets: sets.clone(), look: look.clone() };
        let Answer::Judged(judged) = self.ask(&question)? else { return Err(other_answer()) };
        Ok(Tube { judged: Some(judged), ..plant.tube(sets, None)?.0 })
    }

    fn furthest(&self, directions: &[(At, Vec<f64>)]) -> Result<Vec<Along>> {
        let question = Question::Furthest { directions: directions.to_vec() };
        let Answer::Furthest(found) = self.ask(&question)? else { return Err(other_answer()) };
        if found.len() != directions.len() {
            return Err(other_answer());
        }
        found.into_iter().map(|along| along.ok_or_else(other_answer)).collect()
    }

    fn tolerance(&self) -> Option<f64> {
        Some(self.tolerance)
    }
}

impl SentAnswer {
    pub(crate) fn new(tree: Tree, answer: Answer) -> Self {
        Self { version: VERSION, tree, answer }
    }

    /// Merges the answer of another part.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] for an answer to another question, or of the same recordings.
    pub(crate) fn merge(mut self, other: Self) -> Result<Self> {
        if !self.tree.merge(other.tree) {
            return Err(Error::Fold("two parts have points of the same recording".into()));
        }
        let answer = self.answer.merge(other.answer);
        let answer =
            answer.ok_or_else(|| Error::Fold("two parts were asked different questions".into()))?;
        Ok(Self { answer, ..self })
    }

    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        postcard::to_stdvec(self).expect("every part can be written")
    }

    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let sent: Option<Self> = postcard::from_bytes(bytes).ok();
        sent.filter(|sent| sent.version == VERSION && sent.tree.is_valid())
            .ok_or_else(|| Error::Fold("not an answer of this version".into()))
    }
}

fn question_to_bytes(question: &Question) -> Vec<u8> {
    postcard::to_stdvec(&(VERSION, question)).expect("every part can be written")
}

/// Reads a question.
///
/// # Errors
///
/// [`Error::Fold`] for other bytes.
pub(crate) fn question_from_bytes(bytes: &[u8]) -> Result<Question> {
    let read: Option<(u32, Question)> = postcard::from_bytes(bytes).ok();
    let question = read.filter(|(version, _)| *version == VERSION).map(|(_, question)| question);
    question.ok_or_else(|| Error::Fold("not a question of this version".into()))
}
