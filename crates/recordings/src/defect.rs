use std::fmt;
use std::path::PathBuf;

/// Number of defects of one file that are listed in full; the rest are counted.
const LISTED_PER_FILE: usize = 20;

/// A defect of a recording: where it is, what is wrong, and what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Defect {
    /// The file.
    pub file: PathBuf,
    /// Line in the file, from 1; `None` for a defect of the whole file.
    pub line: Option<u64>,
    /// The joint, from 1; `None` for a defect of no single joint.
    pub joint: Option<usize>,
    /// What is wrong, with the value and the limit.
    pub problem: String,
    /// What to do.
    pub remedy: String,
}

impl Defect {
    /// Returns a defect of a file, or of one `line` of it (from 1).
    #[must_use]
    pub fn new(
        file: impl Into<PathBuf>,
        line: Option<u64>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            file: file.into(),
            line,
            joint: None,
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// Returns the same defect with its joint (from 1).
    #[must_use]
    pub fn of_joint(mut self, joint: Option<usize>) -> Self {
        self.joint = joint;
        self
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if let Some(joint) = self.joint {
            write!(f, ": joint {joint}")?;
        }
        write!(f, ": {}; {}", self.problem, self.remedy)
    }
}

/// Returns the defects in the order found, one per line. The list of a file with very many ends
/// with a count of the rest.
pub(crate) fn list_defects(defects: &[Defect]) -> String {
    let mut lines = Vec::new();
    for group in defects.chunk_by(|a, b| a.file == b.file) {
        lines.extend(group.iter().take(LISTED_PER_FILE).map(Defect::to_string));
        if group.len() > LISTED_PER_FILE {
            let more = group.len() - LISTED_PER_FILE;
            lines.push(format!(
                "{}: there are {more} more defects; correct these first",
                group[0].file.display()
            ));
        }
    }
    lines.join("\n")
}
