//! Times of files that have none, whose samples are evenly spaced.

use super::dialect::{Dialect, end_of_line};

/// Returns the content of a file with a first column `t` \[s\] of samples at a rate \[Hz\], line by
/// line.
pub(super) fn with_times(bytes: &[u8], dialect: &Dialect, rate: f64) -> Vec<u8> {
    let mut out = bytes[..dialect.start].to_vec();
    let (mut at, mut header, mut sample) = (dialect.start, dialect.lines, 0);
    while at < bytes.len() {
        let line = &bytes[at..at + end_of_line(&bytes[at..])];
        let time = match header {
            2 => "t".to_string(),
            1 if dialect.lines == 2 => "s".to_string(),
            1 => "t".to_string(),
            _ => format!("{:.12}", f64::from(sample) / rate),
        };
        if header > 0 {
            header -= 1;
        } else if !line.trim_ascii().is_empty() {
            sample += 1;
        }
        if !line.trim_ascii().is_empty() {
            out.extend(time.as_bytes());
            out.push(dialect.separator);
        }
        out.extend(line);
        out.push(b'\n');
        at += line.len() + 1;
    }
    out
}
