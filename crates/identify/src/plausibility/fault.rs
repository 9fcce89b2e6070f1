use crate::plausibility::implausible::WrongColumns;
use crate::prepare::log::PreparedLog;
use crate::samples::Sampling;
use reachtube_robot::{JointKind, Robot};
use std::f64::consts::PI;

/// A fault of the recordings' columns that may explain a poor fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fault {
    /// The columns of a joint have the wrong sign.
    Sign { joint: usize, columns: Columns },
    /// The columns of two joints are exchanged.
    Swap { joints: [usize; 2], columns: Columns },
    /// The position of a joint exceeds the true one by `offset` \[rad\].
    Offset { joint: usize, offset: f64 },
    /// The torque of a joint, or of all joints, lags the motion by `delay` \[s\].
    Lag { joint: Option<usize>, delay: f64 },
    /// Positions and velocities of all revolute joints are in degrees. Prismatic joints have
    /// limits, by which values in mm are refused.
    Degrees,
}

/// The columns of a joint that have a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Columns {
    Torque,
    Motion,
    All,
}

impl Columns {
    /// All cases.
    pub(super) const CASES: [Self; 3] = [Self::Torque, Self::Motion, Self::All];

    fn words(self) -> &'static str {
        match self {
            Self::Torque => "tau",
            Self::Motion => "q and qd",
            Self::All => "q, qd and tau",
        }
    }

    /// Applies `change` to these columns of a log.
    fn change(self, log: &mut PreparedLog, change: impl Fn(&mut [f64])) {
        if self != Self::Torque {
            [&mut log.q, &mut log.qd, &mut log.qdd].into_iter().for_each(|values| change(values));
        }
        if self != Self::Motion {
            change(&mut log.tau);
        }
    }
}

impl Fault {
    /// Returns the log of a robot without the fault.
    pub(super) fn corrected(&self, robot: &Robot, log: &PreparedLog) -> PreparedLog {
        let (mut out, n) = (log.clone(), log.joints);
        match *self {
            Self::Sign { joint, columns } => columns.change(&mut out, |values| {
                values.iter_mut().skip(joint).step_by(n).for_each(|v| *v = -*v);
            }),
            Self::Swap { joints: [a, b], columns } => columns.change(&mut out, |values| {
                values.chunks_exact_mut(n).for_each(|row| row.swap(a, b));
            }),
            Self::Offset { joint, offset } => {
                out.q.iter_mut().skip(joint).step_by(n).for_each(|q| *q -= offset);
            }
            Self::Lag { joint, delay } => return advanced(log, joint, delay),
            Self::Degrees => {
                let factors = factors_to_rad(robot);
                Columns::Motion.change(&mut out, |values| scale(values, &factors));
                scale(&mut out.slowest, &factors);
            }
        }
        out
    }

    /// Returns the sampling of recordings without the fault: limits of speed have the unit of the
    /// recordings.
    pub(super) fn corrected_sampling(&self, robot: &Robot, sampling: &Sampling) -> Sampling {
        let mut out = sampling.clone();
        if *self == Self::Degrees {
            scale(&mut out.slow, &factors_to_rad(robot));
        }
        out
    }

    /// Returns the same fault with another size, for an offset or a lag.
    pub(super) fn with_size(&self, size: f64) -> Option<Self> {
        match *self {
            Self::Offset { joint, .. } => Some(Self::Offset { joint, offset: size }),
            Self::Lag { joint, .. } => Some(Self::Lag { joint, delay: size }),
            Self::Sign { .. } | Self::Swap { .. } | Self::Degrees => None,
        }
    }

    /// Returns what is wrong with the columns. It is `None` for offsets and lags, because zeros and
    /// clocks of robots are off a little.
    pub(super) fn wrong_columns(&self) -> Option<WrongColumns> {
        match self {
            Self::Sign { .. } => Some(WrongColumns::Sign),
            Self::Swap { .. } => Some(WrongColumns::Swapped),
            Self::Degrees => Some(WrongColumns::Unit),
            Self::Offset { .. } | Self::Lag { .. } => None,
        }
    }

    /// Returns the size of an offset \[rad\] or a lag \[s\].
    pub(super) fn size(&self) -> Option<f64> {
        match *self {
            Self::Offset { offset, .. } => Some(offset),
            Self::Lag { delay, .. } => Some(delay),
            Self::Sign { .. } | Self::Swap { .. } | Self::Degrees => None,
        }
    }

