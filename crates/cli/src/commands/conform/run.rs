use reachtube::conform::{Watch, conform};
use reachtube::recordings::DataSet;
use reachtube::{Model, write};

use super::arguments::Arguments;
use super::settings::{explain, robot_and_settings};
use super::summary::summary;
use crate::error::Result;
use crate::opened::Opened;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::report_files;

pub fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let (robot, mut settings) = robot_and_settings(args)?;
    robot.check_physical()?;
    settings.explain = explain(args, &robot, &settings)?;
    settings.validate(robot.joint_count())?;
    let data = DataSet::open(&args.data.data)?;
    if let Some(path) = &args.out {
        write::try_at(path)?;
    }
    if let Some(folder) = &args.report {
        write::try_at(&folder.join("report.html"))?;
    }
    let bar = Progress::new();
    let show = |done: usize, total: usize| bar.show(done, total);
    let tell = |text: &str| bar.note(text);
    let watch = Watch { reading: &show, finished: &tell, resume: args.resume.as_deref() };
    let found = conform(&robot, &data, &args.data.suites, &settings, &watch)?;
    drop(bar);
    output::notes(&found.recordings.notes);
    let model = Model::new(&robot, &data, &settings, &found);
    drop(found);
    if let Some(path) = &args.out {
        write::atomically(path, |out| out.write_all(model.to_json().as_bytes()))?;
        output::note(&format!("wrote {}", path.display()));
    }
    if json {
        output::print(&model.to_json())?;
    } else {
        output::print(&summary(&model))?;
    }
    let verified = model.verified;
    if let Some(folder) = &args.report {
        let (page, _) = report_files::write(&Opened::with(model, robot, &args.data)?, folder)?;
        output::note(&format!("wrote {}", page.display()));
    }
    Ok(Outcome::of(verified))
}
