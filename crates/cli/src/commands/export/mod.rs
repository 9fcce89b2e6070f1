//! `reachtube export`: models and robots as other tools read them.

mod shield;

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::conform::{Keep, Model};
use reachtube::export::robot::{mjcf_files, updated_urdf_files, urdf_files};
use reachtube::export::{ExportCase, ExportError, ExportFile, InputForm, Meaning, Tool, files};
use reachtube::{Robot, write};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::data_arguments::DataArguments;
use crate::error::{Error, Result};
use crate::file_names;
use crate::lock_arguments::LockArguments;
use crate::opened::OpenedCheck;
use crate::option_values::{Choices, choice, seconds, trimmed};
use crate::outcome::Outcome;
use crate::output;
use crate::table::table;

const HELP: &str = "\
Tools, what they can mean, and what they cannot:
  cora        every model; the recorded input at equally spaced samples, U changing at any time
  flowstar    affine models as a model file, others as a C++ program that steps through samples
  spaceex     affine models; a polynomial one as a carrier for programs that read the format
  xspeed      affine models without a recorded input
  hylaa       affine models without a recorded input, at equally spaced samples; U held over each
  juliareach  affine models without a recorded input
  mjcf, urdf  the robot; of its friction a viscous and a Coulomb coefficient, and for MuJoCo 4 a
              cubic one. urdf has no motor inertia; --update changes a URDF that is there
  sara-shield the radius by which the safety shield SaRA must grow each link, proved; limits in
              its file that --update names, cut to what the motions reach
Unsupported models are refused. The first lines of each file state what the tool computes.

Examples:
  reachtube export --model model.json --to cora --data recordings --suites A --out cora
  reachtube export --model model.json --to hylaa --data recordings --suites A --out hylaa
  reachtube export --robot arm.toml --to mjcf --out robot
  reachtube export --robot identified.toml --to urdf --update arm.urdf --out robot
  reachtube export --model model.json --to sara-shield --data recordings --suites A --until 0.2 \\
    --update robot_parameters_schunk.yaml --out shield

Each suite, or run with a nominal motion of its own, gets a folder, which also holds our bounds
(bounds.csv at samples, tube.csv between them) and the input (inputs.csv). docs/export.md says how
each tool runs its file.";

const TARGETS: Choices = &[
    ("cora", "CORA 2024 or later, MATLAB files"),
    ("spaceex", "SpaceEx, XML and configuration"),
    ("flowstar", "Flow*, a model file for 2.1 or a C++ program for its library"),
    ("hylaa", "HyLAA 2, a Python script"),
    ("xspeed", "XSpeed, XML and configuration"),
    ("juliareach", "ReachabilityAnalysis.jl, a Julia script"),
    ("mjcf", "MuJoCo, the robot"),
    ("urdf", "the robot"),
    ("sara-shield", "SaRA shield, YAML files of the robot and its limits"),
];

const FORMS: Choices = &[
    ("recorded", "the recorded input held from sample to sample, plus U"),
    ("deviation", "only U: the deviations from the nominal motion, for affine models"),
    ("range", "any input in the box of all recorded inputs plus U"),
];

