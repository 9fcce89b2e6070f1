//! `reachtube export`: models and robots as other tools read them.

mod arguments;
mod shield;

use std::path::PathBuf;

use reachtube::export::robot::{mjcf_files, updated_urdf_files, urdf_files};
use reachtube::export::{
    ExportCase, ExportError, ExportFile, InputForm, LinkPadding, Meaning, Paddings, Tool, files,
};
use reachtube::finding::Table;
use reachtube::tracking::{TrackingModel, width_up};
use reachtube::{Robot, write};
use reachtube_files::SealedFile;
use schemars::JsonSchema;
use serde::Serialize;

pub(crate) use arguments::Arguments;
use arguments::{Target, load_robot, model_file, open, refuse_unused, write_all};
pub(crate) use shield::ShieldExport;

use crate::commands::tracking::print_conditions;
use crate::error::{Error, Result};
use crate::file_names;
use crate::outcome::Outcome;
use crate::output;

/// The result of `export` of a robot.
#[derive(Serialize, JsonSchema)]
pub(crate) struct RobotExport<'a> {
    /// Name of the robot.
    robot: &'a str,
    /// Paths of the files.
    files: &'a [String],
}

/// The result of `export` of a model.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ModelExport<'a> {
    /// The tool.
    tool: String,
    /// One entry for each suite, or run with a nominal motion of its own.
    cases: Vec<CaseExport<'a>>,
}

/// An exported case.
#[derive(Serialize, JsonSchema)]
struct CaseExport<'a> {
    /// The suite.
    suite: &'a str,
    /// The run; null where all runs share their nominal motion.
    run: Option<&'a str>,
    /// Number of states of the exported system.
    states: usize,
    /// Number of samples.
    samples: usize,
    /// How the recorded input enters.
    input: InputForm,
    /// Whether the tool knows fewer disturbances than the model, so that its set proves nothing
    /// about it.
    may_be_smaller: bool,
    /// The folder.
    folder: String,
    /// Names in the folder.
    files: Vec<&'a str>,
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
        return Err(Error::setting(
            "--update is for one file with --to urdf, and for files of the shield with --to \
             sara-shield; leave it out",
        ));
    }
    refuse_unused(args)?;
    let updated = |robot: &Robot| match args.update.first() {
        Some(path) => updated_urdf_files(robot, path, &args.lock.lock),
        None => urdf_files(robot),
    };
    match args.to {
        Target::Mjcf => robot(args, &mjcf_files, json),
        Target::Urdf => robot(args, &updated, json),
        Target::SaraShield => shield::run(args, json),
        Target::Ros2Control => tolerances(args, json),
        Target::Moveit => paddings(args, json),
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
    let robot = load_robot(args)?;
    let files = files(&robot)?;
    let paths: Vec<PathBuf> = files.iter().map(|file| args.out.join(&file.name)).collect();
    write_all(&paths, files.iter())?;
    let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
    let result = RobotExport { robot: robot.name(), files: &names };
    let text = || format!("exported {}:\n  {}\n", robot.name(), names.join("\n  "));
    output::show(json, &result, text)?;
    Ok(Outcome::Done)
}

/// The result of `export` of tolerances.
#[derive(Serialize, JsonSchema)]
pub(crate) struct TolerancesExport<'a> {
    /// Names of the joints.
    joints: Vec<&'a str>,
    /// Path of the file.
    file: String,
}

/// Writes the tolerances of a model of an arm under its controller.
fn tolerances(args: &Arguments, json: bool) -> Result<Outcome> {
    let path = args.out.join("constraints.yaml");
    write::try_at(&path)?;
    let model = TrackingModel::open(model_file(args)?)?;
    output::write_all(std::iter::once((&path, model.ros2_control().as_bytes())))?;
    print_conditions(&model);
    let joints = model.joints.iter().map(|joint| joint.name.as_str()).collect();
    let result = TolerancesExport { joints, file: path.display().to_string() };
    output::show(json, &result, || format!("exported to ros2_control:\n  {}\n", path.display()))?;
    Ok(Outcome::Done)
}

/// The result of `export --to moveit`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PaddingsExport<'a> {
    /// The part of the recorded speeds up to which the paddings hold.
    part: f64,
    /// The time by which the arm is late on its path, s.
    late_by: f64,
    /// The links.
    links: &'a [LinkPadding],
    /// Path of the file.
    file: String,
}

/// Writes the paddings of links, of a model of an arm under its controller.
fn paddings(args: &Arguments, json: bool) -> Result<Outcome> {
    let no_urdf = || Error::setting("MoveIt pads the links of a URDF; name it with --robot");
    let urdf = args.robot.as_ref().ok_or_else(no_urdf)?;
    let model = TrackingModel::open(model_file(args)?)?;
    let Paddings { links, deviations, file } =
        Paddings::new(&model, urdf.as_ref(), args.speed.unwrap_or(1.0))?;
    let path = args.out.join(&file.name);
    write_all(std::slice::from_ref(&path), std::iter::once(&file))?;
    print_conditions(&model);
    let result = PaddingsExport {
        part: deviations.part,
        late_by: deviations.late_by,
        links: &links,
        file: path.display().to_string(),
    };
    let row = |of: &LinkPadding| {
        let [path, time] = [of.along_the_path, of.at_the_same_time].map(|of| width_up(of, "m"));
        vec![of.link.clone(), path, time]
    };
    let text = || {
        format!(
            "exported to MoveIt: how far links can be from a plan of up to {} % of the recorded \
             speeds\n{}  {}\n",
            100.0 * deviations.part,
            Table::new(
                ["link", "from its path", "from its place at the same time"],
                links.iter().map(row).collect()
            ),
            path.display()
        )
    };
    output::show(json, &result, text)?;
    Ok(Outcome::Done)
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
            "{tool} supports fewer disturbances than the model: its set may be smaller than the \
             model's and proves nothing about it"
        ));
    }
    let cases = written.iter().map(Written::output).collect();
    output::show(json, &ModelExport { tool: tool.to_string(), cases }, || summary(tool, &written))?;
    Ok(Outcome::Done)
}

fn summary(tool: Tool, written: &[Written]) -> String {
    let rows = written.iter().map(Written::row).collect();
    format!(
        "exported to {tool}\n{}",
        Table::new(["suite", "run", "states", "samples", "input", "folder"], rows)
    )
}

impl Written {
    fn paths(&self) -> impl Iterator<Item = PathBuf> {
        self.files.iter().map(|file| self.folder.join(&file.name))
    }

    fn output(&self) -> CaseExport<'_> {
        CaseExport {
            suite: &self.case.reach.suite,
            run: self.case.reach.run.as_deref(),
            states: self.case.system.dimension(),
            samples: self.case.grid.len(),
            input: self.form,
            may_be_smaller: self.may_be_smaller,
            folder: self.folder.display().to_string(),
            files: self.files.iter().map(|file| &*file.name).collect(),
        }
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
