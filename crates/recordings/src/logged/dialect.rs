//! The separator and the header of a text file.

use std::path::Path;

use crate::defect::{Defect, DefectKind};
use crate::other_format::not_text;
use crate::text::{line_of, quoted};

/// A text file with columns, up to its header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Dialect {
    pub separator: u8,
    /// Byte at which the header starts.
    pub start: usize,
    /// Names of the columns; unnamed ones are empty.
    pub names: Vec<String>,
    /// Line of the header, from 1.
    pub line: u64,
}

impl Dialect {
    /// Recognises the dialect of the content of a file.
    pub(super) fn of(path: &Path, bytes: &[u8]) -> Result<Self, Box<Defect>> {
        let refused = |line, problem: String, remedy: &str| {
            Box::new(Defect::new(path, line, problem, remedy).of_kind(DefectKind::File))
        };
        if let Some((problem, remedy)) = not_text(bytes) {
            return Err(refused(Some(1), problem, remedy));
        }
        let Some((start, line)) = header_at(bytes) else {
            let remedy = "record it again, or take the file out of the folder";
            return Err(refused(Some(1), "the file has no header".into(), remedy));
        };
        let text = bytes[start..].split(|byte| *byte == b'\n').next().unwrap_or_default();
        let separator = separator(text);
        let mut names = fields(text, separator).unwrap_or_default();
        if names.iter().all(|name| name.parse::<f64>().is_ok()) {
            let problem = format!("line {line} holds numbers, so the header is missing");
            let remedy = "add a first line with the names of the columns, such as \
                          t,q1..qn,qd1..qdn,tau1..taun";
            return Err(refused(Some(line), problem, remedy));
        }
        if let [only] = &names[..] {
            let problem = format!("the header {} has one column", quoted(only));
            let remedy = "separate the columns by commas, semicolons, tabs or blanks";
            return Err(refused(Some(line), problem, remedy));
        }
        // A separator at the end of each line makes no column.
        while names.last().is_some_and(String::is_empty) {
            names.pop();
        }
        Ok(Self { separator, start, names, line })
    }

    /// Returns the separator for messages.
    pub(super) fn separator_name(&self) -> &'static str {
        match self.separator {
            b';' => "semicolons",
            b'\t' => "tabs",
            b',' => "commas",
            _ => "blanks",
        }
    }

    /// Calls `row` with the line and the fields of each row after the header, until it returns
    /// whether to go on with `false`. Rows without text are skipped.
    pub(super) fn rows(
        &self,
        bytes: &[u8],
        mut row: impl FnMut(u64, &[&str]) -> bool,
    ) -> Result<(), (u64, String)> {
        let mut reader = reader(&bytes[self.start..], self.separator);
        let mut record = csv::ByteRecord::new();
        let mut is_header = true;
        loop {
            let line = |position| self.line - 1 + line_of(&bytes[self.start..], position);
            match reader.read_byte_record(&mut record) {
                Ok(false) => return Ok(()),
                Ok(true) if is_header => is_header = false,
                Ok(true) => {
                    let text: Vec<_> = record.iter().map(String::from_utf8_lossy).collect();
                    let mut fields: Vec<&str> = text.iter().map(|field| &**field).collect();
                    if self.separator == b' ' {
                        fields.retain(|field| !field.is_empty());
                    }
                    while fields.len() > self.names.len()
                        && fields.last().is_some_and(|field| field.is_empty())
                    {
                        fields.pop();
                    }
                    let is_blank = fields.iter().all(|field| field.is_empty());
                    if !is_blank && !row(line(record.position()), &fields) {
                        return Ok(());
                    }
                }
                Err(error) => return Err((line(error.position()), error.to_string())),
            }
        }
    }
}

fn reader(bytes: &[u8], separator: u8) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .flexible(true)
        .has_headers(false)
        .trim(csv::Trim::All)
        .delimiter(separator)
        .from_reader(bytes)
}

/// Returns the first byte and the line of the header: the first line with text. A last
/// comment `#` before numbers is the header, as NumPy writes it.
fn header_at(bytes: &[u8]) -> Option<(usize, u64)> {
    let mut at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let mut comment = None;
    for (number, line) in (1..).zip(bytes[at..].split(|byte| *byte == b'\n')) {
        let text = line.trim_ascii();
        let is_comment = text.starts_with(b"#");
        if !text.is_empty() && !is_comment {
            let is_number = |name: &String| name.parse::<f64>().is_ok();
            let numbers = fields(text, separator(text))?.iter().any(is_number);
            return comment.filter(|_| numbers).or(Some((at, number)));
        }
        if is_comment {
            let marks = line.iter().take_while(|byte| matches!(byte, b'#' | b' ')).count();
            comment = Some((at + marks, number));
        }
        at += line.len() + 1;
    }
    None
}

/// Returns the separator of a line outside quotes: semicolons before tabs, commas and blanks.
fn separator(line: &[u8]) -> u8 {
    let mut quoted = false;
    let mut found = [false; 3];
    for byte in line.trim_ascii() {
        quoted ^= *byte == b'"';
        for (found, separator) in found.iter_mut().zip(b";\t,") {
            *found |= !quoted && byte == separator;
        }
    }
    let at = found.iter().position(|found| *found);
    at.map_or(b' ', |at| b";\t,"[at])
}

/// Returns the fields of one line.
fn fields(line: &[u8], separator: u8) -> Option<Vec<String>> {
    let mut record = csv::ByteRecord::new();
    reader(line, separator).read_byte_record(&mut record).ok()?;
    let fields = record.iter().map(|field| String::from_utf8_lossy(field).trim().to_string());
    Some(fields.filter(|field| separator != b' ' || !field.is_empty()).collect())
}

#[cfg(test)]
mod tests {
    use super::Dialect;

    fn dialect(text: &str) -> Result<Dialect, String> {
        Dialect::of("log.csv".as_ref(), text.as_bytes()).map_err(|defect| defect.to_string())
    }

    #[test]
    fn separators_are_recognised() {
        let cases = [
            ("t,- a_1_position,b\n", ",", vec!["t", "- a_1_position", "b"]),
            ("t;\"a;b\";c\n", ";", vec!["t", "a;b", "c"]),
            ("t\ta b\tc\r\n", "\t", vec!["t", "a b", "c"]),
            ("\n\nt  a   b\n0 1 2\n", " ", vec!["t", "a", "b"]),
            ("# made by hand\n# t a b\n0 1 2\n", " ", vec!["t", "a", "b"]),
            ("\u{feff}t,a,\n", ",", vec!["t", "a"]),
        ];
        for (text, separator, names) in cases {
            let found = dialect(text).unwrap();
            assert_eq!((found.separator, found.names), (separator.as_bytes()[0], names_of(&names)));
        }
    }

    fn names_of(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).into()).collect()
    }

    #[test]
    fn files_without_a_header_are_refused() {
        for (text, words) in [
            ("", "the file is empty"),
            ("\n\n", "no header"),
            ("1,2,3\n", "the header is missing"),
            ("abc\n", "one column"),
        ] {
            let error = dialect(text).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn empty_lines_are_skipped_and_lines_are_counted() {
        let text = "t,a\n\n1,2\n,\n\n3,4,\n5\n";
        let dialect = dialect(text).unwrap();
        let mut rows = Vec::new();
        let keep = |line, fields: &[&str]| {
            rows.push((line, fields.join("|")));
            true
        };
        dialect.rows(text.as_bytes(), keep).unwrap();
        let expected = [(3, "1|2"), (6, "3|4"), (7, "5")];
        assert_eq!(rows, expected.map(|(line, text)| (line, text.to_string())));
    }
}
