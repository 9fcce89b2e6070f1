use reachtube_scalar::TaylorSpaceError;
use thiserror::Error;

/// What can be wrong with the input of a reachability computation.
#[derive(Debug, Error, Clone, PartialEq)]
#[non_exhaustive]
pub enum ReachError {
    /// The matrices of a system do not fit together.
    #[error("{what} is {found_rows} x {found_columns}, expected {rows} x {columns}")]
    Shape {
        /// Which matrix or vector.
        what: &'static str,
        /// Expected rows.
        rows: usize,
        /// Expected columns.
        columns: usize,
        /// Rows found.
        found_rows: usize,
        /// Columns found.
        found_columns: usize,
    },
    /// An entry is NaN or infinite.
    #[error(
        "{what} has the entry {value} in row {row}, column {column}; every entry must be finite"
    )]
    NotFinite {
        /// Which matrix or vector.
        what: &'static str,
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// A radius is below 0.
    #[error("{what} has the entry {value} in row {row}; a radius is at least 0")]
    Negative {
        /// Which vector.
        what: &'static str,
        /// Row, from 0.
        row: usize,
        /// The entry.
        value: f64,
    },
    /// The sample times do not increase.
    #[error("sample {index} is at {time} s, not after the sample before it at {previous} s")]
    Times {
        /// Index of the offending sample, from 0.
        index: usize,
        /// Its time in s.
        time: f64,
        /// The time before it in s.
        previous: f64,
    },
    /// Taylor models were asked for of a system with trigonometric variables.
    #[error(
        "Taylor models follow polynomials in states and inputs alone; give sin x and cos x as states of their own, with rates ẋ cos x and -ẋ sin x, or use linearisation"
    )]
    Trigonometric,
    /// Taylor models of that order do not exist.
    #[error(transparent)]
    Order(#[from] TaylorSpaceError),
    /// The enclosure of e^{At} grew without bound.
    #[error(
        "the solution cannot be enclosed up to {time} s: rounding errors grow as fast as the system itself; \
         use a shorter horizon (a sampling step times the norm of A far above 1 also does this)"
    )]
    Horizon {
        /// The end of the grid in s.
        time: f64,
    },
}
