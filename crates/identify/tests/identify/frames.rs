//! The number of identifiable combinations and the condition do not depend on the frames of the
//! links.

use crate::lab::{Lab, geometry, lwa4p, simple_friction};
use crate::virtual_robot::{Random, Recorder, slow};
use reachtube_identify::{Identification, IdentifySettings};
use reachtube_robot::{PlacementDescription, Robot};
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;

/// Denavit-Hartenberg parameters a \[m\], alpha \[rad\] and d \[m\] of a 6-joint arm.
const ARM: [[f64; 3]; 6] = [
    [0.0, FRAC_PI_2, 0.18],
    [-0.61, 0.0, 0.0],
    [-0.57, 0.0, 0.0],
    [0.0, FRAC_PI_2, 0.17],
    [0.0, -FRAC_PI_2, 0.12],
    [0.0, 0.0, 0.12],
];

/// Returns the geometry of the arm in standard or modified Denavit-Hartenberg parameters.
///
/// In the modified convention, a and alpha belong to the joint after.
fn denavit_hartenberg(modified: bool) -> Robot {
    let joint = |k: usize| {
        let before = if k == 0 { [0.0; 3] } else { ARM[k - 1] };
        let [a, alpha, _] = if modified { before } else { ARM[k] };
        format!(
            "[[joint]]\nname = \"joint{}\"\ndh = {{ a = {a:?}, alpha = {alpha:?}, theta = 0.0, d = \
             {:?} }}\n",
            k + 1,
            ARM[k][2]
        )
    };
    let convention = if modified { "modified" } else { "standard" };
    let joints: String = (0..ARM.len()).map(joint).collect();
    let head = format!("schema_version = 1\nname = \"arm\"\nconvention = \"{convention}\"\n");
    Robot::from_toml(&format!("{head}{joints}"), "arm.toml").unwrap()
}

/// Returns the same arm with each link's frame moved along its joint's axis \[m\].
fn moved(robot: &Robot, distance: f64) -> Robot {
    let mut description = robot.description().clone();
    for joint in &mut description.joints {
        let dh = joint.dh.take().unwrap();
        let (s, c) = dh.alpha.sin_cos();
        // In the modified convention: rotation by alpha and translation by a along x, then d along
        // z. The frame before moved by `distance` along its own z, and this one does along its own.
        let along = dh.d + distance;
        let before = if joint.name == "joint1" { 0.0 } else { distance };
        joint.placement = Some(PlacementDescription {
            translation: [dh.a, -s * along, c * along - before],
            rpy: Some([dh.alpha, 0.0, 0.0]),
            rotation: None,
        });
    }
    Robot::from_description(&description).unwrap()
}

fn identified(lab: &Lab, robot: &Robot, settings: &IdentifySettings) -> Identification {
    let mut settings = settings.clone();
    settings.model.physical = Some(true);
    settings.model.windows = vec![];
    settings.validate = vec![];
    lab.identify(robot, &settings)
}

#[test]
fn frames_change_neither_the_count_nor_the_condition() {
    let [standard, modified] = [false, true].map(denavit_hartenberg);
    let far = moved(&modified, 4.0);
    // The torque comes from an arm with masses in the standard frames.
    let mut description = standard.description().clone();
    for joint in &mut description.joints {
        (joint.mass, joint.com) = (4.0, Some([0.1, 0.02, 0.03]));
        (joint.inertia, joint.armature) = ([0.05, 0.0, 0.0, 0.06, 0.0, 0.04], Some(0.3));
    }
    let truth = simple_friction(&Robot::from_description(&description).unwrap());
    let lab = Lab::new();
    lab.excite(&truth, 0.3, &[1.0; 6]);
    let found = [&standard, &modified, &far].map(|robot| identified(&lab, robot, &lab.settings()));
    let [first, others @ ..] = &found;
    assert_eq!(first.inertia.determined, first.inertia.parameters.len());
    for other in others {
        let (a, b) = (&first.inertia, &other.inertia);
        assert_eq!((a.determined, a.parameters.len()), (b.determined, b.parameters.len()));
        assert!((a.condition / b.condition - 1.0).abs() < 1e-3, "{} {}", a.condition, b.condition);
        for (a, b) in a.joints.iter().zip(&b.joints) {
            assert!((a.residual / b.residual - 1.0).abs() < 1e-4, "{a:?} {b:?}");
        }
    }
}

#[test]
fn frames_do_not_change_what_stays_open() {
    let truth = simple_friction(&lwa4p());
    let lab = Lab::new();
    let mut recorder =
        Recorder { robot: &truth, noise: 0.1, gains: vec![1.0; 6], random: Random::new(5) };
    recorder.record(&lab.path().join("one.csv"), 20.0, slow(6, 1, 0.3));
    let mut settings = lab.settings();
    settings.excitation = vec![PathBuf::from("one.csv").into()];
    let found = identified(&lab, &geometry(&truth), &settings);
    assert!(found.inertia.determined < found.inertia.parameters.len());
    assert!(found.inertia.condition.is_infinite());
    let open = found.inertia.parameters.len() - found.inertia.determined;
    let words = format!("do not determine {open} of");
    assert!(found.warnings.iter().any(|w| w.contains(&words)), "{:?}", found.warnings);
}
