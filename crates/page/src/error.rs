//! Errors of figures and pages.

use crate::suite_figure::View;

/// The reason why a figure or page could not be made.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Two arrays that belong together differ in length.
    #[error(
        "suite {suite}: {what} has length {got}, but {expected} is needed; pass states as \
         [2n][times], n joints"
    )]
    Shape {
        /// The suite.
        suite: String,
        /// The array.
        what: String,
        /// Its length.
        got: usize,
        /// The length it must have.
        expected: usize,
    },
    /// A number is infinite or not a number.
    #[error(
        "{place}: {what}[{index}] is {value}, which cannot be drawn; check the step that \
         computed it"
    )]
    NotFinite {
        /// The suite, table or chart.
        place: String,
        /// The array.
        what: String,
        /// Index of the value.
        index: usize,
        /// The value.
        value: f64,
    },
    /// Times do not increase.
    #[error(
        "suite {suite}: {what}[{index}] is {value} s, not later than the sample before; sort the \
         samples by time"
    )]
    Order {
        /// The suite.
        suite: String,
        /// The array.
        what: String,
        /// Index of the sample.
        index: usize,
        /// Its time \[s\].
        value: f64,
    },
    /// The view needs a nominal motion that the suite does not have, or has for each run only.
    #[error("suite {suite} has no {view:?} view; draw one of SuiteFigure::views")]
    View {
        /// The suite.
        suite: String,
        /// The requested view.
        view: View,
    },
    /// A suite has no reachable set to draw.
    #[error(
        "suite {suite}: no reachable set was computed; compute the reachable sets of all suites \
         of the page"
    )]
    NoReachableSet {
        /// The suite.
        suite: String,
    },
    /// The contents of the page could not be computed.
    #[error(transparent)]
    Conform(#[from] reachtube_conform::Error),
    /// The page could not be written.
    #[error("the page could not be written: {0}; check the folder and the free space")]
    Io(#[from] std::io::Error),
}

reachtube_files::kinds!(Error {
    [Conform] => inner,
    Io => File,
    _ => NoAnswer,
});

/// A result of this crate.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;
