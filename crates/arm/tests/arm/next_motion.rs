//! Statements about motions that were not recorded, against separate runs of the whole method.

use crate::common::{
    Disturbed, Random, Recorded, conform_all, grid, read, read_with, setup, two_joints,
    write_data_set,
};
use reachtube_abstraction::{Abstraction, ModelKind};
use reachtube_arm::ArmModel;
use reachtube_conform::next_motion::Trust;
use reachtube_conform::settings::NominalStart;
use reachtube_conform::tube::Witness;
use reachtube_conform::{
    Check, Code, Error, Keep, Model, Notion, Problem, Settings, Silent, Tube, UncertaintySets,
    carry_over, check, conform,
};
use reachtube_recordings::{MemoryRuns, Run};
use tempfile::TempDir;

pub(crate) const SUITES: [&str; 4] = ["a", "b", "c", "d"];

/// Four suites of six runs on one grid, in which disturbances of `inputs` N m act.
pub(crate) fn recorded(inputs: [f64; 4]) -> TempDir {
    let (folder, robot, times) = (tempfile::tempdir().unwrap(), two_joints(), grid(0.01, 40));
    let suite = |index: usize| -> (&str, Vec<Recorded>) {
        let arm = Disturbed { robot: &robot, times: &times, start: 0.01, input: inputs[index] };
        let mut random = Random(11 + index as u64);
        (SUITES[index], (0..6).map(|_| arm.record(&mut random)).collect())
    };
    write_data_set(folder.path(), &[suite(0), suite(1), suite(2), suite(3)]);
    folder
}

pub(crate) fn settings(calibrate: &[&str]) -> Settings {
    let calibrate = calibrate.iter().map(|name| name.to_string()).collect();
    Settings { calibrate, ..Settings::default() }
}

/// Reads suites for model 2 of order 3, which is not linear.
pub(crate) fn read_nonlinear(folder: &TempDir, names: &[&str], calibrate: &[&str]) -> Problem {
    let setup = setup(&two_joints(), |arm, sets| {
        arm.abstraction = Abstraction { model: ModelKind::Two, order: 3 };
        *sets = settings(calibrate);
    });
    read_with(setup, folder.path(), names)
}

/// Checks the suites `names` against the model of a problem.
pub(crate) fn check_of(folder: &TempDir, model: &Model, names: &[&str]) -> Check {
    let setup = reachtube_arm::setup(two_joints(), model.arm().settings, model.settings.clone());
    let others = read_with(setup.unwrap(), folder.path(), names);
    let tube = Tube::new(&others, model.sets()).unwrap();
    check(model, &others, &tube).unwrap()
}

#[test]
fn calibrated_sets_are_those_of_the_other_motions_scaled_by_the_largest_gauge() {
    let folder = recorded([0.3, 0.4, 0.6, 1.0]);
    let fit = read(&two_joints(), folder.path(), &["a", "b"], &settings(&[]));
    let fitted = conform_all(&fit);
    let gauges = ["c", "d"].map(|name| {
        let growth = check_of(&folder, &Model::new(&fit, &fitted), &[name]).growth;
        growth.map_or(1.0, |growth| growth.both_sets.unwrap())
    });
    let problem = read(&two_joints(), folder.path(), &[], &settings(&["c", "d"]));
    let found = conform_all(&problem);
    let calibration = found.calibration.clone().unwrap();
    assert_eq!(calibration.fitted, ["a", "b"]);
    assert_eq!(calibration.gauges.len(), 2);
    for (gauge, expected) in calibration.gauges.iter().zip(gauges) {
        assert!((gauge.gauge / expected - 1.0).abs() < 1e-9, "{gauge:?} for {expected}");
    }
    assert!(calibration.factor > 1.2 && calibration.factor == gauges[0].max(gauges[1]).max(1.0));
    // Nothing of the held-out motions but the factor is in the sets.
    let pairs = [
        (&found.sets.initial_set, &fitted.sets.initial_set),
        (&found.sets.input_set, &fitted.sets.input_set),
    ];
    for (scaled, own) in pairs {
        for i in 0..own.radius.len() {
            assert!((scaled.centre[i] - own.centre[i]).abs() < 1e-12);
            assert!((scaled.radius[i] - calibration.factor * own.radius[i]).abs() < 1e-12);
        }
    }
    // They are proved, and no factor that is smaller would do.
    assert!(found.verdict.conformant && found.verdict.rows == 4 * 40 * 4);
    let mut smaller = found.sets.clone();
    let sets = [&mut smaller.initial_set, &mut smaller.input_set];
    sets.into_iter().flat_map(|set| &mut set.radius).for_each(|radius| *radius *= 1.0 - 1e-6);
    let tube = Tube::new(&problem, smaller).unwrap();
    let model = Model::new(&problem, &found);
    assert!(!check(&model, &problem, &tube).unwrap().verdict.conformant);
    // Two motions were held out: 1 in 3 on average, 1 - 0.05^(1/2) at confidence.
    assert_eq!(found.trust.average_probability, Some(1.0 / 3.0));
    assert!((found.trust.violation_probability - (1.0 - 0.05f64.sqrt())).abs() < 1e-12);
    assert_eq!((found.trust.motions, found.trust.deciding), (2, 1));
}

