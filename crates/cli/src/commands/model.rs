//! `reachtube model`: from logs to a model, a page and a verdict.

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::Silent;
use reachtube::conform::plausibility::JointWidth;
use reachtube::conform::result::{Code, FrontEnd};
use reachtube::conform::{Answer, Keep, Opened};
use reachtube::number::significant;
use reachtube::page::{Assets, Sources};
use reachtube::pipeline::{Built, Choice, Choices, HeldOut, build};
use reachtube::recordings::{MemoryRuns, Torque};
use reachtube::write;
use reachtube_files::MARK;
use reachtube_robot::{Lock, Robot};
use serde_json::{Value, json};

use crate::data_arguments::TORQUES;
use crate::error::{Error, Result};
use crate::lock_arguments::LockArguments;
use crate::option_values::{choice, seconds};
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::table::table;
use crate::{output, report_files};

const HELP: &str = "\
Examples:
  reachtube model --robot arm.urdf --data logs --torque motor --out arm
      every choice is made from the logs, printed, and written to arm/choices.toml
  reachtube model --settings arm/choices.toml --out again
      the same choices give the same model

Exit codes: 0 conformant and useful, 1 not proved conformant, 2 error, 3 conformant but too wide to
be of use.";

/// Make a model of a robot's logs: sets, horizon, page and verdict, in one command
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long)]
    pub robot: Option<String>,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Logs: CSV files or folders
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub data: Vec<PathBuf>,
    /// Meaning of the recorded torques
    #[arg(long, value_parser = choice::<Torque>(TORQUES))]
    pub torque: Option<Torque>,
    /// TOML file with choices, as this command writes it; its paths are relative to its folder, and
    /// options on the command line come before it
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    /// Time up to which the model predicts, above 0 s [default: the longest at which no set is
    /// wider than half the motion]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub horizon: Option<f64>,
    /// Motions that are held out from every choice, separated by commas [default: every fourth]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    pub held_out: Vec<String>,
    /// Factors of the recorded torques, one per joint; for motor currents in N m/A [default: 1]
    #[arg(long, value_name = "G,..", value_delimiter = ',', allow_hyphen_values = true)]
    pub gains: Vec<f64>,
    /// Folder for model.json, robot.toml, choices.toml and the page
    #[arg(long, value_name = "FOLDER")]
    pub out: PathBuf,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let choices = choices(args)?;
    let name = choices.robot.clone().ok_or(Error::NoRobot)?;
    let locks: Vec<Lock> =
        choices.lock.iter().map(|lock| lock.parse()).collect::<Result<_, _>>()?;
    let robot = Robot::load_locked(&name, &locks)?;
    let torque = choices.torque.ok_or(Error::NoTorque)?;
    if choices.data.is_empty() {
        return Err(Error::NoData);
    }
    let files = ["model.json", "robot.toml", "choices.toml"].map(|file| args.out.join(file));
    let page = args.out.join("page");
    output::claim_all(&files)?;
    let held_out = args.out.join("held-out");
    output::claim_all(&[&page, &held_out].map(|folder| report_files::page_in(folder)))?;
    let bar = Progress::of("making a model");
    let mut say = |choice: &Choice| {
        output::note(&format!("{}: {} ({})", choice.key, choice.value, choice.reason));
    };
    let built = build(&robot, torque, &choices, &mut say)?;
    drop(bar);
    output::notes(&built.notes);
    save(&built, &files)?;
    let Built { answer, shown, shown_held_out, held_out: other, .. } = &built;
    let all = answer.model.data.run_count();
    let excerpt = format!(", an excerpt of {all} with the ten that decide the sets most");
    output::wrote(&write_page(answer, shown, &page, &excerpt)?);
    if other.failure.is_none() {
        let all = other.windows;
        let excerpt =
            format!(", an excerpt of {all} that were held out, with up to 12 that leave the sets");
        output::wrote(&write_page(answer, shown_held_out, &held_out, &excerpt)?);
    }
    output::show(json, &as_json(&built), || summary(&built, args))?;
    Ok(outcome(&built))
}

