//! The commands: one module holds a command's arguments, its call and the text that it prints.

pub(crate) mod r#abstract;
pub(crate) mod campaign;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod conform;
pub(crate) mod convert;
pub(crate) mod demo;
pub(crate) mod excite;
pub(crate) mod export;
pub(crate) mod identify;
pub(crate) mod inspect;
pub(crate) mod man;
pub(crate) mod model;
pub(crate) mod monitor;
pub(crate) mod prepare;
pub(crate) mod reach;
pub(crate) mod report;
pub(crate) mod reproduce;
pub(crate) mod robot;
pub(crate) mod stop;
pub(crate) mod system;
pub(crate) mod tracking;
pub(crate) mod verify;