/// Write a model over recorded inputs, or its robot, as other tools read it
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Model file that `conform --out` wrote
    #[arg(long, value_name = "FILE", required_unless_present = "robot")]
    pub model: Option<PathBuf>,
    /// Robot in place of a model, for mjcf and urdf: the embedded lwa4p, or a TOML or URDF file
    #[arg(long, value_name = "ROBOT", conflicts_with = "model")]
    pub robot: Option<String>,
    #[command(flatten)]
    pub lock: LockArguments,
    /// With --to urdf: the URDF whose <inertial> and <dynamics> are to become the robot's. With
    /// --to sara-shield: the shield's robot_parameters file, its trajectory_parameters file, or
    /// both, one --update for each. All other text stays as it is
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    pub update: Vec<PathBuf>,
    /// With --to sara-shield: the links' capsules, a TOML or URDF file [default: the
    /// capsules of the embedded robot]
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    pub capsules: Option<PathBuf>,
    /// What to write
    #[arg(long, value_name = "TOOL", value_parser = choice::<Target>(TARGETS))]
    pub to: Target,
    /// Folder for the files
    #[arg(long, value_name = "FOLDER")]
    pub out: PathBuf,
    /// How the recorded input enters [default: the tightest form that the tool can mean]
    #[arg(long, value_parser = choice::<InputForm>(FORMS))]
    pub input: Option<InputForm>,
    /// Folder with runs.csv and the recordings, whose torques mean what they meant to `conform`
    #[arg(long, value_name = "FOLDER", help_heading = "Data")]
    pub data: Option<PathBuf>,
    /// Test suites to use, separated by commas; * and ? match as in A*,B? [default: all]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = trimmed)]
    #[arg(help_heading = "Data")]
    pub suites: Vec<String>,
    /// Use only samples up to this time after the first sample, above 0 s [default: all]
    #[arg(long, hide_short_help = true)]
    #[arg(value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    #[arg(help_heading = "Data")]
    pub until: Option<f64>,
    /// Longest time between two samples, above 0 s; the input is held over it [default: 1.9 times
    /// the usual sample time, 10 times where sample times jitter]
    #[arg(long, hide_short_help = true)]
    #[arg(value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    #[arg(help_heading = "Data")]
    pub max_gap: Option<f64>,
}

/// The files to write.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Target {
    /// The robot for MuJoCo.
    Mjcf,
    /// The robot as URDF.
    Urdf,
    /// The files of the shield SaRA.
    #[serde(rename = "sara-shield")]
    SaraShield,
    /// A model for a tool.
    #[serde(untagged)]
    Tool(Tool),
}

/// An exported case and its files.
struct Written {
    case: ExportCase,
    form: InputForm,
    folder: PathBuf,
    files: Vec<ExportFile>,
    may_be_smaller: bool,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let most = match args.to {
        Target::Urdf => 1,
        Target::SaraShield => 2,
        _ => 0,
    };
    if args.update.len() > most {
        return Err(Error::NothingToUpdate);
    }
    let updated = |robot: &Robot| match args.update.first() {
        Some(path) => updated_urdf_files(robot, path, &args.lock.lock),
        None => urdf_files(robot),
    };
    match args.to {
        Target::Mjcf => robot(args, &mjcf_files, json),
        Target::Urdf => robot(args, &updated, json),
        Target::SaraShield => shield::run(args, json),
        Target::Tool(tool) => model(args, tool, json),
    }
}

/// Writes a robot: the robot of a model, or a robot that is named.
fn robot(
    args: &Arguments,
    files: &dyn Fn(&Robot) -> Result<Vec<ExportFile>, ExportError>,
    json: bool,
) -> Result<Outcome> {
    write::try_at(&args.out.join("robot.xml"))?;
    let robot = match (&args.robot, &args.model) {
        (Some(robot), _) => args.lock.load(robot)?,
        (None, Some(model)) => Model::open(model)?.1.robot().clone(),
        (None, None) => return Err(Error::NoModel),
    };
    let files = files(&robot)?;
    let paths: Vec<PathBuf> = files.iter().map(|file| args.out.join(&file.name)).collect();
    write_all(&paths, files.iter())?;
    let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
    let result = json!({ "robot": robot.name(), "files": names });
    let text = || format!("exported {}:\n  {}\n", robot.name(), names.join("\n  "));
    output::show(json, &result, text)?;
    Ok(Outcome::Done)
}

