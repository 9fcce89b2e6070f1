//! Helpers that tests of several crates share. It is not published.

mod tab;

pub use tab::Tab;
