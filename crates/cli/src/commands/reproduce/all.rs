//! `reachtube reproduce all`: the paper's experiment on one page.

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::campaign::{self, CampaignOptions};
use reachtube::conform::Notion;
use reachtube::page::TextTable;
use reachtube::reproduce::{
    Claim, Coverage, CoverageOptions, Exemplary, PaperFigure, PaperPage, Table1, Table1Options,
    Table2, Table2Options, Table3, coverage, fig1, fig2, fig3, fig4, table1, table2_and_suite,
    table3_and_fig5,
};
use reachtube::{TOOL, write};
use reachtube_robot::Robot;
use serde::Serialize;
use serde_json::json;

use crate::error::Result;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::titled;

const HELP: &str = "\
Example:
  reachtube reproduce all --out paper
      then open paper/paper.html in a browser

Records the campaign of `reachtube campaign` in the folder, if it is not there yet, and computes
everything else again. A run that was stopped can be started again, with the same result.";

/// The whole experiment: every table and figure, on one page that reads like the paper's Sec. V
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Folder for the campaign, the tables, the figures and the page
    #[arg(long, value_name = "FOLDER", default_value = "reachtube-paper")]
    pub out: PathBuf,
    /// Seed of the motions
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// A tenth of the motions and runs, one campaign, and no exact notion: for a first look
    #[arg(long)]
    pub small: bool,
}

/// The sizes of the experiment.
struct Sizes {
    campaign: CampaignOptions,
    table1: Table1Options,
    table2: Table2Options,
    coverage: CoverageOptions,
}

/// The computed tables and figures.
struct Reproduced {
    table1: Table1,
    table2: Table2,
    table3: Table3,
    exemplary: Exemplary,
    figures: Vec<PaperFigure>,
    coverage: Coverage,
}

/// Runs `reproduce all`.
pub(super) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let page_path = args.out.join("paper.html");
    let figure_path = |number: u8| args.out.join(format!("fig{number}.svg"));
    let numbers = args.out.join("paper.json");
    let paths = [vec![page_path.clone(), numbers.clone()], (1..=5).map(figure_path).collect()];
    output::claim_all(&paths.concat())?;
    let sizes = Sizes::new(args);
    let data = args.out.join("campaign");
    let reproduced = reproduce(&sizes, &data)?;
    let Reproduced { table1, table2, table3, exemplary, figures, coverage } = &reproduced;
    let page = PaperPage {
        table1,
        table2,
        table3,
        exemplary,
        figures,
        coverage,
        facts: facts(args, &sizes),
    };
    let claims = page.claims();
    let mut html = Vec::new();
    page.write_html(&mut html).map_err(reachtube::Error::from)?;
    for figure in figures {
        let path = figure_path(figure.number);
        write::atomically(&path, |out| out.write_all(figure.svg.as_bytes()))?;
    }
    let text = serde_json::to_string_pretty(&Numbers::new(&claims, &reproduced));
    let text = text.expect("results have string keys") + "\n";
    write::atomically(&numbers, |out| out.write_all(text.as_bytes()))?;
    write::atomically(&page_path, |out| out.write_all(&html))?;
    output::wrote(&page_path);
    let value = json!({
        "page": page_path.display().to_string(),
        "numbers": numbers.display().to_string(),
        "claims": claims,
    });
    output::show(json, &value, || summary(&claims, &page_path))?;
    Ok(Outcome::of(table2.cases.iter().all(|case| case.conformant)))
}

/// The file of all numbers on the page.
#[derive(Serialize)]
struct Numbers<'a> {
    format: &'static str,
    version: u32,
    claims: &'a [Claim],
    table1: &'a Table1,
    table2: &'a Table2,
    table3: &'a Table3,
    figures: &'a [PaperFigure],
    coverage: &'a Coverage,
}

