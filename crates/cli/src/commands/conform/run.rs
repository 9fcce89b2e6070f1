use reachtube::conform::result::FrontEnd;
use reachtube::conform::{Answer, FitSettings, Job};
use reachtube::page::{Assets, Page, Sources, page};
use reachtube::recordings::DataSet;
use reachtube::write;

use super::arguments::Arguments;
use super::settings::{basis, explain, settings};
use crate::error::Result;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::report_files;

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let job = job(args)?;
    for path in args.out.iter().chain(&args.certificate) {
        output::claim(path)?;
    }
    if let Some(folder) = &args.report {
        output::claim(&report_files::page_in(folder))?;
    }
    let bar = Progress::new();
    let answer = job.run(&bar)?;
    drop(bar);
    output::notes(&answer.problem.recordings().notes);
    if let Some(path) = &args.out {
        answer.model.save(path)?;
        output::wrote(path);
    }
    if let Some(path) = &args.certificate {
        let certificate = answer.certificate()?;
        write::atomically(path, |out| certificate.write(out))?;
        output::wrote(path);
    }
    if json {
        output::print_json_text(&answer.model.to_json_with_findings())?;
    } else {
        output::print(&answer.report().to_string())?;
    }
    if let Some(folder) = &args.report {
        let page = page_of(&answer)?;
        output::wrote(&report_files::write_page(&page, Assets::Inside, folder)?);
    }
    Ok(Outcome::of_model(answer.holds(), &answer.model))
}

/// Returns the job that the arguments describe.
fn job(args: &Arguments) -> Result<Job> {
    let basis = basis(args)?;
    let settings = settings(args, basis.joints())?;
    let torque = settings.torque;
    let fit = FitSettings { groups: args.fit.clone(), pull: args.pull };
    let mut job = Job::new(basis, DataSet::open(&args.data.data)?, torque)
        .settings(settings)
        .suites(&args.data.suites)
        .fit((!args.fit.is_empty()).then_some(fit))
        .certified(args.certificate.is_some())
        .keep_runs(args.report.is_some())
        .resume(args.resume.clone());
    if let Some(tolerance) = explain(args)? {
        job = job.explain(tolerance);
    }
    Ok(job)
}

/// Returns the page about the recordings that the sets were found for, from what is in memory.
pub(crate) fn page_of(answer: &Answer) -> Result<Page> {
    let Answer { model, problem, .. } = answer;
    let (check, reach) = (answer.check(), answer.reach()?);
    let sources =
        Sources { model, problem, reach: &reach, check: &check, front_end: FrontEnd::CommandLine };
    Ok(page(&sources)?)
}
