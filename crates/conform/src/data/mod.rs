//! A model, settings and recordings that are read once: what every step of a conformance takes.

pub(crate) mod case;
pub(crate) mod condition;
pub(crate) mod envelope;
pub(crate) mod fold;
pub(crate) mod input;
pub(crate) mod kept;
pub(crate) mod live_input;
pub(crate) mod marks;
mod notes;
pub(crate) mod notion;
pub(crate) mod origin;
pub(crate) mod problem;
pub(crate) mod recordings;
pub(crate) mod runaway;
pub(crate) mod sensor_noise;
pub mod settings;
pub(crate) mod setup;
pub(crate) mod shape;
pub(crate) mod side;
pub(crate) mod signals;
mod stored;
mod subset;
pub(crate) mod suite;
pub(crate) mod summary;
pub(crate) mod totals;
pub(crate) mod tree;

pub use case::Case;
pub use condition::Condition;
pub use envelope::Envelope;
pub use input::RunInput;
pub use live_input::LiveInput;
pub use sensor_noise::SensorNoise;
pub use setup::{
    Asked, Compensation, Drive, DryFriction, FreeParameter, Near, Parameters, Residual, Torques,
};
pub use side::Side;
pub use signals::{Part, Signal, Signals};
pub use suite::Suite;
pub use summary::RunSummary;
