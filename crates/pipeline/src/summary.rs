//! The answer on a few lines.

use crate::code::Code;
use reachtube_finding::{Finding, FrontEnd, Summary};

use crate::build::Built;
use crate::joint_row::JointRow;
use crate::without_model::WithoutModel;

/// The name of what follows for new motions.
const NEW_MOTIONS: &str = "new motions";

/// The name of the factor that a motion needs which is left out.
const LEFT_OUT: &str = "factor for a motion left out";

/// Number of horizons beyond the chosen one whose sets are listed.
const BEYOND: usize = 2;

/// What is mended in recordings.
const MENDED: [Code; 2] = [Code::TurnsMoved, Code::MissingSamples];

impl Built {
    /// Returns the verdict as one sentence: whether the sets were proved, and up to which time they
    /// are useful.
    #[must_use]
    pub fn verdict(&self) -> String {
        let model = &self.answer.model;
        let horizon = self.choices.horizon.unwrap_or_default();
        let verdict = match (self.answer.holds(), self.is_useful(), model.is_vacuous()) {
            _ if self.contradiction().is_some() => "the recordings contradict the robot".into(),
            (false, ..) => "NOT PROVED conformant".to_string(),
            (true, true, _) => format!("conformant and useful up to {horizon} s"),
            (true, false, true) => {
                let without = self.worse_than_without().map(WithoutModel::why_better);
                let without = without.map_or_else(String::new, |why| format!(", and {why}"));
                format!("conformant, but vacuous{without} at {horizon} s")
            }
            (true, false, false) => {
                format!("conformant, but {} at {horizon} s", self.why_useless())
            }
        };
        let (windows, what) = (model.data.run_count(), self.unit());
        let part = if self.is_cut() { String::new() } else { format!(" up to {horizon} s") };
        let proof = match self.answer.holds() {
            true => format!(", each sample{part} proved with directed rounding"),
            false => String::new(),
        };
        format!("{verdict}: {windows} {what}{proof}")
    }

    /// Returns the answer on a few lines, for users of a front end: the verdict with the horizon,
    /// the sets of each joint there, what was held out, and how the sets grow.
    #[must_use]
    pub fn summary(&self, front_end: FrontEnd) -> Summary {
        let mut summary = self.answer.summary(front_end);
        summary.verdict[0] = self.verdict();
        if let Some(finding) = self.contradiction() {
            // The cause comes first: a proof about wrong columns is worth nothing.
            summary
                .verdict
                .insert(0, format!("not acceptable: {}", finding.written_for(front_end)));
        }
        // What was mended in the recordings comes before what was made of them.
        summary.verdict.splice(0..0, MENDED.iter().filter_map(|code| self.mended(*code)));
        // What was found in the recordings is the cause; else the likeliest one is printed.
        let of_recordings =
            |found: &&Finding| found.code == Code::Contradiction && !self.is_useful();
        let found = self.contradiction().or_else(|| self.findings.iter().find(of_recordings));
        if !self.is_useful() && self.contradiction().is_none() {
            let findings = self.answer.model.findings();
            let is_cause = |other: &&Finding| other.code == reachtube_conform::Code::Cause;
            let causes = found.into_iter().chain(findings.iter().filter(is_cause));
            let cause = causes.map(|cause| cause.written_for(FrontEnd::Choices)).next();
            summary.verdict.extend(cause);
        }
        summary.table = self.answer.table_at_horizon(&self.held_out.growth);
        if let Some(without) = &self.without_model {
            without.add_to(&mut summary.table);
        }
        summary.facts.extend(self.spread().map(|spread| ("in single windows".into(), spread)));
        let is_said = |other: &&Finding| {
            Some(*other) == found || MENDED.iter().any(|code| other.code == *code)
        };
        let warnings = self.findings.iter().filter(|other| !is_said(other));
        summary.warnings = warnings.map(|finding| finding.written_for(front_end)).collect();
        summary.facts.retain(|(name, _)| name != NEW_MOTIONS);
        summary.facts.insert(0, ("held out".into(), self.held_out_words()));
        if let Some(allowance) = self.allowance_words() {
            // The factor is about the sets without an allowance.
            summary.facts.retain(|(name, _)| name != LEFT_OUT);
            summary.fact("allowance for other motions", allowance);
        }
        summary.fact(NEW_MOTIONS, self.next_motion());
        for finding in &self.remedies {
            summary.fact("would help", finding.written_for(FrontEnd::Choices));
        }
        if let Some(without) = &self.without_model {
            summary.fact("without a model", without.words());
        }
        summary.fact("widest set by horizon", self.growth());
        summary.next = None;
        summary
    }

