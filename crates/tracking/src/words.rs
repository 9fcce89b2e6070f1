//! Answers on a few lines.

use reachtube_finding::{Finding, Severity, Summary, Table};
use reachtube_scalar::number::{counted, outward, significant, two_digits_up};
use reachtube_scalar::rounding::mul_up;

use crate::check::TrackingCheck;
use crate::make::{MadeModel, TriedFamily};
use crate::model::{JointTracking, TrackingModel};

/// Number of motions that a table lists at most.
const MOST_MOTIONS: usize = 8;

/// What a model is about.
const HOLDS: &str = "at samples, up to recorded speeds; payload, tool, contact, gains, temperature \
                     as recorded";

impl MadeModel {
    /// Returns the verdict as one sentence.
    #[must_use]
    pub fn verdict(&self) -> String {
        let model = &self.model;
        let word = match (model.verified, self.is_useful()) {
            (false, _) => "NOT PROVED conformant",
            (true, true) => "conformant and useful",
            (true, false) if model.is_useful() => "conformant, but the recordings contradict it",
            (true, false) if model.has_motions() => "conformant, but vacuous",
            (true, false) => "conformant, but it describes these recordings only",
        };
        let all: usize = model.recordings.iter().map(|of| of.samples).sum();
        let aside: usize = model.recordings.iter().map(|of| of.set_aside).sum();
        let of_all = if aside > 0 { format!("{} of {all}", all - aside) } else { all.to_string() };
        let widest = |of: &JointTracking| of.half_width(of.largest_speed);
        let widest = model.joints.iter().map(|of| (widest(of), &of.unit));
        let (width, unit) = widest.max_by(|a, b| a.0.total_cmp(&b.0)).expect("a joint");
        format!(
            "{word}: each joint stays within {} of its nominal position, {} on average; {of_all} \
             samples of {}, each proved with directed rounding",
            width_up(width, unit),
            width_up(model.mean_half_width(), unit),
            counted(model.left_out.motions, "motion"),
        )
    }

    /// Returns the answer on a few lines: the verdict, the joints, what was left out, and what was
    /// tried.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let model = &self.model;
        let failures = self.findings.iter().filter(|of| of.severity == Severity::Failure);
        let mut verdict = vec![self.verdict()];
        verdict.extend(failures.map(|of| of.text.clone()));
        let warnings = self.findings.iter().filter(|of| of.severity == Severity::Warning);
        let mut summary = Summary {
            verdict,
            table: table(model),
            warnings: warnings.map(Finding::to_string).collect(),
            ..Summary::default()
        };
        summary.fact("left out", model.left_out_words());
        let TriedFamily { depends_on, grows, .. } = &self.families[self.chosen];
        let grows = if *grows { "; the sets grow with the speed" } else { "" };
        let after = match model.delay {
            0.0 => String::new(),
            delay => format!(", after a delay of {}", milli(delay, "s")),
        };
        summary.fact("nominal error", format!("{depends_on}{after}{grows}"));
        if let Some(links) = model.links_words() {
            summary.fact("links", links);
        }
        summary.fact("new motions", model.next_motion());
        summary.fact("holds", HOLDS);
        summary
    }
}

impl TrackingModel {
    /// Returns what motions that were left out need, in words.
    fn left_out_words(&self) -> String {
        let left_out = &self.left_out;
        let Some(furthest) = left_out.furthest.as_ref().filter(|_| self.has_motions()) else {
            return "nothing: that needs 3 motions at least".into();
        };
        let factor = self.factor;
        let needed = format!("{furthest} needs the most, {factor:.2} times the smallest sets");
        match left_out.inside {
            _ if left_out.calibrated.is_some() => format!("every second recording; {needed}"),
            Some(inside) => format!(
                "in turn; {needed} of the others; {inside} of {} lie inside sets and factor of the \
                 others",
                left_out.motions
            ),
            None => format!("in turn; {needed} of the others"),
        }
    }

    /// Returns how far links stray, in words.
    fn links_words(&self) -> Option<String> {
        let furthest = self.links.iter().max_by(|a, b| a.radius.total_cmp(&b.radius))?;
        Some(format!(
            "within {} of their nominal places in recorded poses; largest error + 20 %: {}",
            width_up(furthest.radius, "m"),
            milli(1.2 * furthest.largest_error, "m"),
        ))
    }

