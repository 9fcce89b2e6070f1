//! `reachtube verify`: whether the links stay clear of obstacles on every motion of a model.

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::conform::Opened;
use reachtube::page::{VERIFY_PAGE_FILE, verify_files};
use reachtube::pipeline::{ScenarioJob, Verified};
use reachtube::verify::{Answer, Scenario};

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
A model of an arm under its controller takes plans in place of recordings (docs/tracking.md):
  plan = \"plan.csv\"
  robot = \"arm.urdf\"

The folder gets a page with the worst motion in three dimensions, verify.html, and a picture of
each motion, NAME.svg; if it is not safe, also the simulated motion that comes closest,
NAME_closest.csv. With a [stop] in the scenario, each link must stay clear until standstill.

Exit codes: 0 safe, 1 unsafe, 2 error, 3 undecided.";

/// Ending of the names of closest motions.
const CLOSEST: &str = "_closest.csv";

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
    // The names of the other files are not known before the recordings are read.
    output::claim(&args.out.join(VERIFY_PAGE_FILE))?;
    let until = scenario.until;
    let job = ScenarioJob::new(scenario)?;
    let verified = {
        let bar = Progress::new();
        job.run(&bar)?
    };
    output::notes(&verified.notes);
    if let Some(Opened { model, problem, .. }) = &verified.opened {
        print_notes(model, problem, until, "until = SECONDS in the scenario changes the limit");
    }
    verified.warnings.iter().for_each(|warning| output::warn(&warning.text));
    let outcome = match verified.answer() {
        Answer::Safe => Outcome::Done,
        Answer::Undecided => Outcome::Undecided,
        Answer::Unsafe => Outcome::Unsafe,
    };
    if json {
        output::print_json(&verified.to_json())?;
    } else {
        output::print_verdict(&verified.report().to_string(), &outcome)?;
    }
    // A file in the way must not cost the verdict.
    write_files(&args.out, &verified)?;
    Ok(outcome)
}

/// Writes the page, the pictures, and the closest motions of what is not safe.
fn write_files(out: &Path, verified: &Verified) -> Result<()> {
    let files = verify_files(verified).into_iter().map(|(name, text)| (out.join(name), text));
    let files: Vec<(PathBuf, String)> = files.collect();
    output::write_all(files.iter().map(|(path, text)| (path, text.as_bytes())))?;
    let written: Vec<&Path> = files.iter().map(|(path, _)| &**path).collect();
    note_stale(out, &written);
    Ok(())
}

/// Names the closest motions that lie beside the page and do not belong to it.
fn note_stale(out: &Path, written: &[&Path]) {
    let entries = std::fs::read_dir(out).into_iter().flatten().flatten();
    let is_closest = |path: &PathBuf| path.to_string_lossy().ends_with(CLOSEST);
    let mut stale: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_closest).collect();
    stale.retain(|path| !written.contains(&&**path));
    stale.sort();
    for path in stale {
        let text = "is the closest motion of another run; remove it";
        output::note(&format!("{} {text}", path.display()));
    }
}
