//! `reachtube model` and `check` of an arm under its controller.

use std::path::{Path, PathBuf};

use reachtube::axes;
use reachtube::recordings::ColumnSettings;
use reachtube::robot::{Lock, Robot};
use reachtube::tracking::{MadeModel, Reading, TrackingModel, make};
use reachtube::write;
use reachtube_files::SealedFile;
use schemars::JsonSchema;
use serde::Serialize;

use crate::data_arguments::ModelArguments;
use crate::error::{Error, Result};
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;

/// Options of `check` do not fit the model.
pub(crate) const NO_TORQUES: &str = "the model is of an arm under its controller, without \
                                     torques, suites and notions; leave --torque, --suites, \
                                     --notion and --max-gap out";

/// What `model --json` prints of an arm under its controller.
#[derive(Serialize, JsonSchema)]
pub(crate) struct TrackingOutput<'a> {
    /// Whether the sets are proved, and narrower than what the logs alone give.
    useful: bool,
    /// The mean over the joints of the half-widths of their sets at their highest speeds, rad.
    mean_half_width: f64,
    /// The mean over the joints of their largest error + 20 %, rad.
    mean_largest_error: f64,
    /// The answer.
    #[serde(flatten)]
    made: &'a MadeModel,
}

/// What a model of an arm under its controller is made of.
pub(crate) struct TrackingArguments<'a> {
    /// The logs.
    pub data: &'a [PathBuf],
    /// The robot, if one is given, and the joints of it that are held.
    pub robot: Option<&'a str>,
    pub lock: &'a [Lock],
    /// Columns whose names do not tell.
    pub columns: ColumnSettings,
    /// The folder of the result.
    pub out: &'a Path,
}

/// Makes a model of an arm under its controller.
pub(crate) fn model(args: &TrackingArguments, json: bool) -> Result<Outcome> {
    let path = args.out.join("model.json");
    output::claim(&path)?;
    let robot = args.robot.map(|name| Robot::load_to_identify(name, args.lock)).transpose()?;
    let axes = robot.map(|(robot, _)| axes(&robot));
    let reading = Reading { axes: axes.as_deref(), columns: &args.columns, until: None };
    let (recordings, notes) = reading.read(args.data)?;
    output::notes(&notes);
    let bar = Progress::of("making a model");
    let mut made = make(&recordings)?;
    made.model = made.model.with_columns(args.columns.clone());
    drop(bar);
    write::atomically(&path, |out| out.write_all(made.model.to_json().as_bytes()))?;
    let outcome = match (made.model.verified, made.is_useful()) {
        (false, _) => Outcome::NotConformant,
        (true, true) => Outcome::Done,
        (true, false) => Outcome::Vacuous,
    };
    if json {
        output::wrote(&path);
        output::print_json(&TrackingOutput {
            useful: made.is_useful(),
            mean_half_width: made.model.mean_half_width(),
            mean_largest_error: made.model.mean_without_model(),
            made: &made,
        })?;
    } else {
        let mut summary = made.summary();
        summary.fact("wrote", path.display().to_string());
        let check = format!("`reachtube check --model {} --data OTHER-LOGS`", path.display());
        summary.next = made.is_useful().then_some(check);
        output::print_verdict(&summary.to_string(), &outcome)?;
    }
    Ok(outcome)
}

/// Compares logs with a model of an arm under its controller.
pub(crate) fn check(args: &ModelArguments, json: bool) -> Result<Outcome> {
    let ModelArguments { model, data } = args;
    if data.torque.is_some() || data.max_gap.is_some() || !data.suites.is_empty() {
        return Err(Error::setting(NO_TORQUES));
    }
    let model = TrackingModel::open(model)?;
    let axes = model.axes();
    let reading = Reading { axes: Some(&axes), columns: &model.columns, until: data.until };
    let (recordings, notes) = reading.read(&[PathBuf::from(&data.data)])?;
    output::notes(&notes);
    let check = model.check(&recordings)?;
    let outcome = match check.conformant {
        false => Outcome::NotConformant,
        true if model.is_useful() => Outcome::Done,
        true => Outcome::Vacuous,
    };
    match json {
        true => output::print_json(&check)?,
        false => output::print_verdict(&check.summary(&model).to_string(), &outcome)?,
    }
    Ok(outcome)
}
