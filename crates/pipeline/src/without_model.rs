//! What the recordings say without a model of the robot: the least that a model must beat.
//!
//! A joint whose acceleration lies in a box needs no robot and no torque. Its sets are found,
//! proved and left out in turn by the same steps as the sets of the model, over the same windows,
//! so that both can be compared: each with the factor by which the sets of the others have to grow
//! for the motion that leaves them furthest.

use reachtube_arm::Equations;
use reachtube_finding::{Finding, Table};
use reachtube_scalar::number::significant;
use schemars::JsonSchema;
use serde::Serialize;

use crate::allowance::Widened;
use crate::choices::Choices;
use crate::error::{Error, Result};
use crate::faster::Halves;
use crate::foretold::Foretold;
use crate::horizon::MOST_WINDOWS;
use crate::trial::Trial;
use crate::windows::Prepared;
use crate::would_help::would_help;

/// Sets without a model beside the sets of the model.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct WithoutModel {
    /// What stands in place of the robot's motion.
    pub equations: Equations,
    /// Half the width of the widest set by the joint's displacement, with the factor that a motion
    /// needs which is left out; `None` where no factor suffices.
    pub widest: Option<f64>,
    /// The joint, from 0, of that set, and the number of windows.
    #[serde(skip)]
    pub(crate) widest_of: [usize; 2],
    /// The same of the model.
    pub widest_of_model: Option<f64>,
    /// For each joint, n, half the width without a model by half the width with it, both with that
    /// factor.
    #[serde(skip)]
    pub narrower: Vec<f64>,
    /// Part of the rows of the faster half of the motions that lie outside the sets of the slower
    /// half, its allowance included: of the model, and without one. `None` for a single motion.
    pub faster: Option<[f64; 2]>,
    /// The same part of the model with its allowance, where the allowance was found or given for
    /// faster motions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faster_with_allowance: Option<f64>,
    /// The part of the rows that may lie outside.
    #[serde(skip)]
    pub(crate) largest_outside: f64,
}

impl WithoutModel {
    /// Compares the sets of a model with the narrowest sets without one.
    ///
    /// # Errors
    ///
    /// As [`Widened::new`].
    pub(crate) fn new(
        trial: &Trial,
        recordings: &Prepared,
        horizon: f64,
        own: &Foretold,
        halves: Option<&Halves>,
    ) -> Result<Self> {
        let mut best: Option<(Trial, f64)> = None;
        for equations in Equations::KINEMATIC {
            let same = Trial { input_doubling: None, ..kinematic(trial, equations) };
            // At a constant velocity, U grows with nothing.
            let growing = trial.input_doubling.is_some() && equations != Equations::Velocity;
            let growing = growing.then(|| kinematic(trial, equations));
            for other in std::iter::once(same).chain(growing) {
                let found = Widened::of_some(&other, recordings, horizon, MOST_WINDOWS)?;
                let widest = found.foretold.widest();
                if best.as_ref().is_none_or(|(_, narrowest)| widest < *narrowest) {
                    best = Some((other, widest));
                }
            }
        }
        let (other, _) = best.expect("there are kinematic equations");
        let equations = other.equations;
        let Widened { answer, foretold: without, .. } = Widened::new(&other, recordings, horizon)?;
        let windows = answer.model.data.run_count();
        let narrower = |joint| without.half_width(joint) / own.half_width(joint);
        let faster = |halves: &Halves| {
            Ok::<_, Error>([halves.part_outside(trial)?, halves.part_outside(&other)?])
        };
        let finite = |ratio: f64| Some(ratio).filter(|ratio| ratio.is_finite());
        Ok(Self {
            equations,
            widest: finite(without.widest()),
            widest_of: [without.widest_joint(), windows],
            widest_of_model: finite(own.widest()),
            narrower: (0..own.half_widths.len()).map(narrower).collect(),
            faster: halves.map(faster).transpose()?,
            faster_with_allowance: None,
            largest_outside: trial.largest_outside,
        })
    }

    /// Compares sets as [`new`](Self::new) does, if the model knows the robot or its torque, and
    /// widens them by the least allowance with which the slower motions would have foretold the
    /// faster ones, if they do not, but are narrower than without a model. Sets that become too
    /// wide stay as they are. An allowance that was given is tried as it is.
    ///
    /// # Errors
    ///
    /// As [`Widened::new`].
    pub(crate) fn beside(
        mut found: Widened,
        trial: &Trial,
        recordings: &Prepared,
        (horizon, choices): (f64, &Choices),
    ) -> Result<(Option<Self>, Widened)> {
        if trial.equations.is_kinematic() {
            return Ok((None, found));
        }
        let halves = Halves::new(recordings, horizon);
        let mut own = Self::new(trial, recordings, horizon, &found.foretold, halves.as_ref())?;
        let most = own.most_outside().filter(|_| choices.accept(&found.answer.model));
        let Some((halves, most)) = halves.zip(most) else { return Ok((Some(own), found)) };
        let needed = found.answer.found.allowance_needed.as_ref();
        let shape = needed.filter(|_| trial.allowance.is_none()).map(|needed| &*needed.shape);
        let radii = (&*found.allowance, shape.unwrap_or_default());
        let Some((allowance, part)) = halves.allowance(trial, radii, most)? else {
            return Ok((Some(own), found));
        };
        if allowance != found.allowance {
            let trial = Trial { allowance: Some(allowance), ..trial.clone() };
            let wider = Widened::new(&trial, recordings, horizon)?;
            if !choices.accept(&wider.answer.model) {
                return Ok((Some(own), found));
            }
            found = wider.because(&found, part);
        }
        own.faster_with_allowance = Some(part);
        Ok((Some(own), found))
    }

