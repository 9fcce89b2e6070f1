//! Files that are no CSV text with a header.

/// The header of a recording.
pub(crate) const HEADER: &str = "the header must be t,q1..qn,qd1..qdn,tau1..taun, in s, rad, \
                                 rad/s and N m (m, m/s and N for a prismatic joint)";

/// Returns problem and remedy of a file that is not text.
pub(crate) fn not_text(bytes: &[u8]) -> Option<(String, &'static str)> {
    if bytes.is_empty() {
        return Some((
            "the file is empty".into(),
            "record it again, or leave the run out of runs.csv",
        ));
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Some(("the file is UTF-16 text".into(), "save it as CSV in UTF-8"));
    }
    if bytes.contains(&0) {
        return Some(("the file is not text".into(), "write the recording as CSV in UTF-8"));
    }
    None
}

/// Returns problem and remedy of a file that is not comma-separated text with a header.
pub(crate) fn other_format(bytes: &[u8]) -> Option<(String, &'static str)> {
    if let Some(problem) = not_text(bytes) {
        return Some(problem);
    }
    let first = bytes.split(|byte| *byte == b'\n').next().unwrap_or(bytes);
    let first = String::from_utf8_lossy(first);
    let cell = first.split(',').next().unwrap_or("").trim().trim_matches('"');
    if let Some(separator) = [';', '\t'].into_iter().find(|separator| cell.contains(*separator)) {
        let problem = format!("the columns are separated by {separator:?}");
        return Some((problem, "separate them by commas, and write numbers with a decimal point"));
    }
    if cell.parse::<f64>().is_ok() {
        return Some(("the first line holds numbers, so the header is missing".into(), HEADER));
    }
    None
}
