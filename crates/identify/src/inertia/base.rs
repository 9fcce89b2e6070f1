use crate::error::{Error, Result};
use crate::fit::{CONDITION_LIMIT, Fit};
use nalgebra::{DMatrix, DVector};
use reachtube_robot::{BaseParameters, Robot};
use serde::Serialize;

/// A base parameter: an identifiable combination of parameters, with its value in SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BaseParameter {
    /// The combination, such as `Ixx2 - Iyy2 + Izz2 + J2`.
    pub name: String,
    /// Value in the identified robot.
    pub value: f64,
    /// Value by least squares.
    pub least_squares: f64,
    /// Standard error of the least-squares value; infinite if the recordings do not determine it.
    pub standard_error: f64,
    /// Value in the given description.
    pub described: f64,
}

/// Returns the base parameters with their errors, and the condition of their regression.
///
/// # Errors
///
/// [`Error::Undetermined`] if a combination is not determined and the links need not be
/// `physical`, so that no prior decides about it.
pub fn base_parameters(
    robot: &Robot,
    base: &BaseParameters,
    fit: &Fit,
    values: &DVector<f64>,
    physical: bool,
) -> Result<(Vec<BaseParameter>, f64)> {
    // Least squares in the independent columns alone.
    let independent = DMatrix::from_fn(base.parameters().len(), base.count(), |i, j| {
        f64::from(u8::from(base.independent()[j] == i))
    });
    let solution =
        fit.whitened.with_mapped_columns(&independent).solve_within(CONDITION_LIMIT.recip());
    let names = base.names();
    if !physical && !solution.undetermined.is_empty() {
        return Err(Error::Undetermined {
            combinations: solution.undetermined.iter().map(|k| names[*k].clone()).collect(),
            total: names.len(),
            limit: CONDITION_LIMIT,
        });
    }
    // Values of the identified and of the given robot.
    let (found, described) =
        (base.reduce(values.as_slice()), base.reduce(&robot.parameter_values(base.parameters())));
    let errors = solution.standard_errors();
    let parameter = |(k, name)| BaseParameter {
        name,
        value: found[k],
        least_squares: solution.x[k],
        standard_error: errors[k],
        described: described[k],
    };
    Ok((names.into_iter().enumerate().map(parameter).collect(), solution.condition))
}
