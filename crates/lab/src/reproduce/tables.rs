//! The tables as texts, in the paper's layout, with its numbers beside ours.

use reachtube_abstraction::ModelKind;
use reachtube_conform::settings::States;
use reachtube_reach::Disturbance;

use super::coverage::{Coverage, CoverageRow};
use super::figures::PaperFigure;
use super::paper::{Paper, Speed};
use super::table1::{Cell, Table1};
use super::table2::{Table2, Table2Case};
use super::table3::{Effect, Part, Table3, Table3Row};
use reachtube_finding::Table;
use reachtube_page::{Chart, Series};
use reachtube_scalar::number::{four_decimals, interval, significant};

/// Blue, of single campaigns.
const CAMPAIGN: [u8; 3] = [18, 70, 200];
/// Grey, of the line between wrong and right.
const EQUAL: [u8; 3] = [140, 149, 159];

/// A parameter of the arm below this is rounding of the combination it is part of, in SI units.
const ROUNDING: f64 = 1e-12;

/// What is printed of a table or figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Sentences about it, one per line.
    pub words: Vec<String>,
    /// Its numbers.
    pub tables: Vec<Table>,
}

impl Table1 {
    pub(super) fn sheet(&self) -> Sheet {
        let options = &self.options;
        let mut words = vec![format!(
            "Table I for {}: errors of the models against the articulated-body algorithm; inputs \
             held over 4 ms",
            self.robot
        )];
        if options.orders.iter().any(|order| *order > options.model3_up_to) {
            words.push(format!(
                "-: not simulated; --model3-up-to {} limits the order of model 3",
                options.model3_up_to
            ));
        }
        Sheet { words, tables: vec![self.table()] }
    }

    pub(super) fn table(&self) -> Table {
        let rows = self.options.orders.iter();
        let rows = rows.flat_map(|order| Speed::ALL.map(|speed| self.row(*order, speed)));
        let header = ["p", "speed", "model 1", "paper", "model 2", "paper", "model 3", "paper"];
        let (options, [slow, fast]) = (&self.options, self.durations);
        Table::new(header, rows.collect()).titled(format!(
            "Mean |velocity error| over time and joints [rad/s], mean ± standard deviation \
                 over {} random point-to-point motions (seed {}) within {} rad of 0, of {slow:.2} \
                 s (slow) and {fast:.2} s (fast)",
            options.motions,
            options.seed,
            four_decimals(options.range)
        ))
    }

    fn row(&self, order: u32, speed: Speed) -> Vec<String> {
        let kinds = [ModelKind::One, ModelKind::Two, ModelKind::Three];
        let cells = kinds.map(|kind| cell_pair(self.cell(kind, order, speed)));
        let names = [order.to_string(), speed.name().into()];
        names.into_iter().chain(cells.into_iter().flatten()).collect()
    }
}

fn cell_pair(cell: Option<&Cell>) -> [String; 2] {
    let Some(cell) = cell else { return ["-".into(), String::new()] };
    let spread =
        cell.spread.map(|spread| format!(" ± {}", four_decimals(spread))).unwrap_or_default();
    let simulated = match (cell.mean, cell.diverged) {
        (None, diverged) => format!("∞ ({diverged} diverged)"),
        (Some(mean), 0) => format!("{}{spread}", four_decimals(mean)),
        (Some(mean), diverged) => format!("{}{spread} ({diverged} diverged)", four_decimals(mean)),
    };
    let paper = match cell.paper {
        Some(Paper::Error(error)) => format!("{error:.4}"),
        Some(Paper::Diverged) => "∞".into(),
        None => String::new(),
    };
    [simulated, paper]
}

impl Table2 {
    pub(super) fn sheet(&self) -> Sheet {
        let heading = format!(
            "Table II: uncertainty sets of model 1 (p = 1) for {} recordings in {} suites",
            self.runs, self.suites
        );
        let warnings = self.cases.iter().flat_map(|case| &case.warnings);
        let warnings = warnings.map(|warning| format!("warning: {warning}"));
        Sheet {
            words: std::iter::once(heading).chain(warnings).collect(),
            tables: self.cases.iter().map(Table2Case::table).collect(),
        }
    }
}

impl Table2Case {
    pub(super) fn table(&self) -> Table {
        let row = |joint: usize| {
            let papers = [self.paper.x0_q, self.paper.x0_qd, self.paper.u].map(|sets| sets[joint]);
            let pairs = self.bounds(joint).into_iter().zip(papers);
            let cells = pairs
                .flat_map(|(ours, [low, high])| [interval(ours), format!("[{low:.4}, {high:.4}]")]);
            std::iter::once(format!("joint{}", joint + 1)).chain(cells).collect()
        };
        let header = ["joint", "X0 q [rad]", "paper", "X0 qd [rad/s]", "paper", "U [N m]", "paper"];
        let notion = States::All.together(self.notion);
        let disturbance = match self.disturbance {
            Disturbance::Constant => "constant disturbance",
            Disturbance::Sample => "disturbance held over samples",
            Disturbance::Measurable => "measurable disturbance",
        };
        let proved = if self.conformant { "proved" } else { "NOT PROVED" };
        Table::new(header, (0..6).map(row).collect()).titled(format!(
            "{}, {notion}, {disturbance}: {proved}, cost {} ({} summed over samples)",
            self.name(),
            four_decimals(self.cost),
            four_decimals(self.cost_of_samples)
        ))
    }
}

