//! Stops as text.

use crate::code::Code;
use reachtube_finding::{Finding, Table};
use reachtube_scalar::number::{at_least, significant};

use crate::stop::along::WorstStop;
use crate::stop::annex_b::AnnexRow;
use crate::stop::recorded::RecordedStop;
use crate::stop::study::StopStudy;

impl StopStudy {
    /// Returns the answer as text: the verdict, then a table of the motions, the table of ISO
    /// 10218-1 and the recorded stops; ways are in `unit`.
    #[must_use]
    pub fn text(&self, unit: &str) -> String {
        let sentences = |about_table: bool| {
            let findings = self.findings.iter();
            let chosen = findings.filter(move |one| is_about_table(one) == about_table);
            chosen.map(|finding| finding.text.clone())
        };
        let mut parts: Vec<String> = sentences(false).collect();
        if !self.stops.is_empty() {
            parts.push(self.motions(unit).to_string());
        }
        if let Some(table) = &self.annex_b {
            let is_full = |row: &&AnnexRow| row.extension == 1.0 && row.load == table.full_load();
            let full: Vec<AnnexRow> = table.rows.iter().filter(is_full).cloned().collect();
            if !full.is_empty() {
                parts.push(annex_table(&full, unit).to_string());
            }
        }
        parts.extend(sentences(true));
        if !self.recorded.is_empty() {
            parts.push(recorded_table(&self.recorded, unit).to_string());
        }
        let parts: Vec<&str> = parts.iter().map(|part| part.trim_end()).collect();
        parts.join("\n\n") + "\n"
    }

    /// Returns the table of the motions.
    #[must_use]
    pub fn motions(&self, unit: &str) -> Table {
        let way = format!("greatest way [{unit}]");
        let header = ["suite", "joint", &way, "from [s]", "latest standstill [s]", "from [s]"];
        let row = |worst: &WorstStop| {
            vec![
                worst.suite.clone(),
                worst.joint.clone(),
                bound(worst.way),
                format!("{:.3}", worst.way_from),
                bound(worst.time),
                format!("{:.3}", worst.time_from),
            ]
        };
        Table::new(header, self.stops.iter().map(row).collect())
    }
}

/// Returns the rows of ISO 10218-1 as a table.
#[must_use]
pub fn annex_table(rows: &[AnnexRow], unit: &str) -> Table {
    let distance = format!("distance [{unit}]");
    let header = ["joint", "category", "speed", "extension", "load", &distance, "time [s]"];
    let row = |row: &AnnexRow| {
        let percent = |part: f64| format!("{:.0} %", 100.0 * part);
        vec![
            row.joint.clone(),
            row.category.to_string(),
            percent(row.speed),
            percent(row.extension),
            percent(row.load),
            bound(row.way),
            bound(row.time),
        ]
    };
    let title = "ISO 10218-1, Annex B: proved stopping distances and times";
    Table::new(header, rows.iter().map(row).collect()).titled(title)
}

/// Returns recorded stops beside the proved ones as a table.
#[must_use]
pub fn recorded_table(stops: &[RecordedStop], unit: &str) -> Table {
    let [measured, proved] = ["measured", "proved at most"].map(|name| format!("{name} [{unit}]"));
    let header =
        ["recording", "joint", &measured, &proved, "measured [s]", "proved at most [s]", "within"];
    let row = |stop: &RecordedStop| {
        let [low, high] = stop.proved_way;
        let toward = if stop.way < 0.0 { -low } else { high };
        vec![
            stop.recording.clone(),
            stop.joint.clone(),
            significant(stop.way.abs(), 4),
            bound(toward),
            stop.time.map_or("moves on".into(), |time| format!("{time:.3}")),
            bound(stop.proved_time),
            if stop.is_within { "yes" } else { "no" }.into(),
        ]
    };
    let title = "recorded stops, measured and proved from their first states";
    Table::new(header, stops.iter().map(row).collect()).titled(title)
}

fn is_about_table(finding: &Finding) -> bool {
    finding.code == Code::TableIncomplete || finding.code == Code::BrakeWeak
}

fn bound(value: f64) -> String {
    if value.is_finite() { at_least(value) } else { "none".into() }
}
