//! U that grows with the rate of the nominal motion: the optimum that is known by hand, the proof,
//! motions of the model that are simulated, and what is refused.

use reachtube_arm::{ArmModel, ArmSettings, Equations};
use reachtube_conform::settings::{Method, NominalStart};
use reachtube_conform::{
    Answer, CheckJob, Error, Job, Keep, Noise, Notion, Problem, Settings, Silent, Tube, reach,
};
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::Robot;

use crate::common::{Random, bent, grid, setup};

const STEP: f64 = 0.004;

/// Two joints that accelerate at `a` from the start on, where a nominal motion accelerates at
/// `nominal`.
fn run(nominal: f64, a: f64) -> Run {
    let times = grid(STEP, 60);
    let state = |t: &f64| [[0.2 - 0.5 * t + 0.5 * a * t * t; 2], [a * t - 0.5; 2]].concat();
    let states = times.iter().flat_map(state).collect();
    let torques = vec![0.0; 2 * times.len()];
    let run = Run::new(2, times, states, torques).unwrap();
    Run { before: [vec![0.0; 4], vec![nominal; 2]].concat(), ..run }
}

fn runs(all: &[(f64, f64)]) -> MemoryRuns {
    let mut runs = MemoryRuns::default();
    for (index, (nominal, a)) in all.iter().enumerate() {
        let name = format!("run{index}");
        runs.push(&name, Some(&name), Some(&name), run(*nominal, *a));
    }
    runs
}

fn adjust(doubling: Option<f64>) -> impl FnOnce(&mut ArmSettings, &mut Settings) {
    move |arm, settings| {
        arm.equations = Equations::Held;
        settings.noise = Noise::Fitted;
        settings.sensor_noise = Some(vec![1e-9; 4]);
        settings.nominal = NominalStart::Own;
        settings.input_doubling = doubling.map(|rate| vec![rate; 2]);
    }
}

/// Motions that are off by a tenth and a tenth of their acceleration, to both sides.
const MOTIONS: [f64; 4] = [0.0, 0.999, -1.999, 2.999];

fn answer(doubling: Option<f64>) -> Answer {
    let both = |a: &f64| [1.0, -1.0].map(|sign| (*a, a + sign * 0.1 * (1.0 + a.abs())));
    let all: Vec<(f64, f64)> = MOTIONS.iter().flat_map(both).collect();
    Job::new(setup(&bent(), adjust(doubling)), runs(&all)).run(&Silent).unwrap()
}

#[test]
fn the_least_set_at_rest_is_found_and_proved() {
    let [growing, same] = [Some(1.0), None].map(answer);
    assert!(growing.holds() && same.holds());
    for joint in 0..2 {
        let radius = |answer: &Answer| answer.model.input_set.radius[joint];
        // The scale at 0.999 is 2, a multiple of 1/64; the errors there are 0.1999.
        assert!((radius(&growing) - 0.1).abs() < 1e-4, "{}", radius(&growing));
        assert!((radius(&same) - 0.39995).abs() < 2e-3, "{}", radius(&same));
    }
    let gap = |answer: &Answer| answer.model.optimality_gap.unwrap();
    assert!(gap(&growing) < 1e-6, "{}", gap(&growing));
    // Half the widths count by their mean over the motions.
    let width = |answer: &Answer| answer.found.usefulness.parts[0].half_width.unwrap();
    let mean = MOTIONS.iter().map(|a| 0.1 * (1.0 + a.abs())).sum::<f64>() / 4.0;
    assert!((width(&growing) / width(&same) - mean / 0.39995).abs() < 0.01);
}

