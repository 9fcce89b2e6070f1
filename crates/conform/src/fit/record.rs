use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::fit::group::Group;

/// Number of standard errors by which a fit may move a value that is still a measurement.
pub(crate) const MOST_ERRORS: f64 = 3.0;

/// How the nominal model was fitted, for people and for the model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FitRecord {
    /// The weight of the pull toward the identified values, in parts of the identified model's cost
    /// per unit of the logarithm of a factor.
    pub pull: f64,
    /// Cost of the smallest sets of the identified model.
    pub identified_cost: f64,
    /// Cost of the smallest sets of the fitted model.
    pub cost: f64,
    /// The gain of each group. These costs, and the costs without each motion, are approximate
    /// where the times between samples differ.
    pub groups: Vec<GroupCost>,
    /// Groups that were not fitted, because fits without them carry over better to motions that are
    /// left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dropped: Vec<Group>,
    /// Whether the model has the fitted values. Without a given pull it keeps the identified ones
    /// where these carry over better to motions that are left out.
    pub taken: bool,
    /// How the nominal model that was fitted without each motion, and its sets, carry over to that
    /// motion.
    pub leave_one_out: Vec<UnseenMotion>,
    /// How the identified model and its sets carry over to each motion.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub identified_left_out: Vec<UnseenMotion>,
    /// Cost of the identified model's sets when they are calibrated with the same motions; nothing
    /// without calibration, for a model that is not linear, and where no factor calibrates them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub identified_calibrated_cost: Option<f64>,
    /// The weights of the pull that were tried.
    pub(crate) pulls: Vec<PullCost>,
    /// The parameters.
    pub parameters: Vec<FittedParameter>,
    /// The errors of the input that both models predict, one per part.
    pub torque: Vec<TorquePrediction>,
}

/// Gain of a group of parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroupCost {
    /// The group.
    pub group: Group,
    /// Cost of the sets with this group at its identified values and the others fitted again by a
    /// quick search, which may end somewhat above their optimum; `None` if a nominal motion
    /// diverges.
    pub cost_without: Option<f64>,
}

/// A fit without one motion.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UnseenMotion {
    /// The motion.
    pub motion: String,
    /// Cost of the sets of all motions for the nominal model that was fitted without it; `None` if
    /// a nominal motion diverges.
    pub cost: Option<f64>,
    /// Cost of the sets of the other motions for that model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost_without: Option<f64>,
    /// The factor, at least 1, by which the radii of these sets must grow to enclose the motion;
    /// `None` if no factor suffices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growth: Option<f64>,
    /// The factor of X0 that encloses the starts of the motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_growth: Option<f64>,
    /// The factor of U that encloses the rest of the motion once X0 has grown so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_growth: Option<f64>,
    /// The factor by which a set of positions at the end becomes wider, the one that does most,
    /// once X0 has grown in each state as first samples need it, and then U by a factor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wider: Option<f64>,
    /// Cost of these sets once both have grown by `growth`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grown_cost: Option<f64>,
    /// How many rows of the motion leave these sets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<usize>,
    /// Number of rows of the motion.
    #[serde(default)]
    pub rows: usize,
}

impl UnseenMotion {
    pub(crate) fn runs_away(motion: String) -> Self {
        Self { motion, ..Self::default() }
    }
}

/// Returns the mean of a number over motions; `None` if one of them has none.
pub(crate) fn mean_of(
    motions: &[UnseenMotion],
    of: impl Fn(&UnseenMotion) -> Option<f64>,
) -> Option<f64> {
    let sum: Option<f64> = motions.iter().map(of).sum();
    sum.map(|sum| sum / motions.len() as f64)
}

/// A weight of the pull that was tried.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PullCost {
    /// The weight.
    pub pull: f64,
    /// The mean cost of the sets of all motions over the motions left out; `None` if a nominal
    /// motion diverges.
    pub cost: Option<f64>,
    /// The mean cost, over the motions left out, of the sets that were found without a motion and
    /// have grown until they enclose it; `None` if no factor suffices for one of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grown_cost: Option<f64>,
}

impl PullCost {
    pub(crate) fn new(pull: f64, left_out: &[UnseenMotion]) -> Self {
        let cost = mean_of(left_out, |left| left.cost);
        Self { pull, cost, grown_cost: mean_of(left_out, |left| left.grown_cost) }
    }

    pub(crate) fn in_words(&self, motions: usize) -> String {
        let cost = match self.grown_cost {
            Some(cost) => {
                format!("sets that enclose the motion left out cost {cost:.4} on average")
            }
            None => "no factor of the sets encloses one of the motions left out".into(),
        };
        format!("{motions} fits with pull {}, each without one motion: {cost}", self.pull)
    }

