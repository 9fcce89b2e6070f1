//! The nominal model chosen for the smallest sets.

use crate::common::{Random, conform_all, fold_of, grid, setup, step, two_joints};
use nalgebra::DVector;
use reachtube_abstraction::{Abstraction, ExpansionPoint, ModelKind, linear_model};
use reachtube_arm::{ArmSettings, OfArm};
use reachtube_conform::fit::{FitRecord, Fitted};
use reachtube_conform::fleet::OnDefect;
use reachtube_conform::settings::{Centre, NominalStart};
use reachtube_conform::{
    Code, Error, FitSettings, Group, Keep, Model, Problem, Progress, Settings, Setup, Silent,
    carry_over, fit,
};
use reachtube_reach::Disturbance;
use reachtube_recordings::{MemoryRuns, Run, RunSource, Torque};
use reachtube_robot::{FrictionErrors, Parameter, ParameterKind, Robot};
use reachtube_scalar::number::four_decimals;

const SAMPLES: usize = 120;
const RUNS: usize = 5;

/// What the virtual arm is, beside the robot that is given to `conform`.
#[derive(Clone, Copy, Default)]
pub(crate) struct Truth {
    /// Factor on the elbow's viscous friction.
    pub elbow: f64,
    /// What is added to the shoulder's motor inertia, kg m².
    pub shoulder: f64,
    /// Change of the elbow's viscous friction with ln(run), N m s/rad.
    pub warm_up: f64,
    /// Change of the elbow's viscous friction, N m s/rad, and of the shoulder's Coulomb friction,
    /// N m, per K above 30 °C.
    pub heat: [f64; 2],
    /// Extra friction of the shoulder against the motion, N m.
    pub coulomb: f64,
    /// Mass at the tip, whose weight along -y the recorded input does not carry, kg.
    pub payload: f64,
    /// Whether every third time between two samples is twice as long.
    pub uneven: bool,
}

/// Runs of the arm in motions of their own amplitude and frequency.
pub(crate) fn record(robot: &Robot, truth: Truth, motions: usize) -> MemoryRuns {
    let kinds = [(1, ParameterKind::Viscous1), (0, ParameterKind::MotorInertia)];
    let parameters = kinds.map(|(joint, kind)| Parameter { joint, kind });
    let (mut times, mut random) = (grid(0.01, SAMPLES), Random(7));
    if truth.uneven {
        times.iter_mut().enumerate().for_each(|(k, t)| *t += 0.01 * (k / 3) as f64);
    }
    let mut runs = MemoryRuns::default();
    for motion in 0..motions {
        let name = format!("motion{motion}");
        for place in 1..=RUNS {
            let [shoulder, elbow] = HEAT[place - 1].map(|t| t - 30.0);
            let viscous = truth.elbow + truth.warm_up * (place as f64).ln() + truth.heat[0] * elbow;
            let coulomb = truth.coulomb + truth.heat[1] * shoulder;
            let values = [viscous, 0.3 + truth.shoulder];
            let described = robot.description().with_values(&parameters, &values).unwrap();
            let real = Robot::from_description(&described).unwrap();
            let system = linear_model(&real, &ExpansionPoint::zero(2)).unwrap();
            let mut x = DVector::from_fn(4, |_, _| 1e-3 * random.signed());
            let (mut states, mut torques) = (Vec::new(), Vec::new());
            for (k, &t) in times.iter().enumerate() {
                let pace = 3.0 + motion as f64;
                let u = DVector::from_fn(2, |j, _| 2.0 * (pace * t + j as f64).sin());
                states.extend(x.iter());
                torques.extend(u.iter());
                let mut real = u.map(|u| u + 0.02 * random.signed());
                real[0] -= coulomb * (x[2] / 0.02).clamp(-1.0, 1.0);
                let weight = 9.81 * truth.payload;
                let elbow = 0.25 * (x[0] + x[1]).cos();
                real[0] -= weight * (0.3 * x[0].cos() + elbow);
                real[1] -= weight * elbow;
                x = step(&system, times.get(k + 1).map_or(0.01, |next| next - t), &x, &real);
            }
            let mut run = Run::new(2, times.clone(), states, torques).unwrap();
            if truth.heat != [0.0; 2] {
                run = run.with_temperatures(HEAT[place - 1].repeat(SAMPLES)).unwrap();
            }
            runs.push(&format!("{name}_{place}"), Some(&name), Some(&name), run);
        }
    }
    runs
}