/// Sets that are smaller by little leave a point of a motion that was held out.
#[test]
fn points_calibrate_sets_by_the_factor_that_holds_them() {
    let folder = recorded([0.3, 0.4, 0.6, 1.0]);
    let mut before = 1.0;
    for notion in [Notion::Hull, Notion::PhasePlane, Notion::Exact] {
        let settings = Settings { notion, ..settings(&["c", "d"]) };
        let problem = read(&two_joints(), folder.path(), &[], &settings);
        let found = conform_all(&problem);
        assert!(found.verdict.conformant, "{notion:?}");
        let calibration = found.calibration.clone().unwrap();
        let others = Settings { calibrate: vec![], ..settings.clone() };
        let others = read(&two_joints(), folder.path(), &["a", "b"], &others);
        let smallest = conform_all(&others).sets;
        let factor =
            |own: f64, of: f64| assert!((own / of / calibration.factor - 1.0).abs() < 1e-3);
        let pairs = found.sets.input_set.radius.iter().zip(&smallest.input_set.radius);
        pairs.for_each(|(own, of)| factor(*own, *of));
        // A little less leaves a recorded point, or a row, of a motion that was held out.
        let mut smaller = found.sets.clone();
        let sets = [&mut smaller.initial_set, &mut smaller.input_set];
        sets.into_iter().flat_map(|set| &mut set.radius).for_each(|radius| *radius *= 0.999);
        let tube = Tube::new(&problem, smaller).unwrap();
        let model = Model::new(&problem, &found);
        assert!(!check(&model, &problem, &tube).unwrap().verdict.conformant, "{notion:?}");
        // Leaving d out of a, b and d finds the factor again.
        let names = ["a", "b", "d"];
        let plain = Settings { calibrate: vec![], ..settings.clone() };
        let with_d = read(&two_joints(), folder.path(), &names, &plain);
        let one = [1.0; 6];
        let (left, _) = carry_over(&with_d, "d", None, &one, &Silent).unwrap();
        let gauge = calibration.gauges.iter().find(|gauge| gauge.motion == "d").unwrap().gauge;
        assert!((left.gauge.unwrap() / gauge - 1.0).abs() < 1e-3, "{left:?} for {gauge}");
        assert!(left.outside.unwrap() > 0);
        before = calibration.factor;
    }
    assert!(before > 1.2);
}

#[test]
fn a_calibrated_model_is_read_again_and_bounds_other_recordings_as_any_model() {
    let folder = recorded([0.3, 0.4, 0.6, 0.5]);
    let problem = read(&two_joints(), folder.path(), &["a", "b", "c"], &settings(&["c"]));
    let model = Model::new(&problem, &conform_all(&problem));
    assert!(model.cost_lower_bound.is_none() && model.verified);
    let path = folder.path().join("model.json");
    std::fs::write(&path, model.to_json()).unwrap();
    assert_eq!(reachtube_arm::open(&path).unwrap().0, model);
    let held_out = check_of(&folder, &model, &["d"]);
    let trust = held_out.trust.unwrap();
    assert!(trust.basis.starts_with("hold-out bound") && trust.average_probability.is_none());
    // The motion that calibrated the sets is no other one.
    let known = check_of(&folder, &model, &["c"]);
    assert!(known.trust.is_none() && known.verdict.conformant);
}

#[test]
fn a_motion_that_makes_calibrated_sets_absurd_is_named() {
    let folder = recorded([0.05, 0.05, 0.05, 5.0]);
    let cause = |suites: &[&str], calibrate: &[&str]| {
        let found = conform_all(&read(&two_joints(), folder.path(), suites, &settings(calibrate)));
        let cause = found.warnings.into_iter().find(|found| found.code == Code::Cause);
        cause.map(|cause| cause.text)
    };
    let words = cause(&[], &["c", "d"]).unwrap();
    let parts = ["motion d, which was held out, is unlike", "found with (a, b)", "scaled these"];
    assert!(parts.iter().all(|part| words.contains(part)), "{words}");
    assert_eq!(cause(&["a", "b", "c"], &["c"]), None);
}

