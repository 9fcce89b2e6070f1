//! The conic solver, and its answer made exact on the rows that decide.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT,
};
use nalgebra::{DMatrix, DVector};

use crate::error::{Error, Result};

/// A sparse matrix, row by row.
#[derive(Default)]
pub(crate) struct Triplets {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    count: usize,
}

impl Triplets {
    /// Adds a row. Entries below 1e-13 are dropped: they may be rounding, and the repair covers
    /// them.
    pub(crate) fn row(&mut self, entries: impl IntoIterator<Item = (usize, f64)>) {
        for (column, value) in entries.into_iter().filter(|(_, value)| value.abs() > 1e-13) {
            self.rows.push(self.count);
            self.columns.push(column);
            self.values.push(value);
        }
        self.count += 1;
    }
}

/// An optimal point as the solver found it.
pub(crate) struct Optimum {
    pub found: Vec<f64>,
    /// Which rows decide it: rows whose multiplier exceeds their slack.
    pub active: Vec<bool>,
    pub dual: f64,
}

/// The tolerance of an answer that is proved afterwards.
pub(crate) const FINE: f64 = 1e-11;

/// Minimises objective·x subject to A x <= bounds, to `tolerance` in every row and in the
/// objective.
///
/// # Errors
///
/// [`Error::Program`] when the solver stops without an answer.
pub(crate) fn solve_cone(
    objective: &[f64],
    matrix: &Triplets,
    bounds: &[f64],
    tolerance: f64,
) -> Result<Optimum> {
    let (m, n) = (matrix.count, objective.len());
    let a = CscMatrix::new_from_triplets(
        m,
        n,
        matrix.rows.clone(),
        matrix.columns.clone(),
        matrix.values.clone(),
    );
    let cones: [SupportedConeT<f64>; 1] = [NonnegativeConeT(m)];
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_feas(tolerance)
        .tol_gap_abs(tolerance)
        .tol_gap_rel(tolerance)
        .max_iter(200)
        .build()
        .map_err(|error| Error::Program(error.to_string()))?;
    let zero = CscMatrix::zeros((n, n));
    let mut solver = DefaultSolver::new(&zero, objective, &a, bounds, &cones, settings)
        .map_err(|error| Error::Program(error.to_string()))?;
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress => {
            let solution = &solver.solution;
            Ok(Optimum {
                found: solution.x.clone(),
                active: solution.z.iter().zip(&solution.s).map(|(z, s)| z > s).collect(),
                dual: solution.obj_val_dual,
            })
        }
        status => Err(Error::Program(format!(
            "the solver stopped with {status:?}; check that the recordings and the robot belong \
             together"
        ))),
    }
}

/// Moves an optimum the least way onto its active rows. An interior-point solution meets each of
/// them to about 1e-9 of the largest row, which is much for a small one; a vertex meets all to
/// rounding.
pub(crate) fn polished(optimum: &Optimum, matrix: &Triplets, bounds: &[f64]) -> Vec<f64> {
    let Optimum { found: x, active, .. } = optimum;
    let place: Vec<Option<usize>> = active
        .iter()
        .scan(0, |count, &active| {
            *count += usize::from(active);
            Some(active.then(|| *count - 1))
        })
        .collect();
    let count = place.iter().flatten().count();
    if count == 0 {
        return x.clone();
    }
    let mut rows = DMatrix::zeros(count, x.len());
    for ((&row, &column), &value) in matrix.rows.iter().zip(&matrix.columns).zip(&matrix.values) {
        if let Some(at) = place[row] {
            rows[(at, column)] = value;
        }
    }
    let wanted = DVector::from_iterator(
        count,
        bounds.iter().zip(active).filter(|(_, active)| **active).map(|(b, _)| *b),
    );
    let before = DVector::from_column_slice(x);
    let residual = &wanted - &rows * &before;
    let Ok(step) = rows.svd(true, true).solve(&residual, 1e-9) else { return x.clone() };
    (before + step).data.into()
}
