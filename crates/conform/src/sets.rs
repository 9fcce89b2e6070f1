use std::borrow::Cow;

use reachtube_reach::Hyperrectangle;
use reachtube_scalar::rounding::add_up;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The factors of U along a nominal motion, one per input: U has its radii times these. There are
/// none where U is the same along every motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct InputScale(pub(crate) Vec<f64>);

/// The uncertainty sets of a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UncertaintySets {
    /// X0, 2n, rad and rad/s, around the nominal initial state.
    pub initial_set: Hyperrectangle,
    /// U, n, N m, around the nominal input.
    pub input_set: Hyperrectangle,
    /// V, 2n, rad and rad/s, centred at 0: added to the reachable set where it is compared with
    /// measurements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_set: Option<Hyperrectangle>,
}

impl UncertaintySets {
    /// Returns the radius of V in state `i`, 0 without V.
    #[must_use]
    pub fn noise_radius(&self, i: usize) -> f64 {
        self.noise_set.as_ref().map_or(0.0, |set| set.radius[i])
    }

    /// Returns the sets along a motion: the radii of U times its scale, rounded to nearest, which
    /// defines them.
    pub(crate) fn along(&self, InputScale(scale): &InputScale) -> Cow<'_, Self> {
        if scale.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut scaled = self.clone();
        let radii = scaled.input_set.radius.iter_mut();
        radii.zip(scale).for_each(|(radius, factor)| *radius *= factor);
        Cow::Owned(scaled)
    }

    /// The radii of U times `factor`, rounded to nearest.
    pub(crate) fn with_input_scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        scaled.input_set.radius.iter_mut().for_each(|radius| *radius *= factor);
        scaled
    }

    /// Returns the sets with the radii of X0 times `factor`, rounded to nearest.
    pub(crate) fn with_initial_scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        scaled.initial_set.radius.iter_mut().for_each(|radius| *radius *= factor);
        scaled
    }

    /// Returns the sets with the radii of X0 and U scaled about their centres, or of U alone where
    /// the noise of the sensors limits X0 (`input_only`).
    pub(crate) fn grown(&self, factor: f64, input_only: bool) -> Self {
        if input_only { self.with_input_scaled(factor) } else { self.inflated(factor, 0.0) }
    }

    /// Returns the sets with radii added to X0 and U, 3n, rounded up.
    pub(crate) fn widened(&self, allowance: &[f64]) -> Self {
        let mut wider = self.clone();
        let UncertaintySets { initial_set, input_set, .. } = &mut wider;
        let radii = initial_set.radius.iter_mut().chain(&mut input_set.radius);
        radii.zip(allowance).for_each(|(radius, more)| *radius = add_up(*radius, *more));
        wider
    }

    /// All radii times `factor` plus `term`, both rounded to nearest. The radius of V is left
    /// alone: where it is known it must stay.
    pub(crate) fn inflated(&self, factor: f64, term: f64) -> Self {
        let inflate = |set: &Hyperrectangle| Hyperrectangle {
            centre: set.centre.clone(),
            radius: set.radius.iter().map(|r| r * factor + term).collect(),
        };
        Self {
            initial_set: inflate(&self.initial_set),
            input_set: inflate(&self.input_set),
            noise_set: self.noise_set.clone(),
        }
    }
}
