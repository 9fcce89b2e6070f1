//! Recordings that stay in parts on several machines: folds of them, and the points that the parts
//! keep for the notions that ask for points.

pub use crate::check::check_elsewhere;
pub use crate::claim::part_points::{FleetProblem, PartPoints, PartReader};
pub use crate::claim::remote::PointServer;
pub use crate::conformance::conform_elsewhere;
pub use crate::data::fold::fold::Fold;
pub use crate::data::fold::of_fold::OnDefect;
