//! A monitor: samples one at a time, and at once what leaves the reachable set of a model.

mod alarm;
mod fault_watch;
mod findings;
mod healthy;
mod learn;
mod leave;
#[expect(clippy::module_inception, reason = "the folder and its main type share the noun")]
mod monitor;
mod nominal;
mod schedule;
mod statistics;
mod window;

pub use alarm::{Alarm, Fault};
pub use healthy::HealthyMotion;
pub use leave::Leave;
pub use monitor::{Monitor, Totals};
pub use schedule::Schedule;
