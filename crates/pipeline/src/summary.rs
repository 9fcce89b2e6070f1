//! The answer in a few lines.

use std::path::Path;

use reachtube_conform::result::{Code, FrontEnd, Table};
use reachtube_scalar::number::significant;

use crate::build::Built;
use crate::joint_row::JointRow;

impl Built {
    /// Returns the verdict as one sentence: whether the sets were proved, and up to which time they
    /// are useful.
    #[must_use]
    pub fn verdict(&self) -> String {
        let model = &self.answer.model;
        let horizon = self.choices.horizon.unwrap_or_default();
        let verdict = match (self.answer.holds(), self.is_useful(), model.is_vacuous()) {
            (false, ..) => "NOT PROVED conformant".to_string(),
            (true, true, _) => format!("conformant and useful up to {horizon} s"),
            (true, false, true) => format!("conformant, but vacuous at {horizon} s"),
            (true, false, false) => {
                format!("conformant, but too wide to be of use at {horizon} s")
            }
        };
        let (windows, what) = (model.data.run_count(), self.unit());
        format!("{verdict}: {windows} {what}, each sample proved with directed rounding")
    }

    /// Returns the answer in a few lines: warnings, verdict, sets, what was held out, and the sets
    /// by horizon.
    #[must_use]
    pub fn summary(&self, front_end: FrontEnd) -> String {
        let mut lines: Vec<String> =
            self.warnings.iter().map(|warning| format!("warning: {warning}")).collect();
        lines.push(self.verdict());
        if !self.is_useful() {
            let said = [Code::Vacuous, Code::Cause];
            let findings = self.answer.model.findings().into_iter();
            let findings = findings.filter(|finding| said.contains(&finding.code));
            lines.extend(findings.map(|finding| finding.written_for(front_end)));
        }
        lines.push(self.table_of_joints().to_string());
        lines.push(format!("held out: {}", self.held_out_words()));
        let growth = self
            .horizons
            .iter()
            .map(|widths| format!("{} s {}", widths.horizon, percent(Some(widths.worst().1))));
        let growth: Vec<String> = growth.collect();
        lines.push(format!("widest set by horizon, of the motion: {}", growth.join(", ")));
        lines.join("\n") + "\n"
    }

    /// Returns what to do next with the files in a folder, as one line.
    #[must_use]
    pub fn next_step(&self, folder: &Path) -> String {
        match self.is_useful() {
            true => format!("next: open {}", folder.join("page").join("report.html").display()),
            false => format!("next: read {}", folder.join("choices.toml").display()),
        }
    }

    /// Returns how many rows that were held out lie outside the sets, in a few words.
    #[must_use]
    pub fn held_out_words(&self) -> String {
        let held_out = &self.held_out;
        match &held_out.failure {
            Some(why) => why.clone(),
            None => {
                let (rows, outside, windows) = (held_out.rows, held_out.outside, held_out.windows);
                let part = 100.0 * outside as f64 / rows.max(1) as f64;
                let what = self.unit();
                format!("{outside} of {rows} rows outside ({part:.1} %), of {windows} {what}")
            }
        }
    }

    /// Returns the set of each joint at the horizon as a table, with its input set.
    #[must_use]
    pub fn table_of_joints(&self) -> Table {
        let model = &self.answer.model;
        let kinds = model.robot.kinds();
        let row = |(joint, row): (usize, JointRow)| {
            let (low, high) = model.input_set.bounds(joint);
            let (low, high) = (significant(low, 2), significant(high, 2));
            let half = significant(row.half_width.unwrap_or(f64::INFINITY), 2);
            vec![
                row.name,
                format!("± {half} {}", kinds[joint].position_unit()),
                percent(row.ratio),
                format!("[{low}, {high}] {}", kinds[joint].force_unit()),
                row.growth.map_or_else(|| "-".into(), |growth| significant(growth, 2)),
            ]
        };
        let rows = self.joints().into_iter().enumerate().map(row).collect();
        let horizon = model.usefulness.as_ref().map_or(0.0, |said| said.horizon);
        let set = format!("set at {horizon:.3} s");
        Table::new(["joint", &set, "of its motion", "U", "factor, held out"], rows)
    }

    /// Returns what the recordings of the model are called.
    fn unit(&self) -> &'static str {
        let preparation = self.answer.model.preparation.as_ref();
        let is_cut = preparation.is_some_and(|known| known.window.is_some());
        if is_cut { "windows" } else { "recordings" }
    }
}

/// Returns a ratio in percent.
fn percent(ratio: Option<f64>) -> String {
    let finite = ratio.filter(|ratio| ratio.is_finite());
    finite.map_or_else(|| "-".into(), |ratio| format!("{:.0} %", 100.0 * ratio))
}
