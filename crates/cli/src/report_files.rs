//! The report page and its figures as files.

use std::path::{Path, PathBuf};

use reachtube::page::{
    Assets, LIBRARY_FILE, Page, Sources, page, suite_svg, write_html, write_library,
};
use reachtube::write;

use crate::error::Result;
use crate::{file_names, output};

/// Returns where the page is written in `folder`.
pub(crate) fn page_in(folder: &Path) -> PathBuf {
    folder.join("report.html")
}

/// Writes the page and its figures to `folder` and returns the page's path.
pub(crate) fn write(sources: &Sources, assets: Assets, folder: &Path) -> Result<PathBuf> {
    write_excerpt(sources, assets, folder, "")
}

/// Does what [`write()`] does for some of the recordings; `excerpt` ends the line under the title
/// and says which.
pub(crate) fn write_excerpt(
    sources: &Sources,
    assets: Assets,
    folder: &Path,
    excerpt: &str,
) -> Result<PathBuf> {
    let path = page_in(folder);
    let library = folder.join(LIBRARY_FILE);
    output::claim(&path)?;
    if assets == Assets::Beside {
        output::claim(&library)?;
    }
    let mut page = page(sources)?;
    page.subtitle += excerpt;
    let mut html = Vec::new();
    write_html(&page, assets, &mut html)?;
    write_figures(&page, folder)?;
    if assets == Assets::Beside {
        let mut text = Vec::new();
        write_library(&mut text)?;
        write::atomically(&library, |out| out.write_all(&text))?;
    }
    write::atomically(&path, |out| out.write_all(&html))?;
    Ok(path)
}

/// Writes one SVG file per suite and view: A_motion.svg, A_deviation.svg.
pub(crate) fn write_figures(page: &Page, folder: &Path) -> Result<()> {
    let mut figures = Vec::new();
    for (figure, name) in page.suites.iter().zip(file_names::of_figures(&page.suites)) {
        for &view in figure.views() {
            let view_name = format!("{view:?}").to_lowercase();
            figures.push((folder.join(format!("{name}_{view_name}.svg")), figure, view));
        }
    }
    output::claim_all(figures.iter().map(|(path, ..)| path))?;
    for (path, figure, view) in figures {
        let svg = suite_svg(figure, view)?;
        write::atomically(&path, |out| out.write_all(svg.as_bytes()))?;
    }
    Ok(())
}
