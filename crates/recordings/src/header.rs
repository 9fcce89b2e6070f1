//! The header of a recording in CSV text.

use crate::run::column_names;

/// Returns whether text starts with the header `t,q1..qn,qd1..qdn,tau1..taun`.
pub(crate) fn is_strict_header(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
    let Ok(header) = reader.headers() else { return false };
    let n = header.iter().skip(1).take_while(|name| is_numbered(name, "q")).count();
    n > 0
        && header.get(0) == Some("t")
        && (1..).zip(column_names(n)).all(|(at, name)| header.get(at) == Some(&name))
}

/// Returns the name of the column with the temperature of a joint, from 1.
pub(crate) fn temperature(joint: usize) -> String {
    format!("temp{joint}")
}

/// Returns whether a name is `prefix` and a number.
pub(crate) fn is_numbered(name: &str, prefix: &str) -> bool {
    name.strip_prefix(prefix)
        .is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit()))
}
