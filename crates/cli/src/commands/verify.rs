//! `reachtube verify`: whether the links stay clear of obstacles on every motion of a model.

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::conform::Opened;
use reachtube::page::{VERIFY_PAGE_FILE, VerifyPage, write_verify_html};
use reachtube::pipeline::{ScenarioJob, Verified};
use reachtube::verify::{Answer, Scenario};
use reachtube::write;

use crate::error::Result;
use crate::opened::print_notes;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;

const HELP: &str = "\
Example:
  reachtube verify cell.toml --out cell

cell.toml names the model, the recordings and the obstacles (docs/verify.md):
  model = \"model.json\"
  data = \"recordings\"
  [[obstacle]]
  name = \"table\"
  half-space = { normal = [0, 0, 1], offset = -0.3 }

The folder gets a page with the worst motion in three dimensions, verify.html, and a picture of
each motion, NAME.svg; if it is not safe, also the simulated motion that comes closest,
NAME_closest.csv. With a [stop] in the scenario, each link must stay clear until standstill.

Exit codes: 0 safe, 1 unsafe, 2 error, 3 undecided.";

/// Decide whether the links stay clear of obstacles on every motion of a model
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// TOML file with model, recordings and obstacles
    #[arg(value_name = "SCENARIO")]
    pub scenario: PathBuf,
    /// Folder for the page, the pictures and the closest motions
    #[arg(long, value_name = "FOLDER", default_value = "verify")]
    pub out: PathBuf,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let scenario = Scenario::open(&args.scenario)?;
    write::try_at(&args.out.join("A.svg"))?;
    let until = scenario.until;
    let job = ScenarioJob::new(scenario)?;
    let verified = {
        let bar = Progress::new();
        job.run(&bar)?
    };
    let Opened { model, problem, .. } = &verified.opened;
    print_notes(model, problem, until);
    verified.warnings().iter().for_each(|warning| output::warn(&warning.text));
    write_files(&args.out, &verified)?;
    let outcome = match verified.answer() {
        Answer::Safe => Outcome::Done,
        Answer::Undecided => Outcome::Undecided,
        Answer::Unsafe => Outcome::Unsafe,
    };
    if json {
        output::print_json(&verified.to_json())?;
    } else {
        output::print_verdict(&verified.report(), &outcome)?;
    }
    Ok(outcome)
}

/// Writes the pictures, and the closest motions of what is not safe.
fn write_files(out: &Path, verified: &Verified) -> Result<()> {
    let Verified { motions, body, scene, .. } = verified;
    let files = verified.files().into_iter().map(|(name, text)| (out.join(name), text));
    let files: Vec<(PathBuf, String)> = files.collect();
    let mut html = Vec::new();
    let warnings = &verified.warnings();
    write_verify_html(&VerifyPage { all: motions, body, scene, warnings }, &mut html)?;
    let page = out.join(VERIFY_PAGE_FILE);
    output::claim_all(files.iter().map(|(path, _)| path).chain([&page]))?;
    write::atomically(&page, |file| file.write_all(&html))?;
    for (path, text) in &files {
        write::atomically(path, |file| file.write_all(text.as_bytes()))?;
    }
    Ok(())
}