/// Writes files to these paths, after none is in the way. One that is there already to the byte
/// stays: the tables of one case are the same for every tool.
fn write_all<'a>(paths: &[PathBuf], files: impl Iterator<Item = &'a ExportFile>) -> Result<()> {
    let is_new = |(path, file): &(&PathBuf, &ExportFile)| {
        std::fs::read(path).ok().as_deref() != Some(file.text.as_bytes())
    };
    let new: Vec<_> = paths.iter().zip(files).filter(is_new).collect();
    output::claim_all(new.iter().map(|(path, _)| *path))?;
    for (path, file) in new {
        write::atomically(path, |out| out.write_all(file.text.as_bytes()))?;
    }
    Ok(())
}

/// Opens the model over the recordings; `tool` names what it is for.
fn open(args: &Arguments, tool: &str) -> Result<OpenedCheck> {
    let model = args.model.as_ref().ok_or(Error::NoModel)?;
    let no_input = || Error::NoRecordedInput { tool: tool.into() };
    let data = args.data.clone().ok_or_else(no_input)?;
    let (model, setup) = Model::open(model)?;
    let data = DataArguments {
        data,
        suites: args.suites.clone(),
        torque: None,
        until: args.until,
        max_gap: args.max_gap,
    };
    let opened = OpenedCheck::with(model, setup, &data, None, Keep::Needed)?;
    opened.print_notes(&data);
    Ok(opened)
}

/// Writes each case of a model for a tool.
fn model(args: &Arguments, tool: Tool, json: bool) -> Result<Outcome> {
    write::try_at(&args.out.join("A/bounds.csv"))?;
    let opened = open(args, &tool.to_string())?;
    let cases = opened.export_cases()?;
    let names = file_names::of_cases(&cases);
    let written = cases.into_iter().zip(names).map(|(case, name)| {
        let form = args.input.unwrap_or_else(|| tool.default_form(&case));
        let files = files(&case, tool, form)?;
        let may_be_smaller = Meaning::new(&case, tool, form).may_be_smaller;
        Ok(Written { case, form, folder: args.out.join(name), files, may_be_smaller })
    });
    let written: Vec<Written> = written.collect::<Result<_>>()?;
    let paths: Vec<PathBuf> = written.iter().flat_map(Written::paths).collect();
    write_all(&paths, written.iter().flat_map(|case| &case.files))?;
    if written.iter().any(|case| case.may_be_smaller) {
        output::warn(&format!(
            "{tool} knows fewer disturbances than the model: its set may be smaller than the \
             model's and proves nothing about it"
        ));
    }
    let result = || json!({ "tool": tool.to_string(), "cases": cases_json(&written) });
    output::show(json, &result(), || summary(tool, &written))?;
    Ok(Outcome::Done)
}

fn cases_json(written: &[Written]) -> Vec<Value> {
    written.iter().map(Written::json).collect()
}

fn summary(tool: Tool, written: &[Written]) -> String {
    let rows: Vec<_> = written.iter().map(Written::row).collect();
    format!(
        "exported to {tool}\n{}",
        table(&["suite", "run", "states", "samples", "input", "folder"], &rows)
    )
}

impl Written {
    fn paths(&self) -> impl Iterator<Item = PathBuf> {
        self.files.iter().map(|file| self.folder.join(&file.name))
    }

    fn json(&self) -> Value {
        let text = |path: &Path| path.display().to_string();
        json!({
            "suite": self.case.reach.suite,
            "run": self.case.reach.run,
            "states": self.case.system.dimension(),
            "samples": self.case.grid.len(),
            "input": self.form.to_string(),
            "may_be_smaller": self.may_be_smaller,
            "folder": text(&self.folder),
            "files": self.files.iter().map(|file| file.name.clone()).collect::<Vec<_>>(),
        })
    }

    fn row(&self) -> Vec<String> {
        vec![
            self.case.reach.suite.clone(),
            self.case.reach.run.clone().unwrap_or_else(|| "all".into()),
            self.case.system.dimension().to_string(),
            self.case.grid.len().to_string(),
            self.form.to_string(),
            self.folder.display().to_string(),
        ]
    }
}
