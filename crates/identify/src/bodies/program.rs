use crate::bodies::newton::NewtonStep;
use crate::bodies::pseudo_inertia::{PER_LINK, link_parameters, parameter_basis, pseudo_inertia};
use crate::bodies::rising::RisingFriction;
use crate::regression::triangular_factor::TriangularFactor;
use nalgebra::{Cholesky, DMatrix, DVector, Matrix4};

/// Weight of the prior of a positive column relative to a link's, so that it decides where the data
/// do not, and hardly moves what they determine.
const POSITIVE_STRENGTH: f64 = 0.01;

/// Ratio of consecutive barrier weights.
const SHRINK: f64 = 0.1;

/// Last barrier weight, relative to the weight of the prior where that is below 1.
///
/// A larger one would outweigh the prior, and inflate links that the data leave open by the ratio
/// of the two. The objective then is within this weight times the number of inequalities of its
/// minimum. There are four inequalities per link, one per positive column, and three per friction
/// that must rise.
const LAST_BARRIER: f64 = 1e-3;

/// Limit of the Newton steps for one barrier weight; a dozen are typical.
const MAX_STEPS: usize = 200;

/// Squared decrement that is accepted at the last barrier weight, well below the duality gap.
///
/// Rounding may prevent a smaller one.
const ACCEPTED: f64 = 1e-3;

/// Half the squared Newton decrement at which the minimum for a barrier weight is reached.
const CONVERGED: f64 = 1e-8;

/// The semidefinite program whose solution is the physically consistent links nearest to the data.
///
/// It minimises ½ ‖R x - z‖² + s Σ_i [tr(P0_i⁻¹ P_i(x)) - log det P_i(x)] + s' Σ_k [x_k / p_k -
/// log x_k] over all x for which each P_i(x) is positive definite and each listed parameter x_k is
/// positive, where s' is a hundredth of s. Viscous friction that must rise up to a speed has a
/// matrix of its own that must be positive definite, with the same divergence of weight s'.
///
/// P_i is the pseudo-inertia [[Σ, h], [hᵀ, m]] of link i and linear in x. It is positive definite
/// if and only if some distribution of positive mass has the link's ten parameters (Wensing, Kim
/// and Slotine, RA-L 2018). The second term is the divergence of Lee and Park (RA-L 2018) from a
/// prior P0. It is convex, does not depend on the frame, and decides the directions that the data
/// do not determine. The third term is the same divergence from a prior p. Without it, a parameter
/// that the data do not bound, such as the dry friction of a joint that moves one way only, would
/// grow without limit.
///
/// A barrier method solves the program. The cone solver of this workspace supports semidefinite
/// constraints only with BLAS and LAPACK, which would need a Fortran or C build on every user's
/// machine. Here the divergence is the barrier itself, so that Newton's method on about a hundred
/// unknowns suffices.
#[derive(Debug, Clone)]
pub struct BodyProgram<'a> {
    /// The data, with rows in units of their standard deviation.
    ///
    /// The first 10 n columns are the parameters of the n links.
    pub data: &'a TriangularFactor,
    /// Pseudo-inertias P0 of the prior, positive definite, one per link.
    pub prior: &'a [Matrix4<f64>],
    /// Weight s of the prior, above 0; a weight of 1 counts about as much as one independent
    /// sample.
    pub strength: f64,
    /// Columns whose parameters must be positive, such as motor inertias.
    pub positive: &'a [PositiveColumn],
    /// Viscous friction that must rise with speed.
    pub rising: &'a [RisingFriction],
}

/// A column of [`BodyProgram`] whose parameter must be positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositiveColumn {
    /// Index of the column.
    pub index: usize,
    /// Prior p of the parameter, above 0. It decides where the data do not bound the parameter.
    pub prior: f64,
}

/// A solution of [`BodyProgram`].
#[derive(Debug, Clone)]
pub struct BodySolution {
    /// The parameters.
    pub x: DVector<f64>,
    /// Duality gap: the objective exceeds its minimum by at most this value.
    pub gap: f64,
    /// Number of Newton steps taken.
    pub steps: usize,
}

