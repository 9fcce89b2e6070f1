//! All friction of one joint.

use super::coulomb::Coulomb;
use super::viscous::Viscous;

/// Friction of one joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// Load-dependent Coulomb friction tau_c.
    pub coulomb: Coulomb,
    /// Viscous friction tau_v.
    pub viscous: Viscous,
}
