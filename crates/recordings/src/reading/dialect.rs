//! The separator and the header of a text file.

use std::path::Path;

use crate::defect::{Defect, DefectKind};
use crate::text::{line_of, quoted};

/// A text file with columns, up to its header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Dialect {
    pub separator: u8,
    /// Byte at which the header starts.
    pub start: usize,
    /// Byte after the header's lines: one, or two where a line of units follows.
    end: usize,
    pub lines: u64,
    /// Names of the columns, with the units of the line below; unnamed ones are empty, and left
    /// out at the end.
    pub names: Vec<String>,
    /// Number of fields of the header, with unnamed ones at its end.
    fields: usize,
    /// Last line of the header, from 1.
    pub line: u64,
    /// Whether the header is a comment, as NumPy writes it.
    pub is_comment: bool,
}

impl Dialect {
    /// Recognises the dialect of the content of a file.
    pub(super) fn of(path: &Path, bytes: &[u8]) -> Result<Self, Box<Defect>> {
        let refused = |line, problem: String, remedy: &str| {
            Box::new(Defect::new(path, Some(line), problem, remedy).of_kind(DefectKind::File))
        };
        if let Some((problem, remedy)) = not_text(bytes) {
            return Err(refused(1, problem.into(), remedy));
        }
        let Some((start, line)) = header_at(bytes) else {
            let remedy = "record it again, or leave the file out";
            return Err(refused(1, "the file has no header".into(), remedy));
        };
        let text = &bytes[start..start + end_of_line(&bytes[start..])];
        let separator = separator(text);
        let mut names = fields(text, separator);
        if names.iter().all(|name| name.parse::<f64>().is_ok()) {
            let problem = "the first line holds numbers, so the header is missing".into();
            let remedy = "add a first line with the names of the columns, such as \
                          t,q1..qn,qd1..qdn,tau1..taun";
            return Err(refused(line, problem, remedy));
        }
        if let [only] = &names[..] {
            let problem = format!("the header {} has one column", quoted(only));
            let remedy = "separate the columns by commas, semicolons, tabs or blanks";
            return Err(refused(line, problem, remedy));
        }
        let (fields, mut end) = (names.len(), bytes.len().min(start + text.len() + 1));
        let below = &bytes[end..end + end_of_line(&bytes[end..])];
        let units = units_of(below, separator, names.len());
        for (name, unit) in names.iter_mut().zip(&units).filter(|(_, unit)| !unit.is_empty()) {
            name.push_str(&format!(" [{unit}]"));
        }
        let lines = if units.is_empty() { 1 } else { 2 };
        if lines == 2 {
            end = bytes.len().min(end + below.len() + 1);
        }
        while names.last().is_some_and(String::is_empty) {
            names.pop();
        }
        let is_comment = matches!(bytes[..start].last(), Some(b'#' | b' '));
        let line = line + lines - 1;
        Ok(Self { separator, start, end, lines, names, fields, line, is_comment })
    }

