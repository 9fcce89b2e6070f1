//! `reachtube abstract`: a simple model of a robot's forward dynamics.

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use reachtube::abstraction::{ModelKind, OperatingBox, PolynomialModel};
use reachtube::write;
use reachtube_robot::JointKind;
use serde_json::json;

use crate::error::Result;
use crate::expansion::expansion_point;
use crate::lock_arguments::LockArguments;
use crate::option_values::{MODELS, numbered_choice};
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::table;
use reachtube::number::{four_decimals, interval, plural};
use reachtube::units::ColumnUnit;

const HELP: &str = "\
Examples:
  reachtube abstract --robot lwa4p --paper-model 2 --order 5 --out model2.json
  reachtube abstract --robot lwa4p --expansion 0,0.5,0,0,0,0 --out model1.json
  reachtube abstract --robot lwa4p --paper-model 3 --order 3 --box 0.2,0.3,2
      with a proved bound of the model error over the box

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
    /// Prove a bound of the model error over a box about the expansion point: 3 or 3n radii in rad,
    /// rad/s and N m
    #[arg(long = "box", value_delimiter = ',', allow_hyphen_values = true, value_name = "Q,QD,U")]
    pub operating_box: Vec<f64>,
    /// Print the polynomials, one line per joint, instead of the summary
    #[arg(long, hide_short_help = true, conflicts_with = "json")]
    pub print: bool,
    /// Largest number of parts that --box is cut into [default: 4 to 1000, for some 20 s on two
    /// cores]
    #[arg(long, hide_short_help = true, value_name = "COUNT", requires = "operating_box")]
    pub most_boxes: Option<usize>,
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
    let mut model = PolynomialModel::new(&robot, args.paper_model, args.order, &point)?;
    let seconds = started.elapsed().as_secs_f64();
    if !args.operating_box.is_empty() {
        let _bar = Progress::new();
        let operating_box = OperatingBox::about(&point, &args.operating_box)?;
        let most = args.most_boxes.unwrap_or_else(|| model.default_max_boxes());
        let remainder = model.bound_remainder(&operating_box, most)?;
        if remainder.bounds.iter().any(Option::is_none) {
            let narrower = model.narrower_box(&operating_box, most)?;
            output::warn(&no_bound(&model, &operating_box, narrower.as_ref(), remainder.boxes));
        }
        model.set_remainder(remainder);
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
        "variables": model.variable_names(),
        "degree": model.degree(),
        "terms": terms,
        "remainder": model.remainder(),
        "seconds": seconds,
    })
}

/// Returns the result of `abstract`, with one line per joint.
fn summary(model: &PolynomialModel, seconds: f64) -> String {
    let point = model.expansion_point();
    let unit = |unit| JointKind::units(model.joint_kinds(), unit);
    let mut text = format!(
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
    let rows: Vec<_> = (0..model.joints()).map(|joint| joint_row(model, joint)).collect();
    match model.remainder() {
        Some(remainder) => {
            let error = match error_unit(model).shared() {
                Some(unit) => format!("model error [{unit}], proved"),
                None => "model error, proved".into(),
            };
            text.push_str(&table(&["joint", "terms", &error, "largest found"], &rows));
            let _ = writeln!(
                text,
                "\nmodel error: forward dynamics minus model, at every point of the box \
                 (cut into {} {})\nlargest found: its largest magnitude in a search of the box",
                remainder.boxes,
                plural(remainder.boxes, "part")
            );
        }
        None => text.push_str(&table(&["joint", "terms"], &rows)),
    }
    text
}

/// Returns the warning that no bound was found, with the joints whose radii have to be smaller.
fn no_bound(
    model: &PolynomialModel,
    operating_box: &OperatingBox,
    narrower: Option<&OperatingBox>,
    parts: usize,
) -> String {
    let text = format!(
        "no bound of the model error was found in {parts} parts of the box, because the mass \
         matrix changes too much over the positions"
    );
    let Some(narrower) = narrower else {
        return text + "; choose smaller radii of the positions in --box";
    };
    let radius = |[low, high]: [f64; 2]| 0.5 * (high - low);
    let change = |(i, (whole, part)): (usize, (&[f64; 2], &[f64; 2]))| {
        let joint = &model.robot().joints[i];
        let [from, to] = [whole, part].map(|side| four_decimals(radius(*side)));
        let (name, unit) = (&joint.name, joint.kind.position_unit());
        (whole != part).then(|| format!("{name} from {from} to {to} {unit}"))
    };
    let sides = operating_box.q.iter().zip(&narrower.q).enumerate();
    let changes: Vec<String> = sides.filter_map(change).collect();
    match changes[..] {
        [] => text + "; raise --most-boxes",
        _ => format!("{text}; in --box, reduce the radius of {}", changes.join(", ")),
    }
}

fn coordinates(name: &str, values: &[f64]) -> String {
    match values.iter().all(|v| *v == 0.0) {
        true => format!("{name} = 0"),
        false => format!("{name} = {values:?}"),
    }
}

/// Returns the unit of the model error.
fn error_unit(model: &PolynomialModel) -> ColumnUnit {
    ColumnUnit::new(model.joint_kinds(), JointKind::acceleration_unit)
}

fn joint_row(model: &PolynomialModel, joint: usize) -> Vec<String> {
    let mut row = vec![
        model.robot().joints[joint].name.clone(),
        model.acceleration()[joint].term_count().to_string(),
    ];
    if let Some(remainder) = model.remainder() {
        let bound = remainder.bounds[joint].map(|[low, high]| interval((low, high)));
        let unit = error_unit(model);
        row.push(bound.map_or("no bound found".into(), |bound| unit.cell(joint, bound)));
        row.push(unit.cell(joint, four_decimals(remainder.sampled_error[joint])));
    }
    row
}

fn duration(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.2} s") }
}
