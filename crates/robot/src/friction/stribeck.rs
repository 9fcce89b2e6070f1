//! The Stribeck effect: dry friction that rises toward standstill, or saturates with speed.

use reachtube_scalar::Lanewise;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The rise of dry friction toward standstill (Stribeck effect), added to Coulomb friction:
/// (F_s - F_c) exp(-(q̇/v_s)²) sign(q̇) \[N m\].
///
/// With a negative excess, dry friction builds up from F_s at standstill to F_c over the speed v_s.
/// This is friction that saturates, as strain-wave gears show it.
///
/// # Examples
///
/// ```
/// use reachtube_robot::friction::Stribeck;
///
/// let rise = Stribeck { excess: 2.0, speed: 0.1 };
/// assert!((rise.torque(1e-9) - 2.0).abs() < 1e-15);
/// assert!((rise.torque(-0.1) + 2.0 / f64::exp(1.0)).abs() < 1e-15);
/// assert_eq!(rise.torque(0.0), 0.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stribeck {
    /// Breakaway minus Coulomb friction F_s - F_c \[N m; N\], at least -F_c.
    pub excess: f64,
    /// Stribeck speed v_s \[rad/s; m/s\], above 0.
    pub speed: f64,
}

impl Stribeck {
    /// Returns the torque \[N m\] at a joint velocity \[rad/s\]. It is 0 at standstill, where dry
    /// friction is a set of torques.
    pub fn torque<S: Lanewise>(&self, qd: S) -> S {
        qd.map(|qd| {
            let sign = if qd == 0.0 { 0.0 } else { qd.signum() };
            sign * self.excess * (-(qd / self.speed).powi(2)).exp()
        })
    }
}