pub(crate) fn problem(
    truth: Truth,
    motions: usize,
    adjust: impl FnOnce(&mut ArmSettings, &mut Settings),
) -> Problem {
    let robot = two_joints();
    let setup = setup(&robot, adjust);
    let runs = Box::new(record(&robot, truth, motions));
    Problem::read(setup, runs, &[], Keep::All, &Silent).unwrap()
}

pub(crate) fn fitted(problem: &Problem, groups: &[Group], pull: Option<f64>) -> Fitted {
    fit(problem, &FitSettings { groups: groups.to_vec(), pull }, &Silent).unwrap()
}

pub(crate) const PLAIN: Truth = Truth {
    elbow: 1.0,
    shoulder: 0.0,
    warm_up: 0.0,
    heat: [0.0; 2],
    coulomb: 0.0,
    payload: 0.0,
    uneven: false,
};

/// Cancels a job, and keeps its reports.
#[derive(Default)]
struct Cancels(std::sync::Mutex<Vec<String>>);

impl Progress for Cancels {
    fn finished(&self, what: &str) {
        self.0.lock().unwrap().push(what.into());
    }

    fn is_cancelled(&self) -> bool {
        true
    }
}

#[test]
fn a_fit_that_is_cancelled_ends_within_its_first_searches() {
    let cancels = Cancels::default();
    let settings = FitSettings { groups: vec![Group::Viscous], pull: None };
    let refused = fit(&problem(PLAIN, 3, |_, _| ()), &settings, &cancels).unwrap_err();
    assert!(matches!(refused, Error::Cancelled), "{refused}");
    assert_eq!(cancels.0.into_inner().unwrap(), Vec::<String>::new());
}

/// The temperatures of both joints in the runs of a motion, °C, in no order of the runs.
const HEAT: [[f64; 2]; RUNS] =
    [[24.0, 36.0], [36.0, 20.0], [28.0, 42.0], [40.0, 30.0], [32.0, 26.0]];

#[test]
fn a_wrong_inertia_and_friction_are_found_and_the_sets_are_proved() {
    let truth = Truth { elbow: 1.6, shoulder: 0.2, ..PLAIN };
    for disturbance in [Disturbance::Sample, Disturbance::Constant, Disturbance::Measurable] {
        let problem = problem(truth, 3, |_, settings| settings.disturbance = disturbance);
        let before = conform_all(&problem);
        let Fitted { problem: better, record, .. } =
            fitted(&problem, &[Group::Inertia, Group::Viscous], Some(0.001));
        let after = conform_all(&better);
        assert!(after.verdict.conformant && after.cost < 0.2 * before.cost, "{}", after.cost);
        let same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
        assert!(same(record.identified_cost, before.cost) && same(record.cost, after.cost));
        let elbow = record.parameters.iter().find(|p| p.part == 2 && p.group == Group::Viscous);
        assert!((elbow.unwrap().fitted - 1.6).abs() < 0.05, "{:?}", record.parameters);
        let closer = record.torque.iter().all(|torque| torque.fitted < torque.identified);
        assert!(record.torque.len() == 2 && closer, "{:?}", record.torque);
        // The same answer again.
        let again = fitted(&problem, &[Group::Inertia, Group::Viscous], Some(0.001));
        assert_eq!(record, again.record);
    }
}

#[test]
fn the_costs_are_those_of_conform_where_samples_are_uneven() {
    let problem = problem(Truth { elbow: 1.6, uneven: true, ..PLAIN }, 2, |_, _| {});
    let before = conform_all(&problem);
    let Fitted { problem: better, record, .. } =
        fitted(&problem, &[Group::Viscous; 2], Some(0.001));
    let after = conform_all(&better);
    let same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
    assert!(
        same(record.identified_cost, before.cost),
        "{} {}",
        before.cost,
        record.identified_cost
    );
    assert!(same(record.cost, after.cost), "{} {}", after.cost, record.cost);
    // The group was named twice, and is fitted once.
    assert!(record.cost < 0.5 * record.identified_cost && record.groups.len() == 1, "{record:?}");
}

