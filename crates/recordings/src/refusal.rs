//! The defects of a data set, one entry for each kind.

use std::fmt;

use schemars::JsonSchema;
use serde::Serialize;

use crate::defect::{Defect, DefectKind};

/// All defects of one kind in a data set.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Refusal {
    /// Name of the kind.
    pub kind: &'static str,
    /// Number of defects.
    pub count: usize,
    /// Number of recordings that have them.
    pub recordings: usize,
    /// The first of them.
    pub first: DefectPlace,
    /// The remedy.
    pub remedy: String,
    /// The option that accepts all of them, if there is one.
    pub accepted_by: Option<String>,
    #[serde(skip)]
    widest: DefectKind,
}

/// Place and problem of a defect.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct DefectPlace {
    /// Path of the file.
    pub file: String,
    /// Line in the file, from 1.
    pub line: Option<u64>,
    /// The joint, from 1.
    pub joint: Option<usize>,
    /// The problem.
    pub problem: String,
}

impl Refusal {
    pub(crate) fn of_recording(defects: Vec<Defect>) -> Vec<Self> {
        let mut refusals = Vec::new();
        for defect in defects {
            add(&mut refusals, Self::of(defect), 0);
        }
        refusals
    }

    fn of(defect: Defect) -> Self {
        Self {
            kind: defect.kind.name(),
            count: 1,
            recordings: 1,
            accepted_by: acceptance(defect.kind),
            widest: defect.kind,
            remedy: defect.remedy,
            first: DefectPlace {
                file: defect.file.display().to_string(),
                line: defect.line,
                joint: defect.joint,
                problem: defect.problem,
            },
        }
    }
}

pub(crate) fn merge(all: &mut Vec<Refusal>, more: Vec<Refusal>) {
    more.into_iter().for_each(|refusal| add(all, refusal, 1));
}

fn add(all: &mut Vec<Refusal>, more: Refusal, recordings: usize) {
    match all.iter_mut().find(|known| known.widest.is_like(more.widest)) {
        Some(known) => {
            known.count += more.count;
            known.recordings += recordings;
            if let (DefectKind::Gap(known_gap), DefectKind::Gap(gap)) = (known.widest, more.widest)
                && gap > known_gap
            {
                (known.widest, known.accepted_by) = (more.widest, more.accepted_by);
            }
        }
        None => all.push(more),
    }
}

fn acceptance(kind: DefectKind) -> Option<String> {
    match kind {
        // Rounded up to the microsecond, so that it accepts the gap.
        DefectKind::Gap(length) => {
            Some(format!("--max-gap {}", (length.as_secs_f64() * 1e6).ceil() / 1e6))
        }
        _ => None,
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let DefectPlace { file, line, joint, problem } = &self.first;
        write!(f, "{file}")?;
        line.map_or(Ok(()), |line| write!(f, ":{line}"))?;
        joint.map_or(Ok(()), |joint| write!(f, ": joint {joint}"))?;
        write!(f, ": {problem}; {}", self.remedy)?;
        if self.count > 1 {
            let files = if self.recordings == 1 { "recording" } else { "recordings" };
            let (kind, count, recordings) = (self.kind, self.count, self.recordings);
            write!(f, " (kind {kind}: {count} defects in {recordings} {files}, this is the first")?;
            if let Some(option) = &self.accepted_by {
                write!(f, "; {option} accepts all")?;
            }
            write!(f, ")")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{Refusal, merge};
    use crate::defect::{Defect, DefectKind};

    #[test]
    fn defects_of_one_kind_are_one_line_with_the_option_that_accepts_all() {
        let gap = |file: &str, line, seconds: f64| {
            let kind = DefectKind::Gap(Duration::from_secs_f64(seconds));
            Defect::new(file, Some(line), format!("gap of {seconds} s"), "cut").of_kind(kind)
        };
        let value = Defect::new("b.csv", Some(9), "q1 is x", "mend").of_kind(DefectKind::Value);
        let mut all = Vec::new();
        let [first, second] = [gap("a.csv", 4, 0.02), gap("a.csv", 7, 0.25)];
        merge(&mut all, Refusal::of_recording(vec![first, second]));
        merge(&mut all, Refusal::of_recording(vec![value, gap("b.csv", 2, 0.1)]));
        let lines: Vec<String> = all.iter().map(Refusal::to_string).collect();
        let expected = "a.csv:4: gap of 0.02 s; cut (kind gap: 3 defects in 2 recordings, this is \
                        the first; --max-gap 0.25 accepts all)";
        assert_eq!(lines, [expected, "b.csv:9: q1 is x; mend"]);
    }
}
