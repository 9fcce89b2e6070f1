//! Verdicts about plans, against motions of the arm that stay in the sets of its model.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus as Random;
use reachtube_pipeline::followed;
use reachtube_robot::Robot;
use reachtube_tracking::{JointTracking, NeedsOfMotions, Plan, TrackingModel};
use reachtube_verify::{Answer, Body, Capsules, NextStep, Obstacle, Scene, Solid, verify_plan};

/// A model of the embedded arm, late by 9 to 14 ms, within 2 mrad.
fn model() -> TrackingModel {
    let joint = |(index, of): (usize, &reachtube_robot::Joint)| JointTracking {
        name: of.name.clone(),
        unit: "rad".into(),
        offset: 2e-4,
        speed: -9e-3 - 1e-3 * index as f64,
        acceleration: 0.0,
        direction: -4e-4,
        radius: 1e-3,
        radius_per_speed: 1e-3,
        largest_speed: 1.5,
        largest_acceleration: 20.0,
        largest_error: 0.03,
        largest_change: 5e-4,
    };
    TrackingModel {
        format: String::new(),
        version: 0,
        tool: String::new(),
        verified: true,
        delay: 0.0,
        joints: Robot::lwa4p().joints().iter().enumerate().map(joint).collect(),
        links: vec![],
        factor: 1.2,
        step: 0.01,
        left_out: NeedsOfMotions { motions: 9, calibrated: None, furthest: None, inside: None },
        recordings: vec![],
        columns: reachtube_recordings::ColumnSettings::default(),
        log: reachtube_recordings::LogSettings::default(),
        sha256: String::new(),
    }
}

/// A plan of 1 s with waves in each joint.
fn plan(random: &mut Random) -> Plan {
    let waves: Vec<[f64; 4]> = (0..6)
        .map(|_| {
            let [start, size] = [random.random_range(-1.5..1.5), random.random_range(-0.3..0.3)];
            [start, size, random.random_range(1.0..4.0), random.random_range(0.0..6.0)]
        })
        .collect();
    let times: Vec<f64> = (0..51).map(|k| 0.02 * f64::from(k)).collect();
    let at = |t: &f64| -> Vec<f64> {
        waves
            .iter()
            .map(|[start, size, rate, from]| start + size * (rate * t + from).sin())
            .collect()
    };
    Plan {
        file: "plan.csv".into(),
        joints: Robot::lwa4p().joints().iter().map(|of| of.name.clone()).collect(),
        units: vec!["rad"; 6],
        command: times.iter().flat_map(at).collect(),
        times,
    }
}

/// Positions of the arm on four times of each step: errors at corners of the sets of both samples,
/// which change sign now and then, and straight in between.
fn motion(model: &TrackingModel, plan: &Plan, random: &mut Random) -> Vec<(f64, Vec<f64>)> {
    let tube = model.tube(plan).unwrap();
    let samples = plan.times.len();
    let mut signs: Vec<f64> =
        (0..6).map(|_| if random.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 }).collect();
    let mut corners = Vec::new();
    for k in 0..samples {
        if random.random_range(0.0..1.0) < 0.1 {
            signs[random.random_range(0.0..6.0) as usize] *= -1.0;
        }
        corners.extend((0..6).map(|joint| {
            let at = 6 * k + joint;
            let half = 0.5 * (tube.upper[at] - tube.lower[at]);
            0.5 * (tube.upper[at] + tube.lower[at]) + signs[joint] * half * (1.0 - 1e-9)
        }));
    }
    let at = |index: usize| {
        let (k, part) = (index / 4, (index % 4) as f64 / 4.0);
        let time = plan.times[k] + part * (plan.times[k + 1] - plan.times[k]);
        let chord = |joint: usize| {
            (1.0 - part) * corners[6 * k + joint] + part * corners[6 * (k + 1) + joint]
        };
        (time, (0..6).map(chord).collect())
    };
    (0..(samples - 1) * 4).map(at).collect()
}

