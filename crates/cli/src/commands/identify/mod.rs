//! `reachtube identify`: a robot's gravity, friction and inertia from its recordings.

mod arguments;
mod run;

pub(crate) use arguments::Arguments;
pub(crate) use run::run;
