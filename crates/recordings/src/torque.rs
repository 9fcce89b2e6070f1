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
