//! Robots with prismatic joints against closed-form equations of motion, derived by hand from their
//! Lagrangians.

use crate::close::assert_close;
use proptest::prelude::*;
use reachtube_robot::{
    BaseParameters, JointKind, Parameter, ParameterKind, Physicality, Robot, Workspace,
};
use reachtube_scalar::{Interval, TaylorPolynomial};

const GRAVITY: f64 = 9.81;

/// A cart of 2 kg with a motor mass of 0.3 kg that slides along x, and a pole of 0.5 kg on it. The
/// pole hangs at q2 = 0, has its centre of mass 0.4 m below the hinge, and 0.03 kg m² about it.
const CART_POLE: &str = r#"
schema_version = 1
name = "cart-pole"

[[joint]]
name = "cart"
type = "prismatic"
placement = {}
axis = [1.0, 0.0, 0.0]
mass = 2.0
armature = 0.3
position_limits = [-1.0, 2.0]
friction = { viscous = [4.0, 0.0, 0.0] }

[[joint]]
name = "pole"
placement = { translation = [0.1, 0.0, 0.2] }
axis = [0.0, 1.0, 0.0]
mass = 0.5
com = [0.0, 0.0, -0.4]
inertia = [0.03, 0.0, 0.0, 0.03, 0.0, 0.001]
"#;

/// A SCARA by Denavit-Hartenberg parameters: two revolute joints with links of 0.3 m and 0.25 m, a
/// spindle that slides down, and a wrist that turns about the spindle.
const SCARA: &str = r#"
schema_version = 1
name = "SCARA"

[[joint]]
name = "shoulder"
dh = { a = 0.3, alpha = 0.0, theta = 0.0, d = 0.4 }
mass = 6.0
com = [-0.12, 0.0, 0.05]
inertia = [0.02, 0.0, 0.0, 0.06, 0.0, 0.07]
armature = 0.2

[[joint]]
name = "elbow"
dh = { a = 0.25, alpha = 3.141592653589793, theta = 0.0, d = 0.0 }
mass = 4.0
com = [-0.1, 0.0, -0.03]
inertia = [0.01, 0.0, 0.0, 0.03, 0.0, 0.04]
armature = 0.1

[[joint]]
name = "spindle"
type = "prismatic"
dh = { a = 0.0, alpha = 0.0, theta = 0.0, d = 0.05 }
mass = 1.5
inertia = [0.004, 0.0, 0.0, 0.004, 0.0, 0.0006]
armature = 2.0
position_limits = [0.0, 0.2]
velocity_limit = 1.1

[[joint]]
name = "wrist"
dh = { a = 0.0, alpha = 0.0, theta = 0.0, d = 0.0 }
mass = 0.7
inertia = [0.002, 0.0, 0.0, 0.002, 0.0, 0.0009]
armature = 0.01
"#;

fn robot(text: &str) -> Robot {
    Robot::from_toml(text, "robot.toml").unwrap()
}

/// Returns M, c and g of the cart-pole.
///
/// With x = q1 and the pole's angle q = q2 about +y, the centre of mass is at
/// (x + 0.1 - l sin q, 0.2 - l cos q), so T = ½ (m1 + J) ẋ² + ½ m (ẋ - l q̇ cos q)² +
/// ½ m (l q̇ sin q)² + ½ I q̇² and V = -m g l cos q.
fn cart_pole(q: f64, qd: f64) -> [Vec<f64>; 3] {
    let (cart, m, l, own) = (2.0 + 0.3, 0.5, 0.4, 0.03);
    let coupling = -m * l * q.cos();
    [
        vec![cart + m, coupling, coupling, own + m * l * l],
        vec![m * l * q.sin() * qd * qd, 0.0],
        vec![0.0, m * GRAVITY * l * q.sin()],
    ]
}

/// Returns M, c and g of the SCARA.
///
/// Seen from above, joints 1 and 2 are a planar arm. The spindle points down, so the wrist's angle
/// counts backward: it turns at q̇1 + q̇2 - q̇4 about the vertical.
fn scara([_, q2, _, _]: [f64; 4], [v1, v2, _, _]: [f64; 4]) -> [Vec<f64>; 3] {
    let (l1, l2) = (0.3, 0.25);
    let (m1, r1, i1) = (6.0, l1 - 0.12, 0.07);
    let (m2, r2, i2) = (4.0, l2 - 0.1, 0.04);
    // The tool is the spindle with the wrist, whose own inertia turns with all three angles.
    let (tool, spindle, wrist) = (1.5 + 0.7, 0.0006, 0.0009);
    let coupling = l1 * (m2 * r2 + tool * l2);
    let elbow = i2 + m2 * r2 * r2 + tool * l2 * l2 + spindle + wrist;
    let shoulder = i1 + m1 * r1 * r1 + (m2 + tool) * l1 * l1;
    let both = elbow + coupling * q2.cos();
    let whole = shoulder + elbow + 2.0 * coupling * q2.cos() + 0.2;
    #[rustfmt::skip]
    let mass = vec![
        whole, both, 0.0, -wrist,
        both, elbow + 0.1, 0.0, -wrist,
        0.0, 0.0, tool + 2.0, 0.0,
        -wrist, -wrist, 0.0, wrist + 0.01,
    ];
    let swing = coupling * q2.sin();
    [
        mass,
        vec![-swing * v2 * (2.0 * v1 + v2), swing * v1 * v1, 0.0, 0.0],
        vec![0.0, 0.0, -tool * GRAVITY, 0.0],
    ]
}

