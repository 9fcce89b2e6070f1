use crate::fit::Fit;
use crate::inertia::fit::InertiaFit;
use crate::plausibility::compensated::input_unit_warning;
use crate::plausibility::gain::{Gain, GainLikelihood, IMPLAUSIBLE_GAIN, gains};
use crate::plausibility::implausible::Implausible;
use crate::plausibility::offset::independent_columns;
use crate::plausibility::scale::torque_unit_warning;
use crate::prepare::log::{PreparedLog, spread};
use crate::samples::{KnownTorque, Samples, Sampling};
use reachtube_diagnose::{Columns, FreeMisfit, Hypothesis};
use reachtube_robot::{FrictionDescription, ParameterKind, Robot};

/// Standard errors by which a gain must differ from 1 to be reported.
const SIGNIFICANT: f64 = 4.0;

/// Largest number of recordings in which a fault is searched.
const MOST_LOGS: usize = 64;

/// Share of the torque that may stay unexplained without a warning.
const MAX_UNEXPLAINED: f64 = 0.3;

/// The results of a fit to exciting motions whose plausibility is checked.
pub(crate) struct Checked<'a> {
    /// The given robot.
    pub robot: &'a Robot,
    /// The fit.
    pub fit: &'a InertiaFit,
    /// Friction that was known before the fit, one entry per joint.
    pub friction: &'a [FrictionDescription],
    /// The exciting motions.
    pub logs: &'a [PreparedLog],
    /// Their samples.
    pub samples: &'a Samples,
    /// The rules by which the samples were taken.
    pub sampling: &'a Sampling,
    /// The torque that was known before the fit.
    pub known: &'a KnownTorque<'a>,
    /// Whether recordings contain the gravity torque of the given robot.
    pub compensated: bool,
}

impl Checked<'_> {
    /// Returns warnings about implausible results: faults of the columns, a wrong unit of the
    /// torque, friction that does not dissipate, wrong gains, and unexplained torque.
    ///
    /// A fault of the columns makes all gains meaningless, so that it replaces their warnings. So
    /// does a wrong unit where the gravity torque of the description was added: the sum has no unit
    /// at all. A wrong gain may look like an `offset`, the recordings without it and the warning
    /// about it: it is one if the gains agree without it.
    pub(crate) fn warnings(
        &self,
        likelihood: &GainLikelihood,
        gains: &[Gain],
        offset: impl FnOnce() -> Option<(Vec<PreparedLog>, String)>,
    ) -> Vec<Implausible> {
        let gains: Vec<String> = gains.iter().filter_map(wrong_gain).collect();
        let inverted = || {
            let (joint, share) = likelihood.inverted_torque()?;
            Some((Hypothesis::Sign(joint, Columns::Torque), (joint, share)))
        };
        let found = self.likeliest_fault().or_else(inverted);
        // Degrees make all masses meaningless.
        let are_degrees = found.is_some_and(|(fault, _)| fault == Hypothesis::Degrees);
        let torque_unit = if are_degrees {
            None
        } else if self.compensated {
            input_unit_warning(self.robot, self.logs, self.sampling)
        } else {
            torque_unit_warning(self.robot, self.fit, self.logs)
        };
        let has_no_unit = self.compensated && torque_unit.is_some();
        let offset = || {
            let (logs, warning) = offset()?;
            let is_one = gains.is_empty() || self.gains_agree(&logs);
            is_one.then(|| Implausible::new(warning))
        };
        let fault = found.map(|(fault, clearest)| {
            // Zeros and clocks of robots are off a little.
            let is_small = matches!(fault, Hypothesis::Offset(..) | Hypothesis::Lag(..));
            let text = fault.warning(self.robot, clearest);
            Implausible { text, columns: (!is_small).then_some(fault) }
        });
        let fault = if has_no_unit { None } else { fault.or_else(offset) };
        let gains = if fault.is_some() || has_no_unit { Vec::new() } else { gains };
        let others = self.driving_friction().chain(gains).chain(self.unexplained_torque());
        fault.into_iter().chain(torque_unit).chain(others.map(Implausible::new)).collect()
    }

    /// Returns the fault of the columns that explains the torque best, if one does.
    fn likeliest_fault(&self) -> Option<(Hypothesis, (usize, f64))> {
        let Sampling { slow, margin, .. } = self.sampling;
        let logs = spread(self.logs, MOST_LOGS).into_iter();
        let signals = logs.map(|log| log.signals(slow, *margin));
        let columns = independent_columns(self.robot, &self.samples.columns);
        let misfit = FreeMisfit::new(self.robot, columns, signals.collect());
        misfit.likeliest_fault(self.fit.determined == self.fit.parameters.len())
    }

    /// Returns whether other recordings of the same motions have plausible gains.
    fn gains_agree(&self, logs: &[PreparedLog]) -> bool {
        let columns = &self.fit.columns;
        let samples = Samples::in_motion(self.robot, columns, logs, self.sampling, self.known);
        let joints = &Fit::of_groups(&[&samples], false).joints[0];
        let likelihood = GainLikelihood::new(&samples, joints);
        gains(self.robot, &samples, &likelihood).iter().all(|gain| wrong_gain(gain).is_none())
    }

    fn name(&self, joint: usize) -> &str {
        &self.robot.joints()[joint].name
    }

    fn poorly_fitted(&self) -> impl Iterator<Item = usize> {
        let joints = &self.fit.joints;
        (0..joints.len()).filter(|j| joints[*j].relative() > MAX_UNEXPLAINED)
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
            "the torque of {} contradicts the torque of the other joints, and would agree if \
             multiplied by {:.3} ± {:.3}; check its gain",
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