    /// Returns a warning.
    ///
    /// Without the fault, the sum of squared residuals of `joint` drops to `share` of its value.
    pub(super) fn warning(&self, robot: &Robot, (joint, share): (usize, f64)) -> String {
        let of_joint = &robot.joints()[joint].name;
        let name = |joint: usize| robot.joints()[joint].name.as_str();
        let [what, correction, remedy] = match *self {
            Self::Sign { joint, columns } => [
                format!("the sign of {} of {} is probably wrong", columns.words(), name(joint)),
                "the other sign".into(),
                "multiply the columns by -1 (for tau, set a negative gain)".into(),
            ],
            Self::Swap { joints: [a, b], columns } => [
                format!(
                    "the columns {} of {} and {} are probably swapped",
                    columns.words(),
                    name(a),
                    name(b)
                ),
                "exchanging them".into(),
                "correct the order of the columns (`identify` and `prepare` can take it by names)"
                    .into(),
            ],
            Self::Offset { joint, offset } => [
                format!(
                    "the position of {} probably has an offset of {offset:.3} {}",
                    name(joint),
                    robot.joints()[joint].kind.position_unit()
                ),
                "subtracting it".into(),
                format!(
                    "correct the zero of q{}, or the zero of the joint in the robot description",
                    joint + 1
                ),
            ],
            Self::Lag { joint, delay } => [
                format!(
                    "the torque of {} probably {} the motion by {:.0} ms",
                    joint.map_or("all joints", name),
                    if delay > 0.0 { "lags" } else { "leads" },
                    1e3 * delay.abs()
                ),
                "shifting it".into(),
                "record torque and motion with the same clock, or shift the columns tau".into(),
            ],
            Self::Degrees => [
                "q and qd are probably in degrees and degrees/s, not in rad and rad/s".into(),
                "multiplying them by pi/180".into(),
                "all identified values are wrong until then; convert the columns q and qd of all \
                 recordings"
                    .into(),
            ],
        };
        format!(
            "{what}: {correction} reduces the sum of squared residuals of {of_joint} to \
             {share:.3} of its value; {remedy}"
        )
    }
}

/// Returns the factors that take the positions of all joints from degrees to rad, n entries: 1 for
/// prismatic joints.
fn factors_to_rad(robot: &Robot) -> Vec<f64> {
    let of_joint = |kind| if kind == JointKind::Revolute { PI / 180.0 } else { 1.0 };
    robot.kinds().into_iter().map(of_joint).collect()
}

/// Multiplies the values of each joint in row-major `values` by its factor.
fn scale(values: &mut [f64], factors: &[f64]) {
    values.iter_mut().zip(factors.iter().cycle()).for_each(|(value, factor)| *value *= factor);
}

/// Returns a log with the torque of one joint, or of all, advanced by `delay` \[s\].
///
/// Samples without a torque are cut.
fn advanced(log: &PreparedLog, joint: Option<usize>, delay: f64) -> PreparedLog {
    let (n, samples) = (log.joints, log.len() as isize);
    let shift = (delay / log.step).round() as isize;
    let first = (-shift).clamp(0, samples);
    let last = (samples - shift).clamp(first, samples);
    let mut out = log.interval(first as usize..last as usize);
    for (k, row) in out.tau.chunks_exact_mut(n).enumerate() {
        let late = log.tau((first + shift) as usize + k);
        (0..n).filter(|j| joint.is_none_or(|joint| joint == *j)).for_each(|j| row[j] = late[j]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log() -> PreparedLog {
        let values = |scale: f64| (0..12).map(|k| scale * f64::from(k)).collect::<Vec<_>>();
        let (q, qd, tau) = (values(1.0), values(10.0), values(100.0));
        PreparedLog { q, qd, tau, ..PreparedLog::zeros("log", 2, 6, 0.1) }
    }

    /// The faults of the tests look at no joint of the robot.
    fn robot() -> Robot {
        Robot::lwa4p()
    }

    #[test]
    fn faults_change_the_columns_that_they_name() {
        let swapped =
            Fault::Swap { joints: [0, 1], columns: Columns::Torque }.corrected(&robot(), &log());
        assert_eq!((swapped.tau(0), swapped.q(0)), (&[100.0, 0.0][..], &[0.0, 1.0][..]));
        let signed = Fault::Sign { joint: 1, columns: Columns::Motion }.corrected(&robot(), &log());
        assert_eq!((signed.qd(1), signed.tau(1)), (&[20.0, -30.0][..], &[200.0, 300.0][..]));
        let moved = Fault::Offset { joint: 0, offset: 0.5 }.corrected(&robot(), &log());
        assert_eq!((moved.q(1), moved.qd(1)), (&[1.5, 3.0][..], &[20.0, 30.0][..]));
    }

    #[test]
    fn degrees_change_motion_and_limits_of_speed() {
        let corrected = Fault::Degrees.corrected(&robot(), &log());
        assert_eq!((corrected.q(2)[1], corrected.tau(1)), (5.0 * PI / 180.0, &[200.0, 300.0][..]));
        let slow = vec![180.0; 6];
        let sampling = Sampling { rate: 1.0, slow, margin: 0.1, velocities: vec![] };
        assert_eq!(Fault::Degrees.corrected_sampling(&robot(), &sampling).slow, [PI; 6]);
    }

    #[test]
    fn a_late_torque_is_advanced() {
        let late = Fault::Lag { joint: Some(1), delay: 0.2 }.corrected(&robot(), &log());
        assert_eq!((late.len(), late.tau(0), late.q(0)), (4, &[0.0, 500.0][..], &[0.0, 1.0][..]));
        let early = Fault::Lag { joint: None, delay: -0.1 }.corrected(&robot(), &log());
        assert_eq!(
            (early.len(), early.tau(0), early.q(0)),
            (5, &[0.0, 100.0][..], &[2.0, 3.0][..])
        );
        assert!(Fault::Lag { joint: None, delay: 9.0 }.corrected(&robot(), &log()).is_empty());
    }
}
