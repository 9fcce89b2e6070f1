//! The report page and its figures as files.

use std::path::{Path, PathBuf};

use reachtube::page::{
    Assets, LIBRARY_FILE, PAGE_FILE, Page, PageFile, Sources, figure_files, page, page_files,
};
use reachtube::write;

use crate::error::Result;
use crate::output;

pub(crate) fn page_in(folder: &Path) -> PathBuf {
    folder.join(PAGE_FILE)
}

/// Writes the page about `sources` and its figures to `folder` and returns the page's path.
pub(crate) fn write(sources: &Sources, assets: Assets, folder: &Path) -> Result<PathBuf> {
    output::claim(&page_in(folder))?;
    if assets == Assets::Beside {
        output::claim(&folder.join(LIBRARY_FILE))?;
    }
    write_page(&page(sources)?, assets, folder)
}

/// Writes a page and its figures to `folder` and returns the page's path.
pub(crate) fn write_page(page: &Page, assets: Assets, folder: &Path) -> Result<PathBuf> {
    write_files(&page_files(page, assets)?, folder)?;
    Ok(page_in(folder))
}

/// Writes one SVG file per suite and view: A_motion.svg, A_deviation.svg.
pub(crate) fn write_figures(page: &Page, folder: &Path) -> Result<()> {
    write_files(&figure_files(page)?, folder)
}

fn write_files(files: &[PageFile], folder: &Path) -> Result<()> {
    let paths: Vec<PathBuf> = files.iter().map(|file| folder.join(&file.path)).collect();
    output::claim_all(&paths)?;
    for (path, file) in paths.iter().zip(files) {
        write::atomically(path, |out| out.write_all(&file.content))?;
    }
    Ok(())
}
