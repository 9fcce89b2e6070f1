//! The shape of a robot: capsules around its links.

#[expect(clippy::module_inception, reason = "the body is the concept of this folder")]
pub(crate) mod body;
pub(crate) mod capsule;
pub(crate) mod capsules;
mod fit;
mod fit_mesh;
mod read;