/// Compares all algorithms with the closed forms M, c and g at one state.
fn all_agree(robot: &Robot, q: &[f64], qd: &[f64], qdd: &[f64], [mass, c, g]: [Vec<f64>; 3]) {
    let n = q.len();
    assert_close(robot.mass_matrix(q).as_slice(), &mass, "M");
    assert_close(robot.motion_torque(q, qd, &vec![0.0; q.len()]).as_slice(), &c, "c");
    assert_close(robot.gravity_torque(q).as_slice(), &g, "g");
    let inertial = |i: usize| (0..n).map(|j| mass[i * n + j] * qdd[j]).sum::<f64>();
    let tau: Vec<f64> = (0..n).map(|i| inertial(i) + c[i] + g[i]).collect();
    assert_close(robot.inverse_dynamics(q, qd, qdd).as_slice(), &tau, "rnea");
    assert_close(robot.forward_acceleration(q, qd, &tau).as_slice(), qdd, "forward dynamics");
    let ((sin, cos), mut back) = (robot.sin_cos(q), vec![0.0; n]);
    robot.aba(&sin, &cos, qd, &tau, &mut Workspace::new(robot), &mut back);
    assert_close(&back, qdd, "aba");
    // The regressor does not contain the motors.
    let y = crate::regressor::inertial_regressor(robot, q, qd, qdd);
    let theta = nalgebra::DVector::from_vec(robot.inertial_parameters());
    let motors = robot.joints().iter().zip(qdd).map(|(joint, qdd)| joint.armature * qdd);
    let sum: Vec<f64> = (y * theta).iter().zip(motors).map(|(a, b)| a + b).collect();
    assert_close(&sum, &tau, "regressor");
}

proptest! {
    #[test]
    fn a_cart_pole_moves_as_its_lagrangian_says(
        q in prop::array::uniform2(-3.0..3.0f64),
        qd in prop::array::uniform2(-3.0..3.0f64),
        qdd in prop::array::uniform2(-9.0..9.0f64),
    ) {
        all_agree(&robot(CART_POLE), &q, &qd, &qdd, cart_pole(q[1], qd[1]));
    }

    #[test]
    fn a_scara_moves_as_its_lagrangian_says(
        q in prop::array::uniform4(-3.0..3.0f64),
        qd in prop::array::uniform4(-3.0..3.0f64),
        qdd in prop::array::uniform4(-9.0..9.0f64),
    ) {
        all_agree(&robot(SCARA), &q, &qd, &qdd, scara(q, qd));
    }

    /// Model polynomials, and enclosures over boxes of positions.
    #[test]
    fn polynomials_and_enclosures_agree_with_the_closed_form(
        q in prop::array::uniform4(-2.0..2.0f64),
        qd in prop::array::uniform4(-2.0..2.0f64),
        radius in 0.0..0.1f64,
        pick in -1.0..1.0f64,
    ) {
        let robot = robot(SCARA);
        let inside = q.map(|q| q + 0.99 * pick * radius);
        let [mass, c, _] = scara(inside, qd);
        let dynamics = robot.polynomial_dynamics::<f64>().unwrap();
        let (sin, cos) = robot.sin_cos(&inside);
        let at = [sin, cos].concat();
        let found: Vec<f64> = dynamics.mass_matrix.iter().map(|m| m.evaluate(&at)).collect();
        assert_close(&found, &mass, "polynomial M");
        let christoffel = dynamics.christoffel();
        let term = |m: &TaylorPolynomial, jk: usize| m.evaluate(&at) * qd[jk / 4] * qd[jk % 4];
        let torque = |m: &Vec<TaylorPolynomial>| (0..16).map(|jk| term(&m[jk], jk)).sum();
        let found: Vec<f64> = christoffel.iter().map(torque).collect();
        assert_close(&found, &c, "polynomial c");

        let sides = q.map(|q| Interval::centred(q, radius));
        let mut outer = [Interval::ZERO; 16];
        let (sin, cos) = robot.sin_cos(&sides);
        robot.crba(&sin, &cos, &mut Workspace::new(&robot), &mut outer);
        let rounding = 1e-12;
        let contains = |o: &Interval, m: &f64| (*o + Interval::centred(0.0, rounding)).contains(*m);
        prop_assert!(outer.iter().zip(&mass).all(|(o, m)| contains(o, m)));
    }
}

