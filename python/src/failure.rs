//! Errors of the product as exceptions.

use std::path::{MAIN_SEPARATOR, Path};

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use reachtube::conform;
use reachtube::finding::FrontEnd;
use reachtube::recordings::{self, Defect};
use reachtube_files::{ErrorKind, Kind};

/// Why a job failed, before it becomes an exception. The kinds are the classes of
/// `reachtube.errors`.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Recordings with defects, and the list of them for people.
    Defects(Vec<Defect>, String),
    /// A wrong argument.
    Setting(String),
    /// A file that is no model.
    ModelFile(String),
    /// Anything else.
    Other(String),
}

pub(crate) type Result<T, E = Failure> = std::result::Result<T, E>;

impl Failure {
    /// Returns a failure about an argument.
    pub(crate) fn setting(error: impl ToString) -> Self {
        Self::Setting(error.to_string())
    }

    /// Returns a failure about JSON that was made of arguments, whose lines no user sees.
    pub(crate) fn json(what: &str, error: &serde_json::Error) -> Self {
        let text = error.to_string();
        let problem = text.split(" at line ").next().unwrap_or_default();
        Self::Setting(format!("{what}: {problem}"))
    }

    /// Returns the failure with runs in memory, which were written as CSV files in `folder`, by
    /// their names alone.
    pub(crate) fn of_runs_in(self, folder: &Path) -> Self {
        match self {
            Self::Defects(mut defects, text) => {
                for defect in &mut defects {
                    defect.file = without_folder(&defect.file.display().to_string(), folder).into();
                }
                Self::Defects(defects, without_folder(&text, folder))
            }
            Self::Setting(text) => Self::Setting(without_folder(&text, folder)),
            Self::ModelFile(text) => Self::ModelFile(without_folder(&text, folder)),
            Self::Other(text) => Self::Other(without_folder(&text, folder)),
        }
    }

    /// Returns the exception.
    pub(crate) fn raised(self, py: Python<'_>) -> PyErr {
        self.exception(py).map_or_else(|error| error, PyErr::from_value)
    }

    fn exception(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let errors = py.import("reachtube.errors")?;
        let written = without_dashes;
        match self {
            Self::Defects(defects, text) => {
                let class = errors.getattr("Defect")?;
                let make = |defect: &Defect| {
                    class.call1((
                        defect.file.display().to_string(),
                        defect.line,
                        defect.joint,
                        defect.kind.name(),
                        written(&defect.problem),
                        written(&defect.remedy),
                    ))
                };
                let defects = defects.iter().map(make).collect::<PyResult<Vec<_>>>()?;
                errors.getattr("DefectsError")?.call1((written(&text), PyTuple::new(py, defects)?))
            }
            Self::Setting(text) => errors.getattr("SettingError")?.call1((written(&text),)),
            Self::ModelFile(text) => errors.getattr("ModelFileError")?.call1((text,)),
            Self::Other(text) => errors.getattr("ReachtubeError")?.call1((written(&text),)),
        }
    }
}

/// Returns a text in which arguments are written as in Python, such as `max_gap=SECONDS` for
/// `--max-gap SECONDS`: errors of crates below conform name an option of the command.
fn without_dashes(text: &str) -> String {
    let mut parts = text.split("--");
    let first = parts.next().unwrap_or_default().to_string();
    parts.fold(first, |text, part| {
        let is_name = |c: char| c.is_ascii_lowercase() || c == '-';
        let (name, rest) = part.split_at(part.find(|c| !is_name(c)).unwrap_or(part.len()));
        let begins = name.starts_with(|c: char| c.is_ascii_lowercase());
        let value = rest.strip_prefix(' ').filter(|value| {
            let word = value.split(|c: char| !c.is_ascii_uppercase()).next().unwrap_or_default();
            word.len() > 1
        });
        match (begins, value) {
            (false, _) => text + "--" + part,
            (true, Some(value)) => text + &name.replace('-', "_") + "=" + value,
            (true, None) => text + &name.replace('-', "_") + rest,
        }
    })
}

/// Returns a text in which `dynamic_1` stands for the path of `dynamic_1.csv` in a folder.
pub(crate) fn without_folder(text: &str, folder: &Path) -> String {
    let prefix = format!("{}{MAIN_SEPARATOR}", folder.display());
    let mut parts = text.split(&prefix);
    let first = parts.next().unwrap_or_default().to_string();
    parts.fold(first, |text, part| text + &part.replacen(".csv", "", 1))
}

impl<E: Kind> From<E> for Failure {
    fn from(error: E) -> Self {
        let text = match (&error as &dyn Kind).find::<conform::Error>() {
            Some(error) => error.written_for(FrontEnd::Python),
            None => error.to_string(),
        };
        let defects = match (&error as &dyn Kind).find() {
            Some(recordings::Error::Defects(defects)) => Some(defects.clone()),
            _ => None,
        };
        match (defects, error.kind()) {
            (Some(defects), _) => Self::Defects(defects, text),
            (None, ErrorKind::Setting | ErrorKind::Usage) => Self::Setting(text),
            (None, ErrorKind::Model) => Self::ModelFile(text),
            _ => Self::Other(text),
        }
    }
}
