use rayon::prelude::*;
use reachtube_scalar::Interval;
use serde::{Deserialize, Serialize};

use crate::Propagation;
use crate::matrix::{IntervalMatrix, absolute, product};
use crate::variation::{measurable_gains, sample_gains_on_any_grid};

/// How the disturbance of the input may change over time. It decides κ, the gain from the radius of the input set to the radius of the
/// reachable set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Disturbance {
    /// Constant in time (Prop. 1 of the paper): κ = |Γ(t_k)|. Oversizes the input set where an entry of e^{At} B changes sign.
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
    /// Outer enclosure of the exact gain, directed rounding: its lower end times a radius is an inner bound, its upper end an outer bound of the reachable radius. On a grid that is not uniform the upper end of
    /// `Sample` is that of `Measurable`, which contains it.
    pub fn gains(self, propagation: &Propagation) -> Vec<IntervalMatrix> {
        match self {
            Self::Constant => {
                (0..propagation.grid().len()).map(|k| absolute(propagation.integral(k))).collect()
            }
            Self::Sample if propagation.grid().step().is_some() => sample_gains(propagation),
            Self::Sample => sample_gains_on_any_grid(propagation),
            Self::Measurable => measurable_gains(propagation),
        }
    }
}

/// On a uniform grid the increments Γ((j+1)h) - Γ(jh) = e^{A jh} Γ(h) do not depend on k, and κ is their running sum.
fn sample_gains(propagation: &Propagation) -> Vec<IntervalMatrix> {
    let increment = |k: usize| absolute(&product(propagation.exponential(k), &propagation.step(k).gamma));
    let increments: Vec<_> =
        (1..propagation.grid().len()).into_par_iter().map(|k| increment(k - 1)).collect();
    running_sum(propagation, &increments)
}

/// Σ_{j<k} of the increments, at every sample k.
pub(crate) fn running_sum(propagation: &Propagation, increments: &[IntervalMatrix]) -> Vec<IntervalMatrix> {
    let system = propagation.system();
    let mut sum = IntervalMatrix::from_element(system.states(), system.inputs(), Interval::ZERO);
    let mut gains = Vec::with_capacity(propagation.grid().len());
    for k in 0..propagation.grid().len() {
        if k > 0 {
            sum += &increments[k - 1];
        }
        gains.push(sum.clone());
    }
    gains
}
