//! JSON files that notice a change of their content.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};

use crate::digest::hex;
use crate::error::{Error, Result};
use crate::json;
use crate::overwrite::TOOL;
use crate::read::read_text;

/// The fields that every sealed file has.
#[derive(Debug)]
pub struct FileHead<'a> {
    /// The name of the format.
    pub format: &'a mut String,
    /// The version of the format.
    pub version: &'a mut u32,
    /// Name and version of the program that wrote the file.
    pub tool: &'a mut String,
    /// SHA-256 of the rest of the content.
    pub sha256: &'a mut String,
}

/// A JSON file with its format, its version and a SHA-256 of its content.
pub trait SealedFile: Serialize + DeserializeOwned + Clone {
    /// What the field `format` says.
    const FORMAT: &'static str;

    /// The version of the format.
    const VERSION: u32;

    /// The command that writes the file.
    const COMMAND: &'static str;

    /// Returns the fields that every sealed file has.
    fn head(&mut self) -> FileHead<'_>;

    /// Checks what the types do not say.
    ///
    /// # Errors
    ///
    /// What is wrong, after the file's name.
    fn check_content(&self) -> Result<(), String>;

    /// Returns the same with its head filled in.
    #[must_use]
    fn sealed(mut self) -> Self {
        let head = self.head();
        *head.format = Self::FORMAT.into();
        *head.version = Self::VERSION;
        *head.tool = TOOL.into();
        let digest = digest(&self);
        *self.head().sha256 = digest;
        self
    }

    /// Reads the text of a file. Errors name the file `origin`.
    ///
    /// # Errors
    ///
    /// [`Error::Content`], which says what is wrong and what to do.
    fn parse(text: &str, origin: &Path) -> Result<Self> {
        let again = format!(
            "give the file as `{command} --out` wrote it, or run {command} again",
            command = Self::COMMAND
        );
        let read = || -> Result<Self, String> {
            let value = json::versioned(text, Self::FORMAT, Self::VERSION, Self::COMMAND)?;
            let mut found: Self =
                serde_json::from_value(value).map_err(|error| format!("{error}; {again}"))?;
            let stated = found.head().sha256.clone();
            if stated != digest(&found) {
                return Err(format!("its content was changed after it was written; {again}"));
            }
            found.check_content().map_err(|problem| format!("{problem}; {again}"))?;
            Ok(found)
        };
        read().map_err(|problem| Error::Content { path: origin.into(), problem })
    }

    /// Opens a file.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, and as [`parse`](Self::parse).
    fn open(path: &Path) -> Result<Self> {
        Self::parse(&read_text(path, "name a model file")?, path)
    }

    /// Returns whether a file has this format.
    #[must_use]
    fn is_at(path: &Path) -> bool {
        let text = read_text(path, "").unwrap_or_default();
        // The text is not parsed here: a model may be long, and its reader parses it.
        let marks = ["\"format\": ", "\"format\":"].map(|key| format!("{key}\"{}\"", Self::FORMAT));
        marks.iter().any(|mark| text.contains(mark))
    }

    /// Returns the file's text: JSON, ending with a newline.
    #[must_use]
    fn to_json(&self) -> String {
        json::to_lines(&self.clone().sealed())
    }
}

fn digest(file: &impl SealedFile) -> String {
    let mut unsealed = file.clone();
    unsealed.head().sha256.clear();
    hex(&Sha256::digest(serde_json::to_vec(&unsealed).expect("a file has string keys")))
}
