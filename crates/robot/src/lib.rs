#![doc = include_str!("../README.md")]

mod aba;
mod algebra;
mod articulated_body;
mod base_parameters;
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
mod inertial_regressor;
mod input;
mod joint;
mod joint_geometry;
mod joint_kind;
mod kinematics;
mod link;
mod load;
mod lock;
pub mod ltdl;
mod motion;
mod parameter;
mod physicality;
mod placement;
mod polynomial_dynamics;
mod pose;
mod random_states;
mod regressor;
mod rnea;
mod robot;
mod singular_values;
mod text_file;
mod urdf;
mod warmth;
mod workspace;

pub use base_parameters::base::BaseParameters;
pub use description::joint_description::{
    Convention, Dh, FrictionDescription, FrictionErrors, GravityMoments, InertiaPoint,
    JointDescription, PlacementDescription,
};
pub use description::robot_description::{ParameterSet, RobotDescription};
pub use error::RobotError;
pub use excitation::evaluation::Quality;
pub use excitation::fourier::MotionSample;
pub use excitation::optimise::Excitation;
pub use excitation::settings::{Criterion, ExcitationSettings};
pub use field::{DrivenBy, RobotField};
pub use inertia::LinkInertia;
pub use inertial_regressor::RegressorWorkspace;
pub use joint::Joint;
pub use joint_geometry::JointGeometry;
pub use joint_kind::JointKind;
pub use lock::{Lock, LockedJoint};
pub use parameter::{Parameter, ParameterKind};
pub use physicality::outcome::Physicality;
pub use placement::{Placement, snapped_sin_cos};
pub use polynomial_dynamics::PolynomialDynamics;
pub use regressor::Regressor;
pub use robot::Robot;
pub use urdf::collision::{CollisionShape, Shape};
pub use urdf::read::{Urdf, UrdfOptions};
pub use workspace::Workspace;
