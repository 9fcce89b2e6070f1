//! `reachtube model`, `check` and `reach` of an arm under its controller.

use std::path::{Path, PathBuf};

use reachtube::axes;
use reachtube::conform::SuiteReach;
use reachtube::finding::Table;
use reachtube::pipeline::{NOT_USEFUL, body_of, followed, robot_of};
use reachtube::recordings::{ColumnSettings, LogSettings};
use reachtube::robot::{Lock, Robot};
use reachtube::scalar::Interval;
use reachtube::scalar::rounding::sub_up;
use reachtube::tracking::{
    JointTracking, MadeModel, Plan, Reading, TrackedLinks, TrackingModel, make, width_up,
};
use reachtube::verify::{Body, Margin};
use reachtube::write;
use reachtube_files::SealedFile;
use schemars::JsonSchema;
use serde::Serialize;

use crate::data_arguments::ModelArguments;
use crate::error::{Error, Result};
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::set_files::Written;

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
    /// Topics, joints and times of logs.
    pub log: LogSettings,
    /// The folder of the result.
    pub out: &'a Path,
}

/// Makes a model of an arm under its controller.
pub(crate) fn model(args: &TrackingArguments, json: bool) -> Result<Outcome> {
    let path = args.out.join("model.json");
    output::claim(&path)?;
    let robot = args.robot.map(|name| Robot::load_to_identify(name, args.lock)).transpose()?;
    let axes = robot.as_ref().map(|(robot, _)| axes(robot));
    let body = links_of(robot.as_ref().map(|(robot, _)| robot).zip(args.robot));
    let ways = |from: &[Interval], shift: &[Interval]| {
        body.as_ref().map_or(vec![], |body| body.ways_of_links(from, shift))
    };
    let links = body.as_ref().map(|body| TrackedLinks { joints: body.links(), ways: &ways });
    let reading =
        Reading { axes: axes.as_deref(), columns: &args.columns, log: &args.log, until: None };
    let (recordings, notes) = reading.read(args.data)?;
    output::notes(&notes);
    let bar = Progress::of("making a model");
    let mut made = make(&recordings, links.as_ref())?;
    made.model = made.model.read_with(args.columns.clone(), args.log.clone());
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

/// Returns the links of a robot that was named; a note says why a robot has none.
fn links_of(robot: Option<(&Robot, &str)>) -> Option<Body> {
    let (robot, name) = robot?;
    match body_of(robot, name, None) {
        Ok(body) => Some(body),
        Err(error) => {
            output::note(&format!("no distances of links: {error}"));
            None
        }
    }
}

/// Prints for what alone the result of a model holds, and a warning where the model is no better
/// than none.
pub(crate) fn print_conditions(model: &TrackingModel) {
    output::notes(&model.conditions());
    if !model.is_useful() {
        output::warn(NOT_USEFUL);
    }
}

/// Compares logs with a model of an arm under its controller.
pub(crate) fn check(args: &ModelArguments, json: bool) -> Result<Outcome> {
    let ModelArguments { model, data } = args;
    if data.torque.is_some() || data.max_gap.is_some() || !data.suites.is_empty() {
        return Err(Error::setting(NO_TORQUES));
    }
    let model = TrackingModel::open(model)?;
    let axes = model.axes();
    let reading = Reading { until: data.until, ..model.reading(&axes) };
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

/// What `reach --json` prints of an arm that follows plans.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PlansOutput {
    /// The plans.
    plans: Vec<PlanOutput>,
}

/// Where an arm can be that follows a plan.
#[derive(Serialize, JsonSchema)]
struct PlanOutput {
    /// The plan.
    plan: String,
    /// Number of samples.
    samples: usize,
    /// Time of the last sample, s.
    duration: f64,
    /// How far each joint can be from the plan at a sample, rad or m; rounded up.
    joints: Vec<Furthest>,
    /// How far each link can be from the plan at any time, m; rounded up. Empty without a robot.
    links: Vec<Furthest>,
    /// File with the set at samples.
    csv: String,
    /// File with the set over each step.
    tube_csv: String,
}

/// The largest distance from a plan.
#[derive(Serialize, JsonSchema)]
struct Furthest {
    /// The joint, or the joint that moves the link.
    of: String,
    /// The unit of the distance.
    unit: String,
    /// The distance.
    distance: f64,
    /// The time at which it is the largest, s.
    time: f64,
}

/// Computes where an arm can be that follows plans under its controller.
pub(crate) fn reach(
    args: &ModelArguments,
    robot: Option<&str>,
    out: &Path,
    json: bool,
) -> Result<Outcome> {
    let ModelArguments { model, data } = args;
    if data.torque.is_some() || data.max_gap.is_some() || !data.suites.is_empty() {
        return Err(Error::setting(NO_TORQUES));
    }
    let model = TrackingModel::open(model)?;
    let body = robot.map(|name| body_of(&robot_of(&model, name)?, name, None)).transpose()?;
    let (plans, notes) = Plan::read(&data.data, &model, data.until)?;
    output::notes(&notes);
    let sets = plans.iter().map(|plan| followed(&model, plan));
    let sets: Vec<SuiteReach> = sets.collect::<Result<_, _>>()?;
    let written = Written::all(&sets, out);
    let contents = written.iter().flat_map(Written::contents);
    let files: Vec<_> = contents.map(|(name, content)| (out.join(name), content)).collect();
    output::write_all(files.iter().map(|(path, content)| (path, &**content)))?;
    print_conditions(&model);
    let of_plan = |file| PlanOutput::new(file, &model, body.as_ref());
    let output = PlansOutput { plans: written.iter().map(of_plan).collect() };
    match json {
        true => output::print_json(&output)?,
        false => output.plans.iter().try_for_each(|plan| output::print(&plan.text()))?,
    }
    Ok(Outcome::Done)
}

impl PlanOutput {
    fn new(file: &Written, model: &TrackingModel, body: Option<&Body>) -> Self {
        let SuiteReach { times, nominal, lower, upper, dimension, .. } = file.reach;
        let joint = |(joint, of): (usize, &JointTracking)| {
            let distance = |k: usize| {
                let at = k * dimension + joint;
                let below = sub_up(nominal[at], lower[at]);
                (sub_up(upper[at], nominal[at]).max(below), times[k])
            };
            let furthest = (0..times.len()).map(distance).max_by(|a, b| a.0.total_cmp(&b.0));
            let (distance, time) = furthest.unwrap_or_default();
            Furthest { of: of.name.clone(), unit: of.unit.clone(), distance, time }
        };
        let link = |(body, margin): (&Body, Margin)| Furthest {
            of: body.joint_name(margin.joint).into(),
            unit: "m".into(),
            distance: margin.distance,
            time: margin.time,
        };
        let margins = |body: &'_ Body| body.margins(file.reach);
        let links =
            body.into_iter().flat_map(|body| margins(body).into_iter().map(move |m| (body, m)));
        Self {
            plan: file.reach.suite.clone(),
            samples: times.len(),
            duration: times.last().copied().unwrap_or_default(),
            joints: model.joints.iter().enumerate().map(joint).collect(),
            links: links.map(link).collect(),
            csv: file.samples.display().to_string(),
            tube_csv: file.tube.display().to_string(),
        }
    }

    /// Returns the answer as tables.
    fn text(&self) -> String {
        let row = |of: &Furthest| {
            vec![of.of.clone(), width_up(of.distance, &of.unit), format!("{:.3} s", of.time)]
        };
        let table = |head: &str, all: &[Furthest]| {
            Table::new([head, "furthest from the plan", "at"], all.iter().map(row).collect())
        };
        let mut text = format!(
            "{}: {} samples, {:.3} s\n{}",
            self.plan,
            self.samples,
            self.duration,
            table("joint", &self.joints)
        );
        if !self.links.is_empty() {
            text += &format!("{}", table("link of", &self.links));
        }
        text + &format!("  wrote {}, {}\n", self.csv, self.tube_csv)
    }
}