    /// Returns whether the model is worth having: its sets are narrower than without one, and of
    /// faster motions no more rows lie outside than accepted, or than without one.
    #[must_use]
    pub(crate) fn is_model_better(&self) -> bool {
        self.gain() > 1.0 && self.too_many_outside().is_none()
    }

    /// Returns the part of the rows of faster motions that may lie outside, if more lie outside
    /// although the sets are narrower than without a model.
    fn most_outside(&self) -> Option<f64> {
        self.too_many_outside().filter(|_| self.gain() > 1.0)
    }

    fn too_many_outside(&self) -> Option<f64> {
        let [own, without] = self.faster?;
        let most = without.max(self.largest_outside);
        (self.faster_with_allowance.unwrap_or(own) > most).then_some(most)
    }

    /// Returns the geometric mean over the joints of the factor by which sets are narrower.
    fn gain(&self) -> f64 {
        let logarithms = self.narrower.iter().map(|factor| factor.ln());
        (logarithms.sum::<f64>() / self.narrower.len().max(1) as f64).exp()
    }

    /// Adds a column to a table of the joints: by which factor their sets are narrower.
    pub(crate) fn add_to(&self, table: &mut Table) {
        table.header.push("narrower".into());
        for (row, narrower) in table.rows.iter_mut().zip(&self.narrower) {
            let times = || format!("x {}", significant(*narrower, 2));
            row.push(if narrower.is_finite() { times() } else { "-".into() });
        }
    }

    /// Returns why a model is not worth having, in a few words.
    pub(crate) fn why_better(&self) -> String {
        match (self.widest_of_model, self.faster) {
            (None, _) => "no factor of its sets encloses a motion that was left out".into(),
            (_, Some([own, without])) if self.gain() > 1.0 => format!(
                "of faster motions {} of the rows leave its sets, and without a model {},",
                percent(Some(own)),
                percent(Some(without))
            ),
            _ => {
                let gain = significant(self.gain(), 2);
                format!("without a model the sets are no wider, {gain} times as wide,")
            }
        }
    }

    /// Returns what the sets without a model would give, as a choice that was not applied.
    pub(crate) fn remedy(&self, trial: &Trial) -> Finding {
        let [joint, windows] = self.widest_of;
        let widths = [self.widest_of_model, self.widest];
        let widths = widths.map(|widest| widest.unwrap_or(f64::INFINITY));
        let value = format!("{:?}", self.equations).to_lowercase();
        would_help("equations", &value, &trial.robot.joints()[joint].name, widths, windows)
    }

    /// Returns how the sets without a model compare, in a few words.
    #[must_use]
    pub fn words(&self) -> String {
        let [own, without] = [self.widest_of_model, self.widest].map(percent);
        let faster = self.faster.map_or_else(String::new, |[own, without]| {
            let [own, without] = [own, without].map(|part| percent(Some(part)));
            let allowed = self.faster_with_allowance.map_or_else(String::new, |part| {
                format!(", with its allowance {}", percent(Some(part)))
            });
            format!("; of faster motions {without} outside (with it {own}{allowed})")
        });
        let times = match self.gain() {
            gain if gain.is_finite() => format!("sets {} times as wide, the", significant(gain, 2)),
            _ => "the".into(),
        };
        format!("{times} widest {without} (with it {own}){faster}")
    }
}

fn percent(part: Option<f64>) -> String {
    match part {
        None => "without bound".into(),
        Some(part) if part > 0.0 && part < 0.1 => format!("{:.1} %", 100.0 * part),
        Some(part) => format!("{:.0} %", 100.0 * part),
    }
}

/// Returns the trial without a model.
fn kinematic<'a>(trial: &Trial<'a>, equations: Equations) -> Trial<'a> {
    Trial { equations, allowance: None, folds: &[], fit: None, ..trial.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compared(narrower: Vec<f64>, faster: Option<[f64; 2]>) -> WithoutModel {
        let (widest, widest_of_model) = (Some(0.9), Some(0.3));
        let equations = Equations::Held;
        WithoutModel {
            equations,
            widest,
            widest_of: [0, 1],
            widest_of_model,
            narrower,
            faster,
            faster_with_allowance: None,
            largest_outside: 0.01,
        }
    }

    #[test]
    fn a_model_is_worth_having_where_it_beats_none() {
        let better = compared(vec![4.0, 1.0], Some([0.01, 0.2]));
        assert!(better.is_model_better());
        // What is accepted of motions that were left out is accepted of faster ones.
        assert!(compared(vec![4.0], Some([0.01, 0.0])).is_model_better());
        assert!(!compared(vec![4.0], Some([0.02, 0.0])).is_model_better());
        assert_eq!(
            better.words(),
            "sets 2 times as wide, the widest 90 % (with it 30 %); of faster motions 20 % outside \
             (with it 1.0 %)"
        );
        let allowed = WithoutModel {
            faster_with_allowance: Some(0.01),
            ..compared(vec![4.0], Some([0.02, 0.0]))
        };
        assert!(allowed.is_model_better());
        assert!(allowed.words().ends_with("(with it 2.0 %, with its allowance 1.0 %)"));
        let wider = compared(vec![0.5, 1.9], None);
        assert!(!wider.is_model_better() && wider.why_better().contains("no wider, 0.97 times as"));
        let slower = compared(vec![2.0, 2.0], Some([0.4, 0.1]));
        assert!(!slower.is_model_better());
        assert!(slower.why_better().starts_with("of faster motions 40 % of the rows leave"));
        let lost = WithoutModel { widest: None, ..compared(vec![f64::INFINITY], None) };
        assert!(lost.is_model_better());
        assert_eq!(lost.words(), "the widest without bound (with it 30 %)");
        // Neither foretells anything.
        assert!(!compared(vec![f64::NAN], None).is_model_better());
    }
}
