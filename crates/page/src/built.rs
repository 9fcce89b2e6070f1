//! The pages about a model that was made of logs.

use reachtube_conform::result::FrontEnd;
use reachtube_conform::{Keep, Opened, Silent};
use reachtube_pipeline::Built;
use reachtube_recordings::MemoryRuns;

use crate::assemble::page;
use crate::error::Result;
use crate::page::Page;
use crate::sources::Sources;

/// Returns the pages about a model that was made of logs, each with the name of its folder: `page`
/// about some of the model's recordings, and `held-out` about some that were held out, if they
/// could be compared.
///
/// # Errors
///
/// As [`page`](fn@crate::page), and as [`CheckJob::open`](reachtube_conform::CheckJob::open).
pub fn built_pages(built: &Built, front_end: FrontEnd) -> Result<Vec<(&'static str, Page)>> {
    let all = built.answer.model.data.run_count();
    let own = format!(", an excerpt of {all} with the ten that decide the sets most");
    let mut pages = vec![("page", excerpt(built, &built.shown, front_end, &own)?)];
    if built.held_out.failure.is_none() {
        let all = built.held_out.windows;
        let other =
            format!(", an excerpt of {all} that were held out, with up to 12 that leave the sets");
        pages.push(("held-out", excerpt(built, &built.shown_held_out, front_end, &other)?));
    }
    Ok(pages)
}

/// Returns a page about some recordings; `which` ends the line under its title.
fn excerpt(built: &Built, runs: &MemoryRuns, front_end: FrontEnd, which: &str) -> Result<Page> {
    let job = built.answer.model.check(runs.clone()).keep(Keep::All);
    let opened = job.open(&Silent)?;
    let (check, reach) = (opened.check()?, opened.reach()?);
    let Opened { model, problem, .. } = &opened;
    let mut page = page(&Sources { model, problem, reach: &reach, check: &check, front_end })?;
    page.subtitle += which;
    Ok(page)
}
