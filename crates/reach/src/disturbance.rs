use serde::{Deserialize, Serialize};

use crate::Propagation;
use crate::matrix::{IntervalMatrix, absolute};
use crate::variation::{measurable_gains, sample_gains_on_any_grid};

/// How the disturbance of the input may change over time. It decides κ, the gain from the radius of
/// the input set to the radius of the reachable set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Disturbance {
    /// Constant in time (Prop. 1 of the paper): κ = |Γ(t_k)|. Oversizes the input set where an
    /// entry of e^{At} B changes sign.
    Constant,
    /// Constant over each sample: κ = Σ_j |Γ(t_k - t_j) - Γ(t_k - t_{j+1})|.
    #[default]
    Sample,
    /// Any measurable function: κ = ∫₀^{t_k} |e^{Aτ} B| dτ.
    Measurable,
}

impl Disturbance {
    /// κ(t_k), N x m, at every sample of the propagation.
    ///
    /// # Guarantee
    ///
    /// Outer enclosure of the exact gain, directed rounding: its lower end times a radius is an
    /// inner bound, its upper end an outer bound of the reachable radius. On a grid that is not
    /// uniform the upper end of `Sample` is that of `Measurable`, which contains it.
    pub fn gains(self, propagation: &Propagation) -> Vec<IntervalMatrix> {
        match self {
            Self::Constant => {
                (0..propagation.grid().len()).map(|k| absolute(propagation.integral(k))).collect()
            }
            // On a uniform grid the increments Γ((j+1)h) - Γ(jh) do not depend on k, and κ is their
            // running sum.
            Self::Sample if propagation.grid().step().is_some() => propagation.absolute_sums(),
            Self::Sample => sample_gains_on_any_grid(propagation),
            Self::Measurable => measurable_gains(propagation),
        }
    }
}