#[test]
fn motions_that_cannot_calibrate_are_refused() {
    let folder = recorded([0.3; 4]);
    for (calibrate, words) in [
        (&["e"][..], "no motion \"e\"; the motions of the recordings are a, b, c, d"),
        (&SUITES[..], "all motions are held out"),
    ] {
        let problem = read(&two_joints(), folder.path(), &[], &settings(calibrate));
        let Err(Error::Calibration(problem)) = conform(&problem, &Silent, None) else {
            panic!("{calibrate:?} was accepted")
        };
        assert!(problem.problem.contains(words), "{problem}");
    }
}

#[test]
fn sensors_limit_what_calibration_may_scale() {
    let folder = recorded([0.3, 0.4, 0.6, 1.0]);
    let settings = Settings { nominal: NominalStart::Own, ..settings(&["c", "d"]) };
    let found = conform_all(&read(&two_joints(), folder.path(), &[], &settings));
    let alone = Settings { calibrate: Vec::new(), ..settings };
    let fitted = conform_all(&read(&two_joints(), folder.path(), &["a", "b"], &alone));
    let calibration = found.calibration.unwrap();
    assert!(calibration.input_only && calibration.factor > 1.2 && found.verdict.conformant);
    let (scaled, own) = (&found.sets.initial_set.radius, &fitted.sets.initial_set.radius);
    assert_eq!([scaled.len(), own.len()], [4; 2]);
    for (scaled, own) in scaled.iter().zip(own) {
        assert!((scaled - own).abs() < 1e-12);
    }
}

#[test]
fn a_motion_left_out_is_as_a_separate_conformance_and_check_find_it() {
    let folder = recorded([0.3, 0.4, 0.6, 1.0]);
    let found = conform_all(&read(&two_joints(), folder.path(), &[], &settings(&[])));
    assert_eq!(found.left_out.len(), 4);
    for left in &found.left_out {
        let others: Vec<&str> = SUITES.into_iter().filter(|name| *name != left.motion).collect();
        let fit = read(&two_joints(), folder.path(), &others, &settings(&[]));
        let alone = conform_all(&fit);
        let checked = check_of(&folder, &Model::new(&fit, &alone), &[&left.motion]);
        let gauge = checked.growth.map_or(1.0, |growth| growth.both_sets.unwrap());
        assert!((left.cost.unwrap() / alone.cost - 1.0).abs() < 1e-6, "{left:?}");
        assert!((left.gauge.unwrap() / gauge - 1.0).abs() < 1e-4, "{left:?} for {gauge}");
        assert_eq!((left.rows, left.outside), (160, Some(checked.verdict.violations.count)));
    }
    assert!(found.left_out[3].gauge.unwrap() > 1.2, "{:?}", found.left_out);
}

/// Sets in which X0 and U have grown by the two factors enclose the motion, and smaller ones do
/// not.
#[test]
fn x0_and_u_grow_one_after_the_other_until_they_enclose_a_motion() {
    let folder = recorded([0.3, 0.4, 0.6, 1.0]);
    let found = conform_all(&read(&two_joints(), folder.path(), &[], &settings(&[])));
    let (mut of_starts, mut of_inputs) = (0, 0);
    for left in &found.left_out {
        let others: Vec<&str> = SUITES.into_iter().filter(|name| *name != left.motion).collect();
        let fit = read(&two_joints(), folder.path(), &others, &settings(&[]));
        let alone = conform_all(&fit);
        let model = Model::new(&fit, &alone);
        let own = read(&two_joints(), folder.path(), &[&left.motion], &model.settings);
        let scaled = |sets: &UncertaintySets, factors: [f64; 2]| {
            let mut sets = sets.clone();
            for (set, factor) in
                [&mut sets.initial_set, &mut sets.input_set].into_iter().zip(factors)
            {
                set.radius.iter_mut().for_each(|radius| *radius *= factor);
            }
            Tube::new(&own, sets).unwrap()
        };
        let tube = |factors| scaled(&alone.sets, factors);
        let holds = |factors| check(&model, &own, &tube(factors)).unwrap().verdict.conformant;
        let [initial, input] = [left.initial_gauge, left.input_gauge].map(Option::unwrap);
        // X0 of the starts by hand, and the least factor of U by bisection.
        let mut grown = alone.sets.clone();
        let suite = &own.recordings().suites[0];
        for (i, radius) in grown.initial_set.radius.iter_mut().enumerate() {
            let middle = suite.nominal_start[i] + grown.initial_set.centre[i];
            let far = suite.runs.iter().map(|run| (run.start[i] - middle).abs() * (1.0 + 1e-9));
            *radius = far.fold(*radius, f64::max);
        }
        let (mut low, mut high) = (1.0, 16.0);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            let is_enclosed = check(&model, &own, &scaled(&grown, [1.0, middle])).unwrap().holds();
            *if is_enclosed { &mut high } else { &mut low } = middle;
        }
        let [before, after] = [tube([1.0; 2]), scaled(&grown, [1.0, high])];
        let wider = [0, 1].map(|i| after.range_at_end(i)[1] / before.range_at_end(i)[1]);
        let wider = wider[0].max(wider[1]);
        assert!((left.wider.unwrap() / wider - 1.0).abs() < 1e-4, "{left:?} for {wider}");
        assert!(holds([initial, input].map(|factor| factor * (1.0 + 1e-4))), "{left:?}");
        if initial > 1.001 {
            of_starts += 1;
            assert!(!holds([initial * 0.999, 10.0 * input]), "U has no effect at the start");
        }
        if input > 1.001 {
            of_inputs += 1;
            assert!(!holds([initial, input * 0.999]), "{left:?}");
        }
    }
    assert!(of_starts > 0 && of_inputs > 0, "{:?}", found.left_out);
}

