//! Links on the boundary of the physical ones: flat plates, whose largest moment of inertia is the
//! sum of the others.

use crate::lab::{Lab, geometry};
use reachtube_robot::{Physicality, Robot};

/// Returns an arm of three flat links.
fn flat_arm() -> Robot {
    let link = |(name, alpha): (&str, f64)| {
        format!(
            "[[joint]]\nname = \"{name}\"\ndh = {{ a = 0.3, alpha = {alpha:?}, theta = 0.0, \
             d = 0.1 }}\nmass = 4.0\ncom = [-0.1, 0.0, 0.0]\n\
             inertia = [0.01, 0.0, 0.0, 0.03, 0.0, 0.04]\n\
             armature = 0.1\nfriction = {{ viscous = [2.0, 0.0, 0.0] }}\n"
        )
    };
    let links: String = [("a", 1.57), ("b", 0.0), ("c", 1.57)].map(link).concat();
    let text = format!("schema_version = 1\nname = \"flat\"\n{links}");
    Robot::from_toml(&text, "flat.toml").unwrap()
}

#[test]
fn flat_links_are_found_with_and_without_noise() {
    let truth = flat_arm();
    for noise in [0.0, 1e-4, 0.05] {
        let lab = Lab::new();
        lab.excite(&truth, noise, &[1.0; 3]);
        let mut settings = lab.settings();
        settings.model.windows = vec![];
        for robot in [geometry(&truth), truth.clone()] {
            let found = lab.identify(&robot, &settings);
            assert!(found.inertia.physical.is_some());
            assert!(found.warnings.is_empty(), "{noise}: {:?}", found.warnings);
            let found_robot = Robot::from_description(&found.description).unwrap();
            assert!(matches!(found_robot.check_physical(), Ok(Physicality::Links { .. })));
            for joint in &found.validation[0].joints {
                assert!(joint.residual < 1.02 * noise + 2e-3 * joint.torque, "{noise}: {joint:?}");
            }
        }
    }
}