impl Table3 {
    pub(super) fn sheet(&self) -> Sheet {
        let heading = format!(
            "Table III: the model of the LWA 4P, identified from {} static poses, slow motions and \
             exciting motions (SI units)",
            self.poses
        );
        let warnings = self.warnings.iter().map(|warning| format!("warning: {warning}"));
        Sheet {
            words: std::iter::once(heading).chain(warnings).collect(),
            tables: self.tables().to_vec(),
        }
    }

    pub(super) fn tables(&self) -> [Table; 3] {
        let parts = [
            (Part::Friction, "friction parameters"),
            (Part::Gravity, "gravity model"),
            (Part::Inertia, "inertial parameters"),
        ];
        let header = [
            "",
            "ours",
            "standard error",
            "of the arm",
            "error / standard error",
            "paper",
            "biased by",
        ];
        parts.map(|(part, name)| {
            Table::new(header, self.part(part).map(Table3Row::cells).collect())
                .titled(format!("Table III, {name} (SI units)"))
        })
    }
}

impl Table3Row {
    fn cells(&self) -> Vec<String> {
        let effect = |effect: &Effect| match effect {
            Effect::Stribeck => "Stribeck effect",
            Effect::Warming => "warming",
            Effect::Ripple => "ripple",
            Effect::Delay => "delay of the torque",
        };
        let effects: Vec<&str> = self.effects.iter().map(effect).collect();
        vec![
            self.name.clone(),
            four_decimals(self.estimate),
            self.standard_error.map_or("-".into(), |error| significant(error, 2)),
            four_decimals(if self.truth.abs() < ROUNDING { 0.0 } else { self.truth }),
            self.deviation.map_or("-".into(), |deviation| format!("{deviation:+.1}")),
            self.paper.map_or(String::new(), four_decimals),
            if self.deviation.is_some() { effects.join(", ") } else { String::new() },
        ]
    }
}

impl PaperFigure {
    pub(super) fn sheet(&self) -> Sheet {
        let caption = format!("Fig. {}: {}", self.number, self.caption);
        Sheet { words: vec![caption, self.paper.clone()], tables: vec![self.table.clone()] }
    }
}

impl Coverage {
    pub(super) fn sheet(&self) -> Sheet {
        let Self { motions, held_out, calibrating, chosen_by, .. } = self;
        let words = format!(
            "Bounds for the next motion (seed {}): the hold-out bound is for sets found on {} \
             motions, by the other {held_out}; the calibration bounds are for sets found on {}, \
             scaled to hold the other {calibrating}; models that were chosen in several ways are \
             calibrated by {chosen_by} motions",
            self.options.seed,
            motions - held_out,
            motions - calibrating,
        );
        Sheet { words: vec![words], tables: vec![self.table()] }
    }

    pub(super) fn table(&self) -> Table {
        let row = |row: &CoverageRow| {
            vec![
                row.statement.clone(),
                format!("{:.3}", row.mean_bound),
                format!("{:.3}", row.mean_truth),
                match row.if_fixed {
                    None => format!("{:.3}", row.nominal),
                    Some(bound) => format!("{:.3} (not {bound:.3})", row.nominal),
                },
                format!("{:.3} ± {:.3}", row.observed, row.standard_error),
                if row.holds() { "yes".into() } else { "NO".into() },
            ]
        };
        let header =
            ["statement", "mean bound", "mean truth", "may be wrong", "was wrong", "holds"];
        Table::new(header, self.rows.iter().map(row).collect()).titled(format!(
            "{} campaigns of {} random motions: the stated probability that the next motion \
                 leaves the sets, and the part of {} further motions that leave them",
            self.options.campaigns, self.motions, self.options.next
        ))
    }

    /// Returns a chart for each statement at confidence: one dot per campaign, its true probability
    /// over the stated one. The statement is wrong above the line.
    pub(crate) fn charts(&self) -> Vec<Chart> {
        let at_confidence = self.rows.iter().filter(|row| row.is_at_confidence());
        let chart = |row: &CoverageRow| {
            let all = row.campaigns.iter().flat_map(|(bound, truth)| [*bound, *truth]);
            let end = all.fold(0.0, f64::max);
            let line = Series::line(vec![(0.0, 0.0), (end, end)], EQUAL);
            let dots = Series::dots(row.campaigns.clone(), CAMPAIGN);
            let name = row.statement.split(',').next().unwrap_or_default();
            let [observed, nominal] = [row.observed, row.nominal].map(|part| 100.0 * part);
            let title = format!("{name}: wrong in {observed:.1} %, may be in {nominal:.0} %");
            Chart::new(title, "stated probability", "true probability", vec![line, dots])
        };
        at_confidence.map(chart).collect()
    }
}
