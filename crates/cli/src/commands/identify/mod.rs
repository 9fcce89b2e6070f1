//! `reachtube identify`: a robot's gravity, friction and inertia from its recordings.

mod arguments;
mod laws;
mod run;
mod summary;

pub(crate) use arguments::Arguments;
pub(crate) use run::run;
