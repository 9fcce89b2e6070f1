//! Polynomial systems for tests: an arm, and problems of the ARCH competition.

use reachtube_reach::{LinearSystem, PolynomialSystem};
use reachtube_scalar::{Interval, TaylorPolynomial, TaylorSpace};

use crate::arm::arm;

pub(crate) type Polynomial = TaylorPolynomial<Interval>;

pub(crate) fn constant(x: f64) -> Polynomial {
    Polynomial::constant(Interval::point(x))
}

/// Returns the variables of a space of the given order.
pub(crate) fn variables(count: usize, order: u32) -> Vec<Polynomial> {
    let space = TaylorSpace::new(count, order).unwrap();
    (0..count).map(|i| Polynomial::variable(&space, i)).collect()
}

/// Returns A x + B u + d as polynomials.
pub(crate) fn linear(system: &LinearSystem) -> Vec<Polynomial> {
    let z = variables(system.states() + system.inputs(), 3);
    let row = |i: usize| {
        let coefficients =
            system.a().row(i).iter().chain(&system.b().row(i)).copied().collect::<Vec<_>>();
        let terms = z.iter().zip(coefficients).map(|(z, c)| z * &constant(c));
        terms.fold(constant(system.drift()[i]), |sum, term| sum + term)
    };
    (0..system.states()).map(row).collect()
}

/// Returns the arm with a cubic friction torque besides the viscous one.
///
/// A positive `softening` weakens friction at speed, like the cubic term of the paper.
pub(crate) fn cubic_arm(softening: f64) -> PolynomialSystem {
    PolynomialSystem::new(12, 6, &cubic_arm_components(softening)).unwrap()
}

/// Returns ẋ of [`cubic_arm`].
pub(crate) fn cubic_arm_components(softening: f64) -> Vec<Polynomial> {
    let system = arm();
    let mut f = linear(&system);
    let z = variables(18, 3);
    for (i, f) in f.iter_mut().enumerate().skip(6) {
        for j in 0..6 {
            let cube = &(&z[6 + j] * &z[6 + j]) * &z[6 + j];
            *f += &(&constant(system.b()[(i, j)]) * &constant(softening * FRICTION[j])) * &cube;
        }
    }
    f
}

/// Relative size of the cubic term for each joint.
const FRICTION: [f64; 6] = [0.8, 1.0, 1.5, 0.1, 0.2, 0.1];

/// Returns the Van der Pol oscillator ẋ = y, ẏ = (1 - x²) y - x.
pub(crate) fn van_der_pol() -> PolynomialSystem {
    PolynomialSystem::new(2, 0, &van_der_pol_components()).unwrap()
}

/// Returns ẋ of [`van_der_pol`].
pub(crate) fn van_der_pol_components() -> Vec<Polynomial> {
    let z = variables(2, 3);
    let (x, y) = (&z[0], &z[1]);
    vec![y.clone(), y - &(&(x * x) * y) - x.clone()]
}

/// Returns the enzymatic network of Laub and Loomis, 7 states.
pub(crate) fn laub_loomis() -> PolynomialSystem {
    PolynomialSystem::new(7, 0, &laub_loomis_components()).unwrap()
}

/// Returns ẋ of [`laub_loomis`].
pub(crate) fn laub_loomis_components() -> Vec<Polynomial> {
    let z = variables(7, 2);
    let x = |i: usize| &z[i - 1];
    let times = |c: f64, p: &Polynomial| &constant(c) * p;
    vec![
        times(1.4, x(3)) - times(0.9, x(1)),
        times(2.5, x(5)) - times(1.5, x(2)),
        times(0.6, x(7)) - times(0.8, &(x(2) * x(3))),
        constant(2.0) - times(1.3, &(x(3) * x(4))),
        times(0.7, x(1)) - x(4) * x(5),
        times(0.3, x(1)) - times(3.1, x(6)),
        times(1.8, x(6)) - times(1.5, &(x(2) * x(7))),
    ]
}

/// Returns two coupled Van der Pol oscillators, ẍ = (1 - x²) ẋ - x ± b (x₂ - x₁), with the constant
/// coupling b as the last of 5 states (ARCH-COMP, "CVDP23").
pub(crate) fn coupled_van_der_pol() -> PolynomialSystem {
    PolynomialSystem::new(5, 0, &coupled_van_der_pol_components()).unwrap()
}

/// Returns ẋ of [`coupled_van_der_pol`].
pub(crate) fn coupled_van_der_pol_components() -> Vec<Polynomial> {
    let z = variables(5, 3);
    let rate = |x: &Polynomial, y: &Polynomial, other: &Polynomial| {
        y - &(&(x * x) * y) - x.clone() + &z[4] * &(other - x)
    };
    vec![
        z[1].clone(),
        rate(&z[0], &z[1], &z[2]),
        z[3].clone(),
        rate(&z[2], &z[3], &z[0]),
        constant(0.0),
    ]
}

/// Returns the production-destruction system ẋ = -r, ẏ = r - 0.3 y, ż = 0.3 y with
/// r = x y / (1 + x) (ARCH-COMP, "PRDE"); w = 1 / (1 + x) is a fourth state, so that r = (1 - w) y.
pub(crate) fn production_destruction() -> PolynomialSystem {
    PolynomialSystem::new(4, 0, &production_destruction_components()).unwrap()
}

/// Returns ẋ of [`production_destruction`].
pub(crate) fn production_destruction_components() -> Vec<Polynomial> {
    let z = variables(4, 4);
    let (y, w) = (&z[1], &z[3]);
    let rate = y - &(w * y);
    let decay = &constant(0.3) * y;
    vec![-rate.clone(), &rate - &decay, decay, &(w * w) * &rate]
}
