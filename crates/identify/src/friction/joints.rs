use crate::fit::CONDITION_LIMIT;
use crate::friction::fit::{FrictionFit, fit};
use crate::friction::sample::{FrictionSample, isolated_samples};
use crate::prepare::log::PreparedLog;
use crate::samples::Sampling;
use reachtube_robot::{FrictionDescription, Robot};

/// Fits the friction of each joint to the samples in which it alone moves.
///
/// Returns the fits and a warning for each joint that has too few samples or an ill-conditioned
/// fit.
pub(crate) fn fit_joints(
    robot: &Robot,
    slow: &[PreparedLog],
    sampling: &Sampling,
) -> (Vec<FrictionFit>, Vec<String>) {
    let (mut fits, mut warnings) = (Vec::new(), Vec::new());
    if slow.is_empty() {
        return (fits, warnings);
    }
    for (joint, description) in robot.joints().iter().enumerate() {
        let name = &description.name;
        let samples: Vec<FrictionSample> =
            slow.iter().flat_map(|log| isolated_samples(robot, log, joint, sampling)).collect();
        match fit(name, &samples, sampling.velocity_limit(robot, joint)) {
            Some(fit) => {
                warnings.extend(ill_conditioned(name, fit.joint.condition));
                fits.push(fit);
            }
            None => warnings.push(format!(
                "friction of {name}: the joint moves alone in {} samples, which are too few for a \
                 fit; its friction is fitted with the inertial parameters",
                samples.len()
            )),
        }
    }
    (fits, warnings)
}

fn ill_conditioned(name: &str, condition: f64) -> Option<String> {
    (condition > CONDITION_LIMIT).then(|| {
        format!(
            "friction of {name}: the fit is ill-conditioned (condition {condition:.0e}), so that \
             single coefficients are not reliable; move the joint through more speeds and loads"
        )
    })
}

/// Returns the fitted friction of each joint, zero for joints without a fit.
pub(crate) fn coefficients(fits: &[FrictionFit], robot: &Robot) -> Vec<FrictionDescription> {
    let fitted = |name: &String| {
        fits.iter().find(|fit| fit.joint.joint == *name).map(|fit| fit.joint.coefficients)
    };
    robot.joints().iter().map(|joint| fitted(&joint.name).unwrap_or_default()).collect()
}
