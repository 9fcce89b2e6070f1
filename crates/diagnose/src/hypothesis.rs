use std::f64::consts::PI;

use reachtube_recordings::Torque;
use reachtube_robot::{JointKind, Robot};
use serde::{Deserialize, Serialize};

use crate::change::Change;

/// What recordings may mean instead of what was stated. Joints count from 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Hypothesis {
    /// The torques are in units of this many N m.
    TorqueUnit(f64),
    /// All torques have the opposite sign.
    OppositeTorques,
    /// The torques are of another kind.
    Kind(Torque),
    /// The steps of dry friction are missing from motor torques.
    Filtered,
    /// Positions and velocities of all revolute joints are in degrees. Prismatic joints have
    /// limits, by which values in mm are refused.
    Degrees,
    /// The torque of a joint, or of all joints, is later than the motion by this time, s.
    Lag(Option<usize>, f64),
    /// The columns of a joint have the wrong sign.
    Sign(usize, Columns),
    /// The columns of two joints are exchanged.
    Swap([usize; 2], Columns),
    /// The position of a joint exceeds the true one by this offset, rad or m.
    Offset(usize, f64),
}

/// Columns of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Columns {
    /// The torque.
    Torque,
    /// Position and velocity.
    Motion,
    /// All of them.
    All,
}

impl Columns {
    /// All cases.
    pub(crate) const CASES: [Self; 3] = [Self::Torque, Self::Motion, Self::All];

    fn words(self) -> &'static str {
        match self {
            Self::Torque => "tau",
            Self::Motion => "q and qd",
            Self::All => "q, qd and tau",
        }
    }
}

impl Hypothesis {
    /// Returns how recordings of a robot are read under the hypothesis.
    pub(crate) fn change(&self, robot: &Robot, stated: &Change) -> Change {
        let mut out = stated.clone();
        match *self {
            Self::TorqueUnit(factor) => out.torque_factors.fill(factor),
            Self::OppositeTorques => out.torque_factors.fill(-1.0),
            Self::Kind(kind) => out.torque = kind,
            Self::Filtered => out.softened = true,
            Self::Degrees => {
                let factors = out.motion_factors.iter_mut().zip(robot.kinds());
                let revolute = factors.filter(|(_, kind)| *kind == JointKind::Revolute);
                revolute.for_each(|(factor, _)| *factor = PI / 180.0);
            }
            Self::Lag(None, delay) => out.lags.fill(delay),
            Self::Lag(Some(joint), delay) => out.lags[joint] = delay,
            Self::Sign(joint, columns) => {
                if columns != Columns::Torque {
                    out.motion_factors[joint] = -1.0;
                }
                if columns != Columns::Motion {
                    out.torque_factors[joint] = -1.0;
                }
            }
            Self::Swap([a, b], columns) => {
                if columns != Columns::Torque {
                    out.motion_columns.swap(a, b);
                }
                if columns != Columns::Motion {
                    out.torque_columns.swap(a, b);
                }
            }
            Self::Offset(joint, offset) => out.offsets[joint] = offset,
        }
        out
    }

    pub(crate) fn with_size(&self, size: f64) -> Option<Self> {
        match *self {
            Self::Offset(joint, _) => Some(Self::Offset(joint, size)),
            Self::Lag(joint, _) => Some(Self::Lag(joint, size)),
            _ => None,
        }
    }

    /// Returns the size of an offset (rad or m) or a lag (s).
    pub(crate) fn size(&self) -> Option<f64> {
        match *self {
            Self::Offset(_, size) | Self::Lag(_, size) => Some(size),
            _ => None,
        }
    }

    pub(crate) fn number(&self) -> Option<(&'static str, f64)> {
        let name = if matches!(self, Self::Lag(..)) { "lag" } else { "offset" };
        self.size().map(|size| (name, size))
    }

    /// Returns the hypothesis as a clause.
    #[must_use]
    pub fn clause(&self, robot: &Robot) -> String {
        let [subject, verb, rest] = self.words(robot);
        format!("{subject} {verb} {rest}")
    }

    /// Returns the hypothesis as a clause that leaves room for doubt, and the remedy.
    #[must_use]
    pub fn probably(&self, robot: &Robot) -> [String; 2] {
        let [subject, verb, rest] = self.words(robot);
        let clause = match verb.as_str() {
            "is" | "are" => format!("{subject} {verb} probably {rest}"),
            _ => format!("{subject} probably {verb} {rest}"),
        };
        let [_, remedy] = self.remedy();
        [clause, remedy]
    }

