//! The margin of each link contains sampled deviations from the nominal motion.

use reachtube_conform::SuiteReach;
use reachtube_reach::StepBounds;
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_verify::{Body, Capsules};

use crate::common::{Random, placed};

const STEP: f64 = 0.02;

/// Reachable sets of three samples: positions within `radius` of the nominal motion, and
/// velocities within `slack` of its slope.
fn reach(n: usize, radius: f64, slack: f64) -> SuiteReach {
    let position = |k: usize, i: usize| (0.3 * i as f64 + 1.2 * STEP * k as f64).sin();
    let (mut nominal, mut lower, mut upper, mut boxes) = (vec![], vec![], vec![], vec![]);
    for k in 0..3 {
        let sizes = |k: usize| radius * (1.0 + k as f64);
        for i in 0..n {
            nominal.push(position(k, i));
            lower.push(position(k, i) - sizes(k));
            upper.push(position(k, i) + 0.5 * sizes(k));
        }
        for list in [&mut nominal, &mut lower, &mut upper] {
            list.extend(vec![0.0; n]);
        }
        if k < 2 {
            boxes.extend((0..n).map(|_| Interval::ENTIRE));
            boxes.extend((0..n).map(|i| {
                let slope = (position(k + 1, i) - position(k, i)) / STEP;
                // Between two samples a deviation may change from one end to the other.
                Interval::centred(slope, slack + 3.0 * radius / STEP)
            }));
        }
    }
    SuiteReach {
        suite: "A".into(),
        run: None,
        times: vec![0.0, STEP, 2.0 * STEP],
        nominal,
        lower,
        upper,
        tube: StepBounds::from_boxes(2 * n, boxes),
        dimension: 2 * n,
        lost: None,
    }
}

#[test]
fn motions_within_the_tube_stay_within_the_margin_of_the_straight_nominal_motion() {
    let robot = Robot::lwa4p();
    let capsules = Capsules::embedded(&robot).unwrap();
    let body = Body::new(&robot, &capsules);
    let mut random = Random::new(5);
    for (radius, slack) in [(0.003, 0.0), (0.0, 0.5), (0.002, 0.3)] {
        let reach = reach(6, radius, slack);
        let margins = body.margins(&reach);
        assert_eq!(margins.iter().map(|m| m.joint).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
        let mut used = 0.0f64;
        for _ in 0..3000 {
            let k = usize::from(random.signed() > 0.0);
            let s = 0.5 + 0.5 * random.signed();
            let at = |k: usize, i: usize, list: &[f64]| list[k * 12 + i];
            let (mut straight, mut moved) = (vec![], vec![]);
            for i in 0..6 {
                let chord = |a: f64, b: f64| (1.0 - s) * a + s * b;
                let mut end = |k| {
                    let (low, high) = (at(k, i, &reach.lower), at(k, i, &reach.upper));
                    if random.signed() > 0.0 { low } else { high }
                };
                let ends = [end(k), end(k + 1)];
                // The furthest from its chord is the motion at one end of the velocities, then at
                // the other, if these enclose the chord's slope evenly.
                let slope = (ends[1] - ends[0]) / STEP;
                let velocity = reach.tube.bounds(k)[6 + i];
                let room = (velocity.hi() - slope).min(slope - velocity.lo()).max(0.0);
                let zigzag = random.signed().signum() * room * STEP * s.min(1.0 - s);
                straight.push(chord(at(k, i, &reach.nominal), at(k + 1, i, &reach.nominal)));
                moved.push(chord(ends[0], ends[1]) + zigzag);
            }
            for (capsule, margin) in capsules.as_slice().iter().zip(&margins) {
                let ends = placed(&robot, capsule, &straight).into_iter();
                for (a, b) in ends.zip(placed(&robot, capsule, &moved)) {
                    let distance = (a - b).norm();
                    assert!(distance <= margin.distance + 1e-13, "{distance} {margin:?}");
                    used = used.max(distance / margin.distance.max(1e-12));
                }
            }
        }
        assert!(used > 0.6, "{used} of the margin at radius {radius}, slack {slack}");
    }
}
