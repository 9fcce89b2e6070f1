//! Dynamics over Taylor polynomials: M, c and g as exact polynomials, and series expansions against
//! 40-digit arithmetic.

use std::sync::Arc;

use proptest::prelude::*;
use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::{Interval, Scalar, SineCosine, TaylorPolynomial, TaylorSpace};
use serde_json::Value;

use crate::close::assert_close;
use crate::shared::{description, numbers, oracle, oracle_robot};

/// Returns c_i = q̇ᵀ C_i q̇ at (sin, cos) = `at`.
fn christoffel_torque(matrices: &[Vec<TaylorPolynomial>], at: &[f64], qd: &[f64]) -> Vec<f64> {
    let n = qd.len();
    let entry = |c: &TaylorPolynomial, jk: usize| c.evaluate(at) * qd[jk / n] * qd[jk % n];
    matrices.iter().map(|m| m.iter().enumerate().map(|(jk, c)| entry(c, jk)).sum()).collect()
}

fn polynomials_agree_with_numbers(robot: &Robot, q: &[f64], qd: &[f64]) {
    let dynamics = robot.polynomial_dynamics::<f64>().unwrap();
    let (sin, cos) = robot.sin_cos(q);
    let at = [sin, cos].concat();
    let value = |f: &TaylorPolynomial| f.evaluate(&at);
    let mass: Vec<f64> = dynamics.mass_matrix.iter().map(value).collect();
    assert_close(&mass, robot.mass_matrix(q).as_slice(), "M");
    let gravity: Vec<f64> = dynamics.gravity.iter().map(value).collect();
    assert_close(&gravity, robot.gravity_torque(q).as_slice(), "g");
    let coriolis = christoffel_torque(&dynamics.christoffel(), &at, qd);
    assert_close(&coriolis, robot.motion_torque(q, qd, &vec![0.0; q.len()]).as_slice(), "c");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]
    #[test]
    fn polynomials_of_the_lwa4p_agree_with_numbers(
        q in prop::collection::vec(-3.1..3.1f64, 6),
        qd in prop::collection::vec(-2.0..2.0f64, 6),
    ) {
        polynomials_agree_with_numbers(&Robot::lwa4p(), &q, &qd);
    }
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn polynomials_of_the_ur5_agree_with_numbers() {
    let robot = oracle_robot("ur5");
    polynomials_agree_with_numbers(
        &robot,
        &[0.3, -1.2, 0.7, 2.0, -0.4, 1.1],
        &[1.0, -0.5, 0.3, 2.0, -1.0, 0.7],
    );
}

/// M and C have two factors of each angle after the first, so their degree is 10; with q̇ it is the
/// paper's p_max = 12.
#[test]
fn degrees_and_terms_of_the_lwa4p() {
    let dynamics = Robot::lwa4p().polynomial_dynamics::<f64>().unwrap();
    let degree = |list: &[TaylorPolynomial]| list.iter().map(TaylorPolynomial::degree).max();
    let christoffel = dynamics.christoffel();
    assert_eq!(degree(&dynamics.mass_matrix), Some(10));
    assert_eq!(christoffel.iter().filter_map(|m| degree(m)).max(), Some(10));
    assert!(
        dynamics.mass_matrix.iter().all(|m| !m.depends_on(0) && !m.depends_on(6)),
        "M does not depend on q1"
    );
    // Right angles keep their zeros, so rounding leaves no small terms.
    let terms = |list: &[TaylorPolynomial]| -> usize {
        list.iter().map(TaylorPolynomial::term_count).sum()
    };
    let smallest = dynamics
        .mass_matrix
        .iter()
        .flat_map(TaylorPolynomial::terms)
        .map(|t| t.coefficient.abs())
        .fold(1.0, f64::min);
    assert_eq!(terms(&dynamics.mass_matrix), 533);
    assert!(smallest > 1e-6, "{smallest}");
}

#[test]
fn coefficients_over_intervals_enclose_those_over_numbers() {
    let robot = Robot::lwa4p();
    let (numbers, boxes) = (
        robot.polynomial_dynamics::<f64>().unwrap(),
        robot.polynomial_dynamics::<Interval>().unwrap(),
    );
    for (number, interval) in numbers.mass_matrix.iter().zip(&boxes.mass_matrix) {
        for term in number.terms() {
            let enclosure = interval.coefficient(&term.exponents);
            assert!(enclosure.contains(term.coefficient) && enclosure.width() < 1e-14);
        }
    }
}

