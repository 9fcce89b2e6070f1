use crate::inertia::fit::InertiaFit;
use crate::plausibility::gain::{Gain, GainLikelihood, IMPLAUSIBLE_GAIN};
use crate::plausibility::sign::inverted_columns;
use crate::prepare::log::Log;
use crate::samples::{Samples, Sampling};
use crate::validate::torque::LogValidation;
use reachtube_robot::{FrictionDescription, ParameterKind, Robot};

/// Standard errors by which a gain must differ from 1 to be reported.
const SIGNIFICANT: f64 = 4.0;

/// Share of the torque that may stay unexplained without a warning.
const MAX_UNEXPLAINED: f64 = 0.3;

/// The results of a fit to exciting motions whose plausibility is checked.
pub struct Checked<'a> {
    /// The given robot.
    pub robot: &'a Robot,
    /// The fit.
    pub fit: &'a InertiaFit,
    /// Friction that was known before the fit, one entry per joint.
    pub friction: &'a [FrictionDescription],
    /// The exciting motions.
    pub logs: &'a [Log],
    /// Their samples.
    pub samples: &'a Samples,
    /// The rules by which the samples were taken.
    pub sampling: &'a Sampling,
}

impl Checked<'_> {
    /// Returns warnings about implausible results: wrong signs, friction that does not dissipate,
    /// wrong gains, and unexplained torque.
    pub fn warnings(&self, likelihood: &GainLikelihood, gains: &[Gain]) -> Vec<String> {
        let inverted_torque = likelihood.inverted_torque();
        let mut warnings: Vec<String> = self.wrong_sign(inverted_torque).into_iter().collect();
        warnings.extend(self.driving_friction());
        // A wrong sign of a torque makes all gains meaningless.
        if inverted_torque.is_none() {
            warnings.extend(gains.iter().filter_map(wrong_gain));
        }
        warnings.extend(self.unexplained_torque());
        warnings
    }

    fn name(&self, joint: usize) -> &str {
        &self.robot.joints()[joint].name
    }

    /// Returns the joints whose torque the fit explains poorly.
    fn poorly_fitted(&self) -> impl Iterator<Item = usize> {
        let joints = &self.fit.joints;
        (0..joints.len()).filter(|j| joints[*j].relative() > MAX_UNEXPLAINED)
    }

    /// Without an inverted torque, the search over all signs runs only if the fit is poor.
    fn wrong_sign(&self, inverted_torque: Option<(usize, f64)>) -> Option<String> {
        let poor = self.poorly_fitted().next().is_some();
        let search = || inverted_columns(self.robot, self.logs, self.samples, self.sampling);
        let (what, share) = inverted_torque
            .map(|(j, share)| (format!("tau of {}", self.name(j)), share))
            .or_else(|| poor.then(search).flatten())?;
        Some(format!(
            "the sign of {what} is probably wrong: the other sign reduces the sum of squared \
             residuals to {share:.3} of its value; multiply the columns by -1 (for tau, set a \
             negative gain)"
        ))
    }

    fn driving_friction(&self) -> impl Iterator<Item = String> {
        self.friction.iter().enumerate().filter_map(|(j, known)| {
            let (coulomb, viscous) = least_squares_friction(self.fit, known, j);
            (coulomb < 0.0 && viscous < 0.0).then(|| {
                format!(
                    "friction of {} accelerates the joint by least squares (Coulomb {coulomb:.3} \
                     {}, viscous {viscous:.3} {}): the sign of its torque or of its \
                     velocity is probably wrong; check both columns",
                    self.name(j),
                    self.robot.joints()[j].kind.force_unit(),
                    self.robot.joints()[j].kind.damping_unit()
                )
            })
        })
    }

    fn unexplained_torque(&self) -> impl Iterator<Item = String> {
        self.poorly_fitted().map(|j| {
            format!(
                "{}: {:.0} % of the torque is not explained; check the robot description and the \
                 order of the columns; friction that the model does not describe has the same \
                 effect",
                self.name(j),
                100.0 * self.fit.joints[j].relative()
            )
        })
    }
}

fn wrong_gain(gain: &Gain) -> Option<String> {
    let deviation = (gain.gain - 1.0).abs();
    (deviation > IMPLAUSIBLE_GAIN && deviation > SIGNIFICANT * gain.standard_error).then(|| {
        format!(
            "the torque of {} contradicts that of the other joints, and would agree if multiplied \
             by {:.3} ± {:.3}; check its gain",
            gain.joint, gain.gain, gain.standard_error
        )
    })
}

/// Returns Coulomb friction \[N m\] and viscous friction \[N m s/rad\] of a joint by least squares,
/// including the known friction.
fn least_squares_friction(
    fit: &InertiaFit,
    known: &FrictionDescription,
    joint: usize,
) -> (f64, f64) {
    let [a1, _, a3, _, a5, _, a7, _] = known.coulomb;
    let fitted = |kind| {
        let column = fit.columns.iter().position(|c| c.joint == joint && c.kind == kind);
        column.map_or(0.0, |k| fit.fit.solution.x[k])
    };
    (
        0.25 * (a1 + a7 - a3 - a5) + fitted(ParameterKind::Coulomb),
        known.viscous[0] + fitted(ParameterKind::Viscous1),
    )
}

/// Returns a warning for each joint of which more than 30 % of the torque in the validation
/// recordings is not predicted.
pub fn poor_prediction(robot: &Robot, validation: &[LogValidation]) -> Vec<String> {
    let joints = validation.last().map_or(&[][..], |all| &all.joints);
    let poor = robot.joints().iter().zip(joints).filter(|(_, e)| e.relative > MAX_UNEXPLAINED);
    poor.map(|(joint, error)| {
        format!(
            "{}: {:.0} % of the torque in the validation recordings is not explained; friction \
             that the model does not describe, or a motion far from the fitted ones, has this \
             effect",
            joint.name,
            100.0 * error.relative
        )
    })
    .collect()
}
