//! Sentences that several commands print about a model.

use reachtube::conform::{Lost, Trust};

use crate::table::plural;

/// Where a reachable set ended.
pub fn lost(lost: &Lost) -> String {
    format!(
        "{}: the reachable set could not be followed beyond {:.3} s, where {} grew fastest; what is recorded later is not enclosed (--until {:.3} leaves it out)",
        lost.case, lost.time, lost.state, lost.time
    )
}

pub fn trust(trust: &Trust, role: &str) -> String {
    format!(
        "the next motion leaves the set with probability at most {:.3} (confidence {:.0} %): {} {}, {} of them {role};\n{}",
        trust.violation_probability,
        100.0 * trust.confidence,
        trust.motions,
        plural(trust.motions, "motion"),
        trust.deciding,
        trust.basis
    )
}
