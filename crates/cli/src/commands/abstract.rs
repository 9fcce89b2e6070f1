//! `reachtube abstract`: a simple model of a robot's forward dynamics.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use reachtube::abstraction::{ModelKind, PolynomialModel};
use reachtube::finding::Table;
use reachtube::write;
use reachtube_robot::JointKind;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Result;
use crate::expansion::expansion_point;
use crate::lock_arguments::LockArguments;
use crate::option_values::{MODELS, numbered_choice};
use crate::outcome::Outcome;
use crate::output;

const HELP: &str = "\
Examples:
  reachtube abstract --robot lwa4p --paper-model 2 --order 5 --out model2.json
  reachtube abstract --robot lwa4p --expansion 0,0.5,0,0,0,0 --out model1.json

`conform --abstraction FILE` finds the uncertainty sets of a model that --out wrote.";

/// Make a simple model of a robot's forward dynamics
///
/// Liu and Althoff (2018), Sec. IV-B, define the models.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long)]
    pub robot: String,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Model of the forward dynamics, numbered as in the paper
    #[arg(
        long,
        default_value = "1",
        value_name = "MODEL",
        value_parser = numbered_choice::<ModelKind>(MODELS)
    )]
    pub paper_model: ModelKind,
    /// Order of the Taylor polynomials, 1 or more
    #[arg(long, default_value_t = 1, value_name = "P")]
    pub order: u32,
    /// Expansion point: n positions in rad, or also n velocities in rad/s, or also n inputs in N m
    /// [default: 0]
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true, value_name = "Q,..")]
    pub expansion: Vec<f64>,
    /// Print the polynomials, one line per joint, instead of the summary
    #[arg(long, hide_short_help = true, conflicts_with = "json")]
    pub print: bool,
    /// Write the abstraction to this JSON file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = args.lock.load(&args.robot)?;
    robot.check_physical()?;
    let point = expansion_point(&args.expansion, &robot)?;
    if let Some(path) = &args.out {
        output::claim(path)?;
    }
    let started = Instant::now();
    let model = PolynomialModel::new(&robot, args.paper_model, args.order, &point)?;
    let seconds = started.elapsed().as_secs_f64();
    if let Some(path) = &args.out {
        write::atomically(path, |out| out.write_all(model.to_json().as_bytes()))?;
        output::wrote(path);
    }
    if args.print {
        output::print(&model.to_string())?;
    } else {
        output::show(json, &AbstractOutput::new(&model, seconds), || summary(&model, seconds))?;
    }
    Ok(Outcome::Done)
}

/// The result of `abstract`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct AbstractOutput {
    /// The paper's number of the model.
    model: ModelKind,
    /// Order of the model.
    order: u32,
    /// Number of states of the polynomial system.
    states: usize,
    /// Names of the variables.
    variables: Vec<String>,
    /// Degree of the polynomials.
    degree: u32,
    /// Number of terms of each joint.
    terms: Vec<usize>,
    /// Time that the model took, s.
    seconds: f64,
}

impl AbstractOutput {
    fn new(model: &PolynomialModel, seconds: f64) -> Self {
        Self {
            model: model.kind(),
            order: model.order(),
            states: model.states(),
            variables: model.variable_names(),
            degree: model.degree(),
            terms: model.acceleration().iter().map(|f| f.term_count()).collect(),
            seconds,
        }
    }
}

/// Returns the result of `abstract`, with one line per joint.
fn summary(model: &PolynomialModel, seconds: f64) -> String {
    let point = model.expansion_point();
    let unit = |unit| JointKind::column(model.joint_kinds(), unit).list();
    let text = format!(
        "model {} of order {} of {}, expanded about {} {}, {} {}, {} {}\n\
         {} states, degree {}, {} terms, computed in {}\n\n",
        u32::from(model.kind()),
        model.order(),
        model.robot().name,
        coordinates("q", &point.q),
        unit(JointKind::position_unit),
        coordinates("qd", &point.qd),
        unit(JointKind::velocity_unit),
        coordinates("u", &point.input()),
        unit(JointKind::force_unit),
        model.states(),
        model.degree(),
        model.term_count(),
        duration(seconds)
    );
    let rows = (0..model.joints()).map(|joint| joint_row(model, joint)).collect();
    text + &Table::new(["joint", "terms"], rows).to_string()
}

fn coordinates(name: &str, values: &[f64]) -> String {
    match values.iter().all(|v| *v == 0.0) {
        true => format!("{name} = 0"),
        false => format!("{name} = {values:?}"),
    }
}

fn joint_row(model: &PolynomialModel, joint: usize) -> Vec<String> {
    vec![
        model.robot().joints[joint].name.clone(),
        model.acceleration()[joint].term_count().to_string(),
    ]
}

fn duration(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.2} s") }
}
