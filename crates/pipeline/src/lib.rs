#![doc = include_str!("../README.md")]

mod build;
mod choices;
mod chooser;
mod compared;
mod error;
mod held_out;
mod horizon;
mod kinds;
mod noise;
mod plausible;
mod prepared;

mod robot;
mod sorted;
mod trial;
mod windows;

pub use build::{Built, build};
pub use choices::{Choice, Choices};
pub use compared::HeldOut;
pub use error::{Error, Result};
pub use horizon::HorizonWidths;
pub use prepared::prepared;