    /// Returns whether the grown sets cost less than for another weight. If no factor suffices for
    /// either, the sets of all motions are compared.
    pub(crate) fn is_less(&self, other: &Self) -> bool {
        let size = |cost: Option<f64>| cost.unwrap_or(f64::INFINITY);
        let of = |costs: &Self| [size(costs.grown_cost), size(costs.cost)];
        of(self) < of(other)
    }
}

impl FitRecord {
    /// Returns the mean cost over the motions left out, with the weight that was chosen; `None` if
    /// a nominal motion diverges.
    #[must_use]
    pub fn left_out_mean(&self) -> Option<f64> {
        mean_of(&self.leave_one_out, |left| left.cost)
    }

    /// Returns the mean cost, over the motions left out, of the sets that have grown until they
    /// enclose the motion: of the identified and of the fitted model.
    pub(crate) fn carried_over(&self) -> [Option<f64>; 2] {
        [&self.identified_left_out, &self.leave_one_out].map(|of| mean_of(of, |m| m.grown_cost))
    }

    /// Returns whether the identified model carries over better to motions that are left out.
    fn is_worse(&self) -> bool {
        let [identified, fitted] =
            [&self.identified_left_out, &self.leave_one_out].map(|of| PullCost::new(self.pull, of));
        match self.identified_left_out.is_empty() {
            true => fitted.cost.is_none_or(|mean| mean > self.identified_cost),
            false => identified.is_less(&fitted),
        }
    }

    /// Returns why the fit suits its motions only, if it does. `calibrated_cost` is the cost of the
    /// fitted model's calibrated sets, where they are calibrated.
    pub(crate) fn overfitted(&self, calibrated_cost: Option<f64>) -> Option<Overfit> {
        let costs = self.identified_calibrated_cost.zip(calibrated_cost);
        match costs.filter(|(before, after)| after > before) {
            _ if !self.taken => None,
            Some((identified, fitted)) => Some(Overfit::Calibrated { identified, fitted }),
            None => self.is_worse().then(|| {
                let [identified, fitted] = self.carried_over();
                Overfit::LeftOut { identified, fitted }
            }),
        }
    }
}

/// Why a fit suits its own motions only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Overfit {
    /// Calibrated sets cost more with the fitted model than with the identified one.
    Calibrated { identified: f64, fitted: f64 },
    /// With a motion left out, the fitted model needs larger sets than the identified one. The
    /// mean costs of sets that have grown until they enclose the motion, where they were found.
    LeftOut { identified: Option<f64>, fitted: Option<f64> },
}

/// A parameter before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FittedParameter {
    /// Its group.
    pub group: Group,
    /// What it is.
    pub name: String,
    /// The part, from 1.
    pub part: usize,
    /// The unit of the values.
    pub unit: String,
    /// The identified value.
    pub identified: f64,
    /// Its standard error, where the robot's description has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
    /// The fitted value.
    pub fitted: f64,
    /// The factor of the identified value, if the parameter is a factor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
}

impl FittedParameter {
    /// Returns whether the fit moved the value further than the recordings of the identification
    /// allow: it compensates for model error and is no measurement.
    pub(crate) fn is_beyond_error(&self) -> bool {
        let moved = (self.fitted - self.identified).abs();
        self.standard_error.is_some_and(|error| moved > MOST_ERRORS * error)
    }

    /// Returns whether the fit moved the value by more than 0.05 % of it.
    #[must_use]
    pub fn has_changed(&self) -> bool {
        // The factor of several coefficients counts also where the one that is shown is 0.
        if let Some(factor) = self.factor {
            return (factor - 1.0).abs() > 5e-4;
        }
        let size = self.identified.abs().max(self.fitted.abs()).max(1e-6);
        (self.fitted - self.identified).abs() > 5e-4 * size
    }
}

/// The error of the predicted input of one part along the recordings, N m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TorquePrediction {
    /// The part, from 1.
    pub part: usize,
    /// The root mean square with the identified model.
    pub identified: f64,
    /// The root mean square with the fitted model.
    pub fitted: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_beyond_its_error_from_three_standard_errors_on() {
        let of = |standard_error: Option<f64>| FittedParameter {
            group: Group::Viscous,
            name: "viscous friction".into(),
            part: 1,
            unit: "N m/(rad/s)".into(),
            identified: 2.0,
            standard_error,
            fitted: 2.5,
            factor: None,
        };
        let errors = [Some(0.1), Some(0.2), None];
        assert_eq!(errors.map(|error| of(error).is_beyond_error()), [true, false, false]);
    }
}
