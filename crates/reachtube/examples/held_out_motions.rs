//! A virtual arm is recorded, its smallest sets are found on some motions and tried on others.

use reachtube::arm::{ArmSettings, setup};
use reachtube::campaign::{CampaignOptions, record};
use reachtube::{
    DataSet, Keep, Model, Problem, Robot, Settings, Silent, Torque, Tube, check, conform,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let robot = Robot::lwa4p();
    let recorded = record(&robot, &CampaignOptions::small(), folder.path(), &|_done, _total| ())?;
    let arm = ArmSettings::new(Torque::Compensated, 6);
    let setup = setup(robot, arm, Settings::default())?;
    let open = || DataSet::open(folder.path()).map(Box::new);

    let training =
        Problem::read(setup.clone(), open()?, &recorded.training, Keep::Needed, &Silent)?;
    let found = conform(&training, &Silent, None)?;
    let model = Model::new(&training, &found);
    println!("training: {} of {} rows hold", found.verdict.rows, found.verdict.rows);

    let held_out = Problem::read(setup, open()?, &recorded.check, Keep::Needed, &Silent)?;
    let answer = check(&model, &held_out, &Tube::new(&held_out, model.sets())?)?;
    let verdict = &answer.verdict;
    println!("held out: {} of {} rows outside", verdict.violations.count, verdict.rows);
    if let Some(witness) = &verdict.violations.worst {
        println!(
            "furthest: {} at {:.3} s, {} by {:.2e} {}",
            witness.run,
            witness.time,
            witness.state,
            witness.excess,
            model.signals.unit(witness.state)
        );
    }
    Ok(())
}