#[test]
fn motions_of_one_run_decide_nothing_at_their_first_sample() {
    let (robot, times, mut random) = (two_joints(), grid(0.01, 10), Random(5));
    let arm = Disturbed { robot: &robot, times: &times, start: 0.01, input: 0.5 };
    let mut runs = MemoryRuns::default();
    for motion in 0..70 {
        let Recorded { times, states, torques } = arm.record(&mut random);
        let (name, run) = (format!("M{motion}"), Run::new(2, times, states, torques).unwrap());
        runs.push(&name, Some(&name), None, run);
    }
    let setup = setup(&robot, |_, sets| *sets = settings(&[]));
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap();
    let found = conform_all(&problem);
    // More than 60 motions would have needed a program.
    assert!(found.left_out.len() == 70 && found.left_out.iter().all(|left| left.cost.is_some()));
    assert!(found.left_out.iter().any(|left| left.gauge.unwrap() > 1.0));
    // Nor do such samples count for the scenario bound, unless there are no others.
    let needed = found.left_out.iter().filter(|left| left.outside > Some(0)).count();
    assert_eq!(found.trust.deciding, needed, "{:?}", found.trust);
    let touches = &found.tight[0];
    let first = |motion: usize| {
        let suite = format!("M{motion}");
        Witness { suite, sample: 0, excess: 0.0, radius: 1e-16, ..touches.clone() }
    };
    let all: Vec<Witness> = (0..70).map(first).collect();
    let deciding = |tight: &[Witness]| Trust::of_fit(&problem, tight).deciding;
    assert_eq!(deciding(&[found.tight.clone(), all.clone()].concat()), needed);
    assert_eq!(deciding(&all), 70);
}

#[test]
fn the_outer_sets_of_a_model_that_is_not_linear_calibrate_it() {
    let folder = recorded([0.3, 0.3, 0.3, 0.9]);
    let problem = read_nonlinear(&folder, &["a", "b", "d"], &["d"]);
    assert!(problem.dynamics().linear_system().is_none());
    let found = conform_all(&problem);
    let factor = found.calibration.as_ref().unwrap().factor;
    assert!(found.verdict.conformant && factor > 1.05, "{factor}");
    let mut smaller = found.sets.clone();
    let sets = [&mut smaller.initial_set, &mut smaller.input_set];
    sets.into_iter().flat_map(|set| &mut set.radius).for_each(|radius| *radius /= 1.02);
    let tube = Tube::new(&problem, smaller).unwrap();
    let verdict = check(&Model::new(&problem, &found), &problem, &tube).unwrap().verdict;
    assert!(!verdict.conformant && verdict.suites[2].violations.count > 0);
    assert_eq!(found.left_out.len(), 2);
}

