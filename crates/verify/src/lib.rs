#![doc = include_str!("../README.md")]

mod body;
mod code;
mod error;
mod kinematics;
mod margin;
mod mesh;
mod occupancy;
mod report;
mod report_stops;
mod scene;
mod stop;
mod verdict;

pub use body::body::Body;
pub use body::capsule::Capsule;
pub use body::capsules::Capsules;
pub use code::Code;
pub use error::Error;
pub use margin::Margin;
pub use occupancy::SweptCapsule;
pub use report::report;
pub use scene::obstacle::{Obstacle, Solid};
pub use scene::scenario::{Scenario, Scene};
pub use stop::annex_b::AnnexRow;
pub use stop::brakes::{Brakes, Payload};
pub use stop::category::Category;
pub use stop::deceleration::Deceleration;
pub use stop::path::Path;
pub use stop::rule::StopRule;
pub use stop::simulated::{SimulatedStop, StopCase};
pub use stop::stop::{Stop, stop_0, stop_1};
pub use stop::study::{StopQuestion, StopStudy, stop_study};
pub use stop::text::{annex_table, recorded_table};
pub use verdict::findings::{findings, links_without_capsule, worst_first};
pub use verdict::verification::{Answer, Verification, verify};
pub use verdict::witness::Witness;
