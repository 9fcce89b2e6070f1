//! Plans: where the arm can be that follows one, and plans that the model is not for.

use reachtube_tracking::{Plan, PlanTube, TrackedRun, TrackingModel};

use crate::common::{made, near, servo, set};
use crate::servo::{FRICTION, LAGS, Plan as Waves, Random};

/// The plan of a number, at a part of the speed of the logs.
fn plan(number: u64, part: f64) -> Plan {
    let waves = Waves::new(number);
    let times: Vec<f64> = (0..600).map(|k| 0.01 * f64::from(k)).collect();
    let command = times.iter().flat_map(|t| [0, 1].map(|joint| waves.position(joint, part * t)));
    Plan {
        file: format!("plans/{number}.csv").into(),
        joints: vec!["shoulder".into(), "elbow".into()],
        units: vec!["rad"; 2],
        command: command.collect(),
        times,
    }
}

/// The plan as a recording, for the sets in plain arithmetic.
fn as_run(plan: &Plan) -> TrackedRun {
    TrackedRun {
        file: plan.file.clone(),
        joints: plan.joints.clone(),
        units: plan.units.clone(),
        times: plan.times.clone(),
        command: plan.command.clone(),
        actual: plan.command.clone(),
        sha256: String::new(),
    }
}

/// Bounds of a joint within a step, at a part of it.
fn between(tube: &PlanTube, plan: &Plan, (k, part): (usize, f64), joint: usize) -> [f64; 2] {
    let at = 2 * k + joint;
    let chord = |of: &[f64]| (1.0 - part) * of[at] + part * of[at + 2];
    let duration = plan.times[k + 1] - plan.times[k];
    let bulge = part * (1.0 - part) * duration * tube.velocities[at].width();
    [chord(&tube.lower) - bulge, chord(&tube.upper) + bulge]
}

fn model() -> TrackingModel {
    made(&servo(24)).model
}

/// The bounds at samples are the sets, as the test computes them.
#[test]
fn the_tube_at_samples_is_the_set() {
    let model = model();
    let plan = plan(100, 0.5);
    let tube = model.tube(&plan).unwrap();
    let run = as_run(&plan);
    for (index, bounds) in tube.lower.iter().zip(&tube.upper).enumerate() {
        let [nominal, half_width] = set(&model.joints[index % 2], &run, index / 2, index % 2);
        let outer = [nominal - half_width - bounds.0, bounds.1 - nominal - half_width];
        assert!(outer.iter().all(|beyond| (-1e-15..1e-12).contains(beyond)), "{outer:?}");
    }
}

/// The true servo follows 400 plans that no log has, and is watched ten times in each step.
#[test]
fn the_true_arm_stays_in_the_tube_of_its_plan() {
    let model = model();
    let (mut inside, mut all) = (0, 0);
    for number in 100..500 {
        let (part, waves, mut random) = (0.6, Waves::new(number), Random(number));
        let plan = plan(number, part);
        let Ok(tube) = model.tube(&plan) else { continue };
        let mut leaves = false;
        for index in 0..599 * 10 {
            let (k, within) = (index / 10, (index % 10) as f64 / 10.0);
            let time = plan.times[k] + 0.01 * within;
            let stamped = time + random.within(-1e-3, 1e-3);
            for (joint, lag) in LAGS.iter().enumerate() {
                let position = |t: f64| waves.position(joint, part * t);
                let speed = (position(time + 1e-4) - position(time - 1e-4)) / 2e-4;
                let friction = if joint == 0 { FRICTION * (speed / 0.02).tanh() } else { 0.0 };
                let y = position(stamped - lag) - friction + random.within(-5e-5, 5e-5);
                let [low, high] = between(&tube, &plan, (k, within), joint);
                leaves |= y < low || y > high;
            }
        }
        inside += usize::from(!leaves);
        all += 1;
    }
    assert!(all > 350 && inside == all, "{inside} of {all} plans");
}

/// Errors at the corners of the sets, and straight in between, stay inside.
#[test]
fn errors_at_the_corners_stay_inside_between_samples_too() {
    let model = model();
    let plan = plan(101, 0.5);
    let tube = model.tube(&plan).unwrap();
    let run = as_run(&plan);
    for joint in 0..2 {
        let at = |k: usize, sign: f64| {
            let [nominal, half_width] = set(&model.joints[joint], &run, k, joint);
            nominal + sign * half_width * (1.0 - 1e-9)
        };
        for (k, sign) in (0..599).flat_map(|k| [(k, 1.0), (k, -1.0)]) {
            for part in [0.1, 0.3, 0.5, 0.9] {
                let y = (1.0 - part) * at(k, sign) + part * at(k + 1, sign);
                let [low, high] = between(&tube, &plan, (k, part), joint);
                assert!((low..=high).contains(&y), "{k} {part}");
            }
        }
    }
}

