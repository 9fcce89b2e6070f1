//! `reachtube conform`: the smallest sets for which a model encloses every recording.

mod arguments;
mod run;
mod sets;
mod settings;

pub(crate) use arguments::{Arguments, GROUPS};
pub(crate) use run::run;