#[test]
fn standard_errors_of_the_description_stand_beside_the_values() {
    let problem = problem(Truth { elbow: 1.6, ..PLAIN }, 2, |_, _| {});
    let mut description = two_joints().description().clone();
    for joint in &mut description.joints {
        let errors = FrictionErrors { viscous: [0.1, 0.0, 0.0], ..FrictionErrors::default() };
        joint.friction.standard_errors = Some(errors);
    }
    let robot = Robot::from_description(&description).unwrap();
    let setup = setup(&robot, |_, settings| settings.clone_from(problem.settings()));
    let groups = [Group::Inertia, Group::Viscous];
    let Fitted { problem, record, .. } = fitted(&problem.with_setup(setup), &groups, Some(0.02));
    assert!(record.parameters.len() >= 4, "{:?}", record.parameters);
    for parameter in &record.parameters {
        let is_viscous = parameter.group == Group::Viscous;
        assert_eq!(parameter.standard_error, is_viscous.then_some(0.1), "{parameter:?}");
        let moved = (parameter.fitted - parameter.identified).abs();
        assert_eq!(
            moved > 0.3 && parameter.standard_error.is_some(),
            is_viscous && parameter.part == 2,
            "{parameter:?}"
        );
    }
    // A fitted value is no identified one, and has no error.
    let joints = &problem.robot().description().joints;
    assert!(joints[1].friction.standard_errors.is_none(), "{joints:?}");
}

#[test]
fn a_payload_is_found_on_links_that_are_described_by_their_centre_of_mass() {
    let problem = problem(Truth { payload: 0.2, ..PLAIN }, 2, |_, s| s.centre = Centre::Zero);
    let robot = {
        let mut description = two_joints().description().clone();
        description.gravity = [0.0, -9.81, 0.0];
        Robot::from_description(&description).unwrap()
    };
    let setup = setup(&robot, |_, settings| settings.clone_from(problem.settings()));
    let problem = problem.with_setup(setup);
    let Fitted { problem: better, record, .. } = fitted(&problem, &[Group::Payload], Some(1e-4));
    let [only] = &record.parameters[..] else { panic!("{record:?}") };
    assert!((only.fitted - 0.2).abs() < 0.02, "{only:?}");
    assert!(conform_all(&better).verdict.conformant);
}

#[test]
fn a_right_model_is_left_alone_and_bad_settings_are_refused() {
    let right = problem(PLAIN, 3, |_, _| {});
    let record = fitted(&right, &[Group::Inertia, Group::Viscous], Some(0.05)).record;
    let near = record.parameters.iter().all(|p| (p.fitted / p.identified - 1.0).abs() <= 0.05);
    assert!(record.parameters.len() >= 4 && near, "{record:?}");
    let refused = |problem: &Problem, groups: &[Group], pull| {
        let settings = FitSettings { groups: groups.to_vec(), pull };
        fit(problem, &settings, &Silent).unwrap_err().to_string()
    };
    let one = problem(PLAIN, 1, |_, _| {});
    assert!(refused(&one, &[Group::Viscous], None).contains("record a second motion"));
    let rest = problem(PLAIN, 2, |_, settings| settings.calibrate = vec!["motion0".into()]);
    assert!(refused(&rest, &[Group::Viscous], None).contains("hold fewer motions out"));
    assert!(refused(&right, &[Group::Coulomb], None).contains("none of the parameters"));
    assert!(refused(&right, &[Group::Viscous], Some(2.0)).contains("from 0 to 1"));
    let link = problem(PLAIN, 2, |arm, _| arm.torque = Torque::Link);
    assert!(refused(&link, &[Group::Inertia, Group::WarmUp], None).contains("no friction"));
}

#[test]
fn a_model_that_is_not_linear_gets_the_parameters_too() {
    let truth = Truth { elbow: 1.5, shoulder: 0.1, ..PLAIN };
    let problem = problem(truth, 2, |arm, _| {
        arm.abstraction = Abstraction { model: ModelKind::One, order: 3 };
    });
    let before = conform_all(&problem);
    let Fitted { problem: better, .. } =
        fitted(&problem, &[Group::Inertia, Group::Viscous], Some(0.001));
    let after = conform_all(&better);
    assert!(after.verdict.conformant && after.cost < 0.3 * before.cost, "{}", after.cost);
}

