//! Plans that an arm follows under its controller, as reachable sets.

use std::path::Path;

use reachtube_conform::SuiteReach;
use reachtube_finding::{Finding, Severity};
use reachtube_reach::StepBounds;
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::sub_up;
use reachtube_tracking::{Plan, TrackingModel};
use reachtube_verify::{Body, Capsules};

use crate::code::Code;
use crate::error::Result;

/// The warning where a model is used that is no better than none.
pub const NOT_USEFUL: &str = "The model is not proved, or its sets are no narrower than the \
                              largest error + 20 %, or they describe its recordings only; \
                              `reachtube model` names the reason.";

/// Returns the reachable set of an arm that follows a plan under its controller. Its nominal motion
/// is the plan, so that distances from the nominal motion are distances from the plan.
///
/// # Guarantee
///
/// Outer, directed rounding, as [`TrackingModel::tube`]. The velocities are what the positions may
/// do between samples; nothing is claimed of recorded velocities.
///
/// # Errors
///
/// A plan that is faster than the recordings of the model.
pub fn followed(model: &TrackingModel, plan: &Plan) -> Result<SuiteReach> {
    let tube = model.tube(plan)?;
    let (n, samples) = (plan.joints.len(), plan.times.len());
    let velocity = |step: usize, joint: usize| tube.velocities[step * n + joint];
    // At a sample the velocities of both steps are possible.
    let at_sample = |k: usize, joint: usize| {
        let [before, after] = [k.max(1) - 1, k.min(samples - 2)].map(|step| velocity(step, joint));
        before.hull(after)
    };
    let (mut nominal, mut lower, mut upper) = (vec![], vec![], vec![]);
    for k in 0..samples {
        let of_sample = k * n..(k + 1) * n;
        let velocities: Vec<Interval> = (0..n).map(|joint| at_sample(k, joint)).collect();
        nominal.extend_from_slice(&plan.command[of_sample.clone()]);
        nominal.extend(velocities.iter().map(|of| of.mid()));
        lower.extend_from_slice(&tube.lower[of_sample.clone()]);
        lower.extend(velocities.iter().map(|of| of.lo()));
        upper.extend_from_slice(&tube.upper[of_sample]);
        upper.extend(velocities.iter().map(|of| of.hi()));
    }
    // A position strays from the line between two samples by a quarter of the step times the width
    // of its velocity, at most.
    let position = |step: usize, joint: usize| {
        let [here, next] = [step, step + 1].map(|k| {
            let at = k * n + joint;
            Interval::point(tube.lower[at]).hull(Interval::point(tube.upper[at]))
        });
        let duration = sub_up(plan.times[step + 1], plan.times[step]);
        let bulge = Interval::point(0.25) * duration * velocity(step, joint).width();
        here.hull(next) + Interval::centred(0.0, bulge.hi())
    };
    let steps = (0..samples - 1).flat_map(|step| {
        let positions = (0..n).map(move |joint| position(step, joint));
        positions.chain((0..n).map(move |joint| velocity(step, joint))).collect::<Vec<_>>()
    });
    let tube_bounds = StepBounds::from_boxes(2 * n, steps.collect());
    Ok(SuiteReach {
        suite: plan.name(),
        run: None,
        times: plan.times.clone(),
        nominal,
        lower,
        upper,
        tube: tube_bounds,
        dimension: 2 * n,
        lost: None,
    })
}

/// Returns why a verdict about plans says less of the robot than of its model.
pub(crate) fn beyond_proof_of_plans(model: &TrackingModel) -> Vec<Finding> {
    let warning = Finding::new(Severity::Warning, Code::ModelNotUseful, NOT_USEFUL);
    (!model.is_useful()).then_some(warning).into_iter().collect()
}

/// Loads the robot whose joints a model of an arm under its controller names.
///
/// # Errors
///
/// A robot that cannot be read, or has other joints.
pub fn robot_of(model: &TrackingModel, robot: &str) -> Result<Robot> {
    let (loaded, _) = Robot::load_to_identify(robot, &[])?;
    let joints: Vec<String> = loaded.joints().iter().map(|joint| joint.name.clone()).collect();
    model.refuse_other(robot.as_ref(), &joints)?;
    Ok(loaded)
}

/// Returns the links of a robot that was loaded by name or path: with the capsules of a file, or
/// without one the collision shapes of its URDF, or the embedded ones.
///
/// # Errors
///
/// As [`Capsules::open`].
pub fn body_of(robot: &Robot, name: &str, capsules: Option<&Path>) -> Result<Body> {
    let own = Path::new(name);
    let is_urdf = own.extension().is_some_and(|it| it.eq_ignore_ascii_case("urdf"));
    let shapes = capsules.or(is_urdf.then_some(own));
    Ok(Body::new(robot, &Capsules::open(shapes, robot)?))
}