#[test]
fn a_faster_motion_has_a_larger_set() {
    let [growing, same] = [Some(1.0), None].map(|doubling| answer(doubling).model);
    let outside = |model: &reachtube_conform::Model, nominal: f64, a: f64| {
        let setup = model.setup().unwrap();
        let job = CheckJob::new(model.clone(), setup, runs(&[(nominal, a)]));
        job.run(&Silent).unwrap().verdict.violations.count
    };
    // At 5.999 U is 7 times what it is at rest.
    assert_eq!(outside(&growing, 5.999, 5.999 + 0.69), 0);
    assert!(outside(&growing, 5.999, 5.999 + 0.72) > 0);
    assert!(outside(&growing, 0.0, 0.11) > 0 && outside(&same, 0.0, 0.11) == 0);
    assert!(outside(&same, 5.999, 5.999 + 0.69) > 0);
}

#[test]
fn simulated_motions_lie_in_the_sets_and_reach_their_bounds() {
    let model = answer(Some(1.0)).model;
    let source = Box::new(runs(&[(1.999, 1.999), (0.0, 0.0)]));
    let problem = Problem::read(model.setup().unwrap(), source, &[], Keep::All, &Silent).unwrap();
    let tube = Tube::new(&problem, model.sets()).unwrap();
    let mut random = Random(3);
    for (reached, a) in reach(&problem, &tube).unwrap().iter().zip([1.999, 0.0]) {
        let radius = model.input_set.radius[0] * (1.0 + f64::ceil(64.0 * a) / 64.0);
        let centre = model.input_set.centre[0];
        for trial in 0..1000 {
            let [mut q, mut qd] = [0.2, -0.5];
            for k in 0..reached.times.len() {
                let [low, high] = [&reached.lower, &reached.upper].map(|side| side[4 * k]);
                let inside = low - 1e-9 <= q && q <= high + 1e-9;
                assert!(inside, "{q} in [{low}, {high}] at {k} for {a}");
                if trial == 0 && k == 50 {
                    assert!((q - high).abs() < 1e-3 * (high - low), "{q} {high}");
                }
                let vertex = if trial == 0 { 1.0 } else { random.signed().signum() };
                let acceleration = a + centre + vertex * radius;
                q += STEP * qd + 0.5 * STEP * STEP * acceleration;
                qd += STEP * acceleration;
            }
        }
    }
    let along = problem.sets_along(&tube.sets, &problem.cases().unwrap()[0]).unwrap();
    assert_eq!(along.input_set.radius[0], model.input_set.radius[0] * 3.0);
    let braking = problem.input_set_at(&tube.sets, &[0.999, 0.0]);
    let rest = &model.input_set.radius;
    assert_eq!(braking.radius, [2.0 * rest[0], rest[1]]);
}

#[test]
fn what_it_cannot_be_used_with_is_refused() {
    let refused = |change: fn(&mut ArmSettings, &mut Settings)| {
        let settings = |arm: &mut ArmSettings, settings: &mut Settings| {
            settings.input_doubling = Some(vec![1.0; 2]);
            change(arm, settings);
        };
        let mut arm = ArmSettings::new(Torque::Compensated, 2);
        let mut own = Settings::default();
        settings(&mut arm, &mut own);
        let robot: Robot = bent();
        reachtube_arm::setup(robot, arm, own).map(|_| ()).unwrap_err()
    };
    let wrong = [
        refused(|_, settings| settings.notion = Notion::Exact),
        refused(|_, settings| settings.method = Method::Bisection),
        refused(|arm, _| arm.abstraction.order = 3),
    ];
    for error in wrong {
        assert!(
            error.to_string().starts_with("U grows with the nominal motion, which needs"),
            "{error}"
        );
    }
    let error = refused(|_, settings| settings.input_doubling = Some(vec![0.0; 2])).to_string();
    assert!(error.contains("input doubling"), "{error}");
    let error = refused(|_, settings| settings.input_doubling = Some(vec![1.0])).to_string();
    assert!(error.contains("give 2"), "{error}");
    // A check may ask for another notion than the model's.
    let model = answer(Some(1.0)).model;
    let setup = model.setup().unwrap();
    let job = CheckJob::new(model, setup, runs(&[(0.0, 0.0)])).notion(Some(Notion::Exact));
    assert!(matches!(job.run(&Silent).unwrap_err(), Error::InputDoubling(_)));
}
