//! Reachset conformance: the smallest uncertainty sets for which every recording lies in the
//! reachable set of a model, found by programs and proved with directed rounding.
//!
//! A [`Problem`] is a model, [`Settings`] and recordings that are read once. [`conform`] finds its
//! sets, [`Model`] writes them to a file, [`check()`] compares other recordings with the reachable
//! sets ([`Tube`]) of a model, and [`reach()`] returns these sets at samples and between them. A
//! [`Job`] runs all of it, as the command does.
//!
//! What turns recordings into inputs of the model is a [`Drive`](data::Drive). This crate has none:
//! `reachtube-arm` has the one of robot arms, with examples.
//!
//! The parts of an answer are in the modules: what a model file holds in [`model`], [`mod@fit`] and
//! [`next_motion`], warnings in [`plausibility`], reachable sets and what lies outside in [`tube`]
//! and [`claim`]. [`fleet`] is for recordings that stay on several machines.

mod answer;
mod carry_over;
mod check;
mod check_job;
pub mod claim;
mod conformance;
pub mod data;
mod error;
pub mod fit;
pub mod fleet;
mod job;
pub mod model;
pub mod monitor;
pub mod next_motion;
mod nominal;
pub mod outputs;
pub mod plausibility;
mod program;
mod progress;
mod reach;
mod result;
mod search;
mod sets;
mod stiction;
pub mod tube;

pub use answer::Answer;
pub use carry_over::carry_over;
pub use check::{Check, check};
pub use check_job::{CheckJob, Opened};
pub use claim::verdict::Verdict;
pub use conformance::{Conformance, conform};
pub use data::notion::Notion;
pub use data::problem::{Keep, Problem};
pub use data::recordings::Recordings;
pub use data::settings::{self, Noise, Settings};
pub use data::setup::Setup;
pub use error::{Error, Result};
pub use fit::fit::fit;
pub use fit::group::{FitSettings, Group};
pub use job::Job;
pub use model::Model;
pub use progress::{Progress, Silent};
pub use reach::{SuiteReach, reach};
pub use result::code::Code;
pub use sets::UncertaintySets;
pub use stiction::{Stiction, stiction};
pub use tube::tube::Tube;
