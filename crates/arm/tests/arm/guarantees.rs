//! Which bounds are guarantees, and for which models they are stated.

use reachtube_conform::Code;
use reachtube_conform::next_motion::TrustKind;
use reachtube_conform::settings::{InitialLimit, NominalStart};
use reachtube_conform::{Keep, Model, Problem, Settings, Silent};
use reachtube_recordings::{MemoryRuns, Preparation, Run, Torque};
use reachtube_robot::Robot;

use crate::common::{Disturbed, Random, Recorded, conform_all, grid, read, setup, two_joints};
use crate::next_motion::{SUITES, check_of, read_nonlinear, recorded, settings};

/// The best of several models is not one that was fixed beforehand.
#[test]
fn models_of_one_folder_that_the_same_motions_calibrated_are_counted() {
    let folder = recorded([0.3, 0.4, 0.6, 0.5]);
    let models = tempfile::tempdir().unwrap();
    let calibrated = |viscous: f64, calibrate: &[&str]| {
        let mut description = two_joints().description().clone();
        description.joints[0].friction.viscous[0] += viscous;
        let robot = Robot::from_description(&description).unwrap();
        let problem = read(&robot, folder.path(), &[], &settings(calibrate));
        Model::new(&problem, &conform_all(&problem))
    };
    let path = |name: &str| models.path().join(name);
    let first = calibrated(0.0, &["b", "c", "d"]).among_others(&path("first.json"));
    assert_eq!(first.trust.average_probability, Some(0.25));
    assert_eq!(first.trust.kind, Some(TrustKind::Guarantee));
    first.save(path("first.json")).unwrap();
    // The same sets again are no other model, and other files are no models.
    std::fs::write(path("other.json"), "{}").unwrap();
    assert_eq!(first.clone().among_others(&path("again.json")), first);
    // Some of the same recordings are enough to count.
    let second = calibrated(0.05, &["c", "d"]).among_others(&path("second.json"));
    assert_eq!(second.calibration.as_ref().unwrap().candidates, 2);
    assert_eq!(second.trust.average_probability, Some(2.0 / 3.0));
    assert!((second.trust.violation_probability - (1.0 - 0.025f64.sqrt())).abs() < 1e-9);
    let finding = second.findings().into_iter().find(|found| found.code == Code::NextMotion);
    let text = finding.unwrap().text;
    assert!(text.contains("(2 in 3)") && text.contains("counts the 2 models"), "{text}");
    second.save(path("second.json")).unwrap();
    assert_eq!(reachtube_arm::open(&path("second.json")).unwrap().0, second);
    // The first file is counted with the second one when it is read.
    let counted =
        reachtube_arm::open(&path("first.json")).unwrap().0.among_others(&path("first.json"));
    assert_eq!(counted.trust.average_probability, Some(0.5));
    // Three models of two motions leave nothing to state.
    let third = calibrated(0.1, &["c", "d"]).among_others(&path("third.json"));
    assert_eq!((third.trust.average_probability, third.trust.kind), (None, None));
    let text = third.findings().into_iter().find(|found| found.code == Code::NoGuarantee);
    assert!(text.unwrap().text.contains("calibrated 3 models in this folder"));
}

/// A robot that has seen the held-out motions is not one that was fixed beforehand.
#[test]
fn a_robot_that_was_identified_from_held_out_motions_has_no_bound() {
    let folder = recorded([0.3, 0.4, 0.6, 0.5]);
    let plain = read(&two_joints(), folder.path(), &[], &settings(&[]));
    let suites = &plain.recordings().suites;
    let robot_of = |suite: usize| {
        let mut description = two_joints().description().clone();
        description.add_identified_from([suites[suite].runs[2].sha256.clone()]);
        Robot::from_description(&description).unwrap()
    };
    let trust = |robot: &Robot, names: &[&str], calibrate: &[&str]| {
        conform_all(&read(robot, folder.path(), names, &settings(calibrate))).trust
    };
    assert_eq!(trust(&robot_of(0), &[], &["c", "d"]).average_probability, Some(1.0 / 3.0));
    let seen = trust(&robot_of(3), &[], &["c", "d"]);
    assert_eq!((seen.average_probability, seen.violation_probability), (None, 1.0));
    assert!(seen.basis.contains("motions that were held out here (d)"), "{}", seen.basis);
    // The scenario bound asks for a fixed model too.
    assert_eq!(trust(&robot_of(3), &["a", "b"], &[]).kind, Some(TrustKind::Guarantee));
    assert_eq!(trust(&robot_of(3), &[], &[]).kind, Some(TrustKind::Indication));
    // In a check such recordings are not held out.
    let fit = read(&robot_of(3), folder.path(), &["a", "b"], &settings(&[]));
    let model = Model::new(&fit, &conform_all(&fit));
    assert!(check_of(&folder, &model, &["c"]).trust.is_some());
    assert!(check_of(&folder, &model, &["d"]).trust.is_none());
}

