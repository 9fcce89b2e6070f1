//! A polynomial model as the systems of `reachtube-reach`.

use nalgebra::{DMatrix, DVector};
use reachtube_reach::{LinearSystem, PolynomialSystem, ReachError};
use reachtube_robot::JointKind::Revolute;
use reachtube_scalar::{Interval, TaylorPolynomial, TaylorSpace};

use crate::error::{Error, Result};
use crate::polynomial_model::PolynomialModel;

impl PolynomialModel {
    /// Returns the model as ẋ = A x + B u + d with x = (q, q̇), where its accelerations are linear
    /// in (q̇, u). This holds for model 1 at order 1, for model 1 at order 2 without an even
    /// friction term, and for models 2 and 3 at order 1 about q̇_a = 0, u_a = 0.
    ///
    /// # Errors
    ///
    /// [`Error::NotLinear`] where an acceleration has another term.
    pub fn linear_system(&self) -> Result<LinearSystem> {
        let (n, layout) = (self.joints(), self.layout());
        let (mut a, mut b) = (DMatrix::zeros(2 * n, 2 * n), DMatrix::zeros(2 * n, n));
        let mut drift = DVector::zeros(2 * n);
        a.view_mut((0, n), (n, n)).fill_with_identity();
        for (i, f) in self.acceleration().iter().enumerate() {
            // Each term gives one entry of the matrices.
            for term in f.terms() {
                let factors: Vec<usize> =
                    (0..term.exponents.len()).filter(|z| term.exponents[*z] > 0).collect();
                match factors[..] {
                    [] => drift[n + i] += term.coefficient,
                    [z] if term.exponents[z] == 1 && z < n => a[(n + i, n + z)] = term.coefficient,
                    [z] if term.exponents[z] == 1 && z >= layout.input(0) => {
                        b[(n + i, z - layout.input(0))] = term.coefficient;
                    }
                    _ => return Err(self.not_linear(i, &factors)),
                }
            }
            // The polynomials are in offsets from the origin, the system is not.
            let offset: f64 = (0..n)
                .map(|j| {
                    a[(n + i, n + j)] * self.origin()[j]
                        + b[(n + i, j)] * self.origin()[layout.input(j)]
                })
                .sum();
            drift[n + i] -= offset;
        }
        Ok(LinearSystem::new(a, b, drift)?)
    }

    /// Returns the model as a system whose reachable sets [`Flowpipe`](reachtube_reach::Flowpipe)
    /// encloses. Its states are (q, q̇), 2n, for every model; the accelerations of models 2 and 3
    /// are polynomials in sines and cosines of q too, and in q of prismatic joints. It has n
    /// inputs.
    ///
    /// # Guarantee
    ///
    /// Outer: where polynomials in offsets are rewritten in the variables themselves, each
    /// coefficient encloses the exact one.
    pub(crate) fn flowpipe_system(&self) -> Result<PolynomialSystem, ReachError> {
        let (n, layout) = (self.joints(), self.layout());
        // The system's variables are q, q̇, u and then the sines and cosines of the angles, which
        // are the positions of revolute joints.
        let is_angle = |i: &usize| layout.trigonometric && self.joint_kinds()[*i] == Revolute;
        let angles: Vec<usize> = (0..n).filter(is_angle).collect();
        let angle = |i: usize, group: usize| match angles.binary_search(&i) {
            Ok(rank) => 3 * n + group * angles.len() + rank,
            Err(_) => i,
        };
        let index = |z: usize| match z {
            z if z < n => n + z,
            z if z >= layout.input(0) => 2 * n + z - layout.input(0),
            z if z < 2 * n => angle(z - n, 0),
            z => angle(z - 2 * n, 1),
        };
        let indices: Vec<usize> = (0..layout.variables()).map(index).collect();
        let space = TaylorSpace::new(3 * n + 2 * angles.len(), self.degree().max(1))?;
        let offset: Vec<Interval> =
            self.origin().iter().map(|origin| Interval::point(-origin)).collect();
        let about_zero =
            |f: &TaylorPolynomial| f.map_coefficients(|c| Interval::point(*c)).shifted(&offset);
        let velocities = (0..n).map(|i| TaylorPolynomial::variable(&space, n + i));
        let accelerations =
            self.acceleration().iter().map(|f| about_zero(f).embedded(&space, &indices));
        let components: Vec<_> = velocities.chain(accelerations).collect();
        PolynomialSystem::trigonometric(2 * n, n, &angles, &components)
    }

    /// Returns the error for a term of `joint` (from 0) with these variables.
    fn not_linear(&self, joint: usize, factors: &[usize]) -> Error {
        let names = self.variable_names();
        Error::NotLinear {
            model: self.kind().into(),
            order: self.order(),
            joint: joint + 1,
            factors: factors.iter().map(|z| names[*z].clone()).collect(),
        }
    }
}
