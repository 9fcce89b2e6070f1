//! The report page and its figures as files.

use std::path::{Path, PathBuf};

use reachtube::report::{Page, Sources, page, suite_svg, write_html};
use reachtube::write;

use crate::error::Result;
use crate::{file_names, output};

/// Returns where the page is written in `folder`.
pub fn page_in(folder: &Path) -> PathBuf {
    folder.join("report.html")
}

/// Writes the page and its figures to `folder` and returns the page's path.
pub fn write(sources: &Sources, folder: &Path) -> Result<PathBuf> {
    let path = page_in(folder);
    output::claim(&path)?;
    let page = page(sources)?;
    let mut html = Vec::new();
    write_html(&page, &mut html)?;
    write_figures(&page, folder)?;
    write::atomically(&path, |out| out.write_all(&html))?;
    Ok(path)
}

/// Writes one SVG file per suite and view: A_motion.svg, A_deviation.svg.
pub fn write_figures(page: &Page, folder: &Path) -> Result<()> {
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
