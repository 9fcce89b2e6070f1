//! `reachtube conform`: the smallest sets for which a model encloses every recording.

mod arguments;
mod dependence;
mod fit_summary;
mod next_motion;
mod run;
mod settings;
mod summary;

pub(crate) use arguments::Arguments;
pub(crate) use run::{report, run};
pub(crate) use summary::summary;