    pub(super) fn separator_name(&self) -> &'static str {
        match self.separator {
            b';' => "semicolons",
            b'\t' => "tabs",
            b',' => "commas",
            _ => "blanks",
        }
    }

    /// Returns the text after the header, unless only a reader of quotes can divide it.
    pub(super) fn plain_rows<'a>(&self, bytes: &'a [u8]) -> Option<&'a [u8]> {
        let header = &bytes[self.start..self.end];
        let quotes = header.iter().filter(|byte| **byte == b'"').count();
        (quotes % 2 == 0 && is_plain(header, quotes > 0)).then(|| &bytes[self.end..])
    }

    /// Divides a line of plain text into fields, as many as there are names if it has enough. The
    /// result is empty for a line without text.
    pub(super) fn fields<'a>(&self, line: &'a [u8], fields: &mut Vec<&'a [u8]>) {
        fields.clear();
        fields.extend(line.split(|byte| *byte == self.separator).map(<[u8]>::trim_ascii));
        self.trim(fields);
    }

    /// Calls `row` with the line and the fields of each row after the header, until it returns
    /// whether to continue with `false`. This reads text of any kind.
    pub(super) fn rows(
        &self,
        bytes: &[u8],
        mut row: impl FnMut(u64, &[&[u8]]) -> bool,
    ) -> Result<(), (u64, String)> {
        let bytes = &bytes[self.start..];
        let mut reader = reader(bytes, self.separator);
        let mut record = csv::ByteRecord::new();
        let first = self.line - self.lines;
        let line = |position: Option<&csv::Position>| first + line_of(bytes, position);
        let mut header = self.lines;
        loop {
            let is_record = reader.read_byte_record(&mut record);
            if !is_record.map_err(|error| (line(error.position()), error.to_string()))? {
                return Ok(());
            }
            if header > 0 {
                header -= 1;
                continue;
            }
            let mut fields: Vec<&[u8]> = record.iter().collect();
            self.trim(&mut fields);
            if !fields.is_empty() && !row(line(record.position()), &fields) {
                return Ok(());
            }
        }
    }

    /// Drops fields that stand for nothing: of unnamed columns, and of a blank line.
    fn trim(&self, fields: &mut Vec<&[u8]>) {
        if self.separator == b' ' {
            fields.retain(|field| !field.is_empty());
        }
        while fields.len() > self.names.len()
            && (fields.len() <= self.fields || fields.last().is_some_and(|last| last.is_empty()))
        {
            fields.pop();
        }
        if fields.iter().all(|field| field.is_empty()) {
            fields.clear();
        }
    }
}

pub(super) fn end_of_line(text: &[u8]) -> usize {
    text.iter().position(|byte| *byte == b'\n').unwrap_or(text.len())
}

/// Returns whether text can be divided at line ends and separators alone: it has no quotes, unless
/// they are allowed, and a carriage return only before a line feed.
pub(super) fn is_plain(bytes: &[u8], with_quotes: bool) -> bool {
    let is_lone = |at: usize| bytes.get(at + 1) != Some(&b'\n');
    (with_quotes || !bytes.contains(&b'"'))
        && (!bytes.contains(&b'\r')
            || !bytes.iter().enumerate().any(|(at, byte)| *byte == b'\r' && is_lone(at)))
}

/// Returns problem and remedy of a file that is not text.
fn not_text(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    if bytes.is_empty() {
        return Some(("the file is empty", "record it again, or leave the run out of runs.csv"));
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Some(("the file is UTF-16 text", "save it as CSV in UTF-8"));
    }
    let first = bytes.iter().find(|byte| !byte.is_ascii_whitespace());
    if let Some(b'{') = first {
        return Some(("the file is JSON", "write the recording as CSV"));
    }
    bytes.contains(&0).then_some(("the file is not text", "write the recording as CSV in UTF-8"))
}

fn reader(bytes: &[u8], separator: u8) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .flexible(true)
        .has_headers(false)
        .trim(csv::Trim::All)
        .delimiter(separator)
        .from_reader(bytes)
}

/// Returns the first byte and the line of the header: the first line with text that does not name
/// the separator, as spreadsheets write it (`sep=;`). A last comment `#` before numbers is the
/// header, as NumPy writes it.
fn header_at(bytes: &[u8]) -> Option<(usize, u64)> {
    let mut at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let mut comment = None;
    for (number, line) in (1..).zip(bytes[at..].split(|byte| *byte == b'\n')) {
        let text = line.trim_ascii();
        let is_comment = text.starts_with(b"#");
        let names_separator = text.len() < 6 && text.to_ascii_lowercase().starts_with(b"sep=");
        if !text.is_empty() && !is_comment && !names_separator {
            let is_number = |name: &String| name.parse::<f64>().is_ok();
            let numbers = || fields(text, separator(text)).iter().any(is_number);
            return comment.filter(|_| numbers()).or(Some((at, number)));
        }
        if is_comment {
            let marks = line.iter().take_while(|byte| matches!(byte, b'#' | b' ')).count();
            comment = Some((at + marks, number));
        }
        at += line.len() + 1;
    }
    None
}

/// Words of a line of units.
const UNITS: [&str; 27] = [
    "s", "sec", "ms", "us", "ns", "rad", "deg", "°", "m", "mm", "rad/s", "deg/s", "°/s", "m/s",
    "mm/s", "rpm", "rad/s^2", "rad/s²", "deg/s²", "nm", "n m", "n·m", "n*m", "n", "a", "ma", "°c",
];

