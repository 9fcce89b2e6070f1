//! What decides the sets, and motions near the recordings.

use reachtube_robot::JointKind;

use crate::data::settings::Tolerance;
use crate::model::file::{MOST_TIGHT, Model};
use crate::model::records::{Explained, Residual};
use crate::result::code::Code;
use crate::result::finding::{Finding, Severity};
use crate::tube::tube::Enclosure;

impl Finding {
    /// How many recorded values touch the reachable set.
    pub(crate) fn touching(model: &Model) -> Self {
        let set = match model.proof.enclosure {
            Enclosure::Inner => "reachable set",
            Enclosure::Outer => "linearised set",
        };
        let text = match model.tight.len() {
            1 => format!("1 recorded value touches the {set} and decides X0 and U"),
            count => {
                let more = if count == MOST_TIGHT { " or more" } else { "" };
                format!("{count}{more} recorded values touch the {set} and decide X0 and U")
            }
        };
        let text = if model.tight.is_empty() { text } else { text + ":" };
        Self::new(Severity::Info, Code::Touching, text).with("values", model.tight.len() as f64)
    }

    /// How close motions of the model come to the recordings, or to `some` of them; `tolerance`
    /// comes from the settings.
    pub(crate) fn explanations(
        explained: &Explained,
        some: &str,
        tolerance: Tolerance,
        kinds: &[JointKind],
    ) -> Self {
        let Explained { runs, residuals } = explained;
        let size = |residual: &&Residual| residual.in_tolerances(tolerance);
        let worst = residuals.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        let Some(worst) = worst else {
            let text = "There is no recording to explain.";
            return Self::new(Severity::Info, Code::Explanations, text);
        };
        let q = JointKind::any_unit(kinds, JointKind::position_unit);
        let qd = JointKind::any_unit(kinds, JointKind::velocity_unit);
        let median = |of: fn(&Residual) -> Option<f64>| {
            let mut values: Vec<f64> =
                residuals.iter().map(|r| of(r).unwrap_or(f64::INFINITY)).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        let size = |value: Option<f64>| {
            value.map_or_else(|| "infinitely far".into(), |value| format!("{value:.2e}"))
        };
        let [of_q, of_qd] = [median(|r| r.position), median(|r| r.velocity)];
        let text = format!(
            "For {runs} of the {count} recordings{some}, a motion of the model itself (start in \
             X0, input in U, held over each sample) was found within {} {q} and {} {qd}. The \
             closest motions found differ by {of_q:.2e} {q} and {of_qd:.2e} {qd} in the median, \
             and by {} {q} and {} {qd} for {}.",
            tolerance.position,
            tolerance.velocity,
            size(worst.position),
            size(worst.velocity),
            worst.file,
            count = residuals.len(),
        );
        Self::new(Severity::Info, Code::Explanations, text)
            .with("explained", *runs as f64)
            .with("recordings", residuals.len() as f64)
            .with("median_position", of_q)
            .with("median_velocity", of_qd)
    }
}
