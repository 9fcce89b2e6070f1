//! The file `reach.json`, which names what reachable sets are of.

use reachtube_files::json;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::data::problem::Problem;
use crate::model::file::Model;
use crate::model::provenance::Provenance;

/// Value of the field `format` of the file.
const FORMAT: &str = "reachtube-reach";

/// The version of the format.
const VERSION: u32 = 1;

#[derive(Serialize)]
struct ReachRecord<'a> {
    format: &'static str,
    version: u32,
    #[serde(flatten)]
    provenance: Provenance,
    files: Vec<FileRecord<'a>>,
}

#[derive(Serialize)]
struct FileRecord<'a> {
    file: &'a str,
    sha256: String,
}

impl Model {
    /// Returns the JSON that names, by SHA-256, what reachable sets are of: this model, its
    /// settings for the problem, the recordings, and the files `files` (name and content) that
    /// hold the sets.
    #[must_use]
    pub fn reach_record<'f>(&self, problem: &Problem, files: &'f [(String, Vec<u8>)]) -> String {
        let named = |(file, content): &'f (String, Vec<u8>)| FileRecord {
            file,
            sha256: reachtube_files::hex(&Sha256::digest(content)),
        };
        json::to_lines(&ReachRecord {
            format: FORMAT,
            version: VERSION,
            provenance: self.provenance(problem),
            files: files.iter().map(named).collect(),
        })
    }
}
