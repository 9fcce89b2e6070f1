//! Joint friction: Coulomb by motor quadrant and viscous as a cubic, eqs. (5) to (9).

mod coulomb;
mod viscous;

pub use coulomb::{Coulomb, LoadLine};
pub use viscous::Viscous;

/// Friction of one joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// Load-dependent Coulomb friction tau_c.
    pub coulomb: Coulomb,
    /// Viscous friction tau_v.
    pub viscous: Viscous,
}
