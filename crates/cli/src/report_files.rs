//! The report page and its figures as files.

use std::path::{Path, PathBuf};

use reachtube::report::{Page, page, suite_svg, write_html};
use reachtube::write;

use crate::error::Result;
use crate::file_names;
use crate::opened::Opened;

/// Writes the page and its figures to `folder`. Returns the page's path and notes on the
/// recordings.
pub fn write(opened: &Opened, folder: &Path) -> Result<(PathBuf, Vec<String>)> {
    let path = folder.join("report.html");
    write::try_at(&path)?;
    let check = opened.check()?;
    let recordings = opened.recordings()?;
    let reach = opened.reach(&recordings)?;
    let page = page(&opened.sources(&recordings, &reach, &check))?;
    let mut html = Vec::new();
    write_html(&page, &mut html)?;
    write_figures(&page, folder)?;
    write::atomically(&path, |out| out.write_all(&html))?;
    let notes = recordings.notes;
    Ok((path, notes))
}

/// Writes one SVG file per suite and view: A_motion.svg, A_deviation.svg.
pub fn write_figures(page: &Page, folder: &Path) -> Result<()> {
    for (figure, name) in page.suites.iter().zip(file_names::of_figures(&page.suites)) {
        for &view in figure.views() {
            let svg = suite_svg(figure, view)?;
            let path = folder.join(format!("{name}_{}.svg", format!("{view:?}").to_lowercase()));
            write::atomically(&path, |out| out.write_all(svg.as_bytes()))?;
        }
    }
    Ok(())
}
