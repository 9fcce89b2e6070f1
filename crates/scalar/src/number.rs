//! Numbers as text for people: few digits, but enough to tell what a number is.
//!
//! The command and the report print through these functions, so that a value looks the same in
//! both. Files that a program reads back keep every digit and do not use them.

mod digits;
mod outward;

pub use digits::{
    column_decimals, counted, fixed, four_decimals, plural, significant, six_digits, tick_label,
};
pub use outward::{at_least, interval, outward, two_digits_outward, two_digits_up};
