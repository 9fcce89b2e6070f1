//! The summary of a model: the verdict, the sets at the horizon, and what follows.

use reachtube_scalar::number::{two_digits_outward, two_digits_up};

use crate::answer::Answer;
use crate::model::file::Model;
use crate::result::code::Code;
use crate::result::findings;
use crate::tube::tube::{Enclosure, Tube};
use reachtube_finding::{Finding, FrontEnd, Severity, Summary, Table};

/// Ratios from here on are factors, not percent.
const LARGE: f64 = 100.0;

/// How wide the sets are at the end of the longest recording.
pub(crate) struct AtHorizon {
    /// The end of the longest recording, s.
    pub horizon: f64,
    /// Half the widths of the sets with V, 2n; infinite where a set was lost.
    pub radii: Vec<f64>,
}

impl AtHorizon {
    pub(crate) fn new(tube: &Tube) -> Self {
        let (horizon, radii) = tube.at_end();
        Self { horizon, radii }
    }
}

impl Answer {
    /// Returns the answer on a few lines, for users of a front end: the verdict, the sets of each
    /// part at the horizon, what follows for new motions, and what helps most.
    #[must_use]
    pub fn summary(&self, front_end: FrontEnd) -> Summary {
        let Self { model, found, .. } = self;
        let sets = AtHorizon::new(&found.tube);
        let mut summary = Summary {
            verdict: vec![verdict(model, &sets)],
            table: table_of_sets(model, &sets, None),
            importance: widest_first(model, &sets),
            warnings: model.warnings.iter().map(brief).collect(),
            ..Summary::default()
        };
        summary.verdict.extend(against(model));
        summary.facts.extend(model.motion_left_out());
        summary.fact("new motions", findings::next_motion_in_brief(&model.trust, "decide"));
        summary.next = model.most_helpful().map(|finding| remedy(&finding, front_end));
        summary
    }

    /// Returns the sets of each part at the horizon, with the factors by which they would have to
    /// grow for other motions, n.
    #[must_use]
    pub fn table_at_horizon(&self, factors: &[f64]) -> Table {
        table_of_sets(&self.model, &AtHorizon::new(&self.found.tube), Some(factors))
    }
}

impl Model {
    /// Returns the factor that the motion needs whose absence changes the sets most.
    fn motion_left_out(&self) -> Option<(String, String)> {
        let gauges = self
            .left_out
            .iter()
            .filter_map(|left| left.cost.map(|_| (left.growth(), &left.motion)));
        let (gauge, motion) = gauges.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let of = self.left_out.len();
        let value = match gauge.is_finite() {
            true => format!("at most {}, of {of} motions ({motion})", two_digits_up(gauge)),
            false => format!("none suffices for {motion}, one of {of} motions"),
        };
        Some(("factor for a motion left out".into(), value))
    }

    /// Returns the finding with the remedy that helps most: what ended a set, the cause of
    /// warnings, another warning, or the way to a guarantee.
    fn most_helpful(&self) -> Option<Finding> {
        let lost = self.proof.lost.iter().map(Finding::from);
        let causes = self.warnings.iter().filter(|finding| finding.code == Code::Cause);
        let warnings = causes.chain(&self.warnings).cloned();
        let all = lost.chain(warnings).chain([findings::next_motion_of_fit(self)]);
        all.into_iter().find(|finding| finding.remedy.is_some())
    }
}

fn remedy(finding: &Finding, front_end: FrontEnd) -> String {
    finding.remedy.as_ref().map(|remedy| remedy.written_for(front_end)).unwrap_or_default()
}

fn verdict(model: &Model, sets: &AtHorizon) -> String {
    let words = findings::outcome_of_fit(model);
    let proof = &model.proof;
    let how = match proof.enclosure {
        Enclosure::Inner => "proved",
        Enclosure::Outer => "in the computed outer set",
    };
    format!(
        "{words}: {}; {} of {} rows{} {how}, up to {:.3} s",
        findings::recordings_of_fit(model),
        proof.rows - proof.violations.count,
        proof.rows,
        model.settings.states.of_words(),
        sets.horizon
    )
}

/// Returns what speaks against the sets of a model, or limits the proof.
pub(super) fn against(model: &Model) -> Vec<String> {
    let proof = &model.proof;
    let mut lines: Vec<String> = findings::vacuous_in_brief(model).into_iter().collect();
    lines.extend(findings::points(proof, model.settings.states).map(|points| points.text));
    lines.extend(findings::lost_in_brief(&proof.lost));
    lines
}

pub(super) fn brief(finding: &Finding) -> String {
    let meaning = Code::of(&finding.code).map_or("", Code::meaning).trim_end_matches('.');
    match &finding.place {
        _ if finding.code == Code::Cause || finding.severity != Severity::Warning => {
            finding.text.clone()
        }
        Some(place) => format!("{meaning} ({place})"),
        None => format!("{meaning}."),
    }
}

pub(super) fn table_of_sets(model: &Model, sets: &AtHorizon, factors: Option<&[f64]>) -> Table {
    let n = model.inputs();
    let [q, qd] = [0, 1].map(|at| model.signals.units_of_state(at));
    let u = model.signals.units_of_inputs();
    let mut header = vec![
        model.signals.noun.clone(),
        q.head(&format!("q at {:.3} s", sets.horizon)),
        "of motion".into(),
        qd.head("qd"),
        u.head(model.name_of_input_set()),
    ];
    header.extend(factors.map(|_| "held out".into()));
    let half = |unit: &reachtube_finding::Units, part: usize, radius: f64| match radius.is_finite()
    {
        true => unit.cell(part, format!("± {}", two_digits_up(radius))),
        false => "lost".into(),
    };
    let row = |part: usize| {
        let mut row = vec![
            model.signals.parts[part].name.clone(),
            half(&q, part, sets.radii[part]),
            share(model, part, sets.radii[part]),
            half(&qd, part, sets.radii[n + part]),
            u.cell(part, two_digits_outward(model.input_set.bounds(part))),
        ];
        row.extend(factors.map(|factors| match factors[part] {
            factor if factor.is_finite() => two_digits_up(factor),
            _ => "-".into(),
        }));
        row
    };
    Table::new(header, (0..n).map(row).collect())
}

/// Returns the parts, the one whose set is widest beside its motion first.
pub(super) fn widest_first(model: &Model, sets: &AtHorizon) -> Vec<usize> {
    let displacement =
        |part: usize| model.usefulness.as_ref().map_or(1.0, |said| said.parts[part].displacement);
    let ratio = |part: &usize| sets.radii[*part] / displacement(*part);
    let mut parts: Vec<usize> = (0..model.inputs()).collect();
    parts.sort_by(|a, b| ratio(b).total_cmp(&ratio(a)));
    parts
}

/// Returns half a set's width as a share of the part's motion.
pub(super) fn share(model: &Model, part: usize, radius: f64) -> String {
    let parts = model.usefulness.as_ref().map(|said| &said.parts);
    match parts.map(|parts| radius / parts[part].displacement) {
        Some(ratio) if ratio < LARGE => format!("{:.0} %", 100.0 * ratio),
        Some(ratio) if ratio.is_finite() => format!("x {ratio:.0e}"),
        _ => "-".into(),
    }
}
