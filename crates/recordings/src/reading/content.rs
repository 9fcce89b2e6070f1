//! The text of files with columns.

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::defect::{Defect, DefectKind};

/// Returns the text of a file, or the numbers of a Parquet file as text, and the SHA-256 of the
/// file.
pub(super) fn content(path: &Path) -> Result<(Vec<u8>, Sha256), Vec<Defect>> {
    let refused = |problem: String, remedy: &str| {
        vec![Defect::new(path, None, problem, remedy).of_kind(DefectKind::File)]
    };
    let bytes = reachtube_files::bytes(path).map_err(|source| {
        refused(format!("cannot read: {source}"), "check the path and its permissions")
    })?;
    let digest = Sha256::new_with_prefix(&bytes);
    if !bytes.starts_with(MAGIC) {
        return Ok((bytes, digest));
    }
    let text = text_of(path, bytes).map_err(|problem| {
        refused(format!("the Parquet file cannot be read: {problem}"), "write it again")
    })?;
    Ok((text, digest))
}

/// The bytes that a Parquet file starts with.
const MAGIC: &[u8] = b"PAR1";

#[cfg(feature = "parquet")]
use super::parquet::text_of;

#[cfg(not(feature = "parquet"))]
fn text_of(_: &Path, _: Vec<u8>) -> Result<Vec<u8>, &'static str> {
    Err("its format is not built in; build with the feature parquet")
}