impl<'a> Numbers<'a> {
    fn new(claims: &'a [Claim], reproduced: &'a Reproduced) -> Self {
        let Reproduced { table1, table2, table3, figures, coverage, .. } = reproduced;
        Self {
            format: "reachtube-paper",
            version: 1,
            claims,
            table1,
            table2,
            table3,
            figures,
            coverage,
        }
    }
}

/// Records the campaign where it is missing, and computes tables and figures.
fn reproduce(sizes: &Sizes, data: &Path) -> Result<Reproduced> {
    let robot = Robot::lwa4p();
    let bar = Progress::of("recording the campaign");
    campaign::record(&robot, &sizes.campaign, data, &|done, total| bar.show(done, total))?;
    drop(bar);
    let bar = Progress::of("Table I");
    let table1 = table1(&robot, &sizes.table1, &|done, total| bar.show(done, total))?;
    drop(bar);
    let bar = Progress::new();
    let (table2, exemplary) = table2_and_suite(data, &sizes.table2, None, &bar)?;
    drop(bar);
    let bar = Progress::of("identifying");
    let (table3, fig5) = table3_and_fig5(data, &|done, total| bar.show(done, total))?;
    drop(bar);
    let figures = vec![
        fig1(&exemplary)?,
        fig2(&exemplary)?,
        fig3(data, &exemplary.figure.suite)?,
        fig4(&exemplary)?,
        fig5,
    ];
    let bar = Progress::of("bounds for the next motion");
    let coverage = coverage(&sizes.coverage, &|done, total| bar.show(done, total))?;
    drop(bar);
    Ok(Reproduced { table1, table2, table3, exemplary, figures, coverage })
}

impl Sizes {
    fn new(args: &Arguments) -> Self {
        let seed = args.seed;
        let campaign = CampaignOptions { seed, ..CampaignOptions::default() };
        let table1 = Table1Options { seed, ..Table1Options::default() };
        let notions = vec![Notion::Hull, Notion::Exact];
        let table2 = Table2Options { notions, ..Table2Options::default() };
        let coverage = CoverageOptions { seed, ..CoverageOptions::default() };
        if !args.small {
            return Self { campaign, table1, table2, coverage };
        }
        Self {
            campaign: CampaignOptions { motions: 4, runs: 3, rest: 100, one_joint: 1, ..campaign },
            table1: Table1Options { motions: 5, ..table1 },
            table2: Table2Options { notions: vec![Notion::Hull], ..table2 },
            coverage: CoverageOptions { campaigns: 1, next: 100, ..coverage },
        }
    }
}

/// Returns how the page was made.
fn facts(args: &Arguments, sizes: &Sizes) -> Vec<(String, String)> {
    let small = if args.small { " --small" } else { "" };
    let CampaignOptions { motions, start_points, runs, longest, robot, .. } = &sizes.campaign;
    let parameters = serde_json::to_value(robot).expect("parameters are numbers");
    let parameters = parameters.as_object().into_iter().flatten();
    let parameters: Vec<String> =
        parameters.map(|(name, value)| format!("{name} = {value}")).collect();
    [
        ("Written by", TOOL.to_string()),
        ("Command", format!("reachtube reproduce all --seed {}{small}", args.seed)),
        (
            "Campaign",
            format!(
                "{motions} motions, {start_points} starting points, {runs} runs of up to \
                 {longest} s"
            ),
        ),
        ("Virtual robot (docs/campaign.md)", parameters.join(", ")),
    ]
    .map(|(name, value)| (name.to_string(), value))
    .to_vec()
}

/// Returns what the paper claims beside what came out.
fn summary(claims: &[Claim], page: &Path) -> String {
    let row = |claim: &Claim| {
        let holds = if claim.holds { "yes" } else { "NO" };
        vec![claim.place.clone(), claim.claim.clone(), claim.ours.clone(), holds.into()]
    };
    let table = TextTable {
        title: "The paper's experiment on a virtual robot".into(),
        header: ["", "statement", "here", "holds"].map(String::from).to_vec(),
        rows: claims.iter().map(row).collect(),
    };
    format!("{}\n{} has all tables and figures\n", titled(&table), page.display())
}
