//! `reachtube reach`: a model's reachable sets along recorded suites.

use std::path::PathBuf;

use clap::builder::ArgPredicate;
use clap::{Arg, Args};
use reachtube::conform::model::Provenance;
use reachtube::conform::tube::Lost;
use reachtube::conform::{Keep, Model, Stiction, SuiteReach, stiction};
use reachtube::finding::{Finding, FrontEnd, Table};
use reachtube::page::{Sources, page};
use reachtube::systems::SystemModel;
use reachtube::tracking::TrackingModel;
use reachtube::write;
use reachtube_files::SealedFile;
use schemars::JsonSchema;
use serde::Serialize;

use crate::commands::{system, tracking};
use crate::data_arguments::ModelArguments;
use crate::error::{Error, Result};
use crate::opened::OpenedCheck;
use crate::option_values::seconds;
use crate::outcome::Outcome;
use crate::output;
use crate::report_files;
use crate::set_files::Written;
use reachtube::number::{at_least, four_decimals};

const HELP: &str = "\
Examples:
  reachtube reach --model model.json --data recordings --suites A --out reach

  reachtube reach --model arm/model.json --plan plan.csv --robot arm.urdf --out reach
      where an arm under its controller can be that follows a plan

  reachtube reach --system rotor.toml --until 5 --step 0.01 --out reach

Writes A.csv (reachable set at samples), A_tube.csv (over each step, an outer enclosure), the
figures A_*.svg, and reach.json, which names model, settings, recordings and CSV files by digest.

Exit codes: 0 done, 1 a reachable set ended before its suite, 2 error.";

/// What `--data` names; `--plan` is another name of it.
const DATA: &str = "Folder with runs.csv, or logs for a model that `model` made; as --plan, plans \
                    that an arm under its controller follows";

/// Compute a model's reachable sets along recordings, at samples and between them
#[derive(Debug, Args)]
#[command(
    after_help = HELP,
    mut_arg("model", |arg| optional(arg).required_unless_present("system")),
    mut_arg("data", |arg| optional(arg).required_unless_present("system").help(DATA).alias("plan"))
)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub model: ModelArguments,
    /// File with a system whose sets are all given, instead of a model; without recordings, it
    /// starts where the file says
    #[arg(long, value_name = "FILE", conflicts_with = "model")]
    pub system: Option<PathBuf>,
    /// Time between samples of a continuous system without recordings, above 0 s
    #[arg(long, value_name = "SECONDS", value_parser = seconds, requires = "system")]
    pub step: Option<f64>,
    /// Robot that follows the plan, for the distances of its links: an embedded one, or a TOML or
    /// URDF file
    #[arg(long, conflicts_with = "system")]
    pub robot: Option<String>,
    /// Folder for the CSV files and figures
    #[arg(long, value_name = "FOLDER", default_value = "reach")]
    pub out: PathBuf,
}

/// The result of `reach`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ReachOutput<'a> {
    /// One entry for each suite, or run with a nominal motion of its own.
    reach: Vec<SetOutput<'a>>,
    /// Joints whose velocity may be zero in a step of these sets.
    stiction: Vec<RestOutput<'a>>,
    /// What the sets are of.
    #[serde(flatten)]
    provenance: &'a Provenance,
}

/// A reachable set.
#[derive(Serialize, JsonSchema)]
struct SetOutput<'a> {
    /// The suite.
    suite: &'a str,
    /// The run; null where all runs share their nominal motion.
    run: Option<&'a str>,
    /// Number of samples.
    samples: usize,
    /// Time of the last sample, s.
    duration: Option<f64>,
    /// Widths at the last sample, 2n, rad and rad/s.
    final_width: Vec<f64>,
    /// Where the set ended before its suite.
    lost: Option<&'a Lost>,
    /// File with the set at samples.
    csv: String,
    /// File with the set over each step.
    tube_csv: String,
}

/// A joint whose velocity may be zero in a step.
#[derive(Serialize, JsonSchema)]
struct RestOutput<'a> {
    /// Name of the joint.
    joint: &'a str,
    /// Number of steps in which the velocity may be zero.
    steps: usize,
    /// Largest difference between two values of dry friction in one of these steps, N m or N;
    /// rounded up.
    torque: f64,
    /// Largest torque that U contains in both directions, N m or N; rounded down.
    room: f64,
    /// The suite or run in which the difference is the largest.
    case: &'a str,
    /// Start of the step in which it is the largest, s.
    time: f64,
    /// Whether U covers every dry friction that is possible there.
    covered: bool,
}

