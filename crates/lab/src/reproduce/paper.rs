//! The numbers printed in Tables I and II of the paper, and the speeds of Table I.

use reachtube_abstraction::ModelKind;
use schemars::JsonSchema;
use serde::Serialize;

/// The speed of the robot along its paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Speed {
    /// Each joint peaks at a third of its speed limit: 0.4 rad/s for the LWA 4P.
    Slow,
    /// Each joint peaks at its speed limit: 1.2 rad/s for the LWA 4P.
    Fast,
}

impl Speed {
    /// Both speeds.
    pub const ALL: [Self; 2] = [Self::Slow, Self::Fast];

    /// Returns the duration of a motion over its duration at full speed.
    pub(super) fn slowness(self) -> f64 {
        match self {
            Self::Slow => 3.0,
            Self::Fast => 1.0,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Slow => "slow",
            Self::Fast => "fast",
        }
    }
}

/// An entry of Table I in the paper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
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

/// A half of Table II in the paper: the bounds of each joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub(crate) struct PaperSets {
    /// X0, positions \[rad\].
    pub x0_q: [[f64; 2]; 6],
    /// X0, velocities \[rad/s\].
    pub x0_qd: [[f64; 2]; 6],
    /// U \[N m\].
    pub u: [[f64; 2]; 6],
}

/// X0 of the positions, the same in both halves.
const X0_Q: [[f64; 2]; 6] = [
    [-0.0030, 0.0030],
    [-0.0017, 0.0017],
    [-0.0025, 0.0025],
    [-0.0027, 0.0027],
    [-0.0075, 0.0075],
    [-0.0063, 0.0063],
];

/// "Velocity conformant".
pub(super) static PAPER_VELOCITIES: PaperSets = PaperSets {
    x0_q: X0_Q,
    x0_qd: [
        [-0.0317, 1.2140],
        [-0.6586, 0.2550],
        [-0.0154, 0.0463],
        [-0.0184, 0.0331],
        [-0.1179, 0.0551],
        [-0.0765, 0.0765],
    ],
    u: [
        [-2.7201, 3.6017],
        [-2.3225, 7.1559],
        [-6.8833, 2.6287],
        [-1.7374, 2.0317],
        [-1.4919, 0.5486],
        [-1.0060, 1.0060],
    ],
};

/// "Position conformant".
pub(super) static PAPER_POSITIONS: PaperSets = PaperSets {
    x0_q: X0_Q,
    x0_qd: [
        [-0.2785, 1.1309],
        [-2.0695, 2.3636],
        [0.0, 0.0],
        [0.0, 0.6020],
        [-0.3491, 0.1180],
        [-0.6369, 0.7051],
    ],
    u: [
        [-1.9257, 1.8615],
        [-0.8212, 1.0395],
        [-1.8045, 1.5717],
        [-1.2072, 1.2231],
        [-0.6622, 0.2146],
        [-0.5366, 0.5187],
    ],
};
