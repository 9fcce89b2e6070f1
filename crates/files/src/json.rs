//! JSON files that carry their format and version, in a layout that people can read.

use serde::Serialize;
use serde_json::ser::{Formatter, PrettyFormatter, Serializer};

/// Parses `text`, the content of a file that `command --out` wrote, and checks its format and
/// version.
///
/// # Errors
///
/// A message with the problem and the remedy, without the file's name.
///
/// # Examples
///
/// ```
/// use reachtube_files::json;
///
/// let text = r#"{"format": "reachtube-model", "version": 1}"#;
/// assert!(json::versioned(text, "reachtube-model", 1, "conform").is_ok());
/// let error = json::versioned(text, "reachtube-model", 2, "conform").unwrap_err();
/// assert!(error.contains("run conform again"));
/// ```
pub fn versioned(
    text: &str,
    format: &str,
    version: u32,
    command: &str,
) -> Result<serde_json::Value, String> {
    let remedy = format!("give a file that `{command} --out` wrote");
    let value: serde_json::Value =
        serde_json::from_str(text).map_err(|error| format!("it is not JSON: {error}; {remedy}"))?;
    if value["format"] != format {
        let other = value["format"].as_str().map(|other| format!(", but \"{other}\""));
        let other = other.unwrap_or_default();
        return Err(format!("its format is not \"{format}\"{other}; {remedy}"));
    }
    if value["version"] != version {
        let found = &value["version"];
        return Err(format!(
            "it has version {found} of the format, but this program reads version {version}; run \
             {command} again"
        ));
    }
    Ok(value)
}

/// Returns `value` as JSON that ends with a newline. Values nested more than three deep are on one
/// line.
///
/// # Panics
///
/// Panics if `value` cannot be JSON, for example because the keys of a map are not strings.
#[must_use]
pub fn to_lines(value: &impl Serialize) -> String {
    let mut out = Vec::new();
    let mut serializer = Serializer::with_formatter(&mut out, Lines::default());
    value.serialize(&mut serializer).expect("numbers are finite and keys are strings");
    out.push(b'\n');
    String::from_utf8(out).expect("JSON is UTF-8")
}

/// Depth of nesting up to which each value has lines of its own.
const DEPTH: usize = 3;

/// A formatter that is pretty up to [`DEPTH`] and compact inside.
#[derive(Default)]
struct Lines {
    depth: usize,
    pretty: PrettyFormatter<'static>,
}

impl Lines {
    /// Enters an array or object and returns whether it has lines of its own.
    fn opened(&mut self) -> bool {
        self.depth += 1;
        self.depth <= DEPTH
    }

    /// Leaves an array or object and returns whether it had lines of its own.
    fn closed(&mut self) -> bool {
        self.depth -= 1;
        self.depth < DEPTH
    }

    fn is_compact(&self) -> bool {
        self.depth > DEPTH
    }
}

type Io = std::io::Result<()>;

/// Implements methods by the pretty formatter where a condition holds, else by the compact one.
macro_rules! delegate {
    ($($method:ident($($first:ident)?) if $pretty:expr;)*) => {$(
        fn $method<W: ?Sized + std::io::Write>(&mut self, writer: &mut W $(, $first: bool)?) -> Io {
            if $pretty(&mut *self) {
                self.pretty.$method(writer $(, $first)?)
            } else {
                serde_json::ser::CompactFormatter.$method(writer $(, $first)?)
            }
        }
    )*};
}

impl Formatter for Lines {
    delegate! {
        begin_array() if Lines::opened;
        end_array() if Lines::closed;
        begin_object() if Lines::opened;
        end_object() if Lines::closed;
        begin_array_value(first) if |lines: &mut Lines| !lines.is_compact();
        end_array_value() if |lines: &mut Lines| !lines.is_compact();
        begin_object_key(first) if |lines: &mut Lines| !lines.is_compact();
        begin_object_value() if |lines: &mut Lines| !lines.is_compact();
        end_object_value() if |lines: &mut Lines| !lines.is_compact();
    }
}
