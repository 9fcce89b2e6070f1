//! Identities of rigid-body dynamics on random robots and states.

use crate::random::robots_and_states;
use crate::simulation::simulate;
use proptest::prelude::*;
use reachtube_robot::{Physicality, Robot, Workspace, ltdl};
use reachtube_scalar::Interval;

pub(crate) fn close(found: &[f64], expected: &[f64]) -> Result<(), TestCaseError> {
    prop_assert_eq!(found.len(), expected.len());
    let tolerance = 1e-9 * expected.iter().fold(1e-3, |a: f64, b| a.max(b.abs()));
    let same = found.iter().zip(expected).all(|(f, e)| (f - e).abs() <= tolerance);
    prop_assert!(same, "{found:?} is not {expected:?}");
    Ok(())
}

proptest! {
    #[test]
    fn forward_dynamics_inverts_rnea((robot, q, qd, qdd) in robots_and_states()) {
        let tau = robot.inverse_dynamics(&q, &qd, &qdd);
        let (sin, cos) = robot.sin_cos(&q);
        let mut back = vec![0.0; q.len()];
        robot.aba(&sin, &cos, &qd, tau.as_slice(), &mut Workspace::new(&robot), &mut back);
        close(&back, &qdd)?;
        close(robot.forward_acceleration(&q, &qd, tau.as_slice()).as_slice(), &qdd)?;
    }

    #[test]
    fn crba_has_the_columns_of_rnea((robot, q, _, _) in robots_and_states()) {
        let (n, m) = (q.len(), robot.mass_matrix(&q));
        let g = robot.gravity_torque(&q);
        for j in 0..n {
            let unit: Vec<_> = (0..n).map(|i| f64::from(i == j)).collect();
            let column = robot.inverse_dynamics(&q, &vec![0.0; n], &unit) - &g;
            close(column.as_slice(), m.column(j).as_slice())?;
        }
    }

    #[test]
    fn rnea_is_the_sum_of_its_parts((robot, q, qd, qdd) in robots_and_states()) {
        let acceleration = nalgebra::DVector::from_column_slice(&qdd);
        let coriolis = robot.motion_torque(&q, &qd, &vec![0.0; q.len()]);
        let moving = robot.mass_matrix(&q) * acceleration + coriolis;
        close(robot.motion_torque(&q, &qd, &qdd).as_slice(), moving.as_slice())?;
        let sum = moving + robot.gravity_torque(&q);
        close(robot.inverse_dynamics(&q, &qd, &qdd).as_slice(), sum.as_slice())?;
    }

    #[test]
    fn gravity_is_the_gradient_of_potential_energy((robot, q, _, _) in robots_and_states()) {
        let g = robot.gravity_torque(&q);
        let energy = |i: usize, h: f64| {
            let mut at = q.clone();
            at[i] += h;
            robot.potential_energy(&at)
        };
        // The fourth-order central difference has an error of about h⁴.
        let h = 1e-3;
        let gradient = |i| {
            let near = 8.0 * (energy(i, h) - energy(i, -h));
            (near - energy(i, 2.0 * h) + energy(i, -2.0 * h)) / (12.0 * h)
        };
        for i in 0..q.len() {
            prop_assert!((g[i] - gradient(i)).abs() < 1e-8 * (1.0 + g.amax()));
        }
    }

    /// q̇ᵀ c = ½ q̇ᵀ Ṁ q̇: the power of the Coriolis torque is the change of kinetic energy through
    /// M.
    #[test]
    fn power_is_balanced((robot, q, qd, _) in robots_and_states()) {
        let energy = |t: f64| {
            let at: Vec<_> = q.iter().zip(&qd).map(|(q, v)| q + t * v).collect();
            robot.kinetic_energy(&at, &qd)
        };
        let h = 1e-3;
        let near = 8.0 * (energy(h) - energy(-h));
        let rate = (near - energy(2.0 * h) + energy(-2.0 * h)) / (12.0 * h);
        let coriolis = robot.motion_torque(&q, &qd, &vec![0.0; q.len()]);
        let power: f64 = coriolis.iter().zip(&qd).map(|(c, v)| c * v).sum();
        prop_assert!((power - rate).abs() < 1e-7 * (1.0 + energy(0.0)));
    }

    #[test]
    fn pivots_are_articulated_inertias((robot, q, _, tau) in robots_and_states()) {
        // Pivot n is M_nn, and the product of the pivots is det M.
        let mut m = robot.mass_matrix(&q);
        let (n, det) = (q.len(), m.determinant());
        let b = &m * nalgebra::DVector::from_column_slice(&tau);
        let last = m[(n - 1, n - 1)];
        ltdl::factor(m.as_mut_slice(), n);
        // `ltdl` stores row by row, so its lower triangle is the upper one of nalgebra.
        let pivots: Vec<_> = (0..n).map(|i| m[(i, i)]).collect();
        close(&[pivots.iter().product::<f64>(), pivots[n - 1]], &[det, last])?;
        let mut x = b.as_slice().to_vec();
        ltdl::solve(m.as_slice(), &mut x);
        close(&x, &tau)?;
        let Ok(Physicality::Links { least_pivot }) = robot.check_physical() else {
            return Err(TestCaseError::fail("links that are bodies are physical"));
        };
        prop_assert!(pivots.iter().all(|p| *p >= least_pivot * (1.0 - 1e-12)));
    }

    #[test]
    fn intervals_enclose(
        (robot, q, qd, qdd) in robots_and_states(),
        radius in 0.0..0.01f64,
        pick in -1.0..1.0f64,
    ) {
        let n = q.len();
        let wide = |x: &[f64]| {
            x.iter().map(|x| Interval::centred(*x, radius)).collect::<Vec<_>>()
        };
        let (sin, cos) = robot.sin_cos(&q);
        // Sine and cosine are independent: s² + c² = 1 is not required.
        let inside = |x: &[f64]| x.iter().map(|x| x + 0.99 * pick * radius).collect::<Vec<_>>();
        let boxes = [&sin, &cos, &qd, &qdd].map(|x| wide(x));
        let points = [&sin, &cos, &qd, &qdd].map(|x| inside(x));
        let mut wide_ws = Workspace::<Interval>::new(&robot);
        let mut ws = Workspace::<f64>::new(&robot);
        // What is not computed stays NaN, which no interval contains.
        let (mut outer, mut value) = (vec![Interval::ENTIRE; n * n], vec![f64::NAN; n * n]);
        // Each f64 operation rounds to a value within the outward-rounded interval, so no tolerance
        // is needed.
        let encloses = |outer: &[Interval], value: &[f64]| {
            outer.iter().zip(value).all(|(o, v)| o.contains(*v))
        };
        let [sin_box, cos_box, qd_box, last_box] = &boxes;
        robot.rnea(sin_box, cos_box, qd_box, last_box, &mut wide_ws, &mut outer[..n]);
        robot.rnea(&points[0], &points[1], &points[2], &points[3], &mut ws, &mut value[..n]);
        prop_assert!(encloses(&outer[..n], &value[..n]));
        prop_assert!(outer[..n].iter().all(|o| o.width().is_finite()));
        robot.crba(&boxes[0], &boxes[1], &mut wide_ws, &mut outer);
        robot.crba(&points[0], &points[1], &mut ws, &mut value);
        prop_assert!(encloses(&outer, &value));
        prop_assert!(outer.iter().all(|o| o.width().is_finite()));
        outer.fill(Interval::ZERO);
        value.fill(f64::NAN);
        robot.aba(sin_box, cos_box, qd_box, last_box, &mut wide_ws, &mut outer[..n]);
        robot.aba(&points[0], &points[1], &points[2], &points[3], &mut ws, &mut value[..n]);
        prop_assert!(encloses(&outer[..n], &value[..n]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn a_free_motion_keeps_its_energy((robot, q, qd, _) in robots_and_states()) {
        let energy =
            |q: &[f64], qd: &[f64]| robot.kinetic_energy(q, qd) + robot.potential_energy(q);
        let free = vec![vec![0.0; q.len()]; 50];
        let motion = simulate(&robot, &[&q[..], &qd].concat(), &free, 0.002);
        let (end_q, end_qd) = motion[50].split_at(q.len());
        let (start, end) = (energy(&q, &qd), energy(end_q, end_qd));
        let kinetic = robot.kinetic_energy(end_q, end_qd) + robot.kinetic_energy(&q, &qd);
        let scale = kinetic + start.abs();
        prop_assert!((end - start).abs() < 1e-6 * (1.0 + scale), "{start} J became {end} J");
    }
}

#[test]
fn friction_dissipates_energy() {
    let robot =
        Robot::load(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/double_pendulum.toml")).unwrap();
    let motion = simulate(&robot, &[2.0, -1.0, 0.0, 0.0], &vec![vec![0.0; 2]; 10000], 0.002);
    let energies: Vec<_> = motion
        .iter()
        .map(|x| robot.kinetic_energy(&x[..2], &x[2..]) + robot.potential_energy(&x[..2]))
        .collect();
    assert!(energies.windows(2).all(|w| w[1] <= w[0] + 1e-6));
    // Gravity overcomes Coulomb friction at the start, and friction has stopped the motion at the
    // end.
    assert!(energies[0] - energies[10000] > 1.0);
    assert!(robot.kinetic_energy(&motion[10000][..2], &motion[10000][2..]) < 1e-6);
}

#[test]
fn the_double_pendulum_has_its_textbook_mass_matrix() {
    let robot =
        Robot::load(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/double_pendulum.toml")).unwrap();
    let (i1, i2, m2, l1, r2) =
        (0.031887199591513114, 0.05086984812807257, 0.6255677234174437, 0.2, 0.25569305436052964);
    let motor = 36.0 * 6.287203962819607e-5;
    for q2 in [0.0, 0.7, 2.0_f64] {
        let m = robot.mass_matrix(&[0.3, q2]);
        let coupling = m2 * l1 * r2 * q2.cos();
        let expected = [
            i1 + i2 + m2 * l1 * l1 + 2.0 * coupling + motor,
            i2 + coupling,
            i2 + coupling,
            i2 + motor,
        ];
        assert!(
            m.iter().zip(expected).all(|(m, e)| (m - e).abs() < 1e-15),
            "{m} is not {expected:?}"
        );
    }
}

proptest! {
    /// The load is gravity, for which Table III was identified. Under loads above 10 N m, the
    /// friction of joint 5 would not dissipate.
    #[test]
    fn coulomb_friction_dissipates(
        q in prop::collection::vec(-3.2..3.2f64, 6),
        qd in prop::collection::vec(-2.0..2.0f64, 6),
    ) {
        let robot = Robot::lwa4p();
        let torque = robot.coulomb_torque(&q, &qd);
        prop_assert!(torque.iter().zip(&qd).all(|(torque, qd)| *qd == 0.0 || torque * qd > 0.0));
        prop_assert_eq!(robot.coulomb_torque(&q, &[0.0; 6]).amax(), 0.0);
    }

    #[test]
    fn viscous_slope_is_the_derivative(qd in -2.0..2.0f64) {
        for viscous in Robot::lwa4p().joints().iter().map(|j| j.friction.viscous) {
            // For a cubic, the central difference is exact up to the term h² v3.
            let h = 1e-3;
            let difference = (viscous.torque(&(qd + h)) - viscous.torque(&(qd - h))) / (2.0 * h);
            let slope = difference - viscous.v3 * h * h;
            prop_assert!((slope - viscous.slope(&qd)).abs() < 1e-10);
        }
    }

    /// Model (10) with the input (11) equals (4) with (5).
    #[test]
    fn the_input_is_equivalent_to_the_motor_torque(
        q in prop::collection::vec(-3.0..3.0f64, 6),
        qd in prop::collection::vec(-1.2..1.2f64, 6),
        tau_motor in prop::collection::vec(-50.0..50.0f64, 6),
    ) {
        let robot = Robot::lwa4p();
        let friction = robot.coulomb_torque(&q, &qd) + robot.viscous_torque(&qd);
        let tau_link = nalgebra::DVector::from_column_slice(&tau_motor) - friction;
        let qdd = robot.forward_acceleration(&q, &qd, tau_link.as_slice());
        let u = robot.input_from_motor_torque(&q, &qd, &tau_motor);
        let from_link = robot.input_from_link_torque(&q, &qd, tau_link.as_slice());
        close(from_link.as_slice(), u.as_slice())?;
        let moved = robot.mass_matrix(&q) * qdd
            + robot.motion_torque(&q, &qd, &vec![0.0; q.len()])
            + robot.viscous_torque(&qd);
        close(moved.as_slice(), u.as_slice())?;
        let back = robot.motor_torque_from_input(&q, &qd, u.as_slice());
        close(back.as_slice(), &tau_motor)?;
    }
}
