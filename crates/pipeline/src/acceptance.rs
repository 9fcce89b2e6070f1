//! Whether a model is of use, and carries over to motions that it has not seen.

use reachtube_conform::next_motion::LeftOut;
use reachtube_recordings::Torque;

use crate::build::Built;
use crate::choices::{LARGEST_GROWTH, LARGEST_RATIO};
use crate::without_model::WithoutModel;

impl Built {
    /// Returns whether the sets were proved to enclose every window, limit every joint, are narrow
    /// enough at the horizon and narrower than without a model, and carry over to what was held
    /// out, and nothing contradicts the recordings.
    #[must_use]
    pub fn is_useful(&self) -> bool {
        self.choices.accept(&self.answer.model)
            && self.worse_than_without().is_none()
            && self.growth_not_accepted().is_none()
            && self.left_out_not_accepted().is_none()
            && self.held_out.part_outside() <= self.choices.largest_outside()
            && self.contradiction().is_none()
    }

    /// Returns the sets without a model, if they are better: the widest is narrower, or more of the
    /// rows of faster motions lie inside.
    pub(crate) fn worse_than_without(&self) -> Option<&WithoutModel> {
        self.without_model.as_ref().filter(|without| !without.is_model_better())
    }

    /// Returns half a joint's set by the joint's displacement that is accepted at most.
    #[must_use]
    pub fn largest_ratio(&self) -> f64 {
        self.choices.largest_ratio.unwrap_or(LARGEST_RATIO)
    }

    /// Returns the factor by which a joint's set may have to grow for motions that were held out.
    #[must_use]
    pub(crate) fn largest_growth(&self) -> f64 {
        self.choices.largest_growth.unwrap_or(LARGEST_GROWTH)
    }

    /// Returns the joint, from 0, whose set would have to grow most for motions that were held out,
    /// with the factor, if it is not accepted. Without a window that was held out there is none.
    pub(crate) fn growth_not_accepted(&self) -> Option<(usize, f64)> {
        let growth = self.held_out.growth.iter().copied().enumerate();
        let (joint, factor) = growth.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let is_compared = self.held_out.windows > 0;
        (is_compared && factor > self.largest_growth()).then_some((joint, factor))
    }

    /// Returns the factor by which the sets would have to grow for a motion that was left out of
    /// all that was made of the motions, if it is not accepted and the sets have no allowance for
    /// it. Repeated recordings support no claim about other motions.
    pub(crate) fn left_out_not_accepted(&self) -> Option<f64> {
        let model = &self.answer.model;
        let preparation = model.preparation.as_ref();
        let is_repeated = preparation.is_some_and(|done| done.torque == Torque::Compensated);
        let has_allowance = !self.answer.found.allowance.is_empty();
        let factor = model.left_out.iter().map(LeftOut::growth).fold(1.0, f64::max);
        let is_asked = !is_repeated && !has_allowance;
        (is_asked && factor > self.largest_growth()).then_some(factor)
    }

    /// Returns why a model that was proved and is not vacuous is of no use, in a few words.
    pub(crate) fn why_useless(&self) -> String {
        if !self.choices.accept(&self.answer.model) {
            return "too wide to be of use".into();
        }
        if let Some(without) = self.worse_than_without() {
            return without.why_better();
        }
        match self.growth_not_accepted() {
            None if self.left_out_not_accepted().is_some() => {
                "its sets do not foretell a motion that was left out,".into()
            }
            None => format!(
                "{:.1} % of the held-out rows are outside (at most {} % is accepted),",
                100.0 * self.held_out.part_outside(),
                100.0 * self.choices.largest_outside()
            ),
            Some((_, factor)) if factor.is_infinite() => {
                "held-out motions could not be followed".into()
            }
            Some((joint, factor)) => format!(
                "held-out motions need {factor:.2} times the set of {} (at most {} is accepted),",
                self.answer.model.signals.parts[joint].name,
                self.largest_growth()
            ),
        }
    }
}
