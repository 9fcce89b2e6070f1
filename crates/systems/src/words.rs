//! Answers on a few lines.

use reachtube_finding::{Finding, Severity, Summary, Table};
use reachtube_scalar::number::{counted, significant, two_digits_up};

use crate::check::SystemCheck;
use crate::description::{NominalStartRule, SetDescription, ShapedSet};
use crate::form::ScaledSet;
use crate::make::MadeSystem;
use crate::model::SystemModel;

/// Number of recordings that a table lists at most.
const MOST_RUNS: usize = 8;

/// Number of factors of a set that a line lists at most.
const MOST_FACTORS: usize = 6;

impl MadeSystem {
    /// Returns the verdict as one sentence.
    #[must_use]
    pub fn verdict(&self) -> String {
        let model = &self.model;
        let word = match (model.verified, model.is_useful()) {
            (false, _) => "NOT PROVED conformant",
            (true, true) => "conformant",
            (true, false) => "conformant, but vacuous",
        };
        let samples: usize = model.recordings.iter().map(|of| of.samples).sum();
        let narrower = model.without_model.as_ref().map_or(String::new(), |of| {
            let (times, word) = match of.narrower {
                narrower if narrower > 1.0 => (narrower, "narrower"),
                wider => (wider.recip(), "wider"),
            };
            format!("; {} times {word} than without a model", significant(times, 3))
        });
        let proved = if model.verified { ", proved with directed rounding" } else { "" };
        format!(
            "{word}: each output by itself, at {samples} samples of {}{proved}{narrower}",
            counted(model.recordings.len(), "recording")
        )
    }

    /// Returns the answer on a few lines: the verdict, the outputs, the sets, and what was left
    /// out.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let model = &self.model;
        let warnings = self.findings.iter().filter(|of| of.severity == Severity::Warning);
        let mut summary = Summary {
            verdict: vec![self.verdict()],
            table: table(model),
            warnings: warnings.map(Finding::to_string).collect(),
            ..Summary::default()
        };
        summary.fact("sets", model.sets_in_words());
        summary.fact("left out", model.left_out_in_words());
        if let Some(without) = &model.without_model {
            summary.fact("without a model", without.how.clone());
        }
        let starts = match (&model.system.start, model.start_samples) {
            (Some(NominalStartRule::Past { outputs, inputs }), _) => {
                match (outputs - 1).max(*inputs) {
                    0 => "known at the first sample, with the noise of the outputs in X0".into(),
                    past => format!(
                        "known from the {} before, which are not compared; X0 holds the noise of \
                         their outputs",
                        counted(past, "sample")
                    ),
                }
            }
            (_, 0) => "known at the first sample".into(),
            (_, count) => format!(
                "estimated from the first {count} samples by least squares: these have seen the \
                 start, and X0 holds its error"
            ),
        };
        summary.fact("starts", starts);
        summary.fact("next motion", "no guarantee; the sets hold what was recorded");
        summary
    }
}

impl SystemModel {
    fn sets_in_words(&self) -> String {
        let of = |(name, set, given): (&str, &ScaledSet, &Option<SetDescription>)| {
            match given {
                _ if set.scale.is_empty() => return format!("{name} = 0"),
                Some(SetDescription::Shaped(ShapedSet { fixed: true, .. })) => {
                    return format!("{name} as given");
                }
                _ => {}
            }
            let mut scales: Vec<String> =
                set.scale.iter().take(MOST_FACTORS).map(|scale| significant(*scale, 3)).collect();
            let is_common = set.scale.iter().all(|scale| *scale == set.scale[0]);
            if is_common {
                scales.truncate(1);
            } else if set.scale.len() > MOST_FACTORS {
                scales.push("..".into());
            }
            format!("{name} {}", scales.join(", "))
        };
        let (sets, given) = (&self.sets, &self.system.sets);
        let all = [
            ("X0", &sets.start, &given.start),
            ("W", &sets.disturbance, &given.disturbance),
            ("V", &sets.noise, &given.noise),
        ];
        let words = all.map(of).join("; ");
        format!("factors of their generators: {words}")
    }

    fn left_out_in_words(&self) -> String {
        let left_out = &self.left_out;
        let Some(furthest) = &left_out.furthest else {
            return "nothing: that needs 2 recordings at least".into();
        };
        let how = if left_out.is_in_turn { "each in turn" } else { "every second recording" };
        let factor = match left_out.factor {
            Some(factor) => format!("{} times those sets", two_digits_up(factor)),
            None => "more than any factor of them".into(),
        };
        format!(
            "{how}; {} of {} lie in the sets of the others; {furthest} needs the most, {factor}",
            left_out.inside, left_out.runs
        )
    }
}

/// Returns the table of the outputs.
fn table(model: &SystemModel) -> Table {
    let row = |(output, signal): (&crate::model::OutputWidth, &crate::NamedSignal)| {
        let number = |value: f64| format!("{}{}", significant(value, 3), signal.unit());
        let part = if output.motion > 0.0 {
            format!("{} %", significant(100.0 * output.mean / output.motion, 2))
        } else {
            "-".into()
        };
        vec![
            output.name.clone(),
            number(output.least),
            number(output.mean),
            number(output.largest),
            number(output.motion),
            part,
        ]
    };
    let header = ["output", "least", "mean width", "largest width", "motion", "mean of motion"];
    Table::new(header, model.outputs.iter().zip(&model.system.outputs).map(row).collect())
}

impl SystemCheck {
    /// Returns the answer on a few lines: the verdict, and the recordings that need the most.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let inside = self.runs.iter().filter(|run| run.outside == 0).count();
        let word = if self.conformant { "conformant" } else { "not conformant" };
        let verdict = format!(
            "{word}: {} of {} outputs outside the sets; {inside} of {} inside",
            self.outside,
            self.values,
            counted(self.runs.len(), "recording"),
        );
        let size = |at: &usize| self.runs[*at].needed.unwrap_or(f64::INFINITY);
        let mut order: Vec<usize> = (0..self.runs.len()).collect();
        order.sort_by(|a, b| size(b).total_cmp(&size(a)));
        let row = |at: &usize| {
            let run = &self.runs[*at];
            let needed = run.needed.map_or("more than any factor".into(), |needed| {
                format!("{} times", two_digits_up(needed))
            });
            vec![run.run.clone(), needed, run.output.clone(), format!("{:.3} s", run.time)]
        };
        let rows = order.iter().map(row).collect();
        let table = Table::new(["recording", "needs of its set", "output", "at"], rows);
        Summary { verdict: vec![verdict], table: table.cut_to(MOST_RUNS), ..Summary::default() }
    }
}
