//! Conformance in more directions than those of the states: every recorded point lies in the
//! reachable set itself (exact), or in its projections on the phase planes of the joints.

pub(crate) mod certificate;
pub(crate) mod outer;
pub(crate) mod phase_plane;
mod points;
mod proof;
pub(crate) mod smallest_sets;
mod sweep;
mod touching;
pub(crate) mod verdict;
