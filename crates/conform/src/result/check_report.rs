//! The report of a check.

use crate::check::Check;
use crate::claim::verdict::SuiteVerdict;
use crate::data::signals::Signals;
use crate::result::code::Code;
use crate::result::findings;
use reachtube_finding::{Finding, Report, Section, Table};

impl Check {
    /// Returns the answer for people, with one row for each suite; `signals` are the model's.
    #[must_use]
    pub fn report(&self, signals: &Signals) -> Report {
        let of = |codes: &[Code]| -> Vec<Finding> {
            let is_of = |finding: &&Finding| {
                Code::of(&finding.code).is_some_and(|code| codes.contains(&code))
            };
            self.findings.iter().filter(is_of).cloned().collect()
        };
        let verdict = [Code::Conformant, Code::NotConformant, Code::Vacuous, Code::Points];
        let mut first = Section { findings: of(&verdict), ..Section::default() };
        let furthest = self.findings.iter().filter(|finding| {
            finding.code == Code::FurthestOutside && !finding.numbers.contains_key("part")
        });
        // The table has the furthest values, but not the furthest points.
        first.findings.extend(furthest.cloned());
        let mut suites: Vec<&SuiteVerdict> = self.verdict.suites.iter().collect();
        suites.sort_by_key(|suite| !suite.fails());
        let rows = suites.into_iter().map(|suite| row(suite, signals)).collect();
        let header = ["suite", "runs", "rows", "outside", "furthest outside"];
        let suites = Section { tables: vec![Table::new(header, rows)], ..Section::default() };
        let others = [
            &[Code::SetLost] as &[_],
            &[Code::GrowthNeeded],
            &[Code::NextMotion, Code::NoGuarantee],
            &[Code::OtherRecordings],
        ];
        let others = others.map(|codes| Section { findings: of(codes), ..Section::default() });
        let mut sections = vec![first, suites];
        sections.extend(others.into_iter().filter(|section| !section.is_empty()));
        Report { sections }
    }
}

fn row(suite: &SuiteVerdict, signals: &Signals) -> Vec<String> {
    let worst = suite.violations.worst.as_ref();
    vec![
        suite.suite.clone(),
        suite.runs.to_string(),
        suite.rows.to_string(),
        suite.violations.count.to_string(),
        worst.map_or_else(|| "-".into(), |place| findings::place_outside(place, signals)),
    ]
}