/// The distance of a point from the capsules of a link, in floating point.
fn distance(robot: &Robot, body: &Body, q: &[f64], point: [f64; 3]) -> f64 {
    let frames = robot.link_placements(q);
    let of = |capsule: &reachtube_verify::Capsule| {
        let frame = &frames[capsule.joint];
        let place = |p: [f64; 3]| frame.rotation * nalgebra::Vector3::from(p) + frame.translation;
        let [from, to] = [capsule.from, capsule.to].map(place);
        let (along, beside) = (to - from, nalgebra::Vector3::from(point) - from);
        let part = match along.norm_squared() {
            0.0 => 0.0,
            square => (along.dot(&beside) / square).clamp(0.0, 1.0),
        };
        (beside - along * part).norm() - capsule.radius
    };
    body.capsules().iter().map(of).fold(f64::INFINITY, f64::min)
}

fn arm() -> (Robot, Body) {
    let robot = Robot::lwa4p();
    let body = Body::new(&robot, &Capsules::embedded(&robot).unwrap());
    (robot, body)
}

/// Scenarios: a ball beside a link somewhere on the plan, at up to 10 mm, which stands
/// or comes closer. No motion touches where the answer is "safe"; where it is "unsafe", the motion
/// that was found does.
fn check_scenarios(count: usize) {
    let (model, (robot, body)) = (model(), arm());
    let mut answers = [0; 3];
    for number in 0.. {
        if answers.iter().sum::<usize>() == count {
            break;
        }
        let mut random = Random::seed_from_u64(number);
        let plan = plan(&mut random);
        let k = random.random_range(5.0..45.0) as usize;
        let q = &plan.command[6 * k..6 * k + 6];
        let tip = &robot.link_placements(q)[random.random_range(2.0..6.0) as usize];
        let mut away = || random.random_range(-0.2..0.2);
        let centre =
            [tip.translation.x + away(), tip.translation.y + away(), tip.translation.z + away()];
        let gap = distance(&robot, &body, q, centre);
        let closest =
            (0..51).map(|k| distance(&robot, &body, &plan.command[6 * k..6 * k + 6], centre));
        let radius = closest.fold(gap, f64::min) - random.random_range(-2e-3..10e-3);
        if radius < 1e-3 {
            continue;
        }
        let speed = if number % 3 == 0 { 0.02 } else { 0.0 };
        let solid = Solid::Capsule { from: centre, to: centre, radius };
        let obstacles = vec![Obstacle { name: "ball".into(), solid, speed, joints: None }];
        let scene = Scene { obstacles, clearance: 0.0, refine: 8 };
        let reach = followed(&model, &plan).unwrap();
        let slower = |_: f64| None;
        let answer = verify_plan(&robot, (&body, &scene), &slower, reach).unwrap();
        answers[answer.answer as usize] += 1;
        if answer.answer != Answer::Safe {
            continue;
        }
        let all = motion(&model, &plan, &mut random);
        let left = |(time, q): &(f64, Vec<f64>)| {
            distance(&robot, &body, q, centre) - radius - speed * time
        };
        let left = all.iter().map(left).fold(f64::INFINITY, f64::min);
        assert!(left > 0.0, "scenario {number}: {left} m");
        assert!(left >= answer.clearances[0].distance - 1e-12, "scenario {number}");
    }
    println!("safe, undecided, unsafe: {answers:?}");
    assert!(answers[0] > count / 4 && answers[2] > count / 4, "{answers:?}");
}

#[test]
fn nothing_that_is_called_safe_touches() {
    check_scenarios(150);
}

#[test]
#[ignore = "takes long"]
fn nothing_of_a_thousand_that_is_called_safe_touches() {
    check_scenarios(1000);
}

