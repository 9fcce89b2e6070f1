use std::fmt;
use std::path::PathBuf;
use std::time::Duration;

use serde::{Deserialize, Serialize};

/// Number of defects of one file that are listed in full; the rest are counted.
const LISTED_PER_FILE: usize = 20;

/// Number of gaps of one file whose lines are listed.
const LISTED_GAPS: usize = 3;

/// What kind of defect a recording has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum DefectKind {
    /// The file cannot be read, or it is not comma-separated text.
    File,
    /// The header differs.
    Header,
    /// The number of joints differs.
    Joints,
    /// A line has another number of fields than the header.
    Fields,
    /// A value is not a finite number.
    Value,
    /// A time is not later than the one before.
    Time,
    /// Samples are missing for this long.
    Gap(Duration),
    /// There is no sample.
    Empty,
    /// Values cannot be in rad and rad/s.
    Units,
    /// Any other kind.
    Other,
}

impl DefectKind {
    #[must_use]
    pub(crate) fn gap(seconds: f64) -> Self {
        Self::Gap(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX))
    }

    /// Returns the name in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::File => "file",
            Self::Header => "header",
            Self::Joints => "joints",
            Self::Fields => "fields",
            Self::Value => "value",
            Self::Time => "time",
            Self::Gap(_) => "gap",
            Self::Empty => "empty",
            Self::Units => "units",
            Self::Other => "other",
        }
    }

    /// Returns whether both are of one kind; gaps of any length are.
    #[must_use]
    pub(crate) fn is_like(self, other: Self) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }
}

/// A defect of a recording: where it is, what is wrong, and what to do.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Defect {
    /// The file.
    pub file: PathBuf,
    /// Line in the file, from 1; `None` for a defect of the whole file.
    pub line: Option<u64>,
    /// The joint, from 1; `None` for a defect of no single joint.
    pub joint: Option<usize>,
    /// The kind of defect.
    pub kind: DefectKind,
    /// The problem, with the value and the limit.
    pub problem: String,
    /// The remedy.
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
            kind: DefectKind::Other,
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

    /// Returns the same defect with its kind.
    #[must_use]
    pub fn of_kind(mut self, kind: DefectKind) -> Self {
        self.kind = kind;
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

/// Returns the defects in the order found, one per line; the gaps of a file share a line, which
/// is its first. The list of a file with very many defects ends with a count of the rest.
pub(crate) fn list_defects(defects: &[Defect]) -> String {
    let mut lines = Vec::new();
    for group in defects.chunk_by(|a, b| a.file == b.file) {
        let group = folded_gaps(group);
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

/// Returns the defects of one file, with one for all gaps: the first, with the number of gaps, the
/// longest, and the first lines.
fn folded_gaps(defects: &[Defect]) -> Vec<Defect> {
    let length = |defect: &Defect| match defect.kind {
        DefectKind::Gap(length) => Some(length),
        _ => None,
    };
    let gaps: Vec<&Defect> = defects.iter().filter(|defect| length(defect).is_some()).collect();
    let [first, _, ..] = gaps[..] else { return defects.to_vec() };
    let longest = gaps.iter().filter_map(|gap| length(gap)).max().unwrap_or_default();
    let lines: Vec<String> = gaps.iter().filter_map(|gap| Some(gap.line?.to_string())).collect();
    let mut problem = format!(
        "{} ({} gaps, the longest of {:.6} s",
        first.problem,
        gaps.len(),
        longest.as_secs_f64()
    );
    if !lines.is_empty() {
        let more = if lines.len() > LISTED_GAPS { ", .." } else { "" };
        let listed = &lines[..LISTED_GAPS.min(lines.len())];
        problem += &format!(": lines {}{more}", listed.join(", "));
    }
    let folded = Defect { problem: problem + ")", ..first.clone() };
    let others = defects.iter().filter(|defect| length(defect).is_none()).cloned();
    std::iter::once(folded).chain(others).collect()
}

#[cfg(test)]
mod tests {
    use super::{Defect, DefectKind, list_defects};

    #[test]
    fn the_gaps_of_a_file_are_one_line() {
        let gap = |file: &str, line, length: f64| {
            let problem = format!("there is a gap of {length} s");
            Defect::new(file, line, problem, "cut").of_kind(DefectKind::gap(length))
        };
        let value = Defect::new("a.csv", Some(3), "q1 is x", "mend").of_kind(DefectKind::Value);
        let of_a = [(4, 0.02), (7, 0.25), (9, 0.1), (12, 0.03)];
        let mut all: Vec<Defect> =
            of_a.map(|(line, length)| gap("a.csv", Some(line), length)).to_vec();
        all.insert(1, value);
        all.extend([gap("b.csv", Some(2), 0.1), gap("c", None, 0.1), gap("c", None, 0.2)]);
        let expected = "a.csv:4: there is a gap of 0.02 s (4 gaps, the longest of 0.250000 s: \
                        lines 4, 7, 9, ..); cut\na.csv:3: q1 is x; mend\nb.csv:2: there is a \
                        gap of 0.1 s; cut\nc: there is a gap of 0.1 s (2 gaps, the longest of \
                        0.200000 s); cut";
        assert_eq!(list_defects(&all), expected);
    }
}
