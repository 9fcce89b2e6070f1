//! `reachtube conform`: the smallest sets for which a model encloses every recording.

mod arguments;
mod dependence;
mod fit_summary;
mod next_motion;
mod run;
mod settings;
mod summary;

pub use arguments::Arguments;
pub use run::{report, run};
pub use summary::summary;
