use crate::error::Result;
use crate::friction::fit::FrictionFit;
use crate::friction::joints::{coefficients, fit_joints};
use crate::gravity::fit::{GravityFit, fit_gravity};
use crate::prepare::log::PreparedLog;
use crate::samples::Sampling;
use crate::settings::ModelSettings;
use crate::stiction::{KnownFriction, one_sided};
use crate::variant::with_friction;
use reachtube_robot::{FrictionDescription, Robot};

/// Rounds of gravity and friction.
///
/// Each uses the result of the other. The second round corrects the load for the slopes of
/// friction.
const ROUNDS: usize = 3;

/// Gravity, and friction with the gravity torque as its load.
pub(crate) struct GravityAndFriction {
    /// The gravity fit; `None` without poses and slow motions.
    pub gravity: Option<GravityFit>,
    /// The friction fits of the joints that have enough samples.
    pub friction: Vec<FrictionFit>,
    /// Warnings about joints without a reliable friction fit.
    pub warnings: Vec<String>,
}

/// Fits gravity to poses at rest and slow motions, and friction to slow motions, in alternation.
pub(crate) fn fit_gravity_and_friction(
    robot: &Robot,
    rests: &[PreparedLog],
    slow: &[PreparedLog],
    sampling: &Sampling,
    model: &ModelSettings,
) -> Result<GravityAndFriction> {
    let mut found = GravityAndFriction { gravity: None, friction: Vec::new(), warnings: vec![] };
    if rests.is_empty() && slow.is_empty() {
        return Ok(found);
    }
    let frictionless = vec![FrictionDescription::default(); robot.joint_count()];
    let mut latest = with_friction(robot, &frictionless)?;
    for _ in 0..ROUNDS {
        let known = found
            .gravity
            .as_ref()
            .map(|gravity| KnownFriction { robot: &latest, deviations: &gravity.rest_deviations });
        let gravity = fit_gravity(robot, rests, slow, sampling, model, known)?;
        (found.friction, found.warnings) = fit_joints(&gravity.robot, slow, sampling);
        // This gravity is the load of the friction that is known in the next round.
        latest = with_friction(&gravity.robot, &coefficients(&found.friction, robot))?;
        found.gravity = Some(gravity);
    }
    if let Some(gravity) = &found.gravity {
        found.friction.iter_mut().for_each(|fit| fit.add_load_error(robot, &gravity.load_errors));
        found.warnings.extend(one_sided(robot, &gravity.poses.sides));
    }
    Ok(found)
}
