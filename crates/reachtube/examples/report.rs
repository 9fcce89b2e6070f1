//! The report page of a virtual arm, written to the folder `reachtube-report`.

use reachtube::arm::{ArmSettings, setup};
use reachtube::campaign::{CampaignOptions, record};
use reachtube::finding::FrontEnd;
use reachtube::page::{Assets, Sources, page, write_html};
use reachtube::{
    Check, DataSet, Keep, Model, Problem, Robot, Settings, Silent, Torque, conform, reach, write,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let robot = Robot::lwa4p();
    let recorded = record(&robot, &CampaignOptions::small(), folder.path(), &|_done, _total| ())?;
    let arm = ArmSettings::new(Torque::Compensated, 6);
    let setup = setup(robot, arm, Settings::default())?;
    let source = Box::new(DataSet::open(folder.path())?);
    let problem = Problem::read(setup, source, &recorded.training, Keep::All, &Silent)?;
    let found = conform(&problem, &Silent, None)?;
    let model = Model::new(&problem, &found);

    let check = Check::new(&model, &problem, found.verdict.clone());
    let reach = reach(&problem, &found.tube)?;
    let sources = Sources {
        model: &model,
        problem: &problem,
        reach: &reach,
        check: &check,
        front_end: FrontEnd::CommandLine,
    };
    let mut html = Vec::new();
    write_html(&page(&sources)?, Assets::Inside, &mut html)?;
    let path = std::path::Path::new("reachtube-report/report.html");
    write::atomically(path, |out| out.write_all(&html))?;
    println!("wrote {}", path.display());
    Ok(())
}