/// Writes a page about some windows; `excerpt` says which.
fn write_page(answer: &Answer, runs: &MemoryRuns, folder: &Path, excerpt: &str) -> Result<PathBuf> {
    let opened = answer.model.check(runs.clone()).keep(Keep::All).open(&Silent)?;
    let (check, reach) = (opened.check()?, opened.reach()?);
    let Opened { model, problem, .. } = &opened;
    let front_end = FrontEnd::CommandLine;
    let sources = Sources { model, problem, reach: &reach, check: &check, front_end };
    report_files::write_excerpt(&sources, Assets::Inside, folder, excerpt)
}

/// Returns the choices of the settings file and the command line, with paths from the working
/// directory.
fn choices(args: &Arguments) -> Result<Choices> {
    let mut choices = match &args.settings {
        None => Choices::default(),
        Some(path) => {
            let text = reachtube_files::read_text(path, "give a file that `model` wrote")?;
            Choices::from_toml(&text).map_err(|error| Error::SettingsSyntax {
                path: path.clone(),
                message: error.to_string(),
            })?
        }
    };
    let folder = args.settings.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    if let Some(robot) = &choices.robot {
        let beside = folder.join(robot);
        if beside.exists() {
            choices.robot = Some(beside.display().to_string());
        }
    }
    choices.data.iter_mut().for_each(|path| *path = folder.join(&*path));
    let before = choices.clone();
    choices.robot = args.robot.clone().or(choices.robot);
    choices.torque = args.torque.or(choices.torque);
    choices.horizon = args.horizon.or(choices.horizon);
    if !args.data.is_empty() {
        choices.data.clone_from(&args.data);
    }
    if !args.held_out.is_empty() {
        choices.held_out = Some(args.held_out.clone());
    }
    if !args.lock.lock.is_empty() {
        choices.lock = args.lock.lock.iter().map(ToString::to_string).collect();
    }
    if !args.gains.is_empty() {
        choices.gains.clone_from(&args.gains);
    }
    // Reasons of a file are about its own values.
    if choices != before {
        choices.reasons.clear();
    }
    Ok(choices)
}

/// Writes the model, the robot and the choices.
fn save(built: &Built, files: &[PathBuf; 3]) -> Result<()> {
    let [model, robot, choices] = files;
    built.answer.model.save(model)?;
    let description = toml::to_string(built.robot.description());
    let description = description.expect("the keys of a description are strings");
    let text = format!("# {MARK} model.\n{description}");
    write::atomically(robot, |out| out.write_all(text.as_bytes()))?;
    // Paths are relative to the folder of the file.
    let here = std::env::current_dir().unwrap_or_default();
    let absolute = |path: &Path| here.join(path);
    let named = Choices {
        robot: built.choices.robot.as_ref().map(|name| match Path::new(name) {
            path if path.exists() => absolute(path).display().to_string(),
            _ => name.clone(),
        }),
        data: built.choices.data.iter().map(|path| absolute(path)).collect(),
        ..built.choices.clone()
    };
    let text = format!(
        "# {MARK} model: the choices behind model.json, each with its reason.\n\n{}",
        named.to_toml(&built.made)
    );
    write::atomically(choices, |out| out.write_all(text.as_bytes()))?;
    files.iter().for_each(|path| output::wrote(path));
    Ok(())
}

fn outcome(built: &Built) -> Outcome {
    match built.answer.holds() {
        false => Outcome::NotConformant,
        true if built.is_useful() => Outcome::Done,
        true => Outcome::Vacuous,
    }
}

/// Returns a ratio in percent.
fn percent(ratio: f64) -> String {
    if ratio.is_finite() { format!("{:.0} %", 100.0 * ratio) } else { "-".into() }
}

