use reachtube::arm::ArmSettings;
use std::path::{Path, PathBuf};

use reachtube::conform::{Answer, FitSettings, Job};
use reachtube::finding::{FrontEnd, Summary};
use reachtube::page::{Assets, Page, Sources, page};
use reachtube::pipeline::Cut;
use reachtube::recordings::{DataSet, Preparation, Torque};
use reachtube::write;

use super::arguments::Arguments;
use super::settings::{basis, settings};
use crate::commands::system;
use crate::error::{Error, Result};
use crate::global::global;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::report_files;

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    if let Some(system) = &args.system {
        return system::conform(system, &args.data, args.out.as_deref(), json);
    }
    let (job, preparation) = job(args)?;
    for path in args.out.iter().chain(&args.certificate) {
        output::claim(path)?;
    }
    if let Some(folder) = &args.report {
        output::claim(&report_files::page_in(folder))?;
    }
    let bar = Progress::new();
    let written = |error| Error::from(error).written_for(front_end(args));
    let mut answer = job.run(&bar).map_err(written)?;
    drop(bar);
    if let Some(preparation) = preparation {
        answer.model = answer.model.with_preparation(preparation);
    }
    output::notes(&answer.problem.recordings().notes);
    let mut written: Vec<&Path> = Vec::new();
    if let Some(path) = &args.out {
        answer.model = answer.model.among_others(path);
        answer.model.save(path)?;
        written.push(path);
    }
    if let Some(path) = &args.certificate {
        let certificate = answer.certificate()?;
        write::atomically(path, |out| certificate.write(out))?;
        written.push(path);
    }
    // The answer is printed even if the page cannot be written.
    let report = |folder: &PathBuf| report(&answer, front_end(args), folder);
    let page = args.report.as_ref().map(report).transpose();
    written.extend(page.as_ref().ok().and_then(Option::as_deref));
    let outcome = Outcome::of_model(answer.holds(), &answer.model);
    if json || global().verbose {
        written.iter().for_each(|path| output::wrote(path));
    }
    match json {
        true => output::print_json_text(&answer.model.to_json_with_findings())?,
        false if global().verbose => {
            let report = answer.report().written_for(front_end(args));
            output::print_verdict(&report, &outcome)?;
        }
        false => output::print_verdict(&summary(&answer, &written, args)?.to_string(), &outcome)?,
    }
    page?;
    Ok(outcome)
}

/// Returns how settings are written: without `--until`, which windows exclude.
fn front_end(args: &Arguments) -> FrontEnd {
    if args.horizon.is_some() { FrontEnd::Windows } else { FrontEnd::CommandLine }
}

/// Returns the answer on a few lines, with the files that were written.
fn summary(answer: &Answer, written: &[&Path], args: &Arguments) -> Result<Summary> {
    let mut summary = answer.summary(front_end(args));
    if !written.is_empty() {
        let names: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
        summary.fact("wrote", names.join(", "));
    }
    let next = match &args.out {
        _ if !answer.holds() => "`--verbose` prints every finding".into(),
        Some(path) => {
            format!("`reachtube check --model {} --data FOLDER` tries it", path.display())
        }
        None => "`--out FILE` keeps the model".into(),
    };
    summary.next.get_or_insert(next);
    Ok(summary)
}

/// Returns the job that the arguments describe, and what was done to logs for it.
fn job(args: &Arguments) -> Result<(Job, Option<Preparation>)> {
    let basis = basis(args)?;
    let robot = basis.robot()?.into_owned();
    let (arm, settings) = settings(args, &robot)?;
    let fit = FitSettings { groups: args.fit.clone(), pull: args.pull };
    let (job, preparation) = match args.horizon {
        None => {
            let setup = basis.setup(arm, settings)?;
            (Job::new(setup, DataSet::open(&args.data.data)?), None)
        }
        Some(horizon) => {
            let paths = std::slice::from_ref(&args.data.data);
            args.data.refuse_gap_of_logs()?;
            let cut = Cut::new(&robot, arm.torque, horizon, &settings.calibrate, paths)?;
            output::notes(&cut.notes);
            let arm = ArmSettings { torque: Torque::Compensated, ..arm };
            (Job::new(basis.setup(arm, settings)?, cut.windows), Some(cut.preparation))
        }
    };
    let job = job
        .suites(&args.data.suites)
        .fit((!args.fit.is_empty()).then_some(fit))
        .certified(args.certificate.is_some())
        .keep_runs(args.report.is_some())
        .resume(args.resume.clone());
    Ok((job, preparation))
}

/// Returns the page about the recordings that the sets were found for, from what is in memory.
fn page_of(answer: &Answer, front_end: FrontEnd) -> Result<Page> {
    let Answer { model, problem, .. } = answer;
    let (check, reach) = (answer.check(), answer.reach()?);
    let sources = Sources { model, problem, reach: &reach, check: &check, front_end };
    Ok(page(&sources)?)
}

fn report(answer: &Answer, front_end: FrontEnd, folder: &Path) -> Result<PathBuf> {
    report_files::write_page(&page_of(answer, front_end)?, Assets::Inside, folder)
}
