//! `reachtube reproduce`: tables and figures of the paper, and how often bounds for the next motion
//! hold.

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::conform::settings::InitialLimit;
use reachtube::conform::{Notion, Progress as ConformProgress};
use reachtube::finding::Table;
use reachtube::reproduce::{
    Claim, CoverageRow, Item, PaperFigure, ReproduceOptions, Reproduced, reproduce,
};
use reachtube::write;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Result;
use crate::option_values::{Choices, INITIAL_LIMITS, choice, trimmed};
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;

/// Tables and figures, by their names.
const ITEMS: Choices = &[
    ("table1", "errors of models 1, 2 and 3 in simulation"),
    ("table2", "uncertainty sets of model 1, of positions and velocities, and of positions"),
    ("table3", "the model identified from a campaign, beside the arm that moved"),
    ("fig1", "recordings of the joint that spreads most in the reachable set"),
    ("fig2", "one input moves the robot and the model"),
    ("fig3", "the points of a motion at which the open loop begins"),
    ("fig4", "the reachable sets of both cases of Table II, with the recordings of a suite"),
    ("fig5", "the fits of Coulomb and viscous friction, of every joint"),
    ("coverage", "how often the bounds for the next motion are wrong"),
];

const HELP: &str = "\
Examples:
  reachtube reproduce --out paper
      then open paper/paper.html in a browser
  reachtube reproduce table1 --motions 50 --orders 1,3
  reachtube reproduce table2 --data recordings --suites A,B,D,E
  reachtube reproduce fig3 fig4 --data campaign --out figures

`reachtube campaign` makes the recordings, in the folder of --out, if they are missing.
A run that was stopped can be started again, with the same result. The paper's recordings are not
public but for four suites, so only sizes and order can agree. The positions of X0 in Table II reach
no further than the recorded starts, as they seem to in the paper.

Exit codes: 0 every set of Table II is proved conformant, and with the name coverage every bound
holds within three standard errors; 1 one is not; 2 error.";

/// Reproduce tables and figures of the paper, and test the bounds for the next motion
///
/// Without names, everything is computed and put on one page that reads like the paper's Sec. V.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Tables and figures [default: all, on one page]
    #[arg(value_name = "NAME", value_parser = choice::<Item>(ITEMS))]
    pub names: Vec<Item>,
    /// Folder for the page, the figures, and a campaign that is missing
    #[arg(long, value_name = "FOLDER", default_value = "reachtube-paper")]
    pub out: PathBuf,
    /// Folder with runs.csv and the recordings; for table3, fig3 and fig5, of a campaign [default:
    /// campaign in the folder of --out, recorded if it is missing]
    #[arg(long, value_name = "FOLDER")]
    pub data: Option<PathBuf>,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// A tenth of the motions and runs, one campaign, and no exact notion: for a first look
    #[arg(long)]
    pub small: bool,
    #[command(flatten)]
    pub table1: Table1Arguments,
    #[command(flatten)]
    pub table2: Table2Arguments,
    /// The suite of Figs. 1 to 4 [default: the one whose runs end furthest apart]
    #[arg(long, value_name = "NAME", value_parser = trimmed)]
    pub suite: Option<String>,
    /// Number of campaigns for coverage [default: 200]
    #[arg(long, hide_short_help = true, value_name = "COUNT")]
    pub campaigns: Option<usize>,
    /// Number of further motions that measure the truth for coverage [default: 2000]
    #[arg(long, hide_short_help = true, value_name = "COUNT")]
    pub next: Option<usize>,
}

// A comment, not a doc comment: clap would show it as the description of the command.
// What Table I is made of.
#[derive(Debug, Args)]
pub(crate) struct Table1Arguments {
    /// Number of random motions of Table I, each slow and fast [default: 50]
    #[arg(long, value_name = "COUNT")]
    pub motions: Option<usize>,
    /// Orders p of the models of Table I, separated by commas, each 1 or more
    #[arg(long, value_delimiter = ',', default_value = "1,3,5,7", value_name = "P,..")]
    pub orders: Vec<u32>,
    /// Highest order at which model 3 is simulated
    #[arg(long, hide_short_help = true, default_value_t = 5, value_name = "P")]
    pub model3_up_to: u32,
    /// Largest distance of a joint from q = 0 in Table I, rad
    #[arg(
        long,
        hide_short_help = true,
        default_value_t = std::f64::consts::FRAC_PI_2,
        value_name = "RAD",
        allow_negative_numbers = true
    )]
    pub range: f64,
}

// What Table II is made of.
#[derive(Debug, Args)]
pub(crate) struct Table2Arguments {
    /// Test suites of Table II, separated by commas, such as A*,B? [default: all]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = trimmed)]
    pub suites: Vec<String>,
    /// Notions of enclosure in Table II, separated by commas [default: hull,exact]
    #[arg(
        long,
        value_name = "NOTION,..",
        value_delimiter = ',',
        value_parser = choice::<Notion>(Notion::NAMES)
    )]
    pub notions: Vec<Notion>,
    /// How far X0 may reach in Table II
    #[arg(
        long,
        hide_short_help = true,
        default_value = "positions",
        value_parser = choice::<InitialLimit>(INITIAL_LIMITS)
    )]
    pub initial_limit: InitialLimit,
}