/// A window is seen if the log that it was cut from is.
#[test]
fn windows_of_a_log_that_identified_the_robot_have_no_bound() {
    let (times, mut random) = (grid(0.01, 20), Random(7));
    let mut description = two_joints().description().clone();
    description.add_identified_from(["d".repeat(64)]);
    let robot = Robot::from_description(&description).unwrap();
    let arm = Disturbed { robot: &robot, times: &times, start: 0.01, input: 0.5 };
    let mut runs = MemoryRuns::default();
    for motion in SUITES {
        let Recorded { times, states, torques } = arm.record(&mut random);
        let run = Run::new(2, times, states, torques).unwrap();
        runs.push(motion, Some(motion), Some(motion), run).origin = Some(motion.repeat(64));
    }
    let problem = |names: &[&str], calibrate: &[&str]| {
        let (setup, runs) = (setup(&robot, |_, sets| *sets = settings(calibrate)), runs.clone());
        let names: Vec<String> = names.iter().map(ToString::to_string).collect();
        Problem::read(setup, Box::new(runs), &names, Keep::Needed, &Silent).unwrap()
    };
    let trust = |calibrate: &[&str]| conform_all(&problem(&[], calibrate)).trust;
    assert_eq!(trust(&["b", "c"]).average_probability, Some(1.0 / 3.0));
    assert!(trust(&["c", "d"]).basis.contains("motions that were held out here (d)"));
    // The model knows the logs that its own windows were cut from.
    let fit = problem(&["a", "b"], &[]);
    let model = Model::new(&fit, &conform_all(&fit));
    let knows = |name: &str| model.knows_of(problem(&[name], &[]).recordings());
    assert_eq!([knows("b"), knows("c"), knows("d")], [true, false, true].map(Some));
}

/// Windows of one log are not independent, whatever their motions are called.
#[test]
fn windows_of_one_log_have_no_bound() {
    let (times, mut random, robot) = (grid(0.01, 20), Random(7), two_joints());
    let arm = Disturbed { robot: &robot, times: &times, start: 0.01, input: 0.5 };
    let recorded: Vec<Recorded> = SUITES.iter().map(|_| arm.record(&mut random)).collect();
    let kinds = |origin: fn(&str) -> String| {
        let mut runs = MemoryRuns::default();
        for (motion, Recorded { times, states, torques }) in SUITES.iter().zip(&recorded) {
            let run = Run::new(2, times.clone(), states.clone(), torques.clone()).unwrap();
            let entry = runs.push(motion, Some(motion), Some(motion), run);
            entry.origin = Some(origin(motion));
        }
        let setup = setup(&robot, |_, sets| *sets = settings(&[]));
        let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap();
        let model = Model::new(&problem, &conform_all(&problem));
        let preparation = |window, cut_off| Preparation {
            torque: Torque::Motor,
            gains: vec![],
            cut_off,
            window,
            differentiated: false,
            columns: Default::default(),
            log: Default::default(),
        };
        let with = |known| model.clone().with_preparation(known).trust;
        let (given, chosen) =
            (with(preparation(Some(0.2), None)), preparation(Some(0.2), Some(9.0)));
        assert_eq!(given, model.trust);
        (given.kind, with(chosen).kind, given.motions)
    };
    assert_eq!(kinds(|_| "e".repeat(64)), (None, None, 1));
    let [guarantee, indication] = [TrustKind::Guarantee, TrustKind::Indication].map(Some);
    assert_eq!(kinds(|motion| motion.repeat(64)), (guarantee, indication, SUITES.len()));
}

/// Suites may share a motion, if nothing says which motions they are.
#[test]
fn bounds_of_motions_without_names_are_indications() {
    let folder = recorded([0.3, 0.4, 0.6, 0.5]);
    let kinds = || {
        let problem = |names: &[&str], calibrate: &[&str]| {
            read(&two_joints(), folder.path(), names, &settings(calibrate))
        };
        let scenario = conform_all(&problem(&["a", "b"], &[])).trust;
        let calibrated = conform_all(&problem(&[], &["c", "d"])).trust;
        let fit = problem(&["a", "b"], &[]);
        let model = Model::new(&fit, &conform_all(&fit));
        let check = check_of(&folder, &model, &["c", "d"]).trust.unwrap();
        [scenario.kind, calibrated.kind, check.kind].map(Option::unwrap)
    };
    assert_eq!(kinds(), [TrustKind::Guarantee; 3]);
    let index = folder.path().join("runs.csv");
    let text = std::fs::read_to_string(&index).unwrap();
    let lines = text.lines().map(|line| line.rsplit_once(',').unwrap().0);
    std::fs::write(&index, lines.collect::<Vec<_>>().join("\n")).unwrap();
    assert_eq!(kinds(), [TrustKind::Indication; 3]);
}

