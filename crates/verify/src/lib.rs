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
pub use stop::brakes::Brakes;
pub use stop::stop::{JointStop, Stop, stop_0};
pub use verdict::clearance::Clearance;
pub use verdict::decide::Advice;
pub use verdict::verification::{Answer, Verification, verify};
pub use verdict::witness::Witness;