#[test]
fn energy_and_power_are_in_the_units_of_the_joints() {
    let robot = robot(CART_POLE);
    assert_eq!(robot.kinds(), [JointKind::Prismatic, JointKind::Revolute]);
    // The cart alone: ½ (2.5 + 0.3) kg (2 m/s)².
    assert!((robot.kinetic_energy(&[0.0, 0.0], &[2.0, 0.0]) - 5.6).abs() < 1e-12);
    assert_eq!(robot.viscous_torque(&[0.5, 0.0])[0], 2.0);
    let lifted = robot.potential_energy(&[0.7, 3.0]) - robot.potential_energy(&[0.0, 0.0]);
    assert!((lifted - 0.5 * GRAVITY * 0.4 * (1.0 - 3f64.cos())).abs() < 1e-12);
    let placement = &robot.link_placements(&[0.7, 0.0])[1];
    assert!((placement.translation - nalgebra::Vector3::new(0.8, 0.0, 0.2)).amax() < 1e-15);
}

#[test]
fn both_dh_conventions_slide_along_z() {
    let modified =
        SCARA.replace("schema_version = 1", "schema_version = 1\nconvention = \"modified\"");
    let q = [0.0, 0.0, 0.15, 0.0];
    let tip = |text: &str| robot(text).link_placements(&q)[3].translation;
    // The standard twist of joint 2 turns the spindle upside down; the modified one turns joint 2.
    assert!((tip(SCARA) - nalgebra::Vector3::new(0.55, 0.0, 0.4 - 0.05 - 0.15)).amax() < 1e-12);
    let expected = nalgebra::Vector3::new(0.55, 0.0, 0.4 - 0.05 - 0.15);
    assert!((tip(&modified) - expected).amax() < 1e-12, "{}", tip(&modified));
}

#[test]
fn a_gantry_is_physical_and_has_only_masses_as_base_parameters() {
    let axis = |name: &str, axis: [f64; 3], mass: f64| {
        format!(
            "[[joint]]\nname = \"{name}\"\ntype = \"prismatic\"\nplacement = {{}}\n\
             axis = {axis:?}\nmass = {mass}\nposition_limits = [0.0, 2.0]\n"
        )
    };
    let text = format!(
        "schema_version = 1\nname = \"gantry\"\n{}{}{}",
        axis("x", [1.0, 0.0, 0.0], 40.0),
        axis("y", [0.0, 1.0, 0.0], 15.0),
        axis("z", [0.0, 0.0, -1.0], 5.0)
    );
    let robot = robot(&text);
    let mass = robot.mass_matrix(&[1.0, 0.5, 0.2]);
    assert_close(mass.as_slice(), &[60.0, 0.0, 0.0, 0.0, 20.0, 0.0, 0.0, 0.0, 5.0], "M");
    assert_close(robot.gravity_torque(&[0.0; 3]).as_slice(), &[0.0, 0.0, -5.0 * GRAVITY], "g");
    // Links without an extent are no proof by their pseudo-inertia; the mass matrix is constant.
    assert!(
        matches!(robot.check_physical(), Ok(Physicality::Searched { pivot, .. }) if pivot == 5.0)
    );
    let base = BaseParameters::of_robot(&robot, &Parameter::of_joints(3, &ParameterKind::INERTIAL));
    assert_eq!(base.names(), ["m1", "m2", "m3"]);
}

#[test]
fn limits_and_kinds_are_checked() {
    let error = |from: &str, to: &str| {
        assert!(CART_POLE.contains(from));
        Robot::from_toml(&CART_POLE.replace(from, to), "robot.toml").unwrap_err().to_string()
    };
    let missing = error("position_limits = [-1.0, 2.0]\n", "");
    assert!(missing.starts_with("robot.toml:6: joint `cart`: the joint is prismatic"), "{missing}");
    assert!(missing.contains("give the lowest and the highest position in m"), "{missing}");
    let order = error("[-1.0, 2.0]", "[2.0, -1.0]");
    assert!(order.contains("position_limits [2, -1] m: the lower limit"), "{order}");
    let speed = error("armature = 0.3", "armature = 0.3\nvelocity_limit = 0.0");
    assert!(speed.contains("velocity_limit = 0 m/s is not positive"), "{speed}");
    let kind = error("\"prismatic\"", "\"linear\"");
    assert!(kind.contains("expected `revolute` or `prismatic`"), "{kind}");
    let weightless = error("mass = 2.0\narmature = 0.3", "armature = -0.3");
    assert!(weightless.contains("armature = -0.3 is negative"), "{weightless}");
    let copy = robot(CART_POLE).description().to_toml();
    assert_eq!(robot(&copy), robot(CART_POLE));
}

#[test]
fn an_unphysical_slide_is_named_with_its_units() {
    let text = CART_POLE.replace("name = \"cart-pole\"", "name = \"c\"\nparameters = \"base\"");
    let text = text.replace("mass = 2.0\narmature = 0.3", "mass = -2.0");
    let error = robot(&text).check_physical().unwrap_err().to_string();
    assert!(error.contains("joint `cart` has the articulated inertia"), "{error}");
    assert!(error.contains(" kg at q = [") && error.contains("] (m, rad), but"), "{error}");
}