/// The scenario bound is a guarantee only where its theorem's conditions are met.
#[test]
fn a_bound_whose_conditions_are_not_met_is_an_indication() {
    let folder = recorded([0.3; 4]);
    let of = |settings: &Settings| read(&two_joints(), folder.path(), &[], settings);
    let own = Settings { nominal: NominalStart::Own, ..settings(&[]) };
    let given = Settings { sensor_noise: Some(vec![0.05; 4]), ..own.clone() };
    let limited = Settings { initial_limit: InitialLimit::States, ..settings(&[]) };
    for (problem, kind, words) in [
        (of(&settings(&[])), TrustKind::Guarantee, "scenario bound"),
        (of(&given), TrustKind::Guarantee, "scenario bound"),
        (of(&own), TrustKind::Indication, "was estimated from the recordings"),
        (read_nonlinear(&folder, &[], &[]), TrustKind::Indication, "is not linear"),
        (of(&limited), TrustKind::Indication, "the limit of X0"),
    ] {
        let model = Model::new(&problem, &conform_all(&problem));
        assert_eq!(model.trust.kind, Some(kind), "{:?}", model.trust);
        assert!(model.trust.basis.contains(words), "{}", model.trust.basis);
        // Four motions that all decide have no bound; a bound of an indication says what it is.
        let mut model = model;
        model.trust.violation_probability = 0.5;
        let text = model.findings();
        let text = text.iter().find(|found| found.code == Code::NextMotion).unwrap().text.clone();
        let is_indication = text.starts_with("An indication and no guarantee: the next motion");
        assert_eq!(is_indication, kind == TrustKind::Indication, "{text}");
    }
}

/// Copies are no evidence, and neither are recordings of a robot at rest.
#[test]
fn copies_and_rests_are_no_further_motions() {
    let (times, mut random, robot) = (grid(0.01, 20), Random(7), two_joints());
    let arm = Disturbed { robot: &robot, times: &times, start: 0.01, input: 0.5 };
    let recorded: Vec<Recorded> = SUITES.iter().map(|_| arm.record(&mut random)).collect();
    let trust = |of: [usize; 4], resting: usize, calibrate: &[&str], longer: usize| {
        let mut runs = MemoryRuns::default();
        for (at, motion) in SUITES.iter().enumerate() {
            let Recorded { times, states, torques } = &recorded[of[at]];
            let count = if at < longer { 20 } else { 15 };
            let [states, torques] =
                [&states[..4 * count], &torques[..2 * count]].map(<[f64]>::to_vec);
            let run = Run::new(2, times[..count].to_vec(), states, torques).unwrap();
            runs.push(motion, Some(motion), Some(motion), run).at_rest = at < resting;
        }
        let setup = setup(&robot, |_, sets| *sets = settings(calibrate));
        let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap();
        conform_all(&problem).trust
    };
    let plain = trust([0, 1, 2, 3], 0, &[], 4);
    assert_eq!((plain.motions, plain.kind), (4, Some(TrustKind::Guarantee)));
    assert_eq!(trust([0, 1, 2, 0], 0, &[], 4).motions, 3);
    assert_eq!(trust([0, 1, 2, 3], 2, &[], 4).motions, 2);
    let both = ["c", "d"];
    assert_eq!(trust([0, 1, 2, 3], 0, &both, 4).average_probability, Some(1.0 / 3.0));
    assert_eq!(trust([0, 1, 2, 2], 0, &both, 4).average_probability, Some(0.5));
    let copied = trust([0, 1, 2, 0], 0, &both, 4);
    assert!(copied.basis.contains("have copies among the others (a)"), "{}", copied.basis);
    assert_eq!(copied.kind, None);
    // The cost counts until the end of the longest motion: here of one alone.
    let [two, one] = [2, 1].map(|longer| trust([0, 1, 2, 3], 0, &[], longer));
    assert_eq!((two.kind, one.kind), (plain.kind, Some(TrustKind::Indication)));
    assert!(one.basis.contains("end of a single motion"), "{}", one.basis);
}
