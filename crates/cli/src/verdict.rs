//! Sentences that several commands print about a model.

use reachtube::conform::{Lost, Trust};

use crate::table::plural;

/// Reports where a reachable set ended before its suite.
pub fn lost(lost: &Lost) -> String {
    format!(
        "{}: the reachable set could not be computed beyond {:.3} s, where {} grew fastest; later \
         samples are not enclosed (--until {:.3} uses only the samples before)",
        lost.case, lost.time, lost.state, lost.time
    )
}

/// Reports the bound for the next motion; `role` says what the deciding motions did.
pub fn trust(trust: &Trust, role: &str) -> String {
    format!(
        "the next motion leaves the reachable set with probability at most {:.3} \
         (confidence {:.0} %): {} of {} {} {role}\nbasis: {}",
        trust.violation_probability,
        100.0 * trust.confidence,
        trust.deciding,
        trust.motions,
        plural(trust.motions, "motion"),
        trust.basis
    )
}
