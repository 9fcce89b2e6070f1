use reachtube_abstraction::ModelKind;
use reachtube_conform::settings::Method;
use reachtube_diagnose::{Change, Hypothesis, RobotMisfit, gains};
use reachtube_finding::Finding;
use reachtube_recordings::Run;
use reachtube_robot::JointDescription;

use crate::arm::Arm;
use crate::cause::Cause;
use crate::settings::Equations;

/// The inertia at the mean of the positions is named when the unexplained part is this part at most
/// of that at the expansion point.
const LARGEST_OF_MEAN: f64 = 0.7;

/// A robot that leaves less than this part of the input unexplained is not to blame for sets that
/// widen over a long time ...
const LARGEST_OF_GOOD: f64 = 0.25;

/// ... which is longer than this, s.
const LONG: f64 = 1.0;

/// Returns what most likely makes an answer about runs implausible: the reading of the recordings
/// under which the robot's dynamics agree best with them, where it is much better than the one that
/// was stated, and otherwise the cause that is known. `None` where the recordings are too short to
/// show one.
pub(super) fn likely_cause(
    arm: &Arm,
    runs: Vec<Run>,
    method: Method,
    held_out: Option<Finding>,
) -> Option<Finding> {
    let misfit = RobotMisfit::new(arm.robot(), runs);
    let stated = Change::none(arm.settings.torque, arm.robot().joint_count());
    let Some((rest, reading)) = misfit.reading(&stated) else { return held_out };
    if let Some((hypothesis, unexplained)) = reading {
        let clause = hypothesis.clause(arm.robot());
        let kind = match hypothesis {
            Hypothesis::Kind(kind) => Some(kind),
            _ => None,
        };
        return Some(Cause::Reading { clause, kind, unexplained, as_stated: rest }.warning());
    }
    if held_out.is_some() {
        return held_out;
    }
    let lost = lost_by_model(arm, method, &misfit, &stated, rest);
    let cause = lost.unwrap_or_else(|| horizon_or_parameters(arm, misfit.longest(), rest));
    Some(cause.warning())
}

/// Returns the cause where the recordings mean what was stated, and the robot leaves `unexplained`
/// of the input: recordings as long as `longest`, s, or else parameters. What was applied already
/// is no remedy.
fn horizon_or_parameters(arm: &Arm, longest: f64, unexplained: f64) -> Cause {
    if unexplained < LARGEST_OF_GOOD && longest > LONG {
        return Cause::Horizon { unexplained, longest };
    }
    let description = arm.robot().description();
    let errors = |joint: &JointDescription| joint.friction.standard_errors.is_some();
    let is_identified = description.joints.iter().any(errors);
    let is_fitted = arm.correction.is_some();
    Cause::Parameters { unexplained, is_identified, is_fitted, longest }
}

/// Returns what the constant inertia of model 1 does not explain, where the robot itself leaves
/// `rest` unexplained, and the model much more.
fn lost_by_model(
    arm: &Arm,
    method: Method,
    misfit: &RobotMisfit,
    stated: &Change,
    rest: f64,
) -> Option<Cause> {
    let settings = &arm.settings;
    if settings.abstraction.model != ModelKind::One {
        return None;
    }
    let at =
        |q: &[f64]| misfit.unexplained(&Change { inertia_at: Some(q.to_vec()), ..stated.clone() });
    let origin = &settings.expansion_point.q;
    let lost = at(origin)?;
    if !gains(lost, rest) {
        return None;
    }
    let (mean, distance) = misfit.positions(origin);
    let unexplained = at(&mean)?;
    let is_mean_better = unexplained < LARGEST_OF_MEAN * lost;
    if settings.equations == Equations::Robot {
        return is_mean_better.then_some(Cause::ExpansionPoint { distance, mean });
    }
    Some(Cause::ConstantInertia {
        by_robot: rest,
        by_model: lost,
        distance,
        about_mean: is_mean_better.then_some((mean, unexplained)),
        can_follow_robot: settings.abstraction.order == 1 && method == Method::Program,
    })
}