/// Motions of arms whose elbows have this viscous friction.
fn of_arms(elbows: &[f64], calibrate: &[&str]) -> Problem {
    let (robot, mut runs) = (two_joints(), MemoryRuns::default());
    for (motion, elbow) in elbows.iter().enumerate() {
        let all = record(&robot, Truth { elbow: *elbow, ..PLAIN }, motion + 1);
        for (index, entry) in all.runs().iter().enumerate().skip(motion * RUNS) {
            let run = all.read(index, &Default::default()).unwrap();
            runs.push(&entry.file, entry.suite.as_deref(), entry.motion.as_deref(), run);
        }
    }
    let calibrate = calibrate.iter().map(|name| name.to_string()).collect();
    let setup = setup(&robot, |_, settings| settings.calibrate = calibrate);
    Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap()
}

/// The warning that a fit to motions of these arms suits them only, and the fit's record.
fn overfitted(elbows: &[f64], calibrate: &[&str]) -> (Option<String>, FitRecord) {
    let problem = of_arms(elbows, calibrate);
    let Fitted { problem, record, .. } = fitted(&problem, &[Group::Viscous], Some(0.001));
    let model = Model::new(&problem, &conform_all(&problem)).with_fit(record.clone());
    let of = model.warnings.into_iter().filter(|found| found.code == Code::Overfitted);
    (of.map(|found| found.text).next(), record)
}

#[test]
fn a_fit_that_suits_its_own_motions_only_is_a_warning() {
    let (none, record) = overfitted(&[1.6, 1.6, 1.6], &["motion2"]);
    assert!(none.is_none() && record.identified_calibrated_cost.is_some(), "{none:?}");
    let (words, record) = overfitted(&[1.6, 1.6, 0.6], &["motion2"]);
    let before = record.identified_calibrated_cost.unwrap();
    let fact = format!("and {} with the identified one", four_decimals(before));
    assert!(words.as_ref().is_some_and(|words| words.contains(&fact)), "{words:?}");
    let (words, record) = overfitted(&[1.6, 0.6], &[]);
    assert!(record.left_out_mean() > Some(record.identified_cost), "{record:?}");
    assert!(words.is_some_and(|words| words.contains("With a motion left out")));
}

#[test]
fn motions_are_left_out_of_the_fit_as_a_calibration_leaves_them_out() {
    let elbows = [1.6, 1.5, 1.8];
    let (all, groups) = (of_arms(&elbows, &[]), [Group::Viscous]);
    let Fitted { problem, record, .. } = fitted(&all, &groups, Some(0.001));
    let model = Model::new(&problem, &conform_all(&problem)).with_fit(record.clone());
    for (motion, name) in ["motion0", "motion1", "motion2"].into_iter().enumerate() {
        let gauge = |problem: &Problem| conform_all(problem).calibration.unwrap().gauges[0].gauge;
        let held_out = of_arms(&elbows, &[name]);
        let identified = record.identified_left_out[motion].growth.unwrap();
        assert!((identified / gauge(&held_out) - 1.0).abs() < 1e-6, "{name}: {identified}");
        let unseen = &record.leave_one_out[motion];
        let again = gauge(&fitted(&held_out, &groups, Some(0.001)).problem);
        assert!((unseen.growth.unwrap() / again - 1.0).abs() < 0.05, "{unseen:?}, {again}");
        let one = [1.0; 6];
        let (carried, factor) = carry_over(&all, name, None, &one, &Silent).unwrap();
        assert_eq!(factor > Some(0.0), carried.outside > Some(0), "{factor:?}, {carried:?}");
        assert!((carried.gauge.unwrap() / identified - 1.0).abs() < 1e-6, "{carried:?}");
        let settings = FitSettings { groups: groups.to_vec(), pull: Some(0.001) };
        let (carried, _) = carry_over(&all, name, Some(&settings), &one, &Silent).unwrap();
        assert!((carried.gauge.unwrap() / again - 1.0).abs() < 1e-6, "{carried:?}, {again}");
        // The model reports this growth, not the growth for a fit that has seen the motion.
        assert_eq!(model.left_out[motion].gauge, unseen.growth);
        assert_eq!(model.left_out[motion].outside, unseen.outside);
        assert!(unseen.initial_growth.is_some() && unseen.input_growth.is_some(), "{unseen:?}");
        assert_eq!(model.left_out[motion].initial_gauge, unseen.initial_growth);
        assert_eq!(model.left_out[motion].input_gauge, unseen.input_growth);
    }
    let unknown = carry_over(&all, "motion7", None, &[1.0; 6], &Silent).unwrap_err().to_string();
    assert!(unknown.contains("motion0, motion1, motion2"), "{unknown}");
}

