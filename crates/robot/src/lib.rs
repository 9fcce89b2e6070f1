#![doc = include_str!("../README.md")]

mod aba;
mod algebra;
mod base_parameters;
mod chain;
mod column;
mod coriolis;
mod crba;
mod description;
mod error;
mod excitation;
mod field;
mod forward_dynamics;
pub mod friction;
mod gravity;
mod inertia;
mod input;
mod kinematics;
pub mod ltdl;
mod physicality;
mod placement;
mod polynomial_dynamics;
mod regressor;
mod rnea;
mod robot;
mod simulate;
mod singular;
mod states;
mod urdf;
mod workspace;

pub use base_parameters::BaseParameters;
pub use chain::JointGeometry;
pub use column::{Column, ColumnKind, Regressor};
pub use description::{
    Convention, Dh, FrictionDescription, GravityMoments, InertiaPoint, JointDescription,
    Parameters, PlacementDescription, RobotDescription, SCHEMA_VERSION,
};
pub use error::RobotError;
pub use excitation::{
    Criterion, Excitation, ExcitationSettings, FourierTrajectory, MotionSample, Quality,
};
pub use field::{DrivenBy, RobotField};
pub use inertia::LinkInertia;
pub use physicality::Physicality;
pub use placement::{Placement, snapped_sin_cos};
pub use polynomial_dynamics::PolynomialDynamics;
pub use regressor::RegressorWorkspace;
pub use robot::{Joint, Robot};
pub use simulate::Trajectory;
pub use urdf::{Urdf, UrdfEnds};
pub use workspace::Workspace;
