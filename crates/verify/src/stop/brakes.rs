use reachtube_robot::Robot;
use serde::Deserialize;
use toml::Spanned;

use crate::error::{Error, Result, line_of};

/// The brakes of a robot, as they act after the drives are switched off.
#[derive(Debug, Clone, PartialEq)]
pub struct Brakes {
    /// The least and the greatest brake torque of each joint, at the output side of the gear
    /// \[N m; N\]. A brake opposes motion, and holds a joint that stands up to its torque.
    pub torque: Vec<[f64; 2]>,
    /// When the brakes hold at the earliest and at the latest \[s\]. Until the earliest time there
    /// is no brake torque; between both it may be anything up to the greatest one.
    pub delay: [f64; 2],
    /// How far the torque on each joint may be from the robot's equations, at any time \[N m; N\].
    pub error: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    torque: Spanned<Vec<[f64; 2]>>,
    delay: Spanned<[f64; 2]>,
    error: Option<Spanned<Vec<f64>>>,
}

impl Brakes {
    /// Reads brakes from TOML: `torque`, a list of `[least, greatest]` for each joint, `delay`,
    /// `[earliest, latest]`, and `error`, one number for each joint, 0 without it; `origin` names
    /// the text in errors.
    ///
    /// # Errors
    ///
    /// [`Error::Syntax`] and [`Error::Invalid`], with the line.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    /// use reachtube_verify::Brakes;
    ///
    /// let text = "torque = [[40, 60], [40, 60], [40, 60], [40, 60], [20, 30], [20, 30]]
    /// delay = [0.01, 0.03]";
    /// let brakes = Brakes::from_toml(text, "brakes.toml", &Robot::lwa4p())?;
    /// assert_eq!(brakes.torque[4], [20.0, 30.0]);
    /// # Ok::<(), reachtube_verify::Error>(())
    /// ```
    pub fn from_toml(text: &str, origin: &str, robot: &Robot) -> Result<Self> {
        let File { torque, delay, error } = toml::from_str(text)
            .map_err(|e| Error::Syntax { origin: origin.into(), message: e.to_string() })?;
        let invalid = |at: usize, problem: String, remedy: &str| Error::Invalid {
            origin: origin.into(),
            line: line_of(text, at),
            place: String::new(),
            problem,
            remedy: remedy.into(),
        };
        let (given, joints) = (torque.get_ref().len(), robot.joint_count());
        if given != joints {
            let problem = format!("torque has {given} entries, but the robot has {joints} joints");
            let remedy = "give [least, greatest] for each joint";
            return Err(invalid(torque.span().start, problem, remedy));
        }
        let is_range = |[low, high]: &[f64; 2]| 0.0 <= *low && low <= high && high.is_finite();
        if let Some(wrong) = torque.get_ref().iter().find(|range| !is_range(range)) {
            let remedy = "give [least, greatest] with 0 <= least <= greatest, in N m";
            return Err(invalid(torque.span().start, format!("torque {wrong:?}"), remedy));
        }
        if !is_range(delay.get_ref()) {
            let remedy = "give [earliest, latest] with 0 <= earliest <= latest, in s";
            return Err(invalid(
                delay.span().start,
                format!("delay {:?}", delay.get_ref()),
                remedy,
            ));
        }
        let is_error = |error: &Spanned<Vec<f64>>| {
            let all = error.get_ref();
            all.len() == joints && all.iter().all(|x| *x >= 0.0 && x.is_finite())
        };
        if let Some(wrong) = error.as_ref().filter(|error| !is_error(error)) {
            let remedy = "give a number, not below 0, for each joint, in N m";
            return Err(invalid(
                wrong.span().start,
                format!("error {:?}", wrong.get_ref()),
                remedy,
            ));
        }
        let error = error.map_or_else(|| vec![0.0; joints], Spanned::into_inner);
        Ok(Self { torque: torque.into_inner(), delay: delay.into_inner(), error })
    }

    /// Returns the brake torque of a joint over the time from `from` to `to`, least and greatest.
    pub(super) fn over(&self, joint: usize, [from, to]: [f64; 2]) -> [f64; 2] {
        let [least, greatest] = self.torque[joint];
        match self.delay {
            [earliest, _] if to <= earliest => [0.0, 0.0],
            [_, latest] if from >= latest => [least, greatest],
            _ => [0.0, greatest],
        }
    }
}