    /// Returns for what alone plans, paddings and tolerances hold, in sentences.
    #[must_use]
    pub fn conditions(&self) -> [String; 2] {
        let next = self.next_motion();
        [
            "This holds for an arm that follows its plan from the first sample on, with payload, \
             tool, contact, gains and temperature as recorded."
                .into(),
            format!("New motions: {next}."),
        ]
    }

    /// Returns what follows for the next motion, in words.
    #[must_use]
    pub fn next_motion(&self) -> String {
        let left_out = &self.left_out;
        match left_out.calibrated {
            Some(count) => format!(
                "at most 1 in {} recordings leaves the sets, on average, if they are drawn alike",
                count + 1
            ),
            None if self.has_motions() => format!(
                "no guarantee; if motions are alike and independent, about 1 in {} leaves the sets",
                left_out.motions + 1
            ),
            None => "no guarantee".into(),
        }
    }
}

/// Returns the table of the joints.
fn table(model: &TrackingModel) -> Table {
    let row = |joint: &JointTracking| {
        let lag = model.delay - joint.speed;
        let late = if lag == 0.0 { "-".into() } else { milli(lag, "s") };
        vec![
            joint.name.clone(),
            late,
            width_up(joint.half_width(0.0), &joint.unit),
            width_up(joint.half_width(joint.largest_speed), &joint.unit),
            format!("{} {}/s", significant(joint.largest_speed, 2), joint.unit),
            milli(joint.without_model(), &joint.unit),
        ]
    };
    let header = [
        "joint",
        "late by",
        "half-width at rest",
        "at full speed",
        "full speed",
        "largest error + 20 %",
    ];
    Table::new(header, model.joints.iter().map(row).collect())
}

impl TrackingCheck {
    /// Returns the answer on a few lines: the verdict, and the motions that need the most.
    #[must_use]
    pub fn summary(&self, model: &TrackingModel) -> Summary {
        let inside = self.motions.iter().filter(|motion| motion.needed <= 1.0).count();
        let word = if self.conformant { "conformant" } else { "not conformant" };
        let verdict = format!(
            "{word}: {} of {} positions outside the sets; {inside} of {} inside",
            self.outside,
            self.positions,
            counted(self.motions.len(), "motion"),
        );
        let mut order: Vec<usize> = (0..self.motions.len()).collect();
        order.sort_by(|a, b| self.motions[*b].needed.total_cmp(&self.motions[*a].needed));
        let row = |index: &usize| {
            let motion = &self.motions[*index];
            vec![
                motion.name.clone(),
                format!("{} times", two_digits_up(motion.needed)),
                motion.joint.clone(),
                format!("{:.3} s", motion.time),
            ]
        };
        let rows = order.iter().map(row).collect();
        let table = Table::new(["motion", "needs of its set", "joint", "at"], rows);
        let fast = self.joints.iter().filter_map(|joint| {
            let speed = joint.too_fast?;
            let known = model.joints.iter().find(|of| of.name == joint.name)?;
            Some(format!(
                "The command of {} reaches {} {unit}/s, but the model was made of commands up to \
                 {} {unit}/s, and its sets are not for faster ones; add recordings that are as \
                 fast.",
                joint.name,
                significant(speed, 3),
                significant(known.largest_speed, 3),
                unit = known.unit,
            ))
        });
        let mut summary = Summary {
            verdict: vec![verdict],
            table: table.cut_to(MOST_MOTIONS),
            warnings: fast.collect(),
            ..Summary::default()
        };
        summary.fact("of the model", model.next_motion());
        summary
    }
}

/// Returns a number of a unit in thousandths of it, in three digits.
fn milli(value: f64, unit: &str) -> String {
    format!("{} m{unit}", significant(1e3 * value, 3))
}

/// Returns a half-width in thousandths of its unit, rounded up to three digits.
#[must_use]
pub fn width_up(width: f64, unit: &str) -> String {
    let size = mul_up(1e3, width);
    let decimals = (2.0 - size.max(f64::MIN_POSITIVE).log10().floor()).clamp(0.0, 6.0) as usize;
    let [_, up] = outward([0.0, size], decimals);
    format!("{up} m{unit}")
}