    fn words(&self, robot: &Robot) -> [String; 3] {
        let name = |joint: usize| robot.joints()[joint].name.as_str();
        let words = |subject: &str, verb: &str, rest: String| [subject.into(), verb.into(), rest];
        match *self {
            Self::TorqueUnit(unit) => {
                let unit = if unit < 1.0 { "N mm" } else { "kN m" };
                words("the torques", "are", format!("in {unit}, not in N m"))
            }
            Self::OppositeTorques => words("the torques", "have", "the opposite sign".into()),
            Self::Kind(kind) => {
                let kind = format!("{kind:?}").to_lowercase();
                words("the torques", "are", format!("of the kind `{kind}`"))
            }
            Self::Filtered => words(
                "dry friction",
                "steps",
                "where joints turn and rest, and the recorded torques do not, as where they were \
                 filtered; `reachtube prepare --compensate` writes inputs that are free of it"
                    .into(),
            ),
            Self::Degrees => {
                words("q and qd", "are", "in degrees and degrees/s, not in rad and rad/s".into())
            }
            Self::Lag(joint, delay) => {
                let verb = if delay > 0.0 { "lags" } else { "leads" };
                let subject = format!("the torque of {}", joint.map_or("all joints", name));
                words(&subject, verb, format!("the motion by {:.0} ms", 1e3 * delay.abs()))
            }
            Self::Sign(joint, columns) => {
                let subject = format!("the sign of {} of {}", columns.words(), name(joint));
                words(&subject, "is", "wrong".into())
            }
            Self::Swap([a, b], columns) => {
                let (one, other) = (name(a), name(b));
                let subject = format!("the columns {} of {one} and {other}", columns.words());
                words(&subject, "are", "swapped".into())
            }
            Self::Offset(joint, offset) => {
                let unit = robot.joints()[joint].kind.position_unit();
                let subject = format!("the position of {}", name(joint));
                words(&subject, "has", format!("an offset of {offset:.3} {unit}"))
            }
        }
    }

    /// Returns what corrects the recordings, and the remedy; both empty if the clause says so.
    fn remedy(&self) -> [String; 2] {
        match *self {
            Self::TorqueUnit(factor) => {
                ["the factor".into(), format!("multiply the torques by {factor}")]
            }
            Self::Sign(..) => [
                "the other sign".into(),
                "multiply the columns by -1 (for tau, set a negative gain)".into(),
            ],
            Self::Swap(..) => [
                "exchanging them".into(),
                "correct the order of the columns (`identify` and `prepare` can take it by names)"
                    .into(),
            ],
            Self::Offset(joint, _) => [
                "subtracting it".into(),
                format!(
                    "correct the zero of q{}, or the zero of the joint in the robot description",
                    joint + 1
                ),
            ],
            Self::Lag(..) => [
                "shifting it".into(),
                "record torque and motion with the same clock, or shift the columns tau".into(),
            ],
            Self::Degrees => [
                "multiplying them by pi/180".into(),
                "all identified values are wrong until then; convert the columns q and qd of all \
                 recordings"
                    .into(),
            ],
            _ => [String::new(), String::new()],
        }
    }

    /// Returns a warning with the remedy.
    ///
    /// Under the hypothesis, the sum of squared residuals of `joint` drops to `share` of its value.
    #[must_use]
    pub fn warning(&self, robot: &Robot, (joint, share): (usize, f64)) -> String {
        let ([what, remedy], [correction, _]) = (self.probably(robot), self.remedy());
        let of_joint = &robot.joints()[joint].name;
        format!(
            "{what}: {correction} reduces the sum of squared residuals of {of_joint} to \
             {share:.3} of its value; {remedy}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn change(hypothesis: Hypothesis) -> Change {
        hypothesis.change(&Robot::lwa4p(), &Change::none(Torque::Motor, 6))
    }

    #[test]
    fn hypotheses_change_the_columns_that_they_name() {
        let row = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let swapped = change(Hypothesis::Swap([0, 1], Columns::Torque));
        assert_eq!((swapped.torque_columns[0], swapped.rates(&row)[0]), (1, 1.0));
        let signed = change(Hypothesis::Sign(1, Columns::Motion));
        assert_eq!((signed.rates(&row)[1], signed.torque_factors[1]), (-2.0, 1.0));
        let moved = change(Hypothesis::Offset(0, 0.5));
        assert_eq!((moved.q(&row)[0], moved.rates(&row)[0]), (0.5, 1.0));
        let degrees = change(Hypothesis::Degrees);
        assert_eq!((degrees.q(&row)[5], degrees.torque_factors[5]), (6.0 * (PI / 180.0), 1.0));
    }

    #[test]
    fn doubt_stands_where_english_has_it() {
        let robot = Robot::lwa4p();
        let words = |hypothesis: Hypothesis| hypothesis.warning(&robot, (1, 0.012));
        let lag = words(Hypothesis::Lag(None, -0.1));
        assert!(lag.starts_with("the torque of all joints probably leads the motion by 100 ms: "));
        let offset = words(Hypothesis::Offset(2, 0.1));
        assert!(offset.starts_with("the position of joint3 probably has an offset of 0.100 rad"));
        let sign = words(Hypothesis::Sign(0, Columns::All));
        assert!(sign.starts_with("the sign of q, qd and tau of joint1 is probably wrong: "));
        assert!(sign.contains("residuals of joint2 to 0.012 of its value; multiply"), "{sign}");
    }
}
