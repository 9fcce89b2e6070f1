//! Laws by which friction falls while the joints warm up: their fit, and their choice by held-out
//! recordings.

pub(crate) mod choice;
mod law_fit;
pub(crate) mod laws;
mod rows;

pub use choice::{JointWarming, WarmingCandidate, WarmingFit};
