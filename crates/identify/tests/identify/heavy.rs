//! The prior of physical links must not outweigh the data of a heavy arm.

use crate::lab::{Lab, geometry, simple_friction};
use reachtube_identify::Identification;
use reachtube_robot::{ParameterSet, Robot, RobotDescription};
use std::f64::consts::FRAC_PI_2;

/// Translation \[m\], rotation \[rad\], mass \[kg\] and centre of mass \[m\] of a link.
type Link = ([f64; 3], [f64; 3], f64, [f64; 3]);

/// The links of an arm of 300 kg.
const LINKS: [Link; 6] = [
    ([0.0, 0.0, 0.6], [0.0, 0.0, 0.0], 110.0, [0.1, 0.0, -0.1]),
    ([0.3, 0.0, 0.2], [-FRAC_PI_2, 0.0, 0.0], 85.0, [0.5, 0.0, 0.1]),
    ([1.1, 0.0, 0.0], [0.0, 0.0, 0.0], 60.0, [0.1, -0.2, 0.0]),
    ([0.2, -0.9, 0.0], [FRAC_PI_2, 0.0, 0.0], 28.0, [0.0, 0.0, -0.3]),
    ([0.0, 0.0, 0.2], [-FRAC_PI_2, 0.0, 0.0], 12.0, [0.0, 0.05, 0.0]),
    ([0.0, -0.2, 0.0], [FRAC_PI_2, 0.0, 0.0], 5.0, [0.02, 0.0, 0.05]),
];

/// Returns the arm with friction.
fn heavy_arm() -> Robot {
    let link = |(k, (translation, rpy, mass, com)): (usize, &Link)| {
        let inertia = [0.06 * mass, 0.0, 0.0, 0.05 * mass, 0.0, 0.04 * mass];
        format!(
            "[[joint]]\nname = \"joint{}\"\nplacement = {{ translation = {translation:?}, rpy = \
             {rpy:?} }}\nmass = {mass:?}\ncom = {com:?}\ninertia = {inertia:?}\narmature = \
             {:?}\n",
            k + 1,
            0.3 * mass
        )
    };
    let links: String = LINKS.iter().enumerate().map(link).collect();
    let text = format!("schema_version = 1\nname = \"heavy\"\n{links}");
    simple_friction(&Robot::from_toml(&text, "heavy.toml").unwrap())
}

fn with(robot: &Robot, change: impl Fn(&mut RobotDescription)) -> Robot {
    let mut description = robot.description().clone();
    change(&mut description);
    Robot::from_description(&description).unwrap()
}

/// Returns the largest ratio of the errors of the identified robot and of plain least squares over
/// the joints, in recordings that were held out.
fn worst_ratio(found: &Identification) -> f64 {
    assert!(found.held_out);
    let joints = found.validation.last().unwrap().joints.iter();
    let ratios: Vec<f64> =
        joints.map(|j| j.relative.unwrap() / j.relative_plain.unwrap()).collect();
    assert!(ratios.len() == 6 && ratios.iter().all(|ratio| ratio.is_finite()), "{ratios:?}");
    ratios.into_iter().fold(0.0, f64::max)
}

#[test]
fn a_description_without_masses_does_not_outweigh_a_heavy_arm() {
    let truth = heavy_arm();
    let lab = Lab::new();
    lab.excite(&truth, 1.0, &[1.0; 6]);
    let mut settings = lab.settings();
    settings.model.windows = vec![];
    let found = lab.identify(&geometry(&truth), &settings);
    let physical = found.inertia.physical.as_ref().unwrap();
    assert_eq!(physical.balls.len(), 6);
    assert!(worst_ratio(&found) < 1.1, "{:?}", found.validation);
    assert!(physical.residuals.iter().all(|[plain, physical]| *physical < 1.1 * plain));
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
}

#[test]
fn masses_that_contradict_the_data_are_named_with_the_remedies() {
    let truth = heavy_arm();
    let lab = Lab::new();
    lab.excite(&truth, 1.0, &[1.0; 6]);
    let mut settings = lab.settings();
    settings.model.windows = vec![];
    // A description with links of a toy.
    let toy = with(&truth, |description| {
        for joint in &mut description.joints {
            (joint.mass, joint.com, joint.inertia) = (0.1, None, [1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4]);
        }
    });
    let found = lab.identify(&toy, &settings);
    let grown: Vec<&String> =
        found.warnings.iter().filter(|w| w.contains("physical links raise the residual")).collect();
    let [_, first, ..] = &grown[..] else { panic!("{:?}", found.warnings) };
    for part in ["joint", "N m", "masses in the description", "prior_strength", "\"base\""] {
        assert!(first.contains(part), "{part}: {first}");
    }
    // The remedies help.
    settings.model.prior_strength = 1e-6;
    let weak = lab.identify(&toy, &settings);
    assert!(worst_ratio(&weak) < 1.1 && weak.warnings.is_empty(), "{:?}", weak.warnings);
    settings.model.prior_strength = 1.0;
    let base = with(&toy, |description| description.parameters = ParameterSet::Base);
    let plain = lab.identify(&base, &settings);
    assert!(plain.inertia.physical.is_none(), "base parameters must not become bodies");
    assert!((worst_ratio(&plain) - 1.0).abs() < 1e-6, "{:?}", plain.validation);
    assert_eq!(plain.description.parameters, ParameterSet::Base);
}