/// Returns the answer in a few lines: verdict, sets, what was held out, and what to do next.
fn summary(built: &Built, args: &Arguments) -> String {
    let model = &built.answer.model;
    let horizon = built.choices.horizon.unwrap_or_default();
    let is_cut = model.preparation.as_ref().is_some_and(|known| known.window.is_some());
    let what = if is_cut { "windows" } else { "recordings" };
    let windows = model.data.run_count();
    let verdict = match (built.answer.holds(), built.is_useful(), model.is_vacuous()) {
        (false, ..) => "NOT PROVED conformant".to_string(),
        (true, true, _) => format!("conformant and useful up to {horizon} s"),
        (true, false, true) => format!("conformant, but vacuous at {horizon} s"),
        (true, false, false) => format!("conformant, but too wide to be of use at {horizon} s"),
    };
    let head = format!("{verdict}: {windows} {what}, each sample proved with directed rounding");
    let mut lines: Vec<String> =
        built.warnings.iter().map(|warning| format!("warning: {warning}")).collect();
    lines.push(head);
    if !built.is_useful() {
        let said = [Code::Vacuous, Code::Cause];
        let findings = model.findings().into_iter().filter(|finding| said.contains(&finding.code));
        lines.extend(findings.map(|finding| finding.to_string()));
    }
    lines.push(joints(built));
    lines.push(held_out(&built.held_out, what));
    let growth = built
        .horizons
        .iter()
        .map(|widths| format!("{} s {}", widths.horizon, percent(widths.worst().1)));
    let growth: Vec<String> = growth.collect();
    lines.push(format!("widest set by horizon, of the motion: {}", growth.join(", ")));
    lines.push(format!(
        "next: {}",
        match built.is_useful() {
            true => format!("open {}", report_files::page_in(&args.out.join("page")).display()),
            false => format!("read {}", args.out.join("choices.toml").display()),
        }
    ));
    lines.join("\n") + "\n"
}

/// Returns the table of the joints.
fn joints(built: &Built) -> String {
    let model = &built.answer.model;
    let kinds = model.robot.kinds();
    let Some(said) = &model.usefulness else { return String::new() };
    let horizon = said.horizon;
    let row = |(i, width): (usize, &JointWidth)| {
        let (low, high) = model.input_set.bounds(i);
        let half = width.half_width.unwrap_or(f64::INFINITY);
        let growth = built.held_out.growth[i];
        vec![
            model.robot.joints[i].name.clone(),
            format!("± {} {}", significant(half, 2), kinds[i].position_unit()),
            percent(width.ratio()),
            format!(
                "[{}, {}] {}",
                significant(low, 2),
                significant(high, 2),
                kinds[i].force_unit()
            ),
            if growth.is_finite() { significant(growth, 2) } else { "-".into() },
        ]
    };
    let rows: Vec<Vec<String>> = said.joints.iter().enumerate().map(row).collect();
    let set = format!("set at {horizon:.3} s");
    table(&["joint", &set, "of its motion", "U", "factor, held out"], &rows)
}

fn held_out(held_out: &HeldOut, what: &str) -> String {
    match &held_out.failure {
        Some(why) => format!("held out: {why}"),
        None => {
            let HeldOut { rows, outside, windows, .. } = held_out;
            let part = 100.0 * *outside as f64 / (*rows).max(1) as f64;
            format!("held out: {outside} of {rows} rows outside ({part:.1} %), of {windows} {what}")
        }
    }
}

fn as_json(built: &Built) -> Value {
    let model = &built.answer.model;
    let widths = model.usefulness.iter().flat_map(|said| &said.joints).enumerate();
    let joints: Vec<Value> = widths
        .map(|(i, width)| {
            let growth = built.held_out.growth[i];
            json!({
                "name": model.robot.joints[i].name,
                "half_width": width.half_width,
                "displacement": width.displacement,
                "ratio": width.half_width.map(|_| width.ratio()),
                "growth": growth.is_finite().then_some(growth),
            })
        })
        .collect();
    json!({
        "useful": built.is_useful(),
        "conformant": built.answer.holds(),
        "horizon": built.choices.horizon,
        "joints": joints,
        "held_out": {
            "windows": built.held_out.windows,
            "rows": built.held_out.rows,
            "outside": built.held_out.outside,
            "failure": built.held_out.failure,
        },
        "horizons": built.horizons.iter().map(|widths| json!({
            "horizon": widths.horizon, "ratios": widths.ratios, "reason": widths.reason,
        })).collect::<Vec<Value>>(),
        "choices": built.made,
        "warnings": built.warnings,
        "findings": built.answer.findings(),
    })
}
