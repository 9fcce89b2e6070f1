//! Conformance in more directions than the states: every recorded point lies in the reachable set
//! itself (exact), or in its projections on the phase planes of the joints.

pub(crate) mod answers;
mod ask;
pub(crate) mod certificate;
pub(crate) mod elsewhere;
pub(crate) mod outer;
pub(crate) mod part_points;
pub(crate) mod phase_plane;
pub(crate) mod points;
mod proof;
pub(crate) mod smallest_sets;
pub(crate) mod sweep;
mod touching;
pub(crate) mod verdict;
