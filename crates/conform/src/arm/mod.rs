//! What knows robots: how an arm drives its model along a recording.

#[expect(clippy::module_inception, reason = "the folder and its main type share the noun")]
pub(crate) mod arm;
pub(crate) mod correction;
mod corrector;
mod delayed;
mod drive;
mod dry_friction;
mod input;
mod input_error;
mod live_input;
mod loads;
mod parameters;
mod quantity;
pub(crate) mod record;
mod rising;
mod robot_equations;
mod setup;
pub(crate) mod system;

pub use correction::{InputCorrection, JointCorrection};
pub(crate) use corrector::only_payload;
pub use record::DriveRecord;
