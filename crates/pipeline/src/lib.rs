#![doc = include_str!("../README.md")]

mod build;
mod choices;
mod error;
mod held_out;
mod horizon;
mod kinds;
mod robot;
mod trial;
mod windows;

pub use build::{Built, HeldOut, build};
pub use choices::{Choice, Choices};
pub use error::{Error, Result};
pub use horizon::Rung;
