//! The bodies that a simulator moves: a robot's links where they can exist, and otherwise bodies
//! with the same torques.

use nalgebra::{DMatrix, DVector, Matrix4, Vector4};
use reachtube_identify::TriangularFactor;
use reachtube_identify::bodies::{BodyProgram, PER_LINK, PositiveColumn, pseudo_inertia};
use reachtube_robot::{LinkInertia, Parameter, ParameterKind, Placement, Regressor, Robot};

use crate::export::ExportError;
use crate::export::draws::Draws;

/// Number of random states whose torques must agree.
const STATES: usize = 200;

/// Weight of the torques against the prior, in 1/(N m): the program leaves less of them than the
/// projection onto equal torques can move.
const WEIGHT: f64 = 1e4;

/// Singular values below this part of the largest count as 0.
const RANK: f64 = 1e-10;

/// Largest difference of a torque \[N m\] that remains.
const EQUAL: f64 = 1e-9;

/// Second moments \[kg m²\] and mass \[kg\] of a body, for quantities without an effect on the
/// torques.
const PRIOR: Vector4<f64> = Vector4::new(0.01, 0.01, 0.01, 1.0);

/// Motor inertia \[kg m²; kg\], for quantities without an effect on the torques.
const MOTOR_PRIOR: f64 = 1.0;

/// A body and the joint that moves it. Its frame is the joint's, moved by q.
#[derive(Debug, Clone)]
pub(in crate::export) struct Body {
    /// Placement of the joint's frame in the frame of the previous body.
    pub placement: Placement,
    /// Unit vector of the joint's axis.
    pub axis: [f64; 3],
    /// Mass, centre of mass and inertia.
    pub inertia: LinkInertia,
    /// Motor inertia on the link side \[kg m²; kg\].
    pub armature: f64,
}

/// Returns the bodies of a robot, n, from base to tip.
///
/// # Errors
///
/// [`ExportError::SeparateGravity`] where gravity acts on masses of its own, and
/// [`ExportError::NotPhysical`] where a link cannot exist and no bodies with the same torques were
/// found.
pub(in crate::export) fn bodies(robot: &Robot) -> Result<Vec<Body>, ExportError> {
    let (n, joints) = (robot.joint_count(), &robot.description().joints);
    if joints.iter().any(|joint| joint.gravity_moments.is_some()) {
        return Err(ExportError::SeparateGravity { robot: robot.name().into() });
    }
    let mut parameters = robot.inertial_parameters();
    parameters.extend(robot.joints().iter().map(|joint| joint.armature));
    if let Some(link) = first_impossible(&parameters[..PER_LINK * n]) {
        parameters = with_the_same_torques(robot).ok_or_else(|| ExportError::NotPhysical {
            robot: robot.name().into(),
            joint: joints[link].name.clone(),
        })?;
    }
    let (links, armatures) = parameters.split_at(PER_LINK * n);
    let mut before = Placement::identity();
    let geometry = robot.geometry();
    let body = |j: usize| {
        let own = std::array::from_fn(|p| links[PER_LINK * j + p]);
        let placement = before.then(&geometry[j].before);
        before = geometry[j].after.clone();
        Body {
            placement,
            axis: geometry[j].axis.into(),
            inertia: LinkInertia::from_parameters(&own).moved(&before),
            armature: armatures[j],
        }
    };
    Ok((0..n).map(body).collect())
}

/// Checks that each link of a robot is a body by itself.
///
/// # Errors
///
/// As [`bodies`].
pub(super) fn own_links(robot: &Robot) -> Result<(), ExportError> {
    let joints = &robot.description().joints;
    if joints.iter().any(|joint| joint.gravity_moments.is_some()) {
        return Err(ExportError::SeparateGravity { robot: robot.name().into() });
    }
    match first_impossible(&robot.inertial_parameters()) {
        None => Ok(()),
        Some(link) => Err(ExportError::NotPhysical {
            robot: robot.name().into(),
            joint: joints[link].name.clone(),
        }),
    }
}

/// Returns the first of some links that no distribution of positive mass has.
fn first_impossible(links: &[f64]) -> Option<usize> {
    links.chunks_exact(PER_LINK).position(|link| pseudo_inertia(link).cholesky().is_none())
}

/// Finds bodies and motor inertias with the robot's torques: 10 n parameters, and n.
fn with_the_same_torques(robot: &Robot) -> Option<Vec<f64>> {
    let n = robot.joint_count();
    let (torques, wanted) = torques(robot);
    let columns = torques.ncols();
    let mut rows = torques.clone().insert_column(columns, 0.0);
    rows.set_column(columns, &wanted);
    rows *= WEIGHT;
    let data = TriangularFactor::from_rows(rows.transpose().as_slice(), columns);
    let prior = vec![Matrix4::from_diagonal(&PRIOR); n];
    let motor = |index: usize| PositiveColumn { index, prior: MOTOR_PRIOR };
    let motors: Vec<PositiveColumn> = (PER_LINK * n..columns).map(motor).collect();
    let program =
        BodyProgram { data: &data, prior: &prior, strength: 1.0, positive: &motors, rising: &[] };
    let near = program.solve()?.x;
    // The nearest parameters with exactly these torques.
    let misfit = &data.z - &data.r * &near;
    let decomposed = data.r.svd(true, true);
    let least = RANK * decomposed.singular_values.max();
    let x = near + decomposed.solve(&misfit, least).ok()?;
    let exist = first_impossible(&x.as_slice()[..PER_LINK * n]).is_none();
    let driven = motors.iter().all(|motor| x[motor.index] >= 0.0);
    let equal = (torques * &x - wanted).amax() < EQUAL;
    (exist && driven && equal).then(|| x.as_slice().to_vec())
}

/// Returns the regressor of the links and motors at random states, and the robot's torques there.
fn torques(robot: &Robot) -> (DMatrix<f64>, DVector<f64>) {
    let n = robot.joint_count();
    let mut parameters = Parameter::of_joints(n, &ParameterKind::INERTIAL);
    parameters.extend(Parameter::of_joints(n, &[ParameterKind::MotorInertia]));
    let mut draws = Draws::seeded(2);
    let mut draw = |radius: f64| draws.vector(n, radius);
    let states: Vec<[Vec<f64>; 3]> =
        (0..STATES).map(|_| [draw(3.0), draw(2.0), draw(5.0)]).collect();
    let matrix = Regressor::new(robot, &parameters).stacked(&states);
    let torques = states.iter().flat_map(|[q, qd, qdd]| {
        robot.inverse_dynamics(q, qd, qdd).iter().copied().collect::<Vec<_>>()
    });
    let torques = DVector::from_iterator(n * STATES, torques);
    (matrix, torques)
}
