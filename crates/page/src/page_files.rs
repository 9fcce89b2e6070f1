//! A page and its figures as files.

use std::path::PathBuf;

use reachtube_files::distinct_names;

use crate::error::Result;
use crate::figure::suite_svg;
use crate::html::write_html;
use crate::library::{Assets, LIBRARY_FILE, write_library};
use crate::page::Page;

/// Name of a page's file.
pub const PAGE_FILE: &str = "report.html";

/// A file of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PageFile {
    /// Where it lies in the folder of the page.
    pub path: PathBuf,
    /// Its content.
    pub content: Vec<u8>,
}

/// Returns the files of a page: its figures, the library of its interactive figures if it lies
/// beside the page, and the page itself, [`PAGE_FILE`], last.
///
/// # Errors
///
/// As [`write_html`].
pub fn page_files(page: &Page, assets: Assets) -> Result<Vec<PageFile>> {
    let mut files = figure_files(page)?;
    if assets == Assets::Beside {
        let mut content = Vec::new();
        write_library(&mut content)?;
        files.push(PageFile { path: LIBRARY_FILE.into(), content });
    }
    let mut content = Vec::new();
    write_html(page, assets, &mut content)?;
    files.push(PageFile { path: PAGE_FILE.into(), content });
    Ok(files)
}

/// Returns one SVG file for each suite and view of a page, such as `A_motion.svg` and
/// `A_deviation.svg`.
///
/// # Errors
///
/// As [`suite_svg`].
pub fn figure_files(page: &Page) -> Result<Vec<PageFile>> {
    let suites = page.suites.iter().map(|figure| figure.suite.clone());
    let names = distinct_names(suites, &["_motion", "_deviation"]);
    let mut files = Vec::new();
    for (figure, name) in page.suites.iter().zip(names) {
        for &view in figure.views() {
            let path = format!("{name}_{}.svg", view.name()).into();
            files.push(PageFile { path, content: suite_svg(figure, view)?.into_bytes() });
        }
    }
    Ok(files)
}
