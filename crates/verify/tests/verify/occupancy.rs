//! Sampled states of a tube lie in the swept capsules, which are not much wider than they must be.

use nalgebra::Vector3;
use reachtube_reach::StepBounds;
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_verify::{Body, Capsules};

use crate::common::{Random, askew, distance, placed};

/// Samples states in boxes of several sizes; each link's capsule lies in the swept one. Returns the
/// largest part of the radius's growth that a sample needed.
fn sampled(robot: &Robot, capsules: &Capsules, samples: usize, sizes: &[f64]) -> f64 {
    let (body, n) = (Body::new(robot, capsules), robot.joint_count());
    let mut random = Random::new(7);
    let mut used = 0.0f64;
    for size in sizes {
        let centre = random.vector(n, 2.0);
        let side = |(c, r): (&f64, f64)| Interval::centred(*c, r);
        let radii = random.vector(n, *size).into_iter().map(f64::abs);
        let positions: Vec<Interval> = centre.iter().zip(radii).map(side).collect();
        let tube = [positions.clone(), vec![Interval::ZERO; n]].concat();
        let occupancy = body.occupancy(&StepBounds::from_boxes(2 * n, tube));
        assert_eq!(occupancy.len(), 1);
        for sample in 0..samples / sizes.len() {
            // Every other sample is a vertex.
            let part = |x: f64| if sample % 2 == 0 { x.signum() } else { x };
            let at = |p: &Interval| p.mid() + part(random.signed()) * p.rad();
            let q: Vec<f64> = positions
                .iter()
                .map(at)
                .zip(&positions)
                .map(|(q, p)| q.clamp(p.lo(), p.hi()))
                .collect();
            for (capsule, swept) in capsules.as_slice().iter().zip(&occupancy[0]) {
                let segment = [swept.from, swept.to].map(Vector3::from);
                let grown = swept.radius - capsule.radius;
                for end in placed(robot, capsule, &q) {
                    let needed = distance(end, segment);
                    assert!(needed <= grown + 1e-13, "{needed} {grown} at {q:?}");
                    used = used.max(needed / grown);
                }
            }
        }
    }
    used
}

const SIZES: [f64; 5] = [0.0, 1e-4, 0.01, 0.1, 1.0];

#[test]
fn sampled_states_of_the_lwa4p_lie_in_the_swept_capsules() {
    let robot = Robot::lwa4p();
    let capsules = Capsules::embedded(&robot).unwrap();
    sampled(&robot, &capsules, 10_000, &SIZES);
    // The enclosure is close: a vertex needs most of it where the box is as small as a tube's.
    assert!(sampled(&robot, &capsules, 2_000, &[0.01]) > 0.9);
}

#[test]
fn sampled_states_of_a_robot_with_a_slide_and_skew_axes_lie_in_the_swept_capsules() {
    let urdf = askew();
    let capsules = Capsules::of_urdf(&urdf, std::path::Path::new("")).unwrap();
    sampled(urdf.robot(), &capsules, 10_000, &SIZES);
    assert!(sampled(urdf.robot(), &capsules, 2_000, &[0.01]) > 0.9);
}

#[test]
#[ignore = "takes long"]
fn a_million_sampled_states_lie_in_the_swept_capsules() {
    let robot = Robot::lwa4p();
    let capsules = Capsules::embedded(&robot).unwrap();
    let sizes: Vec<f64> = (0..1000).map(|k| 10f64.powf(-4.0 + 0.004 * f64::from(k))).collect();
    sampled(&robot, &capsules, 1_000_000, &sizes);
}

#[test]
fn a_box_without_bound_gives_capsules_without_bound() {
    let robot = Robot::lwa4p();
    let body = Body::new(&robot, &Capsules::embedded(&robot).unwrap());
    let tube = StepBounds::from_boxes(12, vec![Interval::ENTIRE; 12]);
    let occupancy = body.occupancy(&tube);
    assert!(occupancy[0].iter().all(|swept| swept.radius == f64::INFINITY));
}
