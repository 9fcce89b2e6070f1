//! Arrays of numbers between NumPy and the product. Values are taken by their indices, so that the
//! order in memory does not matter.

use numpy::ndarray::{ArrayD, IxDyn};
use numpy::{IntoPyArray, PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;

use crate::failure::{Failure, Result};

pub(crate) type Input<'py> = PyReadonlyArrayDyn<'py, f64>;
pub(crate) type Output<'py> = Bound<'py, PyArrayDyn<f64>>;

/// Returns the values of an array of a given shape, row by row.
///
/// # Errors
///
/// [`Failure::Setting`] for another shape.
pub(crate) fn values(name: &str, array: &Input<'_>, shape: &[usize]) -> Result<Vec<f64>> {
    let view = array.as_array();
    if view.shape() != shape {
        let words = |shape: &[usize]| format!("{shape:?}").replace('[', "(").replace(']', ")");
        return Err(Failure::Setting(format!(
            "{name} has the shape {}, but {} is needed",
            words(view.shape()),
            words(shape)
        )));
    }
    Ok(view.iter().copied().collect())
}

/// Returns an array of a given shape with these values, row by row.
///
/// # Panics
///
/// Panics if the number of values does not fit the shape.
pub(crate) fn array<'py>(py: Python<'py>, values: Vec<f64>, shape: &[usize]) -> Output<'py> {
    let array = ArrayD::from_shape_vec(IxDyn(shape), values);
    array.expect("the values fit the shape").into_pyarray(py)
}
