use std::f64::consts::TAU;

use super::unit::AngleUnit;
use crate::run::Run;
use crate::unwrap::unwrap;

/// Returns commanded positions, one column for each joint, row-major in rad: without jumps by whole
/// turns, and on the turn of the positions of `run` at its first sample.
pub(super) fn commanded(
    mut columns: Vec<Vec<f64>>,
    run: &Run,
    revolute: &[bool],
    unit: AngleUnit,
) -> Vec<f64> {
    for (joint, column) in columns.iter_mut().enumerate().filter(|(joint, _)| revolute[*joint]) {
        column.iter_mut().for_each(|value| *value /= unit.per_radian());
        unwrap(column);
        let turns = ((run.q(0)[joint] - column[0]) / TAU).round() * TAU;
        column.iter_mut().for_each(|value| *value += turns);
    }
    let columns = &columns;
    (0..run.len()).flat_map(|k| columns.iter().map(move |column| column[k])).collect()
}