#[test]
fn a_plan_that_is_too_fast_is_refused_with_the_speed_at_which_it_is_not() {
    let model = model();
    let fast = plan(102, 3.0);
    let text = model.tube(&fast).unwrap_err().to_string();
    for part in
        ["plans/102.csv", " rad/s", "the model was made of commands up to", "send the plan at "]
    {
        assert!(text.contains(part), "{part} is not in {text}");
    }
    let percent: f64 =
        text.split("send the plan at ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((5.0..60.0).contains(&percent), "{text}");
    assert!(model.tube(&fast.slowed(percent / 100.0)).is_ok());
    assert!(model.tube(&fast.slowed((percent + 2.0) / 100.0)).is_err());
}

/// A step of a plan that is ten times as long as the recorded ones may hide ten times the change.
#[test]
fn long_steps_of_a_plan_widen_the_tube_between_samples() {
    let model = model();
    let fine = plan(103, 0.3);
    let rows: Vec<usize> = (0..600).step_by(10).collect();
    let coarse = Plan {
        times: rows.iter().map(|k| fine.times[*k]).collect(),
        command: rows.iter().flat_map(|k| fine.command[2 * k..2 * k + 2].to_vec()).collect(),
        ..fine.clone()
    };
    let change = model.joints[0].largest_change;
    let tubes = [&fine, &coarse].map(|plan| model.tube(plan).unwrap());
    // While the command rests, the bulge is the change of the error alone.
    let bulge = |of: usize, step: f64| 0.25 * step * tubes[of].velocities[0].width();
    near(bulge(0, 0.01), 0.5 * change, 0.01);
    near(bulge(1, 0.1), 5.0 * change, 0.2);
}

/// The bounds from the numbers of the model hold along each plan.
#[test]
fn deviations_bound_every_plan_at_the_same_time_and_along_the_path() {
    let model = model();
    let part = 0.5;
    let of = model.deviations(part);
    near(of.late_by, 0.0115, 0.3);
    assert!(of.along_the_path.iter().sum::<f64>() < 0.7 * of.at_the_same_time.iter().sum::<f64>());
    for number in 200..240 {
        let plan = plan(number, part);
        let (waves, run) = (Waves::new(number), as_run(&plan));
        let joints = &model.joints;
        let is_slow = (0..1200).all(|index| {
            let [v, a] = crate::common::rates(&run, index / 2, index % 2);
            let of = &joints[index % 2];
            v.abs() <= part * of.largest_speed && a.abs() <= part * part * of.largest_acceleration
        });
        if !is_slow {
            continue;
        }
        for (k, joint) in (0..600).flat_map(|k| [(k, 0), (k, 1)]) {
            let [nominal, half_width] = set(&joints[joint], &run, k, joint);
            let before = waves.position(joint, part * (plan.times[k] - of.late_by));
            for y in [nominal - half_width, nominal + half_width] {
                assert!(
                    (y - plan.command[2 * k + joint]).abs() <= of.at_the_same_time[joint] + 1e-12
                );
                assert!((y - before).abs() <= of.along_the_path[joint] + 1e-12, "{number} {k}");
            }
        }
    }
}

/// A joint that never moved is in no plan that moves it, at any speed.
#[test]
fn a_joint_that_stood_still_is_not_moved_slowly_instead() {
    let mut recordings = servo(6);
    for of in &mut recordings {
        of.command.iter_mut().skip(1).step_by(2).for_each(|r| *r = 0.5);
        let noise = |(k, q): (usize, &mut f64)| *q = 0.5 + 1e-5 * f64::from(k as u32 % 3);
        of.actual.iter_mut().skip(1).step_by(2).enumerate().for_each(noise);
    }
    let text = made(&recordings).model.tube(&plan(104, 0.1)).unwrap_err().to_string();
    assert!(text.contains("of elbow") && !text.contains("% of its speed"), "{text}");
    assert!(text.contains("; make the model of recordings"), "{text}");
}
