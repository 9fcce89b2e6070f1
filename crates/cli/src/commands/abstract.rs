//! `reachtube abstract`: a simple model of a robot's forward dynamics.

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use reachtube::abstraction::{ExpansionPoint, ModelKind, OperatingBox, PolynomialModel};
use reachtube::write;
use reachtube_robot::Robot;
use serde_json::json;

use crate::error::Result;
use crate::option_values::{MODELS, numbered_choice};
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::table;
use reachtube::number::{four_decimals, interval};

const HELP: &str = "\
Examples:
  reachtube abstract --robot lwa4p --model 2 --order 5 --out model2.json
  reachtube abstract --robot lwa4p --model 1 --order 1 --at 0,0.5,0,0,0,0 --out model1.json
  reachtube abstract --robot lwa4p --model 3 --order 3 --box 0.2,0.3,2
      with a proved bound of the model error over the box

`conform --abstraction FILE` finds the uncertainty sets of a model that --out wrote.";

/// Make a simple model of a robot's forward dynamics
///
/// The models are those of Liu and Althoff (2018), Sec. IV-B. --box proves a bound of the model
/// error, the forward dynamics minus the model.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long)]
    pub robot: String,
    /// Model of the forward dynamics, numbered as in the paper
    #[arg(long, default_value = "1", value_parser = numbered_choice::<ModelKind>(MODELS))]
    pub model: ModelKind,
    /// Order of the Taylor polynomials, 1 or more
    #[arg(long, default_value_t = 1, value_name = "P")]
    pub order: u32,
    /// Expansion point, separated by commas: n positions in rad; or also n velocities in rad/s; or
    /// also n inputs in N m [default: 0]
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true, value_name = "Q,..")]
    pub at: Vec<f64>,
    /// Prove a bound of the model error over a box about the expansion point: radii of positions
    /// in rad, velocities in rad/s and inputs in N m; 3 numbers, or 3n
    #[arg(long = "box", value_delimiter = ',', allow_hyphen_values = true, value_name = "Q,QD,U")]
    pub operating_box: Vec<f64>,
    /// Print the polynomials, one line per joint, instead of the summary
    #[arg(long, conflicts_with = "json")]
    pub print: bool,
    /// Largest number of parts that --box is cut into; more parts give a tighter bound and take
    /// longer [default: 16 to 2000, fewer for larger models]
    #[arg(long, value_name = "COUNT")]
    pub most_boxes: Option<usize>,
    /// Write the model to this JSON file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

pub fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = Robot::load(&args.robot)?;
    robot.check_physical()?;
    let point = ExpansionPoint::from_values(&args.at, robot.joint_count())?;
    if let Some(path) = &args.out {
        output::claim(path)?;
    }
    let started = Instant::now();
    let mut model = PolynomialModel::new(&robot, args.model, args.order, &point)?;
    let seconds = started.elapsed().as_secs_f64();
    if !args.operating_box.is_empty() {
        let _bar = Progress::new();
        let operating_box = OperatingBox::about(&point, &args.operating_box)?;
        let most = args.most_boxes.unwrap_or_else(|| model.default_max_boxes());
        model.set_remainder(model.bound_remainder(&operating_box, most)?);
    }
    if let Some(path) = &args.out {
        write::atomically(path, |out| out.write_all(model.to_json().as_bytes()))?;
        output::wrote(path);
    }
    if args.print {
        output::print(&model.to_string())?;
    } else {
        output::show(json, &json_summary(&model, seconds), || summary(&model, seconds))?;
    }
    Ok(Outcome::Done)
}

fn json_summary(model: &PolynomialModel, seconds: f64) -> serde_json::Value {
    let terms: Vec<usize> = model.acceleration().iter().map(|f| f.term_count()).collect();
    json!({
        "model": model.kind(),
        "order": model.order(),
        "states": model.states(),
        "variables": model.layout().names(),
        "degree": model.degree(),
        "terms": terms,
        "remainder": model.remainder(),
        "seconds": seconds,
    })
}

/// Returns the result of `abstract`, with one line per joint.
fn summary(model: &PolynomialModel, seconds: f64) -> String {
    let point = model.expansion_point();
    let mut text = format!(
        "model {} of order {} of {}, expanded about {} rad, {} rad/s, {} N m\n\
         {} states, degree {}, {} terms, computed in {}\n\n",
        u32::from(model.kind()),
        model.order(),
        model.robot().name,
        coordinates("q", &point.q),
        coordinates("qd", &point.qd),
        coordinates("u", &point.input()),
        model.states(),
        model.degree(),
        model.term_count(),
        duration(seconds)
    );
    let rows: Vec<_> = (0..model.joints()).map(|joint| joint_row(model, joint)).collect();
    match model.remainder() {
        Some(remainder) => {
            let header = ["joint", "terms", "model error [rad/s^2], proved", "largest found"];
            text.push_str(&table(&header, &rows));
            let _ = writeln!(
                text,
                "\nmodel error: forward dynamics minus model, at every point of the box \
                 (cut into {} parts)\nlargest found: its largest magnitude in a search of the box",
                remainder.boxes
            );
        }
        None => text.push_str(&table(&["joint", "terms"], &rows)),
    }
    text
}

fn coordinates(name: &str, values: &[f64]) -> String {
    match values.iter().all(|v| *v == 0.0) {
        true => format!("{name} = 0"),
        false => format!("{name} = {values:?}"),
    }
}

fn joint_row(model: &PolynomialModel, joint: usize) -> Vec<String> {
    let mut row = vec![
        model.robot().joints[joint].name.clone(),
        model.acceleration()[joint].term_count().to_string(),
    ];
    if let Some(remainder) = model.remainder() {
        let bound = remainder.bounds[joint].map(|[low, high]| interval((low, high)));
        row.push(bound.unwrap_or_else(|| "no bound found".into()));
        row.push(four_decimals(remainder.sampled_error[joint]));
    }
    row
}

fn duration(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.2} s") }
}