/// The file of all numbers, which is printed with `--json` too.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Numbers<'a> {
    /// The name of the format, "reachtube-paper".
    format: &'static str,
    /// The version of the format.
    version: u32,
    /// What the paper claims, and what was found.
    claims: &'a [Claim],
    /// The numbers.
    #[serde(flatten)]
    computed: &'a Reproduced,
}

/// Computes what is requested.
pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let items = if args.names.is_empty() { &Item::ALL[..] } else { &args.names };
    let figure_path = |name: &str| args.out.join(format!("{name}.svg"));
    let [page_path, numbers_path] = ["paper.html", "paper.json"].map(|name| args.out.join(name));
    let figures = ITEMS
        .iter()
        .zip(Item::ALL)
        .filter(|((name, _), item)| name.starts_with("fig") && items.contains(item));
    let mut paths: Vec<PathBuf> = figures.map(|((name, _), _)| figure_path(name)).collect();
    if args.names.is_empty() {
        paths.extend([page_path.clone(), numbers_path.clone()]);
    }
    output::claim_all(&paths)?;
    let data = args.data.clone().unwrap_or_else(|| args.out.join("campaign"));
    let stage = |doing| Box::new(Progress::of(doing)) as Box<dyn ConformProgress>;
    let computed = reproduce(items, &options(args), &data, &stage)?;
    for PaperFigure { number, svg, .. } in &computed.figures {
        let path = figure_path(&format!("fig{number}"));
        write::atomically(&path, |out| out.write_all(svg.as_bytes()))?;
        output::wrote(&path);
    }
    let claims = computed.claims();
    let numbers =
        Numbers { format: "reachtube-paper", version: 1, claims: &claims, computed: &computed };
    if args.names.is_empty() {
        let small = if args.small { " --small" } else { "" };
        let command = format!("reachtube reproduce --seed {}{small}", args.seed);
        let html = computed.page(&command).map_err(reachtube::Error::from)?.unwrap_or_default();
        let text = serde_json::to_string_pretty(&numbers).expect("results have string keys") + "\n";
        write::atomically(&numbers_path, |out| out.write_all(text.as_bytes()))?;
        write::atomically(&page_path, |out| out.write_all(html.as_bytes()))?;
        output::wrote(&page_path);
    }
    output::show(json, &numbers, || {
        if args.names.is_empty() { summary(&claims, &page_path) } else { sheets(&computed) }
    })?;
    let cases = computed.table2.iter().flat_map(|table| &table.cases);
    let are_proved = cases.into_iter().all(|case| case.conformant);
    let mut bounds = computed.coverage.iter().flat_map(|coverage| &coverage.rows);
    let hold = args.names.is_empty() || bounds.all(CoverageRow::holds);
    Ok(Outcome::of(are_proved && hold))
}

fn options(args: &Arguments) -> ReproduceOptions {
    let Arguments { table1, table2, .. } = args;
    let mut options = ReproduceOptions::new(args.seed, args.small);
    if args.data.is_some() {
        options.campaign = None;
    }
    options.table1.motions = table1.motions.unwrap_or(options.table1.motions);
    options.table1.orders.clone_from(&table1.orders);
    options.table1.model3_up_to = table1.model3_up_to;
    options.table1.range = table1.range;
    options.table2.suites.clone_from(&table2.suites);
    if !table2.notions.is_empty() {
        options.table2.notions.clone_from(&table2.notions);
    }
    options.table2.initial_limit = table2.initial_limit;
    options.suite.clone_from(&args.suite);
    options.coverage.campaigns = args.campaigns.unwrap_or(options.coverage.campaigns);
    options.coverage.next = args.next.unwrap_or(options.coverage.next);
    options
}

/// Returns the tables, each after its words.
fn sheets(computed: &Reproduced) -> String {
    let text = |words: &[String], tables: &[Table]| {
        let tables: Vec<String> = tables.iter().map(Table::to_string).collect();
        format!("{}\n\n{}", words.join("\n"), tables.join("\n"))
    };
    let sheets = computed.sheets();
    sheets.iter().map(|sheet| text(&sheet.words, &sheet.tables)).collect::<Vec<_>>().join("\n")
}

/// Returns what the paper claims beside what came out.
fn summary(claims: &[Claim], page: &Path) -> String {
    let row = |claim: &Claim| {
        let holds = if claim.holds { "yes" } else { "NO" };
        vec![claim.place.clone(), claim.claim.clone(), claim.ours.clone(), holds.into()]
    };
    let rows = claims.iter().map(row).collect();
    let table = Table::new(["", "statement", "here", "holds"], rows)
        .titled("The paper's experiment on a virtual robot");
    format!("{table}\n{} has all tables and figures\n", page.display())
}
