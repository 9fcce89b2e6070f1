use std::fmt::{self, Write};

use crate::printable::printable;
use serde::Serialize;

use crate::finding::{Finding, Severity};
use crate::front_end::FrontEnd;
use crate::table::Table;

/// An answer for people: findings, facts and tables in the order in which they are read.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Report {
    /// The sections.
    pub sections: Vec<Section>,
}

/// A section of a [`Report`].
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Section {
    /// What it is about; empty for the first.
    pub title: String,
    /// Its findings.
    pub findings: Vec<Finding>,
    /// Its tables.
    pub tables: Vec<Table>,
    /// Names and values.
    pub facts: Vec<(String, String)>,
}

impl Report {
    /// Returns the findings of all sections, in their order.
    #[must_use]
    pub fn findings(self) -> Vec<Finding> {
        self.sections.into_iter().flat_map(|section| section.findings).collect()
    }

    /// Returns the report as text that ends with a newline, as users of a front end write settings.
    #[must_use]
    pub fn written_for(&self, front_end: FrontEnd) -> String {
        let sections: Vec<String> =
            self.sections.iter().map(|section| section.written_for(front_end)).collect();
        printable(&sections.join("\n"))
    }
}

impl fmt::Display for Report {
    /// Writes the report for the command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.written_for(FrontEnd::CommandLine))
    }
}

impl Section {
    /// Returns whether the section is empty.
    pub fn is_empty(&self) -> bool {
        let Self { findings, tables, facts, .. } = self;
        findings.is_empty() && tables.is_empty() && facts.is_empty()
    }

    /// Adds a fact.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.facts.push((name.into(), value.into()));
    }

    fn written_for(&self, front_end: FrontEnd) -> String {
        let mut text = String::new();
        let mut line = |line: &str| {
            let _ = writeln!(text, "{line}");
        };
        if !self.title.is_empty() {
            line(&format!("{}:", self.title));
        }
        let is_warning = |finding: &&Finding| finding.severity == Severity::Warning;
        for finding in self.findings.iter().filter(|finding| !is_warning(finding)) {
            line(&finding.written_for(front_end));
        }
        self.tables.iter().for_each(|table| line(table.to_string().trim_end_matches('\n')));
        self.facts.iter().for_each(|(name, value)| line(&format!("{name}: {value}")));
        for finding in self.findings.iter().filter(is_warning) {
            line(&format!("warning: {}", finding.written_for(front_end)));
        }
        text
    }
}
