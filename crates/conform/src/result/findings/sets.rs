//! Findings about the recordings that decide the sets.

use crate::model::file::{MOST_TIGHT, Model};
use crate::result::code::Code;
use crate::tube::tube::Enclosure;
use reachtube_finding::{Finding, Severity};

pub(crate) fn touching(model: &Model) -> Finding {
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
    Finding::new(Severity::Info, Code::Touching, text).with("values", model.tight.len() as f64)
}