/// The arguments of the dynamics as polynomials.
struct Motion {
    q: Vec<TaylorPolynomial>,
    qd: Vec<TaylorPolynomial>,
    tau: Vec<TaylorPolynomial>,
}

impl Motion {
    fn sin_cos(&self) -> (Vec<TaylorPolynomial>, Vec<TaylorPolynomial>) {
        self.q.iter().map(SineCosine::sin_cos).unzip()
    }

    /// Returns q̈ by one of the two algorithms.
    fn acceleration(&self, robot: &Robot, by_articulated_bodies: bool) -> Vec<TaylorPolynomial> {
        let (sin, cos) = self.sin_cos();
        let mut ws = Workspace::new(robot);
        let mut out = vec![TaylorPolynomial::from(0.0); robot.joint_count()];
        if by_articulated_bodies {
            robot.aba(&sin, &cos, &self.qd, &self.tau, &mut ws, &mut out);
        } else {
            robot.forward_dynamics(&sin, &cos, &self.qd, &self.tau, &mut ws, &mut out);
        }
        out
    }

    fn bias(&self, robot: &Robot) -> Vec<TaylorPolynomial> {
        let (sin, cos) = self.sin_cos();
        let zeros =
            || -> Vec<TaylorPolynomial> { vec![TaylorPolynomial::from(0.0); robot.joint_count()] };
        let (mut ws, mut coriolis, mut gravity) = (Workspace::new(robot), zeros(), zeros());
        robot.coriolis(&sin, &cos, &self.qd, &mut ws, &mut coriolis);
        robot.gravity(&sin, &cos, &mut ws, &mut gravity);
        coriolis.into_iter().zip(gravity).map(|(c, g)| c + g).collect()
    }
}

/// Returns (q, q̇, tau) = start + t · direction in one variable t.
fn along(space: &Arc<TaylorSpace>, case: &Value) -> Motion {
    let line = |start: &str, direction: &str| {
        let pairs = numbers(&case[start]).into_iter().zip(numbers(&case[direction]));
        pairs
            .map(|(a, d)| {
                TaylorPolynomial::variable(space, 0).scaled(&d) + TaylorPolynomial::constant(a)
            })
            .collect()
    };
    Motion { q: line("q0", "dq"), qd: line("qd0", "dqd"), tau: line("tau0", "dtau") }
}

/// Returns (q, q̇, tau) with every entry as a variable.
fn about(space: &Arc<TaylorSpace>, case: &Value) -> Motion {
    let n = space.variables() / 3;
    let group = |start: &str, first: usize| {
        let values = numbers(&case[start]).into_iter().enumerate();
        values.map(|(i, a)| TaylorPolynomial::variable_at(space, first + i, a)).collect()
    };
    Motion { q: group("q0", 0), qd: group("qd0", n), tau: group("tau0", 2 * n) }
}

/// Asserts that the coefficients of t^0 to t^order agree with the oracle within 1e-9 of the largest
/// coefficient of each joint.
fn assert_coefficients(found: &[TaylorPolynomial], case: &Value, key: &str, order: usize) {
    for (joint, expected) in found.iter().zip(case[key].as_array().unwrap()) {
        let expected = numbers(expected);
        let scale = expected.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        for (power, e) in expected.iter().enumerate().take(order + 1) {
            let f = joint.coefficient(&[power as u8]);
            assert!((f - e).abs() <= 1e-9 * scale, "{key}: t^{power}: {f} is not {e}");
        }
    }
}

/// The coefficients along a line do not depend on the algorithm.
#[test]
#[ignore = "needs the recordings in ../shared"]
fn series_along_a_line_agree_with_40_digit_arithmetic() {
    let space = TaylorSpace::new(1, 6).unwrap();
    for name in ["ur5", "dh6"] {
        let oracle = oracle(&format!("oracle/{name}.json"));
        let robot = Robot::from_description(&description(&oracle)).unwrap();
        for case in oracle["directional_taylor"].as_array().unwrap() {
            let motion = along(&space, case);
            assert_coefficients(&motion.acceleration(&robot, true), case, "qdd_coeffs", 6);
            assert_coefficients(&motion.acceleration(&robot, false), case, "qdd_coeffs", 6);
            assert_coefficients(&motion.bias(&robot), case, "nle_coeffs", 6);
        }
    }
}

