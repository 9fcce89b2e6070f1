//! What an answer says: [`Finding`]s with [`Code`]s and [`Remedy`]s, the [`Report`] of them, and
//! settings as each [`FrontEnd`] writes them.
//!
//! Each crate that has answers defines its own codes with [`codes!`].

mod advice;
mod code;
mod finding;
mod front_end;
mod printable;
mod remedy;
mod report;
mod summary;
mod table;
mod units;

pub use advice::{Advice, advised};
pub use code::Code;
pub use finding::{Finding, Severity};
pub use front_end::{FrontEnd, Setting};
pub use printable::printable;
pub use remedy::Remedy;
pub use report::{Report, Section};
pub use summary::Summary;
pub use table::Table;
pub use units::Units;
