//! The choices so far.

use crate::choices::{Choice, Choices};

/// The choices so far.
pub(crate) struct Road<'a> {
    pub choices: Choices,
    pub made: Vec<Choice>,
    pub say: &'a mut dyn FnMut(&Choice),
}

impl Road<'_> {
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
}
