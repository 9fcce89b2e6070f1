//! JSON files: versions, and a layout that people can read.

use serde::Serialize;
use serde_json::ser::{Formatter, PrettyFormatter, Serializer};

/// Parses a file that `command --out` wrote and checks what it says it is.
///
/// # Errors
///
/// What is wrong and what to do, in words.
pub fn versioned(
    text: &str,
    format: &str,
    version: u32,
    command: &str,
) -> Result<serde_json::Value, String> {
    let remedy = format!("give a file that `{command} --out` wrote");
    let value: serde_json::Value =
        serde_json::from_str(text).map_err(|error| format!("not JSON: {error}; {remedy}"))?;
    if value["format"] != format {
        return Err(format!("its format is not \"{format}\"; {remedy}"));
    }
    if value["version"] != version {
        let found = &value["version"];
        return Err(format!(
            "version {found} of the format, this program reads {version}; run {command} again"
        ));
    }
    Ok(value)
}

/// JSON with what is nested more than [`DEPTH`] deep on one line, ending with a newline.
#[must_use]
pub fn to_lines(value: &impl Serialize) -> String {
    let mut out = Vec::new();
    let mut serializer = Serializer::with_formatter(&mut out, Lines::default());
    value.serialize(&mut serializer).expect("numbers are finite and keys are strings");
    out.push(b'\n');
    String::from_utf8(out).expect("JSON is UTF-8")
}

const DEPTH: usize = 3;

/// Pretty outside, compact inside.
#[derive(Default)]
struct Lines {
    depth: usize,
    pretty: PrettyFormatter<'static>,
}

impl Lines {
    fn opened(&mut self) -> bool {
        self.depth += 1;
        self.depth <= DEPTH
    }

    fn closed(&mut self) -> bool {
        self.depth -= 1;
        self.depth < DEPTH
    }

    fn is_compact(&self) -> bool {
        self.depth > DEPTH
    }
}

type Io = std::io::Result<()>;

/// The formatter that is in charge: the pretty one outside, the plain one inside.
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
