//! Joint friction: Coulomb friction by motor quadrant and cubic viscous friction, (5) to (9).

pub(crate) mod coulomb;
pub(crate) mod joint_friction;
pub(crate) mod viscous;

pub use coulomb::{Coulomb, LoadLine};
pub use joint_friction::Friction;
pub use viscous::Viscous;
