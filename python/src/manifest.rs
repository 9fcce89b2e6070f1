//! The recordings that the manifest of a fleet lists.

use std::path::Path;

use reachtube::recordings::{Defect, DefectKind, ReadOptions, RunEntry, parse_csv};

/// An entry of a manifest: its place, file, suite, motion, order, the SHA-256 that the file should
/// have, and the temperature of all joints, °C.
pub(crate) type Entry = (u64, String, String, Option<String>, u64, Option<String>, Option<f64>);

/// A recording, or its defects.
pub(crate) type Read = std::result::Result<reachtube::Run, Vec<Defect>>;

pub(crate) fn entry(row: &Entry) -> RunEntry {
    let (index, file, suite, motion, order, sha256, temperature) = row.clone();
    RunEntry {
        file,
        suite: Some(suite),
        motion,
        temperature,
        sha256,
        order,
        line: index + 1,
        ..RunEntry::default()
    }
}

/// Reads the recording in the content of a CSV file.
pub(crate) fn read_csv(row: &Entry, content: &[u8], options: &ReadOptions) -> Read {
    let name = Path::new(&row.1);
    let run = parse_csv(name, content, options)?;
    match &row.5 {
        Some(expected) if !expected.eq_ignore_ascii_case(&run.sha256) => {
            let problem = format!("its SHA-256 is {}, but the manifest has {expected}", run.sha256);
            let remedy = "the file was changed or damaged: restore it, or write the manifest again";
            Err(vec![Defect::new(name, None, problem, remedy).of_kind(DefectKind::File)])
        }
        _ => Ok(as_warm(row, run)),
    }
}

/// Checks a recording in memory as one that is read.
pub(crate) fn read_run(row: &Entry, run: &reachtube::Run, options: &ReadOptions) -> Read {
    as_warm(row, run.clone()).checked(Path::new(&row.1), options)
}

/// Gives a run without temperatures the temperature in the manifest.
fn as_warm(row: &Entry, run: reachtube::Run) -> reachtube::Run {
    let Some(temperature) = row.6.filter(|_| run.temperatures.is_empty()) else { return run };
    let temperatures = vec![temperature; run.len() * run.joints];
    run.with_temperatures(temperatures).expect("the manifest's temperature is finite")
}
