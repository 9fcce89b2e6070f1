//! What stops are proved for beyond the robot's friction.

use reachtube_conform::{Code, Model, Problem};
use reachtube_finding::{Finding, Severity};
use reachtube_recordings::Torque;

use crate::correction::JointCorrection;
use crate::model::ArmModel;

/// Returns the warnings of [`Model::beyond_proof`] for stops, which have another reason: joints may
/// have less friction than the robot's description, where it changes with their warmth, or a fit
/// took a part of it off the inputs; and the model has no motors where torques were measured behind
/// the gears.
#[must_use]
pub fn beyond_proof_of_stops(model: &Model, problem: &Problem) -> Vec<Finding> {
    let mut all = model.beyond_proof(problem);
    all.extend(less_friction(model));
    all.extend(no_motors(model));
    all
}

fn no_motors(model: &Model) -> Option<Finding> {
    let preparation = model.preparation.as_ref().map(|done| done.torque);
    let is_behind = [Some(model.arm().settings.torque), preparation].contains(&Some(Torque::Link));
    let text = "The torques were measured behind the gears, so that the model has no inertia of \
                the motors. Brakes have to stop the motors, too: the ways are longer.";
    is_behind.then(|| Finding::new(Severity::Warning, Code::BeyondProof, text))
}

fn less_friction(model: &Model) -> Option<Finding> {
    let arm = model.arm();
    let warms = arm.robot.joints.iter().any(|joint| joint.friction.warming.is_some());
    let falls = |joint: &JointCorrection| {
        let parts = [&joint.coulomb[..], &[joint.warm_up, joint.warm_up_coulomb]].concat();
        parts.iter().any(|part| *part < 0.0)
    };
    let lowered = arm.correction.as_ref().is_some_and(|all| all.joints.iter().any(falls));
    let why = match (warms, lowered) {
        (true, _) => "it changes as the joints warm up",
        (false, true) => "the fit found less of it in some joints",
        (false, false) => return None,
    };
    let text = format!("Stops are proved with the friction in the robot's description: {why}.");
    Some(Finding::new(Severity::Warning, Code::BeyondProof, text))
}
