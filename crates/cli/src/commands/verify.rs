//! `reachtube verify`: whether the links stay clear of obstacles on every motion of a model.

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::page::{VERIFY_PAGE_FILE, VerifyPage, write_verify_html};
use reachtube::robot::{Robot, Urdf, UrdfOptions};
use reachtube::verify::{
    Answer, Body, Capsules, Margin, Scenario, Scene, Verification, Witness, picture, report, verify,
};
use reachtube::write;
use reachtube::{Keep, Model};
use reachtube_files::distinct_names;
use serde_json::{Value, json};

use crate::data_arguments::DataArguments;
use crate::error::Result;
use crate::opened::OpenedCheck;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;

const HELP: &str = "\
Example:
  reachtube verify cell.toml --out cell

cell.toml names the model, the recordings and the obstacles (docs/verify.md):
  model = \"model.json\"
  data = \"recordings\"
  [[obstacle]]
  name = \"table\"
  half-space = { normal = [0, 0, 1], offset = -0.3 }

The folder gets a page with the worst motion in three dimensions, verify.html, and a picture of
each motion, NAME.svg; if it is not safe, also the simulated motion that comes closest,
NAME_closest.csv. With a [stop] in the scenario, each link must stay clear until standstill.

Exit codes: 0 safe, 1 unsafe, 2 error, 3 undecided.";

/// Decide whether the links stay clear of obstacles on every motion of a model
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Scenario: a TOML file with model, recordings and obstacles
    #[arg(value_name = "SCENARIO")]
    pub scenario: PathBuf,
    /// Folder for the page, the pictures and the closest motions
    #[arg(long, value_name = "FOLDER", default_value = "verify")]
    pub out: PathBuf,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let scenario = Scenario::open(&args.scenario)?;
    write::try_at(&args.out.join("A.svg"))?;
    let (model, setup) = Model::open(&scenario.model)?;
    let robot = Robot::from_description(&model.robot)?;
    let scene = scenario.scene(&robot)?;
    let body = Body::new(&robot, &capsules(scenario.capsules.as_deref(), &robot)?);
    let data = DataArguments {
        data: scenario.data.clone(),
        suites: scenario.suites.clone(),
        torque: None,
        until: scenario.until,
        max_gap: None,
    };
    let opened = OpenedCheck::with(model, setup, &data, None, Keep::Needed)?;
    opened.print_notes(&data);
    let stop = scenario.stop(&robot, &opened.tube().sets.input_set)?;
    let all = {
        let _bar = Progress::new();
        let all = verify(&opened.problem, opened.tube(), &body, &scene)?;
        match &stop {
            None => all,
            Some(rule) => {
                let stopped = all
                    .into_iter()
                    .map(|one| one.with_stops(opened.problem.robot(), (&body, &scene), rule));
                stopped.collect()
            }
        }
    };
    write_files(&args.out, &all, &body, &scene)?;
    let outcome = outcome(&all);
    if json {
        output::print_json(&value(&all, &body))?;
    } else {
        output::print_verdict(&report(&all, &body, &scene), &outcome)?;
    }
    Ok(outcome)
}

/// Returns the capsules of a TOML or URDF file, or the embedded ones of the robot.
pub(super) fn capsules(path: Option<&Path>, robot: &Robot) -> Result<Capsules> {
    let Some(path) = path else { return Ok(Capsules::embedded(robot)?) };
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf")) {
        return Ok(Capsules::of_urdf(&Urdf::load(path, &UrdfOptions::default())?)?);
    }
    let text = reachtube_files::read_text(path, "name a TOML or URDF file with capsules")?;
    Ok(Capsules::from_toml(&text, &path.display().to_string(), robot)?)
}

fn outcome(all: &[Verification]) -> Outcome {
    match all.iter().map(|one| one.answer).max() {
        Some(Answer::Unsafe) => Outcome::Unsafe,
        Some(Answer::Undecided) => Outcome::Undecided,
        _ => Outcome::Done,
    }
}

/// Writes the pictures, and the closest motions of what is not safe.
fn write_files(out: &Path, all: &[Verification], body: &Body, scene: &Scene) -> Result<()> {
    let names = distinct_names(all.iter().map(|one| one.reach.name()), &["", "_closest"]);
    let mut files: Vec<(PathBuf, String)> = Vec::new();
    for (one, name) in all.iter().zip(names) {
        files.push((out.join(format!("{name}.svg")), picture(one, body, scene)));
        if let Some(found) = &one.closest {
            files
                .push((out.join(format!("{name}_closest.csv")), motion(found, body.joint_count())));
        }
    }
    let mut html = Vec::new();
    write_verify_html(&VerifyPage { all, body, scene }, &mut html)?;
    let page = out.join(VERIFY_PAGE_FILE);
    output::claim_all(files.iter().map(|(path, _)| path).chain([&page]))?;
    write::atomically(&page, |file| file.write_all(&html))?;
    for (path, text) in &files {
        write::atomically(path, |file| file.write_all(text.as_bytes()))?;
    }
    Ok(())
}

/// Returns a motion as CSV, `t,q1,..,qd1,..,tau1,..`, whose torque is the model's input.
fn motion(found: &Witness, n: usize) -> String {
    let names = |kind: &str| (1..=n).map(|i| format!(",{kind}{i}")).collect::<String>();
    let mut text = format!("t{}{}{}\n", names("q"), names("qd"), names("tau"));
    for (k, t) in found.times.iter().enumerate() {
        text += &t.to_string();
        let row = found.states[2 * n * k..2 * n * (k + 1)].iter();
        row.chain(&found.inputs[n * k..n * (k + 1)]).for_each(|x| text += &format!(",{x}"));
        text.push('\n');
    }
    text
}

fn value(all: &[Verification], body: &Body) -> Value {
    let margin = |margin: &Margin| {
        json!({ "link": body.joint_name(margin.joint), "margin": margin.distance,
                "time": margin.time })
    };
    let one = |one: &Verification| {
        json!({
            "case": one.case,
            "answer": one.answer,
            "clearances": one.clearances,
            "margins": one.margins.iter().map(margin).collect::<Vec<_>>(),
            "closest": one.closest,
            "advice": one.advice,
            "stops": one.stops,
            "lost": one.lost,
        })
    };
    json!({ "answer": all.iter().map(|one| one.answer).max().unwrap_or(Answer::Safe),
            "motions": all.iter().map(one).collect::<Vec<_>>() })
}