impl BodyProgram<'_> {
    /// Solves the program, starting from the prior.
    ///
    /// The result is `None` if the data or the prior are not finite, the prior is not positive
    /// definite, or Newton's method does not converge.
    #[must_use]
    pub fn solve(&self) -> Option<BodySolution> {
        let basis = parameter_basis();
        let inverse: Vec<_> = self.prior.iter().map(|p| p.try_inverse()).collect::<Option<_>>()?;
        let mut x = self.start();
        let (p, all) = (self.data.r.ncols(), x.len());
        // After the parameters, the unknowns are one λ for each friction that must rise.
        let normal = (self.data.r.transpose() * &self.data.r).resize(all, all, 0.0);
        let inequalities = 4 * self.prior.len() + self.positive.len() + 3 * self.rising.len();
        // The first barrier weighs as much as the misfit at the start: its minimum is near.
        let misfit = self.data.sum_of_squares(&x.rows(0, p).into_owned());
        let mut barrier = (misfit / inequalities as f64).max(1.0);
        let weak = self.strength.min(1.0);
        let last = LAST_BARRIER * weak;
        let mut steps = 0;
        loop {
            barrier = (SHRINK * barrier).max(last);
            // Newton's method for this barrier weight.
            let mut squared_decrement = f64::INFINITY;
            for _ in 0..MAX_STEPS {
                let step = self.newton_step(&x, barrier, &normal, &inverse, &basis)?;
                (steps, squared_decrement) = (steps + 1, step.squared_decrement);
                let next = self.advance(&x, &step, barrier, &inverse)?;
                let stuck = next == x;
                x = next;
                if 0.5 * squared_decrement < CONVERGED * weak || stuck {
                    break;
                }
            }
            if barrier <= last {
                let x = x.rows(0, p).into_owned();
                let solution = BodySolution { x, gap: barrier * inequalities as f64, steps };
                return (squared_decrement < ACCEPTED).then_some(solution);
            }
        }
    }

    /// Returns the start: the prior, 0 for columns that have none, and friction that rises.
    pub(crate) fn start(&self) -> DVector<f64> {
        let p = self.data.r.ncols();
        let mut x = DVector::zeros(p + self.rising.len());
        for (i, p) in self.prior.iter().enumerate() {
            x.rows_mut(PER_LINK * i, PER_LINK).copy_from_slice(&link_parameters(p));
        }
        self.positive.iter().for_each(|column| x[column.index] = column.prior);
        self.rising.iter().enumerate().for_each(|(k, friction)| friction.start(&mut x, p + k));
        x
    }

    /// Returns the weights of a divergence of positive columns and of its barrier.
    fn weak(&self, barrier: f64) -> [f64; 2] {
        [POSITIVE_STRENGTH * self.strength, barrier]
    }

    /// Returns the objective with its barrier, infinite outside the feasible set.
    fn value(&self, x: &DVector<f64>, barrier: f64, inverse: &[Matrix4<f64>]) -> f64 {
        let p = self.data.r.ncols();
        let mut value = 0.5 * (&self.data.r * x.rows(0, p) - &self.data.z).norm_squared();
        let rising = self.rising.iter().enumerate();
        let rising = rising.map(|(k, of)| of.value(x.as_slice(), p + k, self.weak(barrier)));
        value += rising.sum::<f64>();
        for (i, prior) in inverse.iter().enumerate() {
            let p = pseudo_inertia(&x.as_slice()[PER_LINK * i..]);
            let Some(factor) = Cholesky::new(p) else { return f64::INFINITY };
            let log_det = 2.0 * factor.l_dirty().diagonal().map(f64::ln).sum();
            value += self.strength * (prior * p).trace() - (self.strength + barrier) * log_det;
        }
        let [strength, _] = self.weak(barrier);
        let divergence = |column: &PositiveColumn| match x[column.index] {
            own if own > 0.0 => strength * own / column.prior - (strength + barrier) * own.ln(),
            _ => f64::INFINITY,
        };
        value + self.positive.iter().map(divergence).sum::<f64>()
    }

    /// Returns the Newton step of the objective with its barrier; `normal` is RᵀR.
    fn newton_step(
        &self,
        x: &DVector<f64>,
        barrier: f64,
        normal: &DMatrix<f64>,
        inverse: &[Matrix4<f64>],
        basis: &[Matrix4<f64>; PER_LINK],
    ) -> Option<NewtonStep> {
        // Misfit.
        let mut hessian = normal.clone();
        let p = self.data.r.ncols();
        let misfit = self.data.r.transpose() * (&self.data.r * x.rows(0, p) - &self.data.z);
        let mut gradient = misfit.resize_vertically(x.len(), 0.0);
        // Divergence and barrier of each link. With P = L Lᵀ and W_k = L⁻¹ E_k L⁻ᵀ, tr(P⁻¹ E_k) =
        // tr W_k and tr(P⁻¹ E_k P⁻¹ E_l) = ⟨W_k, W_l⟩, so that the Hessian is never indefinite.
        for (i, prior) in inverse.iter().enumerate() {
            let at = PER_LINK * i;
            let whiten = Cholesky::new(pseudo_inertia(&x.as_slice()[at..]))?.l().try_inverse()?;
            let whitened = basis.map(|e| whiten * e * whiten.transpose());
            for k in 0..PER_LINK {
                gradient[at + k] += self.strength * (prior * basis[k]).trace()
                    - (self.strength + barrier) * whitened[k].trace();
                for l in 0..PER_LINK {
                    hessian[(at + k, at + l)] +=
                        (self.strength + barrier) * whitened[k].dot(&whitened[l]);
                }
            }
        }
        // Divergence and barrier of the positive columns.
        let [strength, _] = self.weak(barrier);
        for &PositiveColumn { index, prior } in self.positive {
            gradient[index] += strength / prior - (strength + barrier) / x[index];
            hessian[(index, index)] += (strength + barrier) / x[index].powi(2);
        }
        for (k, friction) in self.rising.iter().enumerate() {
            let sums = (&mut gradient, &mut hessian);
            friction.add_derivatives(x.as_slice(), p + k, self.weak(barrier), sums)?;
        }
        NewtonStep::new(&hessian, &gradient)
    }

    /// Returns the point after a backtracking line search, which halves the step until it is
    /// feasible and descends enough.
    ///
    /// The point itself is returned if rounding prevents any descent.
    fn advance(
        &self,
        x: &DVector<f64>,
        step: &NewtonStep,
        barrier: f64,
        inverse: &[Matrix4<f64>],
    ) -> Option<DVector<f64>> {
        let here = self.value(x, barrier, inverse);
        let lengths = std::iter::successors(Some(1.0), |length| Some(0.5 * length)).take(50);
        let reach = |length: f64| x + length * &step.direction;
        let enough = |length: &f64| {
            self.value(&reach(*length), barrier, inverse)
                <= here - 0.1 * length * step.squared_decrement
        };
        here.is_finite().then(|| lengths.into_iter().find(enough).map_or_else(|| x.clone(), reach))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SymmetricEigen;
    use proptest::prelude::*;

    fn ball() -> Matrix4<f64> {
        Matrix4::from_diagonal(&nalgebra::Vector4::new(0.02, 0.03, 0.04, 2.0))
    }

    fn solve(
        data: &TriangularFactor,
        strength: f64,
        positive: &[PositiveColumn],
    ) -> Option<BodySolution> {
        BodyProgram { data, prior: &[ball()], strength, positive, rising: &[] }.solve()
    }

    /// Data whose least-squares solution is `target`, with the standard deviation 0.01.
    fn data_for(target: &[f64]) -> TriangularFactor {
        let n = target.len();
        let mut rows = vec![0.0; n * (n + 1)];
        for k in 0..n {
            rows[k * (n + 1) + k] = 100.0;
            rows[k * (n + 1) + n] = 100.0 * target[k];
        }
        TriangularFactor::from_rows(&rows, n)
    }

    #[test]
    fn a_physically_consistent_link_is_reproduced() {
        let target = link_parameters(&ball());
        let data = data_for(&target);
        let point = solve(&data, 1e-6, &[]).unwrap();
        assert!(point.x.iter().zip(&target).all(|(a, b)| (a - b).abs() < 1e-3), "{}", point.x);
    }

    #[test]
    fn a_negative_mass_becomes_the_nearest_consistent_link() {
        // With h = 0 the nearest link keeps its inertia and has almost no mass.
        let mut target = link_parameters(&ball());
        target[0] = -1.0;
        let data = data_for(&target);
        let point = solve(&data, 1e-6, &[]).unwrap();
        assert!(point.x[0] > 0.0 && point.x[0] < 1e-3, "{}", point.x);
        assert!((point.x[4] - target[4]).abs() < 1e-3);
    }

    #[test]
    fn positive_parameters_stay_positive() {
        let target = [link_parameters(&ball()).as_slice(), &[-0.5, 0.7]].concat();
        let data = data_for(&target);
        let positive = [PositiveColumn { index: 10, prior: 1.0 }];
        let point = solve(&data, 1e-6, &positive).unwrap();
        assert!(point.x[10] > 0.0 && point.x[10] < 1e-3 && (point.x[11] - 0.7).abs() < 1e-6);
    }

    #[test]
    fn a_positive_parameter_that_the_data_do_not_bound_stays_near_its_prior() {
        // The data determine only the sum of the parameters 10 and 11.
        let mut rows = vec![0.0; 13];
        (rows[10], rows[11], rows[12]) = (100.0, 100.0, 500.0);
        let data = TriangularFactor::from_rows(&rows, 12);
        let positive = [PositiveColumn { index: 10, prior: 2.0 }];
        let point = solve(&data, 1.0, &positive).unwrap();
        assert!((point.x[10] - 2.0).abs() < 0.3, "{}", point.x);
        assert!((point.x[10] + point.x[11] - 5.0).abs() < 1e-6, "{}", point.x);
    }

    #[test]
    fn without_data_the_solution_is_the_prior() {
        let data = TriangularFactor::from_rows(&[vec![0.0; 10], vec![0.0]].concat(), 10);
        let point = solve(&data, 1.0, &[]).unwrap();
        // At the minimum s P0⁻¹ = (s + barrier) P⁻¹, so that the last barrier scales the prior.
        let scaled = (1.0 + LAST_BARRIER) * ball();
        assert!((pseudo_inertia(point.x.as_slice()) - scaled).amax() < 1e-6);
    }

    #[test]
    fn a_weak_prior_still_decides_what_the_data_leave_open() {
        // The data determine the mass alone.
        let mut rows = vec![0.0; 11];
        (rows[0], rows[10]) = (100.0, 100.0 * ball()[(3, 3)]);
        let data = TriangularFactor::from_rows(&rows, 10);
        for strength in [1e-3, 1e-6, 1e-9] {
            let found = pseudo_inertia(solve(&data, strength, &[]).unwrap().x.as_slice());
            assert!((found - ball()).amax() < 0.01 * ball().amax(), "{strength}: {found}");
        }
    }

    /// A flat link lies on the boundary; exact data have the smallest deviation that a fit allows.
    #[test]
    fn a_flat_link_is_found_from_exact_data() {
        let flat =
            link_parameters(&Matrix4::from_diagonal(&nalgebra::Vector4::new(0.03, 0.01, 0.0, 4.0)));
        for scale in [1e2, 1e6, 1e8] {
            let mut data = data_for(&flat);
            (data.r, data.z) = (data.r * (scale / 100.0), data.z * (scale / 100.0));
            let found = solve(&data, 1.0, &[]).unwrap_or_else(|| panic!("no link at {scale}"));
            let off = found.x.iter().zip(&flat).map(|(a, b)| (a - b).abs());
            let off = off.max_by(f64::total_cmp).unwrap();
            assert!(off < 0.1 / scale.sqrt(), "{scale}: {off}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Projection theorem: the vector from the solution to the target makes an obtuse angle
        /// with the vector from the solution to any consistent link.
        #[test]
        fn the_solution_is_nearest(
            target in prop::collection::vec(-1.0..1.0_f64, 10),
            other in prop::collection::vec(-1.0..1.0_f64, 16),
        ) {
            let data = data_for(&target);
            let point = solve(&data, 1e-9, &[]).unwrap();
            let p = pseudo_inertia(point.x.as_slice());
            prop_assert!(SymmetricEigen::new(p).eigenvalues.min() > 0.0);
            let root = Matrix4::from_row_slice(&other);
            let body = DVector::from_row_slice(&link_parameters(&(root * root.transpose())));
            let to_target = DVector::from_row_slice(&target) - &point.x;
            // In units of the objective (weights 100²). At the last barrier's minimum the product
            // is barrier · (tr(P⁻¹ B) - 4).
            let angle = 1e4 * to_target.dot(&(body - &point.x));
            prop_assert!(angle < 4.0 * point.gap, "{angle}");
        }
    }
}