/// The series in all 18 variables is composed with the line.
#[test]
#[ignore = "needs the recordings in ../shared"]
fn series_in_all_variables_agree_with_40_digit_arithmetic() {
    for (name, order) in [("ur5", 4), ("dh6", 5)] {
        let oracle = oracle(&format!("oracle/{name}.json"));
        let robot = Robot::from_description(&description(&oracle)).unwrap();
        let case = &oracle["directional_taylor"][0];
        let (space, line) =
            (TaylorSpace::new(18, order).unwrap(), TaylorSpace::new(1, order).unwrap());
        let all = about(&space, case).acceleration(&robot, order == 4);
        let direction: Vec<TaylorPolynomial> = ["dq", "dqd", "dtau"]
            .iter()
            .flat_map(|key| numbers(&case[*key]))
            .map(|d| TaylorPolynomial::variable(&line, 0).scaled(&d))
            .collect();
        let composed: Vec<TaylorPolynomial> = all.iter().map(|f| f.evaluate(&direction)).collect();
        assert_coefficients(&composed, case, "qdd_coeffs", order as usize);
    }
}

/// The polynomials of rnea and crba differ for independent s and c. They agree on the circle, where
/// s and c are series of one angle.
#[test]
fn the_extensions_off_the_circle_agree_on_it() {
    let robot = Robot::lwa4p();
    let n = robot.joint_count();
    let space = TaylorSpace::new(4 * n, 20).unwrap();
    let variables = |first: usize| -> Vec<TaylorPolynomial> {
        (0..n).map(|i| TaylorPolynomial::variable(&space, first + i)).collect()
    };
    let (sin, cos, qd) = (variables(0), variables(n), variables(2 * n));
    let mut newton_euler = vec![TaylorPolynomial::<f64>::from(0.0); n];
    robot.coriolis(&sin, &cos, &qd, &mut Workspace::new(&robot), &mut newton_euler);
    assert_eq!(newton_euler.iter().map(TaylorPolynomial::degree).max(), Some(13));
    let angles = TaylorSpace::new(n, 3).unwrap();
    let (s, c): (Vec<_>, Vec<_>) =
        (0..n).map(|i| TaylorPolynomial::variable_at(&angles, i, 0.3 + i as f64).sin_cos()).unzip();
    let qd = [0.5, -1.0, 0.7, 0.2, -0.3, 0.9];
    let constants: Vec<TaylorPolynomial> =
        qd.iter().map(|v| TaylorPolynomial::constant(*v)).collect();
    let arguments =
        [s.clone(), c.clone(), constants, vec![TaylorPolynomial::from(0.0); n]].concat();
    let christoffel = robot.polynomial_dynamics::<f64>().unwrap().christoffel();
    for (left, matrix) in newton_euler.iter().zip(&christoffel) {
        let left = left.evaluate(&arguments);
        let mut right = TaylorPolynomial::from(0.0);
        for (jk, entry) in matrix.iter().enumerate() {
            right +=
                entry.evaluate(&[s.clone(), c.clone()].concat()).scaled(&(qd[jk / n] * qd[jk % n]));
        }
        let difference = &left - &right;
        let same = difference.terms().iter().all(|t| t.coefficient.abs() < 1e-13);
        assert!(same, "{difference:?}");
    }
}

/// The dynamics over any scalar uses only ring operations and division.
#[test]
fn interval_series_enclose_the_series_of_numbers() {
    fn series<C: Scalar + SineCosine>(robot: &Robot) -> Vec<TaylorPolynomial<C>> {
        let space = TaylorSpace::new(2, 3).unwrap();
        let n = robot.joint_count();
        let q: Vec<TaylorPolynomial<C>> = (0..n)
            .map(|i| TaylorPolynomial::variable_at(&space, i % 2, C::from(0.25 * i as f64)))
            .collect();
        let (sin, cos): (Vec<_>, Vec<_>) = q.iter().map(SineCosine::sin_cos).unzip();
        let mut out = vec![TaylorPolynomial::from(0.0); n];
        robot.aba(&sin, &cos, &q, &q, &mut Workspace::new(robot), &mut out);
        out
    }
    let robot = Robot::lwa4p();
    for (number, interval) in series::<f64>(&robot).iter().zip(&series::<Interval>(&robot)) {
        for term in number.terms() {
            let enclosure = interval.coefficient(&term.exponents);
            let tolerance = 1e-12 * (1.0 + term.coefficient.abs());
            assert!(
                Interval::centred(enclosure.mid(), enclosure.rad() + tolerance)
                    .contains(term.coefficient)
            );
            assert!(enclosure.rad() < 1e-9 * (1.0 + term.coefficient.abs()));
        }
    }
}