    /// Returns in which recordings the same was mended: the first of them, with the number of the
    /// others.
    fn mended(&self, code: Code) -> Option<String> {
        let mut mended = self.findings.iter().filter(|other| other.code == code);
        let first = mended.next()?;
        let more = match mended.count() {
            0 => String::new(),
            count => format!(" ({count} more likewise)"),
        };
        Some(format!("warning: {}{more}", first.text))
    }

    /// Returns what follows for the next motion, in a few words.
    #[must_use]
    pub fn next_motion(&self) -> String {
        self.held_out.next_motion(1 + self.answer.model.replaced)
    }

    /// Returns how many rows that were held out lie outside the sets, in a few words.
    #[must_use]
    pub fn held_out_words(&self) -> String {
        let held_out = &self.held_out;
        match &held_out.failure {
            Some(why) => why.clone(),
            None => {
                let (rows, outside, windows) = (held_out.rows, held_out.outside, held_out.windows);
                let part = match 100.0 * outside as f64 / rows.max(1) as f64 {
                    part if outside > 0 && part < 0.1 => "less than 0.1 %".into(),
                    part => format!("{part:.1} %"),
                };
                let what = self.unit();
                format!("{outside} of {rows} rows outside ({part}), of {windows} {what}")
            }
        }
    }

    /// Returns the allowance in words, if the sets have one.
    #[must_use]
    pub fn allowance_words(&self) -> Option<String> {
        let choice = self.made.iter().find(|choice| choice.key == "allowance")?;
        (!self.answer.model.allowance.is_empty()).then(|| choice.value.clone())
    }

    /// Returns how far the sets of single windows differ where U grows with the nominal motion, of
    /// the joint whose set is the widest in some window.
    fn spread(&self) -> Option<String> {
        self.choices.input_doubling.as_ref().filter(|doubling| !doubling.is_empty())?;
        let of = |(joint, row): (usize, JointRow)| {
            let range = self.answer.found.tube.range_at_end(joint);
            (range.map(|radius| radius / row.displacement), row.name)
        };
        let all = self.joints().into_iter().enumerate().map(of);
        let ([least, most], name) = all.max_by(|(a, _), (b, _)| a[1].total_cmp(&b[1]))?;
        Some(format!("the set of {name} is {} to {} of its motion", percent(least), percent(most)))
    }

    /// Returns how the widest set grows up to the horizon, and a little beyond.
    fn growth(&self) -> String {
        let horizon = self.choices.horizon.unwrap_or_default();
        let shorter = self.horizons.iter().filter(|widths| widths.horizon <= horizon).count();
        let shown = self.horizons.iter().take(shorter + BEYOND);
        let all = shown.map(|widths| {
            let (_, ratio) = widths.worst();
            let fit = if widths.with_fit { " with fit" } else { "" };
            format!("{} s {}{fit}", widths.horizon, percent(ratio))
        });
        let mut all: Vec<String> = all.collect();
        all.extend((all.len() < self.horizons.len()).then(|| "..".into()));
        all.join(", ")
    }

    /// Returns what the recordings of the model are called.
    fn unit(&self) -> &'static str {
        if self.is_cut() { "windows" } else { "recordings" }
    }

    /// Returns whether the recordings of the model are windows of logs.
    fn is_cut(&self) -> bool {
        let preparation = self.answer.model.preparation.as_ref();
        preparation.is_some_and(|known| known.window.is_some())
    }
}

fn percent(ratio: f64) -> String {
    if ratio.is_finite() { format!("{:.0} %", 100.0 * ratio) } else { "-".into() }
}
