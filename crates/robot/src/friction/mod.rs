//! Joint friction: Coulomb friction by motor quadrant and cubic viscous friction, (5) to (9), with
//! the Stribeck effect and its change while a joint warms up.

pub(crate) mod coulomb;
pub(crate) mod joint_friction;
pub(crate) mod stribeck;
pub(crate) mod viscous;
pub(crate) mod warming;

pub use coulomb::{Coulomb, LoadLine};
pub use joint_friction::Friction;
pub use stribeck::Stribeck;
pub use viscous::Viscous;
pub use warming::{Warming, WarmingBy};