#[test]
fn a_motion_left_out_of_a_search_is_as_a_separate_search_and_check_find_it() {
    let folder = recorded([0.3, 0.4, 0.6, 1.0]);
    let found = conform_all(&read_nonlinear(&folder, &[], &[]));
    assert_eq!(found.left_out.len(), 4);
    for left in &found.left_out {
        let others: Vec<&str> = SUITES.into_iter().filter(|name| *name != left.motion).collect();
        let fit = read_nonlinear(&folder, &others, &[]);
        let alone = conform_all(&fit);
        let separate = alone.search.as_ref().unwrap().linearised_cost.unwrap();
        let checked = check_of(&folder, &Model::new(&fit, &alone), &[&left.motion]);
        let outside = checked.verdict.violations.count;
        // The cost counts the samples of all motions, as the cost of the others alone does here.
        assert!((left.cost.unwrap() / separate - 1.0).abs() < 0.02, "{left:?} {separate}");
        assert_eq!(left.rows, 160);
        let apart = left.outside.unwrap().abs_diff(outside);
        assert!(apart <= 2 + outside / 10, "{left:?} {outside}");
        assert_eq!(left.outside == Some(0), left.gauge == Some(1.0), "{left:?}");
    }
    assert!(found.left_out[3].gauge.unwrap() > 1.2, "{:?}", found.left_out);
}

#[test]
fn a_factor_is_found_below_those_under_which_the_reachable_set_is_lost() {
    let found = |inputs: [f64; 2]| {
        let (folder, times) = (tempfile::tempdir().unwrap(), grid(0.01, 200));
        let suite = |index: usize| -> (&str, Vec<Recorded>) {
            let (robot, input) = (&two_joints(), inputs[index]);
            let arm = Disturbed { robot, times: &times, start: 0.01, input };
            let mut random = Random(11 + index as u64);
            (SUITES[index], (0..6).map(|_| arm.record(&mut random)).collect())
        };
        write_data_set(folder.path(), &[suite(0), suite(1)]);
        let problem = read_nonlinear(&folder, &[], &["b"]);
        conform(&problem, &Silent, None).map(|found| (problem, found))
    };
    let (problem, enclosed) = found([6.0, 14.0]).unwrap();
    let factor = enclosed.calibration.as_ref().unwrap().factor;
    assert!(enclosed.verdict.conformant && factor > 1.9, "{factor}");
    // Sets that are 3.5 times as large as the smallest are too large.
    let mut larger = enclosed.sets.clone();
    let sets = [&mut larger.initial_set, &mut larger.input_set];
    sets.into_iter().flat_map(|set| &mut set.radius).for_each(|radius| *radius *= 3.5 / factor);
    let tube = Tube::new(&problem, larger).unwrap();
    let model = Model::new(&problem, &enclosed);
    assert!(!check(&model, &problem, &tube).unwrap().verdict.lost.is_empty());
    let Err(Error::Calibration(words)) = found([10.0, 24.0]) else { panic!("a factor was found") };
    assert!(words.problem.contains("sets of motion b are lost when the sets grow 1."), "{words}");
}

/// Records one suite whose second joint is off by a constant torque, in the order of `torques`.
fn drifting(torques: &[f64]) -> Problem {
    let (robot, times) = (two_joints(), grid(0.01, 100));
    let arm = Disturbed { robot: &robot, times: &times, start: 0.0, input: 0.0 };
    let (mut runs, mut random) = (MemoryRuns::default(), Random(3));
    for (run, torque) in torques.iter().enumerate() {
        let Recorded { times, mut states, torques } = arm.record(&mut random);
        // An offset of the elbow that grows with time.
        for (k, state) in states.chunks_exact_mut(4).enumerate() {
            state[1] += torque * k as f64 * 0.01;
        }
        let recorded = Run::new(2, times, states, torques).unwrap();
        runs.push(&format!("run{run}"), Some("A"), None, recorded);
    }
    let setup = setup(&robot, |_, sets| *sets = settings(&[]));
    Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap()
}

#[test]
fn a_joint_that_follows_the_order_of_the_runs_is_named() {
    let rising: Vec<f64> = (0..12).map(|run| 0.01 * f64::from(run)).collect();
    let found = conform_all(&drifting(&rising));
    let [trend] = &found.trends[..] else { panic!("{:?}", found.trends) };
    assert_eq!((trend.suite.as_str(), trend.runs, trend.part), ("A", 12, 2));
    // 100 samples: every second one is kept, up to sample 98.
    assert!(trend.correlation > 0.999 && (trend.range - 0.11 * 0.98).abs() < 1e-9, "{trend:?}");
    let mixed = [0.0, 0.09, 0.03, 0.06, 0.01, 0.11, 0.04, 0.08, 0.02, 0.1, 0.05, 0.07];
    assert!(conform_all(&drifting(&mixed)).trends.is_empty());
}
