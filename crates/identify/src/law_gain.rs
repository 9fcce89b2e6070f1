use crate::fitted::Fitted;
use crate::inputs::Inputs;
use crate::validate::torque::predict_torque;
use reachtube_robot::Robot;
use serde::Serialize;

/// Growth of a residual on validation recordings that is worth a warning.
const WORSE: f64 = 1.01;

/// Torque residuals without and with the friction laws.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LawGain {
    /// Whether the recordings are validation recordings, to which nothing was fitted.
    pub held_out: bool,
    /// Root mean square of the residual while a joint moves \[N m\], without laws, n entries.
    pub before: Vec<f64>,
    /// The same with the chosen laws, n entries.
    pub after: Vec<f64>,
}

impl LawGain {
    /// Returns a warning for each joint that the laws predict worse on validation recordings.
    pub(crate) fn warnings(&self, robot: &Robot) -> Vec<String> {
        let pairs = self.before.iter().zip(&self.after).zip(robot.joints());
        let worse = pairs.filter(|((old, new), _)| self.held_out && **new > WORSE * **old);
        let warning = |((before, after), joint): ((&f64, &f64), &reachtube_robot::Joint)| {
            format!(
                "{}: the friction laws predict the validation recordings worse (residual \
                 {after:.4} instead of {before:.4} {}), although they predict held-out parts of \
                 the others better; set stribeck = false or warming = \"none\"",
                joint.name,
                joint.kind.force_unit()
            )
        };
        worse.map(warning).collect()
    }
}

/// Returns the residual of each joint \[N m\] over all validation recordings, or else over the
/// exciting motions.
pub(crate) fn held_out_residuals(fitted: &Fitted, inputs: &Inputs) -> Vec<f64> {
    let (_, tried) = inputs.validation();
    let Fitted { found, known, inertia, .. } = fitted;
    let (validation, _) = predict_torque(found, known, tried, &inputs.sampling, inertia);
    let all = validation.last();
    all.map_or(vec![], |all| all.joints.iter().map(|joint| joint.residual).collect())
}
