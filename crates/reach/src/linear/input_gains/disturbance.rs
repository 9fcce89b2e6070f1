use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::linear::input_gains::measurable::measurable_gains;
use crate::linear::input_gains::sampled::sample_gains_on_any_grid;
use crate::linear::propagation::Propagation;
use crate::sets::interval_matrix::{IntervalMatrix, absolute};

/// The class of disturbances of the input: how they may change over time.
///
/// The class decides the input gain κ from the radius of the input set to the radius of the
/// reachable set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Disturbance {
    /// The disturbance is constant in time (Prop. 1 of the paper): κ = |Γ(t_k)|.
    ///
    /// Conformance then needs a larger input set where an entry of e^{At} B changes sign.
    Constant,
    /// The disturbance is constant over each sampling step:
    /// κ = Σ_j |Γ(t_k - t_j) - Γ(t_k - t_{j+1})|.
    #[default]
    Sample,
    /// The disturbance is any measurable function: κ = ∫₀^{t_k} |e^{Aτ} B| dτ.
    Measurable,
}

impl Disturbance {
    /// Computes the input gains κ(t_k), N x m, at every sample of the propagation.
    ///
    /// # Guarantee
    ///
    /// Outer enclosure of the exact gain, directed rounding. The lower end times a radius is an
    /// inner bound of the reachable radius, the upper end an outer bound. On a grid that is not
    /// uniform, `Sample` has the upper end of `Measurable`, which contains it.
    pub fn input_gains(self, propagation: &Propagation) -> Vec<IntervalMatrix> {
        match self {
            Self::Constant => {
                (0..propagation.grid().len()).map(|k| absolute(propagation.integral(k))).collect()
            }
            // On a uniform grid, κ is the running sum of the absolute increments Γ((j+1)h) - Γ(jh).
            Self::Sample if propagation.grid().step().is_some() => propagation.absolute_sums(),
            Self::Sample => sample_gains_on_any_grid(propagation),
            Self::Measurable => measurable_gains(propagation),
        }
    }
}
