#![doc = include_str!("../README.md")]

mod acceptance;
mod allowance;
mod build;
mod choices;
mod chooser;
mod compared;
mod contradicted;
mod cut;
mod error;
mod files;
mod findings;
mod held_out;
mod horizon;
mod joint_row;
mod journal;
mod kinds;
mod mean_position;
mod motors;
mod noise;
mod plausible;
mod prepared;
mod remedies;
mod robot;
mod sorted;
mod summary;
mod trial;
mod windows;

pub use build::{Built, build};
pub use choices::{Choice, Choices};
pub use compared::HeldOut;
pub use cut::Cut;
pub use error::{Error, Result};
pub use horizon::HorizonWidths;
pub use joint_row::JointRow;
pub use prepared::prepared;
