use reachtube_robot::Robot;
use serde::{Deserialize, Serialize};

/// What the columns `tau` of a recording mean. It is stated by the user and never guessed
/// (correction I of the method).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Torque {
    /// The input u of eq. (11) itself: gravity and Coulomb friction are already taken off.
    Compensated,
    /// Motor torque τ_m on the link side of the gear; u = τ_m - τ_c(g(q), q̇) - g(q), eq. (11), is
    /// evaluated along each run.
    Motor,
    /// Link-side torque τ_l, as a joint torque sensor measures it; u = τ_l - g(q) + τ_v(q̇), so
    /// that u - τ_v is what accelerates the links, eqs. (3), (5).
    Link,
}

impl Torque {
    /// The input u (n, N m) for one sample with position `q` (rad), velocity `qd` (rad/s) and
    /// recorded torque `tau` (N m). What is recorded is the definition of the model's input; it is
    /// evaluated in double precision.
    pub fn input(self, robot: &Robot, q: &[f64], qd: &[f64], tau: &[f64]) -> Vec<f64> {
        match self {
            Self::Compensated => tau.to_vec(),
            Self::Motor => robot.input_from_motor_torque(q, qd, tau).data.into(),
            Self::Link => robot.input_from_link_torque(q, qd, tau).data.into(),
        }
    }
}
