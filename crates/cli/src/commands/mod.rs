//! The commands: one module holds a command's arguments, its call and the text that it prints.

pub mod r#abstract;
pub mod campaign;
pub mod check;
pub mod completions;
pub mod conform;
pub mod convert;
pub mod demo;
pub mod excite;
pub mod export;
pub mod identify;
pub mod inspect;
pub mod man;
pub mod prepare;
pub mod reach;
pub mod report;
pub mod reproduce;
pub mod robot;
