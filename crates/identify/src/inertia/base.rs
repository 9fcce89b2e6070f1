use crate::error::{Error, Result};
use crate::fit::CONDITION_LIMIT;
use crate::regression::singular::Singular;
use crate::regression::triangular_factor::TriangularFactor;
use nalgebra::{DMatrix, DVector};
use reachtube_robot::{BaseParameters, Robot};
use schemars::JsonSchema;
use serde::Serialize;

/// Part of a parameter's variance over the reference motion that may lie in undetermined
/// directions.
const MIN_OPEN: f64 = 0.0025;

/// A base parameter: an identifiable combination of parameters, with its value in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct BaseParameter {
    /// The combination, such as `Ixx2 - Iyy2 + Izz2 + J2`.
    pub name: String,
    /// Value in the identified robot.
    pub value: f64,
    /// Value by least squares.
    pub least_squares: f64,
    /// Standard error of the least-squares value; infinite if the recordings do not determine it.
    #[schemars(with = "Option<f64>")]
    pub standard_error: f64,
    /// Value in the given description.
    pub described: f64,
}

/// The base parameters with their errors, and how well the recordings determine them.
pub(crate) struct BaseFit {
    /// The base parameters.
    pub parameters: Vec<BaseParameter>,
    /// Number of combinations that the recordings determine.
    pub determined: usize,
    /// Condition number: the largest over the smallest excitation of a combination, each relative
    /// to its excitation by the reference motion. It is infinite if one is not determined.
    pub condition: f64,
}

/// Returns the base parameters by least squares beside the `values` that are used.
///
/// `reference` is the triangular factor of [`reference_factor`], which measures combinations
/// independently of the frames.
///
/// # Errors
///
/// [`Error::Undetermined`] if a combination is not determined and the links need not be
/// `physical`, so that no prior decides about it.
///
/// [`reference_factor`]: crate::inertia::reference::reference_factor
pub(crate) fn base_parameters(
    robot: &Robot,
    base: &BaseParameters,
    [fit, reference]: [&TriangularFactor; 2],
    values: &DVector<f64>,
    physical: bool,
) -> Result<BaseFit> {
    let solution = LeastSquares::new(base, fit, reference);
    let names = base.names();
    if !physical && solution.determined < names.len() {
        let open = (0..names.len()).filter(|k| solution.errors[*k].is_infinite());
        return Err(Error::Undetermined {
            count: names.len() - solution.determined,
            combinations: open.map(|k| names[k].clone()).collect(),
            total: names.len(),
            limit: CONDITION_LIMIT,
        });
    }
    // Values of the identified and of the given robot.
    let (found, described) =
        (base.reduce(values.as_slice()), base.reduce(&robot.parameter_values(base.parameters())));
    let parameter = |(k, name)| BaseParameter {
        name,
        value: found[k],
        least_squares: solution.x[k],
        standard_error: solution.errors[k],
        described: described[k],
    };
    Ok(BaseFit {
        parameters: names.into_iter().enumerate().map(parameter).collect(),
        determined: solution.determined,
        condition: solution.condition,
    })
}

/// The least-squares solution for k base parameters.
struct LeastSquares {
    /// The base parameters.
    x: DVector<f64>,
    /// Standard errors; infinite for a parameter with a part in an undetermined direction.
    errors: Vec<f64>,
    /// Number of determined directions.
    determined: usize,
    condition: f64,
}

impl LeastSquares {
    /// Solves in coordinates y in which the reference motion excites all directions equally.
    ///
    /// With the reference factor R of the independent columns, x = R⁻¹ y. Another choice of the
    /// links' frames changes x, but y only by a rotation. The singular values in y therefore depend
    /// on the motion, and not on the frames.
    fn new(base: &BaseParameters, fit: &TriangularFactor, reference: &TriangularFactor) -> Self {
        let independent = DMatrix::from_fn(base.parameters().len(), base.count(), |i, j| {
            f64::from(u8::from(base.independent()[j] == i))
        });
        let k = base.count();
        let from_y = reference
            .with_mapped_columns(&independent)
            .r
            .solve_upper_triangular(&DMatrix::identity(k, k))
            .expect("the columns are independent over the reference motion");
        let data = fit.with_mapped_columns(&(independent * &from_y));
        let Singular { u, values: sigma, v } = Singular::of(&data.r);
        let cut = sigma.max() / CONDITION_LIMIT;
        // Each direction of y is a column of x-values.
        let directions = &from_y * v;
        let (mut x, mut variances) = (DVector::zeros(k), vec![0.0; k]);
        let mut open = vec![0.0; k];
        for d in 0..k {
            let direction = directions.column(d);
            if sigma[d] > cut {
                x += direction * (u.column(d).dot(&data.z) / sigma[d]);
                let add = |(v, e): (&mut f64, &f64)| *v += (e / sigma[d]).powi(2);
                variances.iter_mut().zip(direction.iter()).for_each(add);
            } else {
                open.iter_mut().zip(direction.iter()).for_each(|(o, e)| *o += e * e);
            }
        }
        let is_open = |i: usize| open[i] > MIN_OPEN * directions.row(i).norm_squared();
        let error = |i: usize| if is_open(i) { f64::INFINITY } else { variances[i].sqrt() };
        let determined = sigma.iter().filter(|s| **s > cut).count();
        let whole = determined == k;
        Self {
            x,
            errors: (0..k).map(error).collect(),
            determined,
            condition: if whole { sigma.max() / sigma.min() } else { f64::INFINITY },
        }
    }
}
