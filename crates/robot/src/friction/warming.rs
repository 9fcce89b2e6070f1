//! Friction that falls while a joint warms up.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The quantity that measures how warm a joint is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum WarmingBy {
    /// The temperature T of the joint \[°C\]; its warmth is T - T_ref \[K\].
    #[default]
    Temperature,
    /// The number r of the run since the start, from 1; its warmth is ln(r / r_ref).
    Runs,
    /// The number r of the run since the start, from 1, as a first-order thermal state that equal
    /// friction power in each run drives; its warmth is e^{-(r_ref - 1)/τ} - e^{-(r - 1)/τ}.
    Thermal,
}

impl WarmingBy {
    #[must_use]
    pub(crate) fn rate_unit(self) -> &'static str {
        match self {
            Self::Temperature => "1/K",
            Self::Runs | Self::Thermal => "-",
        }
    }
}

/// The law by which friction changes with the warmth s of a joint: it is multiplied by
/// e^{-rate · s}.
///
/// The viscosity of a lubricant falls about exponentially with temperature (Reynolds). The law
/// keeps the sign of friction at each temperature, which a straight line does not, and another
/// reference only scales the friction.
///
/// # Examples
///
/// ```
/// use reachtube_robot::friction::{Warming, WarmingBy};
///
/// let law = Warming { reference: 30.0, coulomb: 0.0, viscous: 0.01, ..Warming::default() };
/// assert_eq!(law.factors(30.0), [1.0, 1.0]);
/// assert!((law.factors(40.0)[1] - f64::exp(-0.1)).abs() < 1e-15);
/// let by_runs = Warming { by: WarmingBy::Runs, reference: 1.0, ..law };
/// assert!((by_runs.factors(8.0)[1] - 8f64.powf(-0.01)).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Warming {
    /// The quantity that the law depends on.
    pub by: WarmingBy,
    /// The temperature \[°C\] or run at which the joint has the friction of the description.
    pub reference: f64,
    /// Time constant τ of [`WarmingBy::Thermal`] \[runs\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_constant: Option<f64>,
    /// Rate of Coulomb friction and of the Stribeck effect, per unit of warmth.
    #[serde(default)]
    pub coulomb: f64,
    /// Rate of viscous friction, per unit of warmth.
    #[serde(default)]
    pub viscous: f64,
}

impl Warming {
    fn warmth(&self, value: f64) -> f64 {
        match self.by {
            WarmingBy::Temperature => value - self.reference,
            WarmingBy::Runs => (value / self.reference).ln(),
            WarmingBy::Thermal => {
                let decay = |run: f64| (-(run - 1.0) / self.time_constant.unwrap_or(1.0)).exp();
                decay(self.reference) - decay(value)
            }
        }
    }

    /// Returns the factors of Coulomb and viscous friction at a temperature \[°C\], or at a run
    /// from 1.
    #[must_use]
    pub fn factors(&self, value: f64) -> [f64; 2] {
        let warmth = self.warmth(value);
        [self.coulomb, self.viscous].map(|rate| (-rate * warmth).exp())
    }
}
