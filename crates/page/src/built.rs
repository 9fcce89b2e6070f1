//! The pages about a model that was made of logs.

use reachtube_arm::ArmModel;
use reachtube_conform::{CheckJob, Keep, Opened, Silent};
use reachtube_finding::FrontEnd;
use reachtube_pipeline::Built;
use reachtube_recordings::MemoryRuns;

use crate::assemble::{as_sentence, page};
use crate::error::Result;
use crate::lead::of_built;
use crate::page::Page;
use crate::page_files::PAGE_FILE;
use crate::sources::Sources;

impl Page {
    /// Adds a link to the page about motions that were held out, in the folder `held-out` beside
    /// this page's folder.
    pub(crate) fn link_to_held_out(&mut self) {
        self.link("the same sets on motions that were held out", "held-out");
    }

    /// Adds a link to the page about the model's own recordings, in `folder` beside this page's
    /// folder.
    pub(crate) fn link_to_own(&mut self, folder: &str) {
        self.link("the recordings that the model was made of", folder);
    }

    fn link(&mut self, words: &str, folder: &str) {
        self.lead.links.push((words.into(), format!("../{folder}/{PAGE_FILE}")));
    }
}

/// Returns the pages about a model that was made of logs, each with the name of its folder: `page`
/// about some of the model's recordings, and `held-out` about some that were held out, if they
/// could be compared.
///
/// # Errors
///
/// As [`page`](fn@crate::page), and as [`CheckJob::open`](reachtube_conform::CheckJob::open).
pub fn built_pages(built: &Built) -> Result<Vec<(&'static str, Page)>> {
    let all = built.answer.model.data.run_count();
    // No recording decides sets with an allowance.
    let which = match built.answer.model.allowance.is_empty() {
        true => format!(", an excerpt of {all} with the ten that decide the sets most"),
        false => format!(", an excerpt of {all}"),
    };
    let mut own = excerpt(built, &built.shown, &which)?;
    of_built(built, &mut own.lead);
    own.verdict.words = as_sentence(&built.verdict());
    own.verdict.useful = Some(built.is_useful());
    // What follows for new motions follows from all that was held out, and not from an excerpt.
    let new_motions = vec![as_sentence(&format!("new motions: {}", built.next_motion()))];
    own.trust.clone_from(&new_motions);
    let findings = built.findings.iter().map(|finding| finding.written_for(FrontEnd::Choices));
    own.verdict.warnings.splice(0..0, findings);
    let remedies = built.remedies.iter();
    let remedies = remedies.map(|finding| as_sentence(&finding.written_for(FrontEnd::Choices)));
    own.verdict.warnings.extend(remedies);
    if built.held_out.failure.is_some() {
        return Ok(vec![("page", own)]);
    }
    let all = built.held_out.windows;
    let which =
        format!(", an excerpt of {all} that were held out, with up to 12 that leave the sets");
    let mut other = excerpt(built, &built.shown_held_out, &which)?;
    other.trust = new_motions;
    other.verdict.words = format!("Held out: {}. {}", built.held_out_words(), other.verdict.words);
    own.link_to_held_out();
    other.link_to_own("page");
    Ok(vec![("page", own), ("held-out", other)])
}

fn excerpt(built: &Built, runs: &MemoryRuns, which: &str) -> Result<Page> {
    let own = &built.answer.model;
    let job = CheckJob::new(own.clone(), own.setup()?, runs.clone()).keep(Keep::All);
    let opened = job.open(&Silent)?;
    let (check, reach) = (opened.check()?, opened.reach()?);
    let Opened { model, problem, .. } = &opened;
    let front_end = FrontEnd::Choices;
    let mut page = page(&Sources { model, problem, reach: &reach, check: &check, front_end })?;
    page.subtitle += which;
    Ok(page)
}
