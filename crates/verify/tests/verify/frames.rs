//! The embedded capsules of the LWA 4P against the configuration that they come from.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use reachtube_robot::Robot;
use reachtube_verify::Capsules;

use crate::common::{Random, placed};

/// The joint frames of the shield's configuration, each in the link before: three columns of the
/// rotation, and the origin. Entries of 1e-15 there are 0 here.
const JOINTS: [([[f64; 3]; 3], [f64; 3]); 6] = [
    ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0, 0.0, 0.054]),
    ([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]], [0.0, 0.1013, 0.1013]),
    ([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]], [0.0, -0.35, 0.0]),
    ([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]], [0.0, 0.1013, 0.1013]),
    ([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]], [0.0, 0.0748, 0.1999]),
    ([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]], [0.0, 0.0748, 0.0748]),
];

/// Its capsules: two ends in the frame of the link, and the radius.
const CAPSULES: [([f64; 3], [f64; 3], f64); 6] = [
    ([0.0, -0.015, 0.1013], [0.0, -0.015, 0.1013], 0.09),
    ([0.00022952, -0.3499, 0.01358], [-0.00066172, 9.4084e-5, 0.012745], 0.074021),
    ([0.0, -0.015, 0.1013], [0.0, -0.015, 0.1013], 0.09),
    ([-4.6934e-5, -0.0058834, -0.00049515], [-2.3657e-6, 0.061878, 0.19827], 0.07),
    ([0.0, 0.0, 0.0748], [0.0, 0.0, 0.0748], 0.07),
    ([0.00049324, 0.0033497, 0.024003], [-0.00049264, 0.0031812, 0.09], 0.072549),
];

/// Height of the shoulder, the origin of our robot, above the shield's base, m.
const SHOULDER: f64 = 0.054 + 0.1013;

/// The frames of the shield's links in its base frame.
fn shield_frames(q: &[f64]) -> Vec<Isometry3<f64>> {
    let mut frame = Isometry3::identity();
    let joint = |((columns, origin), q): (&([[f64; 3]; 3], [f64; 3]), &f64)| {
        let rotation = Matrix3::from_columns(&columns.map(Vector3::from));
        let fixed = UnitQuaternion::from_matrix(&rotation);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), *q);
        assert!(Rotation3::from_matrix_unchecked(rotation).matrix().determinant() > 0.0);
        frame *= Isometry3::from_parts(Translation3::from(Vector3::from(*origin)), fixed * turn);
        frame
    };
    JOINTS.iter().zip(q).map(joint).collect()
}

#[test]
fn the_lwa4p_has_the_capsules_of_the_shields_configuration() {
    let robot = Robot::lwa4p();
    let capsules = Capsules::embedded(&robot).unwrap();
    let mut random = Random::new(1);
    for _ in 0..20 {
        let q = random.vector(6, 3.0);
        let frames = shield_frames(&q);
        for (i, capsule) in capsules.as_slice().iter().enumerate() {
            let (from, to, radius) = CAPSULES[i];
            assert_eq!((capsule.joint, capsule.radius), (i, radius));
            let ours = placed(&robot, capsule, &q);
            for (ours, theirs) in ours.iter().zip([from, to]) {
                let theirs = frames[i] * nalgebra::Point3::from(theirs);
                let theirs = theirs.coords - SHOULDER * Vector3::z();
                assert!((ours - theirs).norm() < 1e-12, "link {i} at {q:?}: {ours} {theirs}");
            }
        }
    }
}
