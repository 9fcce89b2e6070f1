use std::path::{Path, PathBuf};

use reachtube::identify::prepare::LogEntry;
use reachtube::identify::{Identification, IdentifySettings, identify};
use reachtube::page::identified_html;
use reachtube::recordings::Torque;
use reachtube::write;
use reachtube_files::MARK;
use reachtube_robot::{Robot, Urdf, UrdfOptions};

use super::arguments::Arguments;
use crate::error::{Error, NO_ROBOT, Result};
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let (settings, folder) = settings(args)?;
    let name = settings.robot.clone().ok_or_else(|| Error::setting(NO_ROBOT))?;
    let name = from_folder(&name, args, &folder);
    let robot = args.lock.load_to_identify(&name)?;
    check_urdf(args, &name)?;
    let options =
        UrdfOptions { locks: args.lock.lock.clone(), any_inertia: true, ..UrdfOptions::default() };
    let urdf = args.urdf.is_some().then(|| Urdf::load(&name, &options)).transpose()?;
    output::claim_all(&outputs(args))?;
    let bar = Progress::of("identifying");
    let found = identify(&robot, &settings, &folder, &|done, total| bar.show(done, total))?;
    drop(bar);
    output::notes(&found.changes);
    files(args, &found, urdf.as_ref())?;
    output::show(json, &found.summary(), || text(&found))?;
    output::warnings(&found.warnings);
    Ok(Outcome::Done)
}

fn text(found: &Identification) -> String {
    format!("{}: identified\n\n{}", found.description.name, found.report())
}

fn outputs(args: &Arguments) -> Vec<PathBuf> {
    let page = args.report.as_ref().map(|folder| page_in(folder));
    let companion = args.urdf.as_ref().map(|path| path.with_extension("toml"));
    [args.out.clone(), args.urdf.clone(), companion, page].into_iter().flatten().collect()
}

fn page_in(folder: &Path) -> PathBuf {
    folder.join("identify.html")
}

/// Returns a TOML file with the mark by which a later command recognises that it may replace it.
fn marked(toml: &str) -> String {
    format!("# {MARK} identify.\n{toml}")
}

/// Checks that a URDF can be written: the robot was read from one, and the companion file beside
/// the new URDF replaces no other output.
fn check_urdf(args: &Arguments, robot: &str) -> Result<()> {
    let Some(urdf) = &args.urdf else { return Ok(()) };
    if Path::new(robot).extension().is_none_or(|extension| extension != "urdf") {
        return Err(Error::setting(format!(
            "--urdf writes the identified values into the robot's own URDF, but {robot} is not a \
             URDF file; give --robot a URDF file, or drop --urdf"
        )));
    }
    let companion = urdf.with_extension("toml");
    if args.out.as_ref() == Some(&companion) {
        return Err(Error::setting(format!(
            "--out {}: --urdf writes motors and friction to the same file; choose another name for \
             one of them",
            companion.display()
        )));
    }
    Ok(())
}

/// Writes the robot file, the report page and the URDF that the arguments select.
fn files(args: &Arguments, found: &Identification, urdf: Option<&Urdf>) -> Result<()> {
    if let Some(folder) = &args.report {
        save(&page_in(folder), identified_html(found)?.as_bytes())?;
    }
    let writes_robot = args.out.is_some() || args.urdf.is_some();
    if let Some(problem) = found.inertia.impossible.clone().filter(|_| writes_robot) {
        // No other command would read it.
        let causes = found.implausible.iter().map(|result| result.text.clone()).collect();
        return Err(reachtube::identify::Error::ImpossibleRobot { problem, causes }.into());
    }
    if let Some(path) = &args.out {
        save(path, marked(&found.robot_toml()).as_bytes())?;
    }
    if let (Some(path), Some(urdf)) = (&args.urdf, urdf) {
        let robot = Robot::from_description(&found.description)?;
        save(path, urdf.updated(&robot)?.as_bytes())?;
        // URDF has no elements for motors and load-dependent friction.
        save(&path.with_extension("toml"), marked(&urdf.companion(&robot)).as_bytes())?;
    }
    Ok(())
}

fn save(path: &Path, content: &[u8]) -> Result<()> {
    write::atomically(path, |out| out.write_all(content))?;
    output::wrote(path);
    Ok(())
}

/// Returns the settings of the file and the command line, and the folder that paths are relative
/// to: the settings file's, or the working directory.
fn settings(args: &Arguments) -> Result<(IdentifySettings, PathBuf)> {
    let mut settings = match &args.settings {
        Some(path) => IdentifySettings::load(path)?,
        None => IdentifySettings::default(),
    };
    let folder =
        args.settings.as_deref().and_then(Path::parent).unwrap_or(Path::new("")).to_path_buf();
    let here = std::env::current_dir().unwrap_or_default();
    let given = [
        (&mut settings.rest, &args.rest),
        (&mut settings.one_joint, &args.one_joint),
        (&mut settings.excitation, &args.excitation),
        (&mut settings.validate, &args.validate),
    ];
    for (entries, paths) in given {
        if !paths.is_empty() {
            // Paths on the command line are relative to the working directory.
            *entries = paths.iter().map(|path| LogEntry::Path(here.join(path))).collect();
        }
    }
    settings.robot = args.robot.clone().or(settings.robot);
    settings.prepare.cut_off = args.cut_off.or(settings.prepare.cut_off);
    if let Some(columns) = &args.columns {
        settings.prepare.columns.clone_from(columns);
    }
    if !args.topic.is_empty() {
        settings.prepare.log.topic.clone_from(&args.topic);
    }
    settings.prepare.max_gap = args.max_gap.or(settings.prepare.max_gap);
    if !args.gains.is_empty() {
        settings.prepare.gains = args.gains.clone();
    }
    if let Some(torque) = args.torque {
        settings.model.motor_inertia = torque != Torque::Link;
    }
    Ok((settings, folder))
}

/// Returns the robot's path: a robot that the settings file names lies beside that file, unless it
/// is an embedded one.
fn from_folder(name: &str, args: &Arguments, folder: &Path) -> String {
    let beside = folder.join(name);
    if args.robot.is_none() && beside.exists() { beside.display().to_string() } else { name.into() }
}
