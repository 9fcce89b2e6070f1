use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The meaning of the columns `tau` of a recording. The user states it, and it is never guessed
/// (docs/method.md, correction I).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Torque {
    /// The input u of eq. (11) itself: gravity and Coulomb friction are already subtracted.
    Compensated,
    /// Motor torque τ_m on the link side of the gear. The input u = τ_m - τ_c(g(q), q̇) - g(q),
    /// eq. (11), is evaluated along each run.
    Motor,
    /// Link-side torque τ_l, as a joint torque sensor measures it. The input is
    /// u = τ_l - g(q) + τ_v(q̇), so that u - τ_v accelerates the links, eqs. (3), (5).
    Link,
}

impl Torque {
    /// Returns the input u (n, N m) at one sample with positions `q` (n, rad), velocities `qd`
    /// (n, rad/s) and recorded torques `tau` (n, N m). The result in double precision is by
    /// definition the input of the model.
    #[must_use]
    pub fn input(self, robot: &Robot, q: &[f64], qd: &[f64], tau: &[f64]) -> Vec<f64> {
        match self {
            Self::Compensated => tau.to_vec(),
            Self::Motor => robot.input_from_motor_torque(q, qd, tau).data.into(),
            Self::Link => robot.input_from_link_torque(q, qd, tau).data.into(),
        }
    }
}
