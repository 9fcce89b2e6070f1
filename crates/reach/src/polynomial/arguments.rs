//! Checks of the arguments of a flowpipe.

use crate::error::ReachError;
use crate::grid::TimeGrid;
use crate::polynomial::settings::FlowpipeSettings;
use crate::polynomial::system::PolynomialSystem;
use crate::polynomial::uncertain_input::UncertainInput;
use crate::sets::hyperrectangle::Hyperrectangle;

/// Returns an error for the first argument that does not fit the system and the grid.
pub(crate) fn check(
    system: &PolynomialSystem,
    grid: &TimeGrid,
    start: &[f64],
    initial_set: &Hyperrectangle,
    input: &UncertainInput<'_>,
    settings: &FlowpipeSettings,
) -> Result<(), ReachError> {
    let (n, m) = (system.states(), system.inputs());
    check_vector("the start", start, n)?;
    for (set, centre, radius, size) in [
        (initial_set, "the centre of the initial set", "the radius of the initial set", n),
        (input.set, "the centre of the input set", "the radius of the input set", m),
    ] {
        check_vector(centre, &set.centre, size)?;
        check_vector(radius, &set.radius, size)?;
        if let Some(row) = set.radius.iter().position(|r| *r < 0.0) {
            return Err(ReachError::Negative { what: radius, row, value: set.radius[row] });
        }
    }
    let found_rows = settings.pieces.len();
    if found_rows != 0 && found_rows != n || settings.pieces.contains(&0) {
        let what = "the list of pieces, each at least 1,";
        return Err(ReachError::Shape { what, rows: n, columns: 1, found_rows, found_columns: 1 });
    }
    check_measured(input.measured, grid.len().saturating_sub(1), m)
}

/// Checks that the measured input has one row per step, or one more for the last sample.
fn check_measured(measured: &[f64], rows: usize, m: usize) -> Result<(), ReachError> {
    let (what, found) = ("the input", measured.len());
    if found != rows * m && found != (rows + 1) * m {
        let (found_rows, found_columns) = (found.checked_div(m).unwrap_or(found), m);
        return Err(ReachError::Shape { what, rows, columns: m, found_rows, found_columns });
    }
    check_vector(what, measured, found)
}

fn check_vector(what: &'static str, vector: &[f64], rows: usize) -> Result<(), ReachError> {
    if vector.len() != rows {
        let found_rows = vector.len();
        return Err(ReachError::Shape { what, rows, columns: 1, found_rows, found_columns: 1 });
    }
    match vector.iter().position(|x| !x.is_finite()) {
        Some(row) => Err(ReachError::NotFinite { what, row, column: 0, value: vector[row] }),
        None => Ok(()),
    }
}
