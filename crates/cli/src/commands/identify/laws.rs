//! The section of `identify` about friction laws.

use reachtube::identify::{Identification, SaturatingFriction};
use reachtube::number::four_decimals;

use crate::table::table;

/// Returns the table of the joints whose friction saturates; it is empty if there are none.
pub(super) fn laws(found: &Identification) -> String {
    if found.saturating.is_empty() {
        return String::new();
    }
    let row = |law: &SaturatingFriction| {
        let numbers = [law.held_out[0], law.held_out[1], law.builds_up, law.speed];
        let numbers = numbers.into_iter().map(four_decimals);
        std::iter::once(law.joint.clone()).chain(numbers).collect()
    };
    let header =
        ["friction saturates", "residual without", "held-out residual with", "builds up", "over"];
    let rows: Vec<_> = found.saturating.iter().map(row).collect();
    format!("\nfriction laws\n{}", table(&header, &rows))
}
