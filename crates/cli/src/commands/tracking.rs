//! `reachtube model` and `check` of an arm under its controller.

use std::path::PathBuf;

use reachtube::axes;
use reachtube::recordings::{Axis, ColumnSettings};
use reachtube::robot::Robot;
use reachtube::tracking::{MadeModel, Reading, TrackingModel, make};
use reachtube::write;
use schemars::JsonSchema;
use serde::Serialize;

use crate::commands::{check, model};
use crate::error::{Error, NO_TORQUE, Result};
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;

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

/// Makes a model of an arm under its controller.
pub(crate) fn model(args: &model::Arguments, json: bool) -> Result<Outcome> {
    let of_torque = args.settings.is_some()
        || args.horizon.is_some()
        || !(args.held_out.is_empty() && args.gains.is_empty() && args.fit.is_empty());
    if of_torque {
        return Err(Error::setting(NO_TORQUE));
    }
    let path = args.out.join("model.json");
    output::claim(&path)?;
    let lock = &args.lock.lock;
    let robot =
        args.robot.as_deref().map(|name| Robot::load_to_identify(name, lock)).transpose()?;
    let axes = robot.map(|(robot, _)| axes(&robot));
    let columns = args.log.columns.clone().unwrap_or_default();
    let (recordings, notes) = reading(axes.as_deref(), &columns).read(&args.data)?;
    output::notes(&notes);
    let bar = Progress::of("making a model");
    let made = make(&recordings)?;
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
        summary.next =
            Some(format!("`reachtube check --model {} --data OTHER-LOGS`", path.display()));
        output::print_verdict(&summary.to_string(), &outcome)?;
    }
    Ok(outcome)
}

/// Compares logs with a model of an arm under its controller.
pub(crate) fn check(args: &check::Arguments, json: bool) -> Result<Outcome> {
    let data = &args.model.data;
    let is_other = args.notion.is_some()
        || data.torque.is_some()
        || data.max_gap.is_some()
        || !data.suites.is_empty();
    if is_other {
        return Err(Error::setting(
            "the model is of an arm under its controller, and has no torques, suites and notions; \
             leave --torque, --suites, --notion and --max-gap out",
        ));
    }
    let model = TrackingModel::open(&args.model.model)?;
    let columns = ColumnSettings::default();
    let reading = Reading { until: data.until, ..reading(None, &columns) };
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

fn reading<'a>(axes: Option<&'a [Axis]>, columns: &'a ColumnSettings) -> Reading<'a> {
    Reading { axes, columns, until: None }
}
