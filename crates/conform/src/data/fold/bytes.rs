//! A fold in bytes.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize, Serializer};
use sha2::{Digest, Sha256};

use crate::data::fold::context::Context;
use crate::data::fold::defects::Defects;
use crate::data::fold::fold::{Fold, FoldState, other_setup};
use crate::data::fold::suite_fold::SuiteFold;
use crate::data::setup::Setup;
use crate::data::tree::Tree;
use crate::error::{Error, Result};

/// What the bytes of a fold begin with.
const FORMAT: &[u8] = b"reachtube-fold";

/// The version of the bytes.
const VERSION: u32 = 1;

/// A fold in bytes, after the format and its version and before their SHA-256.
#[derive(Deserialize)]
struct StoredFold {
    /// The digest of what the reading depends on.
    context: [u8; 32],
    most_bytes: usize,
    runs: u64,
    tree: Tree,
    defects: Defects,
    compared: Option<(String, u64)>,
    suites: Vec<(String, SuiteFold)>,
}

/// The same as it is written: a fold has many megabytes, so only one suite is copied at a time.
#[derive(Serialize)]
struct StoredRef<'a> {
    context: [u8; 32],
    most_bytes: usize,
    runs: u64,
    tree: &'a Tree,
    defects: &'a Defects,
    compared: &'a Option<(String, u64)>,
    suites: Settled<'a>,
}

/// The suites of a fold without what is superfluous.
struct Settled<'a>(&'a FoldState);

impl Serialize for Settled<'_> {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        let are_listed = self.0.are_listed();
        out.collect_seq(self.0.suites.iter().map(|(name, suite)| {
            let mut suite = suite.clone();
            suite.settle(are_listed, true);
            (name, suite)
        }))
    }
}

impl Fold {
    /// Returns the fold in bytes. Folds of the same recordings have the same bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let state = &self.state;
        let stored = StoredRef {
            context: self.context.digest,
            most_bytes: state.most_bytes,
            runs: state.runs,
            tree: &state.tree,
            defects: &state.defects,
            compared: &state.compared,
            suites: Settled(state),
        };
        let header = [FORMAT, &VERSION.to_le_bytes()].concat();
        let mut bytes = postcard::to_extend(&stored, header).expect("every part can be written");
        let digest = Sha256::digest(&bytes);
        bytes.extend_from_slice(&digest);
        bytes
    }

    /// Reads the bytes of a fold that was made with the same setup.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] for other bytes, another version, or another setup.
    pub fn from_bytes(setup: &Setup, bytes: &[u8]) -> Result<Self> {
        let context = Context::new(setup)?;
        let wrong =
            |what: &str| Error::Fold(format!("the bytes {what}; fold the recordings again").into());
        let body = bytes.strip_prefix(FORMAT).ok_or_else(|| wrong("are not a fold"))?;
        let (version, body) =
            body.split_first_chunk().ok_or_else(|| wrong("of a fold are cut off"))?;
        let version = u32::from_le_bytes(*version);
        if version != VERSION {
            return Err(wrong(&format!(
                "of a fold have version {version}, and this program reads version {VERSION}"
            )));
        }
        let (body, digest) =
            body.split_last_chunk::<32>().ok_or_else(|| wrong("of a fold are cut off"))?;
        if Sha256::digest(&bytes[..bytes.len() - 32])[..] != digest[..] {
            return Err(wrong("of a fold were damaged"));
        }
        let stored: StoredFold =
            postcard::from_bytes(body).map_err(|_| wrong("of a fold were damaged"))?;
        if !stored.tree.is_valid() {
            return Err(wrong("of a fold contradict themselves"));
        }
        if stored.context != context.digest {
            return Err(other_setup());
        }
        let suite = |(name, suite): (String, SuiteFold)| Some((name, suite.completed(&context)?));
        let suites: Option<BTreeMap<String, SuiteFold>> =
            stored.suites.into_iter().map(suite).collect();
        let state = FoldState {
            most_bytes: stored.most_bytes,
            runs: stored.runs,
            tree: stored.tree,
            suites: suites.ok_or_else(|| wrong("of a fold contradict themselves"))?,
            defects: stored.defects,
            compared: stored.compared,
        };
        Ok(Self { context: Arc::new(context), state, fitted: None })
    }
}
