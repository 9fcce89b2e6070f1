//! Conditions on recordings beyond the rows: every recorded point lies in the reachable set itself
//! (exact), or in its projections on the phase planes of the parts.

pub(crate) mod certificate;
#[expect(clippy::module_inception, reason = "the folder and its main trait share the noun")]
pub(crate) mod claim;
pub(crate) mod look;
pub(crate) mod notion;
pub(crate) mod phase_plane;
pub(crate) mod points;
mod sample_points;
mod sample_set;
pub(crate) mod touching;
pub(crate) mod verdict;
pub(crate) mod witness;

pub use certificate::Certificate;
pub use phase_plane::PhasePlane;
pub use verdict::{SuiteVerdict, Violations};
pub use witness::{PointVerdict, PointWitness};