/// Returns the units in the line below a header of as many fields; none if it is no line of units.
fn units_of(line: &[u8], separator: u8, count: usize) -> Vec<String> {
    let bare = |field: String| {
        let is_bracket = |letter: char| matches!(letter, '[' | ']' | '(' | ')' | '"');
        field.trim_matches(is_bracket).trim().to_string()
    };
    let units: Vec<String> = fields(line, separator).into_iter().map(bare).collect();
    let is_unit = |unit: &String| {
        let unit = unit.to_lowercase();
        unit.is_empty() || unit == "-" || UNITS.contains(&unit.as_str())
    };
    let are_units = units.len() == count && units.iter().all(is_unit);
    let is_named = units.iter().any(|unit| UNITS.contains(&unit.to_lowercase().as_str()));
    if are_units && is_named { units } else { Vec::new() }
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
fn fields(line: &[u8], separator: u8) -> Vec<String> {
    let text = |field: &[u8]| String::from_utf8_lossy(field).trim().to_string();
    let mut found: Vec<String> = if line.contains(&b'"') || line.trim_ascii().contains(&b'\r') {
        let mut record = csv::ByteRecord::new();
        // Reading bytes in memory does not fail.
        let _ = reader(line, separator).read_byte_record(&mut record);
        record.iter().map(text).collect()
    } else {
        line.split(|byte| *byte == separator).map(text).collect()
    };
    found.retain(|field| separator != b' ' || !field.is_empty());
    found
}

#[cfg(test)]
mod tests {
    use super::{Dialect, is_plain};

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
            ("t , a\r1,2\r", ",", vec!["t", "a"]),
            ("sep=;\nt;a,1\n", ";", vec!["t", "a,1"]),
            ("SEP=,\r\nt,a\r\n", ",", vec!["t", "a"]),
            ("t,q1,tau1\ns,rad,Nm\n0,1,2\n", ",", vec!["t [s]", "q1 [rad]", "tau1 [Nm]"]),
            ("t;a\n[s];[deg]\n", ";", vec!["t [s]", "a [deg]"]),
            ("t,a\ns,-\n", ",", vec!["t [s]", "a [-]"]),
            ("t,a\nx,y\n", ",", vec!["t", "a"]),
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
            ("{\"t\": 0, \"q\": [1]}\n", "the file is JSON"),
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
        let keep = |line, fields: &[&[u8]]| {
            let fields: Vec<&str> = fields.iter().map(|f| str::from_utf8(f).unwrap()).collect();
            rows.push((line, fields.join("|")));
            true
        };
        dialect.rows(text.as_bytes(), keep).unwrap();
        let expected = [(3, "1|2"), (6, "3|4"), (7, "5")];
        let with_units = format!("sep=,\n{}", text.replacen("t,a\n", "t,a\ns,rad\n", 1));
        let of_units = self::dialect(&with_units).unwrap();
        let mut lines = Vec::new();
        let keep_line = |line, _: &[&[u8]]| {
            lines.push(line);
            true
        };
        of_units.rows(with_units.as_bytes(), keep_line).unwrap();
        assert_eq!((lines, of_units.line), (vec![5, 8, 9], 3));
        assert_eq!(rows, expected.map(|(line, text)| (line, text.to_string())));
    }

    #[test]
    fn quotes_and_lone_carriage_returns_are_not_plain() {
        assert!(is_plain(b"a\r\nb", false) && !is_plain(b"a\rb", false) && !is_plain(b"a\r", true));
        assert!(!is_plain(b"\"a\",b", false) && is_plain(b"\"a\",b", true));
        let rows = |text: &'static str| dialect(text).unwrap().plain_rows(text.as_bytes());
        assert_eq!(rows("\r\n\nt,\"q1\"\r\n\n1,2\n"), Some(&b"\n1,2\n"[..]));
        assert_eq!(rows("t,q1"), Some(&b""[..]));
        assert_eq!([rows("t,\"q\n1\"\n0,1\n"), rows("t,q1\r1,2\n")], [None, None]);
    }
}
