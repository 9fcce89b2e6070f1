//! The choices so far.

use reachtube_conform::Progress;

use crate::allowance::Widened;
use crate::choices::{Choice, Choices};
use crate::held_out::Split;

/// The choices so far.
pub(crate) struct Chooser<'a> {
    pub choices: Choices,
    pub made: Vec<Choice>,
    pub say: &'a mut dyn FnMut(&Choice),
    pub progress: &'a dyn Progress,
}

impl Chooser<'_> {
    /// Reports a choice and notes it. A reason that came with the settings is kept.
    pub(crate) fn choose(
        &mut self,
        key: &'static str,
        value: impl Into<String>,
        reason: impl Into<String>,
    ) {
        let reason = self.choices.reasons.get(key).cloned().unwrap_or_else(|| reason.into());
        let choice = Choice { key, value: value.into(), reason };
        (self.say)(&choice);
        self.made.push(choice);
    }

    pub(crate) fn choose_held_out(&mut self, split: &Split) {
        let names = if split.names.is_empty() { "the end".into() } else { split.names.join(", ") };
        self.choose("held-out", names, &split.reason);
        self.choices.held_out = (!split.names.is_empty()).then(|| split.names.clone());
    }

    pub(crate) fn choose_allowance(&mut self, found: &Widened) {
        self.choose("allowance", found.words(), &found.reason);
        self.choices.allowance = Some(found.allowance.clone());
    }
}
