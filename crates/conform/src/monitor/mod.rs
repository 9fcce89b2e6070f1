//! A monitor: samples one at a time, and at once what leaves the reachable set of a model.

mod delayed;
mod findings;
mod input;
mod leave;
#[expect(clippy::module_inception, reason = "the folder and its main type share the noun")]
mod monitor;
mod nominal;
mod schedule;
mod window;

pub use leave::Leave;
pub use monitor::{Monitor, Totals};
pub use schedule::Schedule;
