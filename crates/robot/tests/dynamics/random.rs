//! Random robots with physical parameters.

use proptest::prelude::*;
use reachtube_robot::{
    Dh, InertiaPoint, JointDescription, JointKind, ParameterSet, PlacementDescription, Robot,
    RobotDescription,
};

/// Makes a joint whose link is a body of four random points, so that its parameters are physical.
fn joint(x: Vec<f64>, index: usize, by_dh: bool, kind: JointKind) -> JointDescription {
    let points = x[..12].chunks(3).map(|c| nalgebra::Vector3::new(c[0], c[1], c[2]));
    let mass = 1.0 + x[12].abs();
    let com = points.clone().sum::<nalgebra::Vector3<f64>>() / 4.0;
    let inertia = points
        .map(|p| p - com)
        .map(|r| {
            0.25 * mass * (nalgebra::Matrix3::identity() * r.norm_squared() - r * r.transpose())
        })
        .sum::<nalgebra::Matrix3<f64>>();
    let placement = PlacementDescription {
        rotation: None,
        rpy: Some([x[13], x[14], x[15]]),
        translation: [x[16], x[17], x[18]],
    };
    JointDescription {
        name: format!("j{index}"),
        kind,
        position_limits: (kind == JointKind::Prismatic).then_some([-1.0, 1.5]),
        dh: by_dh.then_some(Dh { a: x[16], alpha: x[13], theta: x[14], d: x[17] }),
        placement: (!by_dh).then_some(placement),
        axis: (!by_dh).then_some([x[19], x[20], 0.3 + x[21].abs()]),
        mass,
        com: Some(com.into()),
        inertia: [0, 1, 2, 4, 5, 8].map(|k| inertia[k]),
        about: InertiaPoint::Com,
        armature: Some(0.05 + 0.1 * x[19].abs()),
        ..Default::default()
    }
}

/// Generates robots with 1 to 7 joints of both kinds and no friction.
pub(crate) fn robots() -> impl Strategy<Value = Robot> {
    let kinds = prop_oneof![2 => Just(JointKind::Revolute), 1 => Just(JointKind::Prismatic)];
    let joints = prop::collection::vec(
        (prop::collection::vec(-1.0..1.0f64, 22), any::<bool>(), kinds),
        1..8,
    );
    (joints, prop::array::uniform3(-10.0..10.0f64)).prop_map(|(joints, gravity)| {
        let description = RobotDescription {
            schema_version: 1,
            name: "random".into(),
            parameters: ParameterSet::Physical,
            convention: Default::default(),
            gravity,
            locked: Vec::new(),
            identified_from: Vec::new(),
            joints: joints
                .into_iter()
                .enumerate()
                .map(|(i, (x, by_dh, kind))| joint(x, i, by_dh, kind))
                .collect(),
        };
        Robot::from_description(&description).unwrap()
    })
}

/// Generates a robot with three vectors: q, q̇, and q̈ or torque.
pub(crate) fn robots_and_states() -> impl Strategy<Value = (Robot, Vec<f64>, Vec<f64>, Vec<f64>)> {
    robots().prop_flat_map(|robot| {
        let n = robot.joint_count();
        let vector = move |bound: f64| prop::collection::vec(-bound..bound, n);
        (Just(robot), vector(3.2), vector(2.0), vector(5.0))
    })
}
