//! The JavaScript library that draws the interactive figures, Plotly.js, as the crate `plotly`
//! carries it.

use super::error::Error;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;

/// Name of the library's file where it lies beside a page.
pub const LIBRARY_FILE: &str = "plotly.js";

/// Where a page has the library of its interactive figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Assets {
    /// In the page, which then needs no other file.
    #[default]
    Inside,
    /// In the file [`LIBRARY_FILE`] beside the page, which several pages of a folder share.
    Beside,
}

/// Writes the library for pages with [`Assets::Beside`].
///
/// # Errors
///
/// Fails where `out` fails.
pub fn write_library(out: &mut impl Write) -> Result<(), Error> {
    // The mark lets a later command replace the file.
    write!(out, "/* {} */\n{}", reachtube_files::MARK, library())?;
    Ok(())
}

/// Returns the text of Plotly.js. The crate hands it out in the first of two script elements; the
/// second holds a library for formulas, which the pages do not have.
fn library() -> String {
    let elements = plotly::Plot::offline_js_sources();
    let script = elements.split_once('>').map_or("", |(_, rest)| rest);
    script.split_once("</script>").map_or("", |(text, _)| text).to_string()
}

/// Returns the library compressed with gzip, in base64: 1.9 instead of 4.7 MB in each page.
pub(super) fn compressed_library() -> String {
    // The best level takes twice as long for 2 % less.
    let mut gzip = GzEncoder::new(Vec::new(), Compression::new(4));
    let written = gzip.write_all(library().as_bytes()).and_then(|()| gzip.finish());
    STANDARD.encode(written.expect("a vector takes every byte"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_plotly_alone() {
        let text = library();
        assert!(text.trim_start().starts_with("/**\n* plotly.js v3"));
        assert!(text.len() > 4_000_000 && text.len() < 5_000_000, "{}", text.len());
        assert!(compressed_library().len() < 2_000_000);
    }

    #[test]
    fn the_file_beside_a_page_may_be_replaced() {
        let mut file = Vec::new();
        write_library(&mut file).unwrap();
        assert!(
            file[..60]
                .windows(reachtube_files::MARK.len())
                .any(|part| { part == reachtube_files::MARK.as_bytes() })
        );
    }
}