#[test]
fn a_fit_that_carries_over_worse_is_not_taken() {
    let problem = of_arms(&[1.6, 0.6], &[]);
    let Fitted { problem: kept, record, .. } = fitted(&problem, &[Group::Viscous], None);
    assert!(!record.taken && record.cost == record.identified_cost, "{record:?}");
    assert_eq!(kept.robot().description(), problem.robot().description());
    let model = Model::new(&kept, &conform_all(&kept)).with_fit(record);
    let findings = model.findings();
    let not_taken = findings.iter().find(|finding| finding.code == Code::FitNotTaken).unwrap();
    let [before, after] = ["identified", "fitted"].map(|name| not_taken.numbers[name]);
    assert!(before < after, "{not_taken:?}");
    assert!(!findings.iter().any(|finding| finding.code == Code::Overfitted));
    // Motions of one arm share what is fitted.
    let problem = of_arms(&[1.6, 1.6, 1.6], &[]);
    let record = fitted(&problem, &[Group::Viscous], None).record;
    assert!(record.taken && record.cost < 0.5 * record.identified_cost, "{record:?}");
}

#[test]
fn without_a_group_the_others_are_fitted_again() {
    let problem = problem(Truth { elbow: 1.6, shoulder: 0.2, ..PLAIN }, 3, |_, _| {});
    let both = fitted(&problem, &[Group::Inertia, Group::Viscous], Some(0.001)).record;
    for (group, other) in [(0, Group::Viscous), (1, Group::Inertia)] {
        let alone = fitted(&problem, &[other], Some(0.001)).record.cost;
        let without = both.groups[group].cost_without.unwrap();
        // The search is a quick one: it ends in another local optimum for the inertia alone.
        let range = 0.99 * alone..1.15 * alone;
        assert!(range.contains(&without), "{other:?}: {without}, {alone}");
    }
}

/// The fold of a source, read back as the problem that the source gives.
fn folded(setup: &Setup, runs: &MemoryRuns) -> Problem {
    let fold = fold_of(setup, runs);
    Problem::of_fold(setup.clone(), fold, OnDefect::Refuse).unwrap()
}

#[test]
fn recordings_that_were_folded_are_fitted_to_the_last_bit() {
    let robot = two_joints();
    let truth = Truth { elbow: 1.6, shoulder: 0.2, uneven: true, ..PLAIN };
    let runs = record(&robot, truth, 3);
    let with = |adjust: &dyn Fn(&mut Settings)| setup(&robot, |_, settings| adjust(settings));
    let own = with(&|settings| settings.nominal = NominalStart::Own);
    let calibrated = with(&|settings| settings.calibrate = vec!["motion1".into()]);
    let groups = [Group::Inertia, Group::Viscous];
    for setup in [with(&|_| {}), own, calibrated] {
        let once = Problem::read(setup.clone(), Box::new(runs.clone()), &[], Keep::Needed, &Silent);
        let [by_fold, once] = [folded(&setup, &runs), once.unwrap()].map(|problem| {
            let Fitted { problem, record, .. } = fitted(&problem, &groups, Some(0.001));
            let found = conform_all(&problem);
            assert!(found.verdict.conformant);
            Model::new(&problem, &found).with_fit(record).to_json()
        });
        assert_eq!(by_fold, once);
    }
    // A fold of runs that share their input has not kept them.
    let warm_up = FitSettings { groups: vec![Group::WarmUp], pull: Some(0.02) };
    let refused = fit(&folded(&with(&|_| {}), &runs), &warm_up, &Silent).unwrap_err().to_string();
    assert!(refused.contains("warm-up"), "{refused}");
}
