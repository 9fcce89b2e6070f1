//! What knows robots.

pub(crate) mod system;
