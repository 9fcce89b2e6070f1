//! Inertial parameters by linear regression, and the nearest physically consistent links.

pub(crate) mod base;
pub(crate) mod columns;
pub(crate) mod description;
pub(crate) mod diagonal;
pub(crate) mod fit;
pub(crate) mod physical;
mod prior;
mod reference;
pub(crate) mod saturation;

pub use base::BaseParameter;
pub use fit::InertiaFit;
pub use physical::PhysicalFit;
pub use saturation::SaturatingFriction;
