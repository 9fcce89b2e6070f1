//! The nominal model chosen for the smallest sets.

mod common;

use common::{conform_all, read};
use reachtube_conform::{FitSettings, Group, Settings, Silent, fit};
use reachtube_reach::Disturbance;
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

#[test]
#[ignore = "needs the recordings in ../shared"]
fn the_sets_of_the_papers_arm_shrink() {
    let folder = common::shared("schunk_lwa4p");
    let groups = std::env::var("FITGROUPS").unwrap_or("inertia,viscous".into());
    let groups: Vec<Group> = groups
        .split(',')
        .map(|g| Group::ALL.into_iter().find(|x| x.name() == g).unwrap())
        .collect();
    let pull = std::env::var("PULL").ok().map(|p| p.parse().unwrap());
    for disturbance in [Disturbance::Sample, Disturbance::Constant] {
        let settings = Settings { disturbance, ..Settings::new(Torque::Compensated, 6) };
        let problem = read(&Robot::lwa4p(), &folder, &["A", "B", "D", "E"], &settings);
        let start = std::time::Instant::now();
        let fitted = fit(&problem, &FitSettings { groups: groups.clone(), pull }, &Silent).unwrap();
        eprintln!("{:?}", start.elapsed());
        let r = &fitted.record;
        eprintln!("{} -> {} pull {}", r.identified_cost, r.cost, r.pull);
        eprintln!("{:?}\n{:?}\n{:?}", r.pulls, r.leave_one_out, r.groups);
        for p in &r.parameters {
            eprintln!("{} {} {} -> {} {:?}", p.name, p.joint, p.identified, p.fitted, p.factor);
        }
        eprintln!("{:?}", r.torque);
        let found = conform_all(&fitted.problem);
        eprintln!("cost {} verified {}", found.cost, found.verdict.conformant);
    }
}
