//! What U says of parts that stick.

use reachtube_reach::Disturbance;
use reachtube_scalar::number::{at_least, four_decimals};

use crate::model::file::Model;
use crate::result::code::Code;
use crate::stiction::Stiction;
use reachtube_finding::{Finding, Remedy, Severity};

impl Model {
    /// Returns what U says of the dry friction of these parts; `None` for no part.
    #[must_use]
    pub fn finding_of_stiction(&self, rests: &[Stiction]) -> Option<Finding> {
        let lack = |rest: &&Stiction| rest.torque - rest.room;
        let worst = rests.iter().max_by(|a, b| lack(a).total_cmp(&lack(b)))?;
        let name = |rest: &Stiction| self.signals.parts[rest.part - 1].name.clone();
        let open: Vec<String> = rests.iter().filter(|rest| !rest.is_covered()).map(name).collect();
        let unit = self.signals.units_of_inputs().any();
        let noun = &self.signals.noun;
        let is_held = self.settings.disturbance == Disturbance::Sample;
        let (mut severity, mut remedy) = (Severity::Info, None);
        let text = if !open.is_empty() {
            severity = Severity::Warning;
            let is_tried = self.settings.stiction;
            remedy = (!is_tried).then(|| Remedy::new("stiction", "true"));
            format!(
                "U does not cover stiction of {noun}s {}: in {} from {:.3} s on, dry friction of \
                 {} may differ by {} {unit} between motions, and U allows {}. Another motion under \
                 the same motor torque may leave the sets where a {noun} sticks.{}",
                open.join(", "),
                worst.case,
                worst.time,
                name(worst),
                at_least(worst.torque),
                four_decimals(worst.room),
                if is_tried { " No wider U was found that covers it." } else { "" }
            )
        } else if self.settings.stiction {
            let most = rests.iter().map(|rest| rest.room).fold(0.0, f64::max);
            remedy = is_held.then(|| Remedy::new("disturbance", "measurable"));
            format!(
                "U was widened by up to {} {unit} for stiction: the sets cover other motions under \
                 the same motor torque, whose {noun}s stick or slip at other times{}.",
                four_decimals(most),
                if is_held { ", if friction changes at samples only" } else { "" }
            )
        } else {
            format!("U covers stiction of every {noun} that may come to rest.")
        };
        let finding = Finding::new(severity, Code::Stiction, text)
            .at(name(worst))
            .with("torque", worst.torque)
            .with("room", worst.room)
            .with("uncovered", open.len() as f64)
            .remedied_by(remedy);
        Some(finding)
    }
}
