use schemars::JsonSchema;
use serde::Serialize;

use crate::data::signals::Signals;
use crate::result::code::Code;
use reachtube_finding::{Finding, Severity};

/// The kind of a fault that makes motion unlike healthy motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// A torque that acts on a part suddenly, as a collision's does, N m.
    Push,
    /// Friction of a part that the model does not have, N m.
    Drag,
    /// A mass at the origin of the last link's frame that the model does not have, kg.
    Payload,
}

/// A number that is outside its range in healthy motion.
///
/// # Guarantee
///
/// None for a single alarm: it is calibrated, not proved.
/// [`HealthyMotion::bound`](crate::monitor::HealthyMotion::bound) bounds how often healthy motion
/// raises one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Alarm {
    /// Time of the sample, s.
    pub time: f64,
    /// What changed.
    pub fault: Fault,
    /// Part, from 1; `None` for the payload.
    pub part: Option<usize>,
    /// The number, N m or kg.
    pub value: f64,
    /// The least and the largest number without an alarm, N m or kg.
    pub range: [f64; 2],
}

impl Alarm {
    /// Returns the alarm as a finding about a model with these signals.
    #[must_use]
    pub fn finding(&self, signals: &Signals) -> Finding {
        let Self { time, value, range: [low, high], .. } = *self;
        let of = |part: usize| {
            (signals.parts[part - 1].name.as_str(), signals.inputs[part - 1].unit.as_str())
        };
        let (name, unit) = self.part.map_or(("the arm", "N m"), of);
        let (what, unit) = match self.fault {
            Fault::Push => (format!("a sudden torque acts on {name}"), unit),
            Fault::Drag => (format!("{name} drags"), unit),
            Fault::Payload => ("the payload is not the model's".into(), "kg"),
        };
        let text = format!(
            "{time:.4} s: {what}: {value:.2} {unit}; in healthy motion between {low:.2} and \
             {high:.2} {unit}"
        );
        let finding = Finding::new(Severity::Failure, Code::UnlikeHealthy, text).at(name);
        finding.with("time", time).with("value", value).with("low", low).with("high", high)
    }
}
