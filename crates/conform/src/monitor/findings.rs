//! The findings of a monitor.

use reachtube_scalar::number::counted;

use crate::data::side::Side;
use crate::data::signals::Signals;
use crate::monitor::leave::Leave;
use crate::monitor::monitor::Totals;
use crate::result::code::Code;
use reachtube_finding::{Finding, Severity};

impl Leave {
    /// Returns the value as a finding about a model with these signals.
    #[must_use]
    pub fn finding(&self, signals: &Signals) -> Finding {
        let name = &signals.parts[self.part - 1].name;
        let Self { time, window, state, excess, .. } = self;
        let side = match self.side {
            Side::Upper => "above",
            Side::Lower => "below",
        };
        let rounding = if self.proved { "" } else { ", within rounding" };
        let unit = signals.unit(*state);
        let text = format!(
            "{time:.4} s: {name} left its set: {state} is {excess:.2e} {unit} {side} \
             it{rounding}, in the window from {window:.4} s"
        );
        let finding = Finding::new(Severity::Failure, Code::LeftSet, text).at(name);
        finding.with("time", *time).with("window", *window).with("excess", *excess)
    }
}

impl Totals {
    /// Returns the verdict about all windows.
    #[must_use]
    pub fn finding(&self) -> Finding {
        let Self { samples, windows, left, rows, outside, alarms } = *self;
        let raised = counted(alarms as usize, "alarm");
        let finding = if left == 0 && alarms > 0 {
            let text = format!(
                "unlike healthy motion: {raised}; {samples} samples stayed in the sets of \
                 all windows, of which {windows} ended"
            );
            Finding::new(Severity::Failure, Code::UnlikeHealthy, text)
        } else if left == 0 {
            let text = format!(
                "never left: {samples} samples stayed in the sets of all windows, of which \
                 {windows} ended"
            );
            Finding::new(Severity::Info, Code::NeverLeft, text)
        } else {
            let text = format!(
                "left: {left} windows left their sets, {windows} ended; {outside} of {rows} rows \
                 are outside{}",
                if alarms > 0 { format!("; {raised}") } else { String::new() }
            );
            Finding::new(Severity::Failure, Code::LeftSet, text)
        };
        let finding = finding.with("samples", samples as f64).with("windows_left", left as f64);
        finding.with("alarms", alarms as f64)
    }
}
