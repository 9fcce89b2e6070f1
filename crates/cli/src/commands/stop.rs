//! `reachtube stop`: how far a robot moves after a stop.

use reachtube::arm::{OfArm, beyond_proof_of_stops};
use std::path::PathBuf;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use reachtube::Keep;
use reachtube::page::{STOP_PAGE_FILE, StopPage, stop_html};
use reachtube::recordings::{DataSet, RunSource};
use reachtube::robot::JointKind;
use reachtube::verify::{Brakes, Category, StopQuestion, StopStudy, stop_study};
use reachtube::write;

use crate::data_arguments::ModelArguments;
use crate::error::Result;
use crate::opened::OpenedCheck;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;

const HELP: &str = "\
Example:
  reachtube stop --model model.json --data recordings --suites A --brakes brakes.toml --out stops

brakes.toml gives the least and the greatest torque of each brake, in N m at the output side of the
gear, and when the brakes hold at the earliest and at the latest, in s (docs/verify.md):
  torque = [[40, 60], [40, 60], [40, 60], [40, 60], [20, 30], [20, 30]]
  delay = [0.01, 0.03]
Category 1 needs the greatest deceleration of each joint too, in rad/s²:
  deceleration = [4, 4, 4, 6, 6, 6]

Prints the greatest proved way and the latest proved standstill of each joint, for stops from every
recorded sample. With --out, the table of ISO 10218-1, Annex B, and a page: stop.html.

Exit codes: 0 every stop is proved, 1 a recorded stop is not within the proved one, 2 error,
3 not proved from some samples.";

/// Enclose how far and how long a robot moves after a stop
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub model: ModelArguments,
    /// TOML file with torque and delay
    #[arg(long, value_name = "FILE")]
    pub brakes: PathBuf,
    /// Stop category: 0 drives off and brakes on, 1 after a controlled deceleration
    #[arg(long, value_name = "0|1", default_value_t = 0)]
    #[arg(value_parser = clap::value_parser!(u8).range(0..=1))]
    pub category: u8,
    /// Stop from every Nth sample
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = RangedU64ValueParser::<usize>::new().range(1..))]
    pub every: usize,
    /// Recorded stops: a folder with runs.csv; each recording begins with its stop
    #[arg(long, value_name = "FOLDER")]
    pub stops: Option<PathBuf>,
    /// Folder for the page with the table of ISO 10218-1, Annex B
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let page = args.out.as_ref().map(|folder| folder.join(STOP_PAGE_FILE));
    if let Some(page) = &page {
        write::try_at(page)?;
        output::claim(page)?;
    }
    let text =
        reachtube_files::read_text(&args.brakes, "write the brakes as docs/verify.md describes")?;
    let opened = OpenedCheck::new(&args.model, None, Keep::Needed)?;
    let robot = opened.problem.robot();
    let brakes = Brakes::from_toml(&text, &args.brakes.display().to_string(), robot)?;
    let sets = &opened.tube().sets;
    let origin = args.brakes.display().to_string();
    let input_set = |rates: &[f64]| opened.problem.input_set_at(sets, rates);
    let category = Category::numbered(args.category, &brakes, &origin, &input_set)?;
    let recorded = args.stops.as_ref().map(DataSet::open).transpose()?;
    opened.print_notes(&args.model.data);
    let warnings = &beyond_proof_of_stops(&opened.model, &opened.problem);
    warnings.iter().for_each(|warning| output::warn(&warning.text));
    let question = StopQuestion {
        brakes: &brakes,
        category: &category,
        every: args.every,
        table: page.is_some(),
        recorded: recorded.as_ref().map(|data| data as &dyn RunSource),
    };
    let study = {
        let _bar = Progress::new();
        stop_study(&opened.problem, sets, &question)?
    };
    if let Some(path) = &page {
        let (model, brakes, study) = (&opened.model, &brakes, &study);
        let content = StopPage { robot, model, brakes, study, warnings };
        let html = stop_html(&content)?;
        write::atomically(path, |file| file.write_all(html.as_bytes()))?;
        output::wrote(path);
    }
    let outcome = outcome(&study);
    if json {
        output::print_json(&study)?;
    } else {
        let unit = JointKind::column(&robot.kinds(), JointKind::position_unit).any();
        output::print_verdict(&study.text(&unit), &outcome)?;
    }
    Ok(outcome)
}

fn outcome(study: &StopStudy) -> Outcome {
    match study.outside() {
        Some(_) => Outcome::NotConformant,
        None if study.is_proved() => Outcome::Done,
        None => Outcome::Undecided,
    }
}
