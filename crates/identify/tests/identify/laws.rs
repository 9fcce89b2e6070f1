//! Friction that saturates is found where it is.

use crate::lab::{Lab, geometry, lwa4p, simple_friction};
use reachtube_identify::Identification;
use reachtube_robot::Robot;
use reachtube_robot::friction::Stribeck;

/// Joint 1 has dry friction of 3 N m at standstill and 11 N m at high speeds, and all others have a
/// law that the fit contains.
#[test]
fn friction_that_saturates_is_found_where_it_is_and_predicts_better() {
    let mut description = simple_friction(&lwa4p()).description().clone();
    let friction = &mut description.joints[0].friction;
    friction.coulomb = [11.0, 0.0, -11.0, 0.0, -11.0, 0.0, 11.0, 0.0];
    friction.stribeck = Some(Stribeck { excess: -8.0, speed: 0.3 });
    let truth = Robot::from_description(&description).unwrap();
    let lab = Lab::new();
    lab.excite(&truth, 0.2, &[1.0; 6]);
    let mut settings = lab.settings();
    settings.model.windows = vec![];
    let found = lab.identify(&geometry(&truth), &settings);
    let names: Vec<&str> = found.saturating.iter().map(|law| law.joint.as_str()).collect();
    assert_eq!(names, ["joint1"], "{:?}", found.saturating);
    let law = &found.saturating[0];
    assert!((law.builds_up - 8.0).abs() < 1.5 && (law.speed - 0.3).abs() < 0.07, "{law:?}");
    assert!(law.held_out[1] < 0.8 * law.held_out[0], "{law:?}");
    let own = &found.description.joints[0].friction;
    assert!(own.saturates() && own.dissipates_at_standstill(), "{own:?}");
    let robot = Robot::from_toml(&found.robot_toml(), "found").unwrap();
    assert_eq!(robot.description().joints[0].friction, *own);
    // Without it, held-out motions are predicted worse, with a cubic too.
    let residual = |found: &Identification| found.validation.last().unwrap().joints[0].residual;
    settings.model.saturating = false;
    for cubic in [false, true] {
        settings.model.cubic = Some(cubic);
        let plain = lab.identify(&geometry(&truth), &settings);
        assert!(plain.saturating.is_empty());
        assert!(
            residual(&found) < 0.8 * residual(&plain),
            "{} {}",
            residual(&found),
            residual(&plain)
        );
    }
}
