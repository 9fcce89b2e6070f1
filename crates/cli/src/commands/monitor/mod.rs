//! `reachtube monitor`: samples on standard input, and at once what leaves a model's sets.

mod arguments;
mod events;
mod lines;
mod run;
mod samples;
mod tracking;

pub(crate) use arguments::Arguments;
pub(crate) use events::Event;
pub(crate) use run::run;
pub(crate) use tracking::TrackingEvent;
