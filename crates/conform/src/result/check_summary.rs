//! The summary of a check: the verdict, the suites that leave the sets, and what follows.

use reachtube_scalar::number::{counted, two_digits_up};

use crate::check::Check;
use crate::claim::verdict::{SuiteVerdict, Verdict};
use crate::data::signals::Signals;
use crate::model::file::Model;
use crate::model::provenance::Provenance;
use crate::result::code::Code;
use crate::result::findings;
use crate::result::model_summary::{AtHorizon, brief, share, table_of_sets, widest_first};
use crate::tube::tube::Tube;
use reachtube_finding::{FrontEnd, Remedy, Severity, Summary, Table};

impl Check {
    /// Returns the answer on a few lines, for users of a front end: the verdict, the suites that
    /// leave the sets or else the sets of each part at the horizon, and what follows. `tube` has
    /// the reachable sets that were compared.
    #[must_use]
    pub fn summary(&self, model: &Model, tube: &Tube, front_end: FrontEnd) -> Summary {
        let signals = &model.signals;
        let sets = AtHorizon::new(tube);
        let failing = failing(&self.verdict);
        // The cause and its remedy are part of the model's own answer.
        let warnings = model.warnings.iter().filter(|warning| warning.code != Code::Cause);
        let warnings = warnings.map(|warning| format!("of the model itself: {}", brief(warning)));
        let causes = self.findings.iter().filter(|finding| finding.code == Code::Cause);
        let other = self.findings.iter().filter(|finding| {
            finding.code == Code::OtherRecordings && finding.severity == Severity::Warning
        });
        let other = causes.clone().chain(other).map(|finding| finding.text.clone());
        let mut summary = Summary {
            verdict: self.verdict_lines(model).into_iter().chain(other).collect(),
            warnings: warnings.collect(),
            ..Summary::default()
        };
        if failing.is_empty() {
            summary.table = table_of_sets(model, &sets, None);
            summary.importance = widest_first(model, &sets);
        } else {
            summary.table = table_of_suites(&failing, signals);
            summary.facts.push(widest(model, &sets, signals));
        }
        if let Some(growth) = &self.growth {
            summary.fact("covered, without a proof, if", findings::least_growth(growth, signals));
        }
        summary.fact(
            "new motions",
            match &self.trust {
                Some(trust) => findings::next_motion_in_brief(trust, "left them"),
                None => "no guarantee: the model was fitted to some of these recordings".into(),
            },
        );
        let lost = self.verdict.lost.first().map(|lost| Remedy::until(lost.time));
        // The command `model` has widened its sets for motions left out.
        let is_widened = model.calibration.is_some() || !model.allowance.is_empty();
        let is_wide = !is_widened && !self.verdict.conformant;
        let next = match lost {
            Some(remedy) => Some(remedy.written_for(front_end)),
            // `model` has no calibration: it holds motions out by itself.
            // Recordings that differ by a known cause do not belong among the model's.
            None if causes.count() > 0 => None,
            None if is_wide && model.preparation.is_some() => {
                Some("make the model again, with these recordings among its logs".into())
            }
            None => is_wide.then(|| Remedy::new("calibrate", "MOTION,..").written_for(front_end)),
        };
        summary.next = next;
        summary
    }

    fn verdict_lines(&self, model: &Model) -> Vec<String> {
        let Verdict { conformant, runs, rows, violations, suites, lost, .. } = &self.verdict;
        let set = self.verdict.enclosure.set_name();
        let words = match conformant {
            true if model.is_vacuous() => "conformant, but vacuous",
            true => "conformant",
            false => "not conformant",
        };
        let outside = suites.iter().filter(|suite| suite.violations.count > 0).count();
        let percent = match violations.count {
            0 => String::new(),
            count => format!(" ({:.1} %)", 100.0 * count as f64 / (*rows).max(1) as f64),
        };
        let mut lines = vec![format!(
            "{words}: {}; {} of {rows} rows{} outside the {set}{percent}, in {outside} of {}{}",
            counted(*runs, "recording"),
            violations.count,
            model.settings.states.of_words(),
            counted(suites.len(), "suite"),
            self.until_words(),
        )];
        lines.extend(findings::vacuous_in_brief(model));
        let points = findings::points(&self.verdict, model.settings.states);
        lines.extend(points.map(|points| points.text));
        lines.extend(findings::lost_in_brief(lost));
        lines
    }
}

impl Check {
    /// Returns up to which time the recordings were compared, if they were not to their end.
    fn until_words(&self) -> String {
        let Provenance { settings, data, .. } = &self.provenance;
        let end = settings.until.map(|until| data.longest().unwrap_or(until));
        end.map_or_else(String::new, |end| format!(", up to {end} s"))
    }
}

/// Returns the suites that were not proved, the ones with the most rows outside first.
fn failing(verdict: &Verdict) -> Vec<&SuiteVerdict> {
    let mut failing: Vec<&SuiteVerdict> =
        verdict.suites.iter().filter(|suite| suite.fails()).collect();
    failing.sort_by_key(|suite| std::cmp::Reverse(suite.violations.count));
    failing
}

fn table_of_suites(failing: &[&SuiteVerdict], signals: &Signals) -> Table {
    let row = |suite: &&SuiteVerdict| {
        let worst = suite.violations.worst.as_ref();
        let place = worst.map(|worst| {
            let unit = signals.unit(worst.state);
            let excess = two_digits_up(worst.excess);
            // A window is a suite of one run, whose name the first column has.
            let run = match worst.run == suite.suite {
                true => String::new(),
                false => format!("{}, ", worst.run),
            };
            format!("{run}{:.3} s: {} by {excess} {unit}", worst.time, worst.state)
        });
        vec![
            suite.suite.clone(),
            suite.rows.to_string(),
            suite.violations.count.to_string(),
            place.unwrap_or_else(|| "-".into()),
        ]
    };
    Table::new(["suite", "rows", "outside", "furthest"], failing.iter().map(row).collect())
}

/// Returns the widest sets at the horizon: of the position that is widest beside its motion, and of
/// the velocities.
fn widest(model: &Model, sets: &AtHorizon, signals: &Signals) -> (String, String) {
    let n = model.inputs();
    let name = |part: usize| &model.signals.parts[part].name;
    let q = widest_first(model, sets).first().copied().unwrap_or_default();
    let speed = |part: &usize| sets.radii[n + part];
    let qd = (0..n).max_by(|a, b| speed(a).total_cmp(&speed(b))).unwrap_or_default();
    let value = format!(
        "± {} {} ({}, {} of its motion), ± {} {} ({})",
        two_digits_up(sets.radii[q]),
        signals.states[q].unit,
        name(q),
        share(model, q, sets.radii[q]),
        two_digits_up(sets.radii[n + qd]),
        signals.states[n + qd].unit,
        name(qd),
    );
    (format!("widest sets at {:.3} s", sets.horizon), value)
}
