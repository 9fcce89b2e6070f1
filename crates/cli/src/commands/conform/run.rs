use std::path::{Path, PathBuf};

use reachtube::conform::{
    Certificate, Check, Conformance, FitSettings, Group, Keep, Notion, Problem, conform, fit, reach,
};
use reachtube::page::{Assets, Sources};
use reachtube::recordings::DataSet;
use reachtube::{Model, write};

use super::arguments::Arguments;
use super::settings::setup;
use crate::error::Result;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::report_files;

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let setup = setup(args)?;
    let source = Box::new(DataSet::open(&args.data.data)?);
    for path in args.out.iter().chain(&args.certificate) {
        output::claim(path)?;
    }
    let has_points =
        setup.settings.notion != Notion::Hull && setup.dynamics.linear_system().is_some();
    if args.certificate.is_some() && !has_points {
        return Err(reachtube::conform::Error::NotPoints.into());
    }
    if let Some(folder) = &args.report {
        output::claim(&report_files::page_in(folder))?;
    }
    let fit_settings =
        (!args.fit.is_empty()).then(|| FitSettings { groups: args.fit.clone(), pull: args.pull });
    if let Some(settings) = &fit_settings {
        settings.check(&setup)?;
    }
    let by_run = args.report.is_some() || args.fit.contains(&Group::WarmUp);
    let keep = if by_run { Keep::All } else { Keep::Needed };
    let bar = Progress::new();
    let mut problem = Problem::read(setup, source, &args.data.suites, keep, &bar)?;
    let mut record = None;
    if let Some(settings) = &fit_settings {
        let fitted = fit(&problem, settings, &bar)?;
        (problem, record) = (fitted.problem, Some(fitted.record));
    }
    let found = conform(&problem, &bar, args.resume.as_deref())?;
    drop(bar);
    output::notes(&problem.recordings().notes);
    let model = Model::new(&problem, &found);
    let model = match record {
        Some(record) => model.with_fit(record),
        None => model,
    };
    if let Some(path) = &args.out {
        write::atomically(path, |out| out.write_all(model.to_json().as_bytes()))?;
        output::wrote(path);
    }
    if let Some(path) = &args.certificate {
        let certificate = Certificate::new(&problem, &model)?;
        write::atomically(path, |out| certificate.write(out))?;
        output::wrote(path);
    }
    if json {
        output::print_json_text(&model.to_json())?;
    } else {
        output::print(&model.report().to_string())?;
    }
    if let Some(folder) = &args.report {
        let page = report(&problem, &model, &found, folder)?;
        output::wrote(&page);
    }
    Ok(Outcome::of(model.verified))
}

/// Writes the page about the recordings that the sets were found for, from what is in memory.
pub(crate) fn report(
    problem: &Problem,
    model: &Model,
    found: &Conformance,
    folder: &Path,
) -> Result<PathBuf> {
    let check = Check::new(model, problem, found.verdict.clone());
    let reach = reach(problem, &found.hulls)?;
    let sources = Sources { model, problem, reach: &reach, check: &check };
    report_files::write(&sources, Assets::Inside, folder)
}