/// Returns an argument that a system stands in for, with a dash in its place.
fn optional(arg: Arg) -> Arg {
    arg.required(false).default_value_if("system", ArgPredicate::IsPresent, "-")
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    if args.system.is_some() || SystemModel::is_at(&args.model.model) {
        let (system, how) = (args.system.as_deref(), (args.step, &*args.out));
        return system::reach(system, &args.model, how, json);
    }
    if TrackingModel::is_at(&args.model.model) {
        return tracking::reach(&args.model, args.robot.as_deref(), &args.out, json);
    }
    if args.robot.is_some() {
        return Err(Error::setting("the model has its robot; leave --robot out"));
    }
    write::try_at(&args.out.join("A.csv"))?;
    let opened = OpenedCheck::new(&args.model, None, Keep::All)?;
    let OpenedCheck { model, problem, .. } = &opened;
    opened.print_notes(&args.model.data);
    let (reach, check) = (opened.reach()?, opened.check()?);
    if !check.holds() {
        opened.warn_beyond_proof();
    }
    let mut rests = stiction(problem, &model.sets(), &model.allowance, &reach);
    rests.retain(|rest| rest.steps > 0);
    let written = Written::all(&reach, &args.out);
    let record = args.out.join("reach.json");
    let tables = written.iter().flat_map(|file| [&file.samples, &file.tube]);
    output::claim_all(tables.chain([&record]))?;
    let contents = written.iter().flat_map(Written::contents).collect::<Vec<_>>();
    for (name, content) in &contents {
        write::atomically(&args.out.join(name), |out| out.write_all(content))?;
    }
    let text = model.reach_record(problem, &contents);
    write::atomically(&record, |out| out.write_all(text.as_bytes()))?;
    let sources =
        Sources { model, problem, reach: &reach, check: &check, front_end: FrontEnd::CommandLine };
    report_files::write_figures(&page(&sources)?, &args.out)?;
    if json {
        output::print_json(&ReachOutput {
            reach: written.iter().map(Written::output).collect(),
            stiction: rests.iter().map(|rest| RestOutput::new(model, rest)).collect(),
            provenance: &check.provenance,
        })?;
    } else {
        let [q, qd] = [0, 1].map(|at| model.signals.units_of_state(at).any());
        let [q, qd] = [format!("widest q [{q}]"), format!("widest qd [{qd}]")];
        let header = ["suite", "run", "samples", &q, &qd, "file"];
        let rows = written.iter().map(Written::row).collect();
        output::print(&format!(
            "reachable sets, with their widest interval at the last sample\n{}{}",
            Table::new(header, rows),
            rests_text(model, &rests)
        ))?;
    }
    for lost in reach.iter().filter_map(|reach| reach.lost.as_ref()) {
        output::note(&Finding::from(lost).to_string());
    }
    Ok(Outcome::of(reach.iter().all(|reach| reach.lost.is_none())))
}

fn joint_of<'a>(model: &'a Model, rest: &Stiction) -> &'a str {
    &model.signals.parts[rest.part - 1].name
}

impl<'a> RestOutput<'a> {
    fn new(model: &'a Model, rest: &'a Stiction) -> Self {
        Self {
            joint: joint_of(model, rest),
            steps: rest.steps,
            torque: rest.torque,
            room: rest.room,
            case: &rest.case,
            time: rest.time,
            covered: rest.is_covered(),
        }
    }
}

/// Returns the dry friction of joints that may come to rest, beside U.
fn rests_text(model: &Model, rests: &[Stiction]) -> String {
    if rests.is_empty() {
        return String::new();
    }
    let row = |rest: &Stiction| {
        vec![
            joint_of(model, rest).to_owned(),
            rest.steps.to_string(),
            at_least(rest.torque),
            four_decimals(rest.room),
            if rest.is_covered() { "yes" } else { "no" }.to_owned(),
        ]
    };
    let rows = rests.iter().map(row).collect();
    let finding = model.finding_of_stiction(rests).map(|found| format!("{found}\n"));
    let header = ["joint", "steps", "friction differs by", "U allows", "covered"];
    format!(
        "dry friction where a velocity may be zero [N m]\n{}{}",
        Table::new(header, rows),
        finding.unwrap_or_default()
    )
}

impl Written<'_> {
    /// Returns the widths of the set at the last sample, 2n, in rad and rad/s.
    fn final_width(&self) -> Vec<f64> {
        let SuiteReach { lower, upper, dimension, .. } = self.reach;
        (upper.len() - dimension..upper.len()).map(|at| upper[at] - lower[at]).collect()
    }

    fn output(&self) -> SetOutput<'_> {
        SetOutput {
            suite: &self.reach.suite,
            run: self.reach.run.as_deref(),
            samples: self.reach.times.len(),
            duration: self.reach.times.last().copied(),
            final_width: self.final_width(),
            lost: self.reach.lost.as_ref(),
            csv: self.samples.display().to_string(),
            tube_csv: self.tube.display().to_string(),
        }
    }

    fn row(&self) -> Vec<String> {
        let widths = self.final_width();
        let (positions, velocities) = widths.split_at(widths.len() / 2);
        let widest = |widths: &[f64]| at_least(widths.iter().copied().fold(0.0, f64::max));
        vec![
            self.reach.suite.clone(),
            self.reach.run.clone().unwrap_or_else(|| "all".into()),
            self.reach.times.len().to_string(),
            widest(positions),
            widest(velocities),
            self.samples.display().to_string(),
        ]
    }
}
