use reachtube_scalar::TaylorSpaceError;
use thiserror::Error;

/// Errors of a reachability computation: invalid input, or a horizon without a finite enclosure.
#[derive(Debug, Error, Clone, PartialEq)]
#[non_exhaustive]
pub enum ReachError {
    /// A matrix or vector has the wrong shape.
    #[error("{what} is {found_rows} x {found_columns}, expected {rows} x {columns}")]
    Shape {
        /// Name of the matrix or vector.
        what: &'static str,
        /// Expected number of rows.
        rows: usize,
        /// Expected number of columns.
        columns: usize,
        /// Number of rows found.
        found_rows: usize,
        /// Number of columns found.
        found_columns: usize,
    },
    /// An entry is NaN or infinite.
    #[error(
        "{what} has the entry {value} in row {row}, column {column}; every entry must be finite"
    )]
    NotFinite {
        /// Name of the matrix or vector.
        what: &'static str,
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The entry.
        value: f64,
    },
    /// A radius is negative.
    #[error("{what} has the entry {value} in row {row}; a radius must be at least 0")]
    Negative {
        /// Name of the vector.
        what: &'static str,
        /// Row, from 0.
        row: usize,
        /// The entry.
        value: f64,
    },
    /// The sample times do not increase.
    #[error(
        "sample {index} is at {time} s, not after the previous sample at {previous} s; \
         sample times must be finite and increase"
    )]
    Times {
        /// Index of the offending sample, from 0.
        index: usize,
        /// Its time in s.
        time: f64,
        /// Time of the previous sample in s.
        previous: f64,
    },
    /// The settings select Taylor models of a system with sines and cosines.
    #[error(
        "Taylor models support only polynomials in states and inputs; \
         add sin x and cos x as states with the rates ẋ cos x and -ẋ sin x, or use linearisation"
    )]
    Trigonometric,
    /// No Taylor space has this order for this number of states.
    #[error(transparent)]
    Order(#[from] TaylorSpaceError),
    /// The enclosure of e^{At} is not finite over the horizon.
    #[error(
        "no finite enclosure of the solution exists up to {time} s: rounding errors grow as fast \
         as the system; use a shorter horizon or a shorter sampling step \
         (a step times the norm of A far above 1 has the same effect)"
    )]
    Horizon {
        /// End of the grid in s.
        time: f64,
    },
}
