//! `reachtube reproduce fig1` to `fig5`: the figures of the paper.

use std::path::PathBuf;

use clap::Args;
use reachtube::reproduce::{
    PaperFigure, Table2Options, fig1, fig2, fig3, fig4, table2_and_suite, table3_and_fig5,
};
use reachtube::write;
use serde_json::json;

use crate::error::Result;
use crate::option_values::trimmed;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::titled;

const HELP: &str = "\
Example:
  reachtube campaign --out campaign
  reachtube reproduce fig4 --data campaign --out fig4.svg

The figures show the sets of `reproduce table2`: smallest for all suites, in the hull. fig5
shows the fits of `reproduce table3`.";

/// What a figure is drawn of.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Folder with runs.csv and the recordings; for fig3 and fig5, of a campaign
    #[arg(long, value_name = "FOLDER")]
    pub data: PathBuf,
    /// The test suite to draw, but for fig5 [default: the one whose runs end furthest apart]
    #[arg(long, value_name = "NAME", value_parser = trimmed)]
    pub suite: Option<String>,
    /// Write the figure to this SVG file [default: the figure's name, such as fig1.svg]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// Runs `reproduce fig1` to `fig5`.
pub(super) fn run(number: u8, args: &Arguments, json: bool) -> Result<Outcome> {
    let path = args.out.clone().unwrap_or_else(|| format!("fig{number}.svg").into());
    output::claim(&path)?;
    let figure = draw(number, args)?;
    write::atomically(&path, |out| out.write_all(figure.svg.as_bytes()))?;
    output::wrote(&path);
    let value = json!({
        "number": figure.number,
        "caption": figure.caption,
        "paper": figure.paper,
        "table": figure.table,
        "file": path.display().to_string(),
    });
    output::show(json, &value, || summary(&figure))?;
    Ok(Outcome::Done)
}

fn draw(number: u8, args: &Arguments) -> Result<PaperFigure> {
    if number == 5 {
        let bar = Progress::of("identifying");
        return Ok(table3_and_fig5(&args.data, &|done, total| bar.show(done, total))?.1);
    }
    let bar = Progress::new();
    let options = Table2Options::default();
    let (_, suite) = table2_and_suite(&args.data, &options, args.suite.as_deref(), &bar)?;
    drop(bar);
    Ok(match number {
        1 => fig1(&suite)?,
        2 => fig2(&suite)?,
        3 => fig3(&args.data, &suite.figure.suite)?,
        _ => fig4(&suite)?,
    })
}

/// Returns the caption, what the paper has, and the numbers.
pub(super) fn summary(figure: &PaperFigure) -> String {
    let PaperFigure { number, caption, paper, table, .. } = figure;
    format!("Fig. {number}: {caption}\n{paper}\n\n{}", titled(table))
}
