#![doc = include_str!("../README.md")]

mod body;
mod error;
mod kinematics;
mod margin;
mod occupancy;
mod picture;
mod report;
mod scene;
mod stop;
mod verdict;

pub use body::body::Body;
pub use body::capsule::Capsule;
pub use body::capsules::Capsules;
pub use error::{Error, Result};
pub use margin::Margin;
pub use occupancy::{Occupancy, SweptCapsule};
pub use picture::picture;
pub use report::report;
pub use scene::obstacle::{Obstacle, Solid};
pub use scene::scenario::{Scenario, Scene};
pub use stop::along::{WorstStop, stops_along};
pub use stop::annex_b::{AnnexB, AnnexRow, annex_b};
pub use stop::brakes::{Brakes, Payload};
pub use stop::category::Category;
pub use stop::deceleration::Deceleration;
pub use stop::path::Path;
pub use stop::recorded::{RecordedStop, recorded_stops};
pub use stop::stop::{JointStop, Stop, stop_0, stop_1};
pub use stop::study::{StopQuestion, StopStudy, stop_study};
pub use stop::text::{annex_table, recorded_table};
pub use verdict::clearance::Clearance;
pub use verdict::decide::Advice;
pub use verdict::findings::findings;
pub use verdict::verification::{Answer, Verification, verify};
pub use verdict::witness::Witness;
