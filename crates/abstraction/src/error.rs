use std::path::PathBuf;

use reachtube_reach::ReachError;
use thiserror::Error;

/// Why a model could not be built or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The paper has no model of this number.
    #[error("there is no model {number}; give 1, 2 or 3")]
    UnknownModel {
        /// The requested number.
        number: u32,
    },
    /// The order of a model is 0.
    #[error("the order is 0, but a model has order 1 at least; give a higher order")]
    OrderZero,
    /// The terms of a model would not fit in memory.
    #[error(
        "model 3 of order {order} for {joints} joints would need about {:.0} GB for its terms, \
         but the limit is {:.0} GB; order {fitting_order} fits",
        needed / 1e9,
        limit / 1e9
    )]
    TooManyTerms {
        /// The requested order.
        order: u32,
        /// Number of joints n.
        joints: usize,
        /// Estimated memory, bytes.
        needed: f64,
        /// Memory that the terms may take, bytes.
        limit: f64,
        /// Highest order that fits.
        fitting_order: u32,
    },
    /// M_m(q_a) is not positive definite.
    #[error(
        "the mass matrix of {robot} is not positive definite at the expansion point \
         q = {q:?} {unit}; correct the robot's inertias or choose another expansion point"
    )]
    SingularMassMatrix {
        /// Name of the robot.
        robot: String,
        /// Positions q_a, n.
        q: Vec<f64>,
        /// Unit of the positions, or their units.
        unit: String,
    },
    /// A value of an expansion point is NaN or infinite.
    #[error("value {number} of the expansion point is {value}; give finite numbers")]
    ExpansionPointValue {
        /// Which value, from 1.
        number: usize,
        /// The value.
        value: f64,
    },
    /// An expansion point has another number of values than n, 2n or 3n.
    #[error(
        "the expansion point has {values} values, but the robot has {joints} joints; give \
         {joints} positions (rad or m), or {} values (positions, then velocities per s), or {} \
         values (then also inputs in N m or N)",
        2 * joints,
        3 * joints
    )]
    ExpansionPointSize {
        /// Number of values given.
        values: usize,
        /// Number of joints n.
        joints: usize,
    },
    /// A model that should be linear in (q̇, u) has another term.
    #[error(
        "model {model} of order {order} is not linear: the acceleration of joint {joint} has a \
         term in {}; use order 1, for which a linear program finds the sets",
        factors.join(", ")
    )]
    NotLinear {
        /// Number of the model: 1, 2 or 3.
        model: u32,
        /// Order of the model.
        order: u32,
        /// The joint, from 1.
        joint: usize,
        /// Names of the variables in the term.
        factors: Vec<String>,
    },
    /// The polynomials of a file are not a model's.
    #[error(transparent)]
    Records(#[from] RecordsError),
    /// A file is not an abstraction file, or has another version.
    #[error("{}: {problem}", path.display())]
    ModelFile {
        /// The file.
        path: PathBuf,
        /// The problem and the remedy.
        problem: String,
    },
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
    /// Polynomials of this order do not fit in a Taylor space.
    #[error(transparent)]
    Space(#[from] reachtube_scalar::TaylorSpaceError),
    /// The system does not fit a reachable-set computation.
    #[error(transparent)]
    Reach(#[from] ReachError),
}

/// Why the polynomials of a file are not a model's.
#[derive(Debug, Error, Clone, PartialEq)]
#[non_exhaustive]
pub enum RecordsError {
    /// The model has more possible terms than a file may ask for.
    #[error(
        "its polynomials of order {order} in {variables} variables have more than 1e12 possible \
         terms, and a file is checked by making its model again; choose a lower order"
    )]
    Order {
        /// The order.
        order: u32,
        /// Number of variables.
        variables: usize,
    },
    /// The variables differ from the model's.
    #[error("its variables are not {}", expected.join(", "))]
    Variables {
        /// Names of the model's variables, in order.
        expected: Vec<String>,
    },
    /// `origin` or `acceleration` has the wrong length.
    #[error(
        "origin has {origin} values and acceleration {accelerations} polynomials, but a model of \
         {joints} joints has {variables} and {joints}"
    )]
    Size {
        /// Length of `origin`.
        origin: usize,
        /// Length of `acceleration`.
        accelerations: usize,
        /// Number of variables of the model.
        variables: usize,
        /// Number of joints n.
        joints: usize,
    },
    /// The expansion point has the wrong length.
    #[error("its expansion point does not have one value per joint for {joints} joints")]
    ExpansionPoint {
        /// Number of joints n.
        joints: usize,
    },
    /// A term does not belong to a polynomial of the model's variables and order.
    #[error(
        "acceleration of joint {joint}: a term has {exponents} exponents of sum {degree} and the \
         coefficient {coefficient}, but the model has {variables} variables and order {order}"
    )]
    Term {
        /// The joint, from 1.
        joint: usize,
        /// Number of exponents.
        exponents: usize,
        /// Sum of the exponents.
        degree: u32,
        /// The coefficient.
        coefficient: f64,
        /// Number of variables of the model.
        variables: usize,
        /// Order of the model.
        order: u32,
    },
    /// The terms differ from the robot's.
    #[error(
        "its terms do not agree with its robot at its expansion point: the file was changed after \
         it was written"
    )]
    Changed,
}

reachtube_files::kinds!(Error {
    [File | Robot] => inner,
    ModelFile | Records => Model,
    SingularMassMatrix | Reach => NoAnswer,
    _ => Setting,
});

/// A result of this crate.
pub(crate) type Result<T, E = Error> = std::result::Result<T, E>;
