//! `reachtube report`: the HTML page and figures about a model and recordings.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use reachtube::conform::Keep;
use reachtube::finding::FrontEnd;
use reachtube::page::{Assets, Sources};
use schemars::JsonSchema;
use serde::Serialize;

use crate::data_arguments::ModelArguments;
use crate::error::Result;
use crate::opened::OpenedCheck;
use crate::outcome::Outcome;
use crate::{output, report_files};

const HELP: &str = "\
Example:
  reachtube report --model model.json --data recordings --out report

Writes report.html, which works offline, and one SVG file per figure to the folder.";

/// Where the page has the library of its interactive figures
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum AssetsArgument {
    /// In the page
    Inside,
    /// In a file beside the page
    Beside,
}

impl From<AssetsArgument> for Assets {
    fn from(argument: AssetsArgument) -> Self {
        match argument {
            AssetsArgument::Inside => Assets::Inside,
            AssetsArgument::Beside => Assets::Beside,
        }
    }
}

/// Write an HTML page and figures that compare a model with recordings
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub model: ModelArguments,
    /// Folder for the page and figures
    #[arg(long, value_name = "FOLDER", default_value = "report")]
    pub out: PathBuf,
    /// Where the page has the library of its interactive figures
    #[arg(long, value_enum, default_value_t = AssetsArgument::Inside)]
    pub assets: AssetsArgument,
}

/// The result of `report`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ReportOutput {
    /// Path of the page.
    report: String,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    output::claim(&report_files::page_in(&args.out))?;
    let opened = OpenedCheck::new(&args.model, None, Keep::All)?;
    let (check, reach) = (opened.check()?, opened.reach()?);
    let OpenedCheck { model, problem, .. } = &opened;
    let sources =
        Sources { model, problem, reach: &reach, check: &check, front_end: FrontEnd::CommandLine };
    let page = report_files::write(&sources, args.assets.into(), &args.out)?;
    opened.print_notes(&args.model.data);
    output::show(json, &ReportOutput { report: page.display().to_string() }, || {
        format!("wrote {}\n", page.display())
    })?;
    Ok(Outcome::Done)
}
