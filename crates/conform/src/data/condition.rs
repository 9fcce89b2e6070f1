use reachtube_recordings::Run;
use reachtube_robot::Robot;
use serde::{Deserialize, Serialize};

/// What friction of a robot may depend on in one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// The run's place in the order of its suite, from 1.
    pub place: u64,
    /// The mean temperature of each joint, n, °C, where it was recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperatures: Option<Vec<f64>>,
}

impl Condition {
    /// Returns the condition of a run.
    pub(crate) fn of(place: u64, run: &Run) -> Self {
        Self { place, temperatures: run.mean_temperature() }
    }

    /// Returns the condition of the first run, the default.
    #[must_use]
    pub(crate) fn first() -> Self {
        Self { place: 1, temperatures: None }
    }

    /// Returns the robot as warm as it is in this condition; `None` if its friction does not
    /// change. A law of temperature without a recorded temperature keeps its reference.
    #[must_use]
    pub(crate) fn warm(&self, robot: &Robot) -> Option<Robot> {
        if robot.warms_by().is_empty() {
            return None;
        }
        let warm = robot.at_run(self.place as f64);
        Some(match &self.temperatures {
            Some(temperatures) => warm.at_temperature(temperatures),
            None => warm,
        })
    }
}
