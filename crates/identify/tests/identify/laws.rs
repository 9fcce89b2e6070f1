//! Friction laws of simulated robots are found, and laws that are not there are not.

use crate::lab::{Lab, geometry, lwa4p, simple_friction};
use crate::virtual_robot::{Random, Recorder, excitation};
use reachtube_identify::prepare::LogEntry;
use reachtube_identify::{Identification, IdentifySettings, WarmingChoice, identify};
use reachtube_robot::Robot;
use reachtube_robot::friction::{Stribeck, Warming, WarmingBy};
use std::path::Path;

/// Number of exciting motions.
const MOTIONS: u64 = 8;

/// Returns the robot whose joints have this law.
fn with_law(law: Warming) -> Robot {
    let mut description = simple_friction(&lwa4p()).description().clone();
    description.joints.iter_mut().for_each(|joint| joint.friction.warming = Some(law));
    Robot::from_description(&description).unwrap()
}

/// Records exciting motions 1 to 8 and a validation motion 9 of a robot in its states of warmth.
fn record(lab: &Lab, robot: &dyn Fn(u64) -> Robot, temperature: Option<&dyn Fn(u64) -> f64>) {
    for run in 1..=MOTIONS + 1 {
        let warm = robot(run);
        let path = lab.path().join(format!("run_{run}.csv"));
        let mut recorder =
            Recorder { robot: &warm, noise: 0.2, gains: vec![1.0; 6], random: Random::new(run) };
        recorder.record(&path, 12.0, excitation(6, run));
        if let Some(temperature) = temperature {
            add_temperatures(&path, temperature(run));
        }
    }
}

fn add_temperatures(path: &Path, temperature: f64) {
    let text = std::fs::read_to_string(path).unwrap();
    let names: String = (1..=6).map(|joint| format!(",temp{joint}")).collect();
    let values = format!(",{temperature}").repeat(6);
    let line =
        |(k, line): (usize, &str)| format!("{line}{}\n", if k == 0 { &names } else { &values });
    let text: String = text.lines().enumerate().map(line).collect();
    std::fs::write(path, text).unwrap();
}

fn settings(warming: WarmingChoice, with_order: bool) -> IdentifySettings {
    let entry = |run: u64| LogEntry::Stretch {
        path: format!("run_{run}.csv").into(),
        from: 0.0,
        until: None,
        order: with_order.then_some(run * run),
        compensated: false,
    };
    let mut settings = IdentifySettings {
        dynamic: (1..=MOTIONS).map(entry).collect(),
        validate: vec![entry(MOTIONS + 1)],
        ..IdentifySettings::default()
    };
    settings.prepare.cut_off = Some(8.0);
    settings.model.physical = Some(false);
    settings.model.windows = vec![];
    settings.model.warming = warming;
    settings
}

/// Asserts that the rates of all joints are found within their errors.
fn assert_rates(found: &Identification, by: WarmingBy, [coulomb, viscous]: [f64; 2]) {
    let joints = &found.warming.as_ref().unwrap().joints;
    let mut off = Vec::new();
    for joint in joints {
        let law = joint.law.unwrap_or_else(|| panic!("{joint:?}"));
        assert_eq!(law.by, by);
        for (rate, (true_rate, error)) in [law.coulomb, law.viscous]
            .into_iter()
            .zip([coulomb, viscous].into_iter().zip(joint.standard_errors))
        {
            if error > 0.0 {
                off.push((rate - true_rate).abs() / error);
            }
        }
    }
    assert!(joints.len() == 6 && off.len() >= 6, "{joints:?}");
    let within = off.iter().filter(|off| **off < 2.0).count();
    assert!(off.iter().all(|off| *off < 4.0), "{off:?}");
    assert!(10 * within >= 8 * off.len(), "{off:?}");
    let laws = found.laws.as_ref().unwrap();
    assert_eq!([laws.before.len(), laws.after.len()], [6; 2]);
    for (before, after) in laws.before.iter().zip(&laws.after) {
        assert!(laws.held_out && after < before, "{laws:?}");
    }
    let robot = Robot::from_toml(&found.robot_toml(), "found").unwrap();
    assert_eq!(robot.warms_by(), [by]);
}

#[test]
fn friction_by_temperature_is_recovered_within_its_errors() {
    let law = Warming { reference: 33.0, coulomb: 0.012, viscous: 0.012, ..Warming::default() };
    let lab = Lab::new();
    let temperature = |run: u64| 22.0 + 4.0 * run as f64;
    let warm = |run| with_law(law).at_temperature(&[temperature(run); 6]);
    record(&lab, &warm, Some(&temperature));
    let geometry = geometry(&lwa4p());
    let found = lab.identify(&geometry, &settings(WarmingChoice::Compare, false));
    assert_rates(&found, WarmingBy::Temperature, [0.012, 0.012]);
    // The recordings have no order, and a warning says so.
    assert!(found.warnings.iter().any(|w| w.contains("number of runs was not tried: run_1")));
    let by_runs = settings(WarmingChoice::Runs, false);
    let error = identify(&geometry, &by_runs, lab.path(), &|_, _| {}).unwrap_err().to_string();
    assert!(error.contains("run_1: friction by the number of runs needs it"), "{error}");
}

