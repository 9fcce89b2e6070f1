//! A model, settings and recordings that are read once: what every step of a conformance takes.

pub(crate) mod case;
mod cases;
pub(crate) mod condition;
pub(crate) mod input;
pub(crate) mod kept;
mod limits;
pub(crate) mod marks;
pub(crate) mod origin;
#[expect(clippy::module_inception, reason = "the folder and its main type share the noun")]
pub(crate) mod problem;
pub(crate) mod recordings;
mod subset;
pub(crate) mod suite;
pub(crate) mod totals;
pub(crate) mod tree;

pub use case::Case;
pub use condition::Condition;
pub use input::RunInput;
pub use marks::Marks;
pub use problem::{Keep, Problem, Setup};
pub use recordings::Recordings;
pub use suite::{RunSummary, Suite};
pub use totals::Totals;
