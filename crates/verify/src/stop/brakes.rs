use reachtube_robot::Robot;
use serde::{Deserialize, Serialize};
use toml::Spanned;

use crate::error::{Error, Result, line_of};

/// The brakes of a robot, as they act after the drives are switched off.
#[derive(Debug, Clone, PartialEq)]
pub struct Brakes {
    /// The least and the greatest brake torque of each joint, at the output side of the gear
    /// \[N m; N\]. A brake opposes motion, and holds a joint that stands up to its torque.
    pub torque: Vec<[f64; 2]>,
    /// Earliest and latest time until the brakes hold \[s\]. Until the earliest time there is no
    /// brake torque; between both it may be anything up to the greatest one.
    pub delay: [f64; 2],
    /// Largest difference of each joint's torque from the robot's equations, at any time \[N m;
    /// N\].
    pub error: Vec<f64>,
    /// The greatest deceleration of each joint in a stop of category 1, on a straight path
    /// \[rad/s²; m/s²\]; `None` if the robot has no such stop.
    pub deceleration: Option<Vec<f64>>,
    /// The heaviest load, if it is known.
    pub payload: Option<Payload>,
}

/// A load that the last link carries, as a point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Payload {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass in the frame of the last link \[m\].
    pub centre: [f64; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    torque: Spanned<Vec<[f64; 2]>>,
    delay: Spanned<[f64; 2]>,
    error: Option<Spanned<Vec<f64>>>,
    deceleration: Option<Spanned<Vec<f64>>>,
    payload: Option<Spanned<Payload>>,
}

impl Brakes {
    /// Returns brakes with the least and the greatest torque of each joint (N m; N) and the
    /// earliest and the latest time at which they hold (s).
    #[must_use]
    pub fn new(torque: Vec<[f64; 2]>, delay: [f64; 2]) -> Self {
        let error = vec![0.0; torque.len()];
        Self { torque, delay, error, deceleration: None, payload: None }
    }

    /// Reads brakes from TOML; `origin` names the text in errors.
    ///
    /// | key | value |
    /// |---|---|
    /// | `torque` | `[least, greatest]` for each joint |
    /// | `delay` | `[earliest, latest]` |
    /// | `error` | a number for each joint; 0 without it |
    /// | `deceleration` | a number for each joint; for stops of category 1 |
    /// | `payload` | `mass` and `centre`; no load without it |
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
        let File { torque, delay, error, deceleration, payload } = toml::from_str(text)
            .map_err(|e| Error::Syntax { origin: origin.into(), message: e.to_string() })?;
        let read = Reader { text, origin, joints: robot.joint_count() };
        let (given, joints) = (torque.get_ref().len(), read.joints);
        if given != joints {
            let problem = format!("torque has {given} entries, but the robot has {joints} joints");
            let remedy = "give [least, greatest] for each joint";
            return Err(read.invalid(torque.span().start, problem, remedy));
        }
        let is_range = |[low, high]: &[f64; 2]| 0.0 <= *low && low <= high && high.is_finite();
        if let Some(wrong) = torque.get_ref().iter().find(|range| !is_range(range)) {
            let remedy = "give [least, greatest] with 0 <= least <= greatest, in N m";
            return Err(read.invalid(torque.span().start, format!("torque {wrong:?}"), remedy));
        }
        if !is_range(delay.get_ref()) {
            let remedy = "give [earliest, latest] with 0 <= earliest <= latest, in s";
            let problem = format!("delay {:?}", delay.get_ref());
            return Err(read.invalid(delay.span().start, problem, remedy));
        }
        let error = read.of_joints("error", error, |x| x >= 0.0, "not below 0, in N m")?;
        let above = |x| x > 0.0;
        let deceleration =
            read.of_joints("deceleration", deceleration, above, "above 0, in rad/s²")?;
        let payload = payload.map(|payload| read.payload(&payload)).transpose()?;
        Ok(Self {
            torque: torque.into_inner(),
            delay: delay.into_inner(),
            error: error.unwrap_or_else(|| vec![0.0; joints]),
            deceleration,
            payload,
        })
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

/// The text of a file, and what its values must fit.
struct Reader<'a> {
    text: &'a str,
    origin: &'a str,
    joints: usize,
}

impl Reader<'_> {
    fn invalid(&self, at: usize, problem: String, remedy: &str) -> Error {
        Error::Invalid {
            origin: self.origin.into(),
            line: line_of(self.text, at),
            place: String::new(),
            problem,
            remedy: remedy.into(),
        }
    }

    /// Returns one number for each joint, each of which passes `is_right`.
    fn of_joints(
        &self,
        name: &str,
        values: Option<Spanned<Vec<f64>>>,
        is_right: fn(f64) -> bool,
        range: &str,
    ) -> Result<Option<Vec<f64>>> {
        let Some(values) = values else { return Ok(None) };
        let all = values.get_ref();
        if all.len() == self.joints && all.iter().all(|x| is_right(*x) && x.is_finite()) {
            return Ok(Some(values.into_inner()));
        }
        let remedy = format!("give a number for each joint, {range}");
        Err(self.invalid(values.span().start, format!("{name} {all:?}"), &remedy))
    }

    fn payload(&self, payload: &Spanned<Payload>) -> Result<Payload> {
        let Payload { mass, centre } = *payload.get_ref();
        if mass > 0.0 && mass.is_finite() && centre.iter().all(|x| x.is_finite()) {
            return Ok(Payload { mass, centre });
        }
        let remedy = "give a mass above 0 kg, and its centre in the last link's frame, in m";
        let problem = format!("payload of {mass} kg at {centre:?}");
        Err(self.invalid(payload.span().start, problem, remedy))
    }
}