/// Links stay within their margins of the plan, and within what the model bounds for every plan.
#[test]
fn links_stay_within_their_margins_of_the_plan() {
    let (model, (robot, body)) = (model(), arm());
    let ranges = vec![reachtube_scalar::Interval::centred(0.0, 7.0); 6];
    let bounds = body.largest_ways(&ranges, &model.deviations(1.0).at_the_same_time);
    let mut largest = vec![[0.0f64; 2]; 6];
    for number in 0..300 {
        let mut random = Random::seed_from_u64(5000 + number);
        let plan = plan(&mut random);
        let margins = body.margins(&followed(&model, &plan).unwrap());
        for (k, (_, q)) in motion(&model, &plan, &mut random).iter().step_by(4).enumerate() {
            let [planned, actual] =
                [&plan.command[6 * k..6 * k + 6], q].map(|q| robot.link_placements(q));
            for (capsule, bound) in body.capsules().iter().zip(&bounds) {
                let joint = capsule.joint;
                let margin = margins.iter().find(|of| of.joint == joint).unwrap().distance;
                for end in [capsule.from, capsule.to].map(nalgebra::Vector3::from) {
                    let [was, is] = [&planned, &actual]
                        .map(|of| of[joint].rotation * end + of[joint].translation);
                    let moved = (is - was).norm();
                    assert!(moved <= margin + 1e-12 && moved <= *bound, "{moved} {margin} {bound}");
                    largest[joint] = [
                        largest[joint][0].max(moved / margin),
                        largest[joint][1].max(moved / bound),
                    ];
                }
            }
        }
    }
    // The margins are not much larger than what is reached.
    assert!(largest[5][0] > 0.8 && largest[5][1] > 0.2, "{largest:?}");
}

/// What is named decides: a lower speed, where the sets are narrower at it, or else smaller sets.
#[test]
fn what_would_make_a_plan_safe_is_named_and_does() {
    let (robot, body) = arm();
    let (mut slower, mut smaller) = (0, 0);
    for number in 0..40 {
        let mut model = model();
        let plan = plan(&mut Random::seed_from_u64(700 + number));
        let q = &plan.command[6 * 25..6 * 26];
        let tip = robot.link_placements(q)[5].translation;
        let centre = [tip.x, tip.y, tip.z + 0.4];
        let places = plan.command.chunks_exact(6);
        let closest = places.map(|q| distance(&robot, &body, q, centre));
        let closest = closest.fold(f64::INFINITY, f64::min);
        let decide = |model: &TrackingModel, part: f64, gap: f64| {
            let at_speed = |part: f64| followed(model, &plan.slowed(part)).ok();
            let solid = Solid::Capsule { from: centre, to: centre, radius: closest - gap };
            let obstacles = vec![Obstacle { name: "ball".into(), solid, speed: 0.0, joints: None }];
            let scene = Scene { obstacles, clearance: 0.0, refine: 64 };
            let reach = at_speed(part).unwrap();
            verify_plan(&robot, (&body, &scene), &at_speed, reach).unwrap()
        };
        let gaps = [4e-3, 3e-3, 2e-3, 1e-3, 5e-4];
        let tried = gaps.map(|gap| (gap, decide(&model, 1.0, gap)));
        let Some((gap, first)) = tried.iter().find(|(_, of)| of.answer != Answer::Safe) else {
            continue;
        };
        match first.advice {
            Some(NextStep::Slower(part)) => {
                assert_eq!(decide(&model, part, *gap).answer, Answer::Safe, "{number}: {part}");
                slower += 1;
            }
            Some(NextStep::SmallerSets(factor)) if factor > 0.0 => {
                for joint in &mut model.joints {
                    joint.radius *= factor;
                    joint.radius_per_speed *= factor;
                    joint.largest_change *= factor;
                }
                assert_eq!(decide(&model, 1.0, *gap).answer, Answer::Safe, "{number}: {factor}");
                smaller += 1;
            }
            other => assert!(other.is_some(), "{number}"),
        }
    }
    println!("slower {slower}, smaller {smaller}");
    assert!(slower > 5 && smaller > 0, "slower {slower}, smaller {smaller}");
}
