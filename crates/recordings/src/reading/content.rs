//! The text of files with columns.

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::defect::{Defect, DefectKind};

/// What was read of a file.
pub(super) struct Content {
    /// Its text, or the numbers of a Parquet file as text.
    pub text: Vec<u8>,
    /// The SHA-256 of the file.
    pub digest: Sha256,
    /// What is missing in the text.
    pub notes: Vec<String>,
}

pub(super) fn content(path: &Path) -> Result<Content, Vec<Defect>> {
    let refused = |problem: String, remedy: &str| {
        vec![Defect::new(path, None, problem, remedy).of_kind(DefectKind::File)]
    };
    let bytes = reachtube_files::bytes(path).map_err(|source| {
        refused(format!("cannot read: {source}"), "check the path and its permissions")
    })?;
    let digest = Sha256::new_with_prefix(&bytes);
    if !bytes.starts_with(MAGIC) {
        return Ok(Content { text: bytes, digest, notes: vec![] });
    }
    // The decoders of the library panic at some damaged files.
    let read = std::panic::catch_unwind(|| text_of(path, bytes).map_err(|of| of.to_string()));
    let read = read.unwrap_or_else(|_| Err("it is damaged".into()));
    let (text, notes) = read.map_err(|problem| {
        refused(format!("the Parquet file cannot be read: {problem}"), "write it again")
    })?;
    Ok(Content { text, digest, notes })
}

/// The bytes that a Parquet file starts with.
const MAGIC: &[u8] = b"PAR1";

#[cfg(feature = "parquet")]
use super::parquet::text_of;

#[cfg(not(feature = "parquet"))]
fn text_of(_: &Path, _: Vec<u8>) -> Result<(Vec<u8>, Vec<String>), &'static str> {
    Err("its format is not built in; build with the feature parquet")
}