/// A logarithm of the runs and a thermal state are hardly distinguished by eight recordings, so
/// only what either law is good for is tested.
#[test]
fn friction_that_changes_with_the_runs_is_predicted_better_by_a_law() {
    let law = Warming {
        reference: 1.0,
        coulomb: 0.2,
        viscous: 0.2,
        by: WarmingBy::Runs,
        time_constant: None,
    };
    let lab = Lab::new();
    record(&lab, &|run| with_law(law).at_run((run * run) as f64), None);
    let found = lab.identify(&geometry(&lwa4p()), &settings(WarmingChoice::Runs, true));
    assert_eq!(found.warming.as_ref().unwrap().candidates.len(), 6);
    let robot = Robot::from_toml(&found.robot_toml(), "found").unwrap();
    let by = robot.warms_by();
    assert!(!by.is_empty() && !by.contains(&WarmingBy::Temperature), "{by:?}");
    let laws = found.laws.unwrap();
    let is_better = |(before, after): (&f64, &f64)| *after < 0.95 * before;
    let better = laws.before.iter().zip(&laws.after).filter(|pair| is_better(*pair)).count();
    assert!(laws.held_out && better >= 4, "{laws:?}");
}

#[test]
fn a_law_that_is_not_there_changes_next_to_nothing() {
    let truth = simple_friction(&lwa4p());
    let lab = Lab::new();
    let temperature = |run: u64| 22.0 + 4.0 * run as f64;
    record(&lab, &|_| truth.clone(), Some(&temperature));
    let geometry = geometry(&lwa4p());
    let found = lab.identify(&geometry, &settings(WarmingChoice::Temperature, false));
    let joints = &found.warming.as_ref().unwrap().joints;
    let chosen = joints.iter().filter(|joint| joint.law.is_some()).count();
    assert!(joints.len() == 6 && chosen <= 2, "{joints:?}");
    assert!(joints.iter().all(|joint| joint.held_out[1] <= joint.held_out[0]));
    let laws = found.laws.unwrap();
    assert_eq!([laws.before.len(), laws.after.len()], [6; 2]);
    assert!(laws.before.iter().zip(&laws.after).all(|(a, b)| *b < 1.01 * a), "{laws:?}");
    // Without the setting, nothing of the laws is computed.
    let plain = lab.identify(&geometry, &settings(WarmingChoice::None, false));
    assert!(plain.laws.is_none() && plain.warming.is_none());
    assert!(!plain.robot_toml().contains("warming"));
}

#[test]
fn the_stribeck_effect_of_slow_motions_becomes_part_of_the_robot() {
    let mut description = simple_friction(&lwa4p()).description().clone();
    for joint in &mut description.joints {
        joint.friction.stribeck = Some(Stribeck { excess: 1.5, speed: 0.12 });
    }
    let truth = Robot::from_description(&description).unwrap();
    let lab = Lab::new();
    lab.excite(&truth, 0.1, &[1.0; 6]);
    let mut settings = lab.settings();
    lab.record_slowly(&truth, &mut settings);
    settings.model.physical = Some(false);
    settings.model.windows = vec![];
    settings.model.stribeck = true;
    let found = lab.identify(&geometry(&truth), &settings);
    assert_eq!(found.friction.len(), 6);
    for fit in &found.friction {
        let law = fit.joint.coefficients.stribeck.unwrap_or_else(|| panic!("{:?}", fit.joint));
        // The low-pass smooths the rise a little.
        assert!((law.excess - 1.5).abs() < 0.25 && (law.speed - 0.12).abs() < 0.02, "{law:?}");
    }
    let laws = found.laws.as_ref().unwrap();
    let gained = laws.before.iter().zip(&laws.after).filter(|(a, b)| *b < *a).count();
    assert!(gained >= 5, "{laws:?}");
    assert!(found.robot_toml().contains("[joint.friction.stribeck]"));
    // Without slow motions, a warning says what is missing.
    settings.friction.clear();
    let without = lab.identify(&geometry(&truth), &settings);
    assert!(without.warnings.iter().any(|w| w.contains("Stribeck effect was not tried")));
}

/// Joint 1 has dry friction of 3 N m at standstill and 11 N m at high speeds, and all others have a
/// law that the fit contains.
#[test]
fn friction_that_saturates_is_found_where_it_is_and_predicts_better() {
    let mut description = simple_friction(&lwa4p()).description().clone();
    let friction = &mut description.joints[0].friction;
    friction.coulomb = [11.0, 0.0, -11.0, 0.0, -11.0, 0.0, 11.0, 0.0];
    friction.stribeck = Some(Stribeck { excess: -8.0, speed: 0.3 });
    let truth = Robot::from_description(&description).unwrap();
    let lab = Lab::new();
    lab.excite(&truth, 0.2, &[1.0; 6]);
    let mut settings = lab.settings();
    settings.model.windows = vec![];
    let found = lab.identify(&geometry(&truth), &settings);
    let names: Vec<&str> = found.saturating.iter().map(|law| law.joint.as_str()).collect();
    assert_eq!(names, ["joint1"], "{:?}", found.saturating);
    let law = &found.saturating[0];
    assert!((law.builds_up - 8.0).abs() < 1.5 && (law.speed - 0.3).abs() < 0.07, "{law:?}");
    assert!(law.held_out[1] < 0.8 * law.held_out[0], "{law:?}");
    let own = &found.description.joints[0].friction;
    assert!(own.saturates() && own.dissipates_at_standstill(), "{own:?}");
    let robot = Robot::from_toml(&found.robot_toml(), "found").unwrap();
    assert_eq!(robot.description().joints[0].friction, *own);
    // Without it, held-out motions are predicted worse, with a cubic too.
    let residual = |found: &Identification| found.validation.last().unwrap().joints[0].residual;
    settings.model.saturating = false;
    for cubic in [false, true] {
        settings.model.cubic = Some(cubic);
        let plain = lab.identify(&geometry(&truth), &settings);
        assert!(plain.saturating.is_empty());
        assert!(
            residual(&found) < 0.8 * residual(&plain),
            "{} {}",
            residual(&found),
            residual(&plain)
        );
    }
}
