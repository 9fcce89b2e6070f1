//! The numbers printed in Table I of the paper.

use reachtube_abstraction::ModelKind;
use serde::Serialize;

use super::speed::Speed;

/// An entry of Table I in the paper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Paper {
    /// Mean velocity error \[rad/s\].
    Error(f64),
    /// ∞: the model diverged.
    Diverged,
}

impl Paper {
    /// Returns the entry for a model of an order at a speed, where the paper has one.
    pub(super) fn entry(model: ModelKind, order: u32, speed: Speed) -> Option<Self> {
        let [slow, fast] = match (model, order) {
            (_, 1) => [0.0040, 0.0408],
            (ModelKind::One, 3) => [0.0034, 0.0243],
            (ModelKind::Two, 3) => [0.0042, 0.0294],
            (ModelKind::Two, 5) => [0.0026, 0.0161],
            (ModelKind::Two, 7) => [0.0025, 0.0162],
            (ModelKind::Three, 3) => [f64::INFINITY; 2],
            (ModelKind::Three, 5) => [0.0031, f64::INFINITY],
            _ => return None,
        };
        let error = if speed == Speed::Slow { slow } else { fast };
        Some(if error.is_finite() { Self::Error(error) } else { Self::Diverged })
    }
}
