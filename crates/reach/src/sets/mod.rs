//! Set representations: boxes, zonotopes, interval vectors and interval matrices.

pub(crate) mod generators;
pub(crate) mod hyperrectangle;
pub(crate) mod interval_matrix;
pub(crate) mod membership;
pub(crate) mod square_matrix;
pub(crate) mod zonotope;

pub use hyperrectangle::Hyperrectangle;
pub use interval_matrix::{IntervalMatrix, IntervalVector};
pub use membership::{GeneratorRows, Membership, MembershipProof, MembershipWorkspace, Place};
pub use zonotope::Zonotope;
