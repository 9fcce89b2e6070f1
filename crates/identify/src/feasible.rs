//! The parameters nearest to the data whose links are bodies: a semidefinite program.

use super::regression::Triangle;
use nalgebra::{Cholesky, DMatrix, DVector, Matrix4};

/// Inertial parameters a link: m, m c (3), Ixx, Ixy, Iyy, Ixz, Iyz, Izz about the link's origin.
pub const PER_LINK: usize = 10;

/// Factor between two barriers.
const SHRINK: f64 = 0.1;

/// The last barrier: the objective is within this times the number of inequalities (5 a link) of
/// its least value.
const LAST_BARRIER: f64 = 1e-3;

/// Newton steps for one barrier; a dozen are usual.
const MOST_STEPS: usize = 200;

/// A squared decrement that rounding may leave at the last barrier, well below its gap.
const NEARLY: f64 = 1e-3;

/// Half the squared Newton decrement at which a barrier's minimum is reached.
const REACHED: f64 = 1e-8;

/// min ½ ‖R x - z‖² + s Σ_i [tr(P0_i⁻¹ P_i(x)) - log det P_i(x)] over all x whose links have P_i(x)
/// positive definite and whose listed parameters are positive.
///
/// P_i is the pseudo-inertia [[Σ, h], [hᵀ, m]] of link i, linear in x: it is positive definite if
/// and only if some distribution of positive mass has the link's ten parameters (Wensing, Kim and
/// Slotine, RA-L 2018). The second term is the divergence of Lee and Park (RA-L 2018) from a prior
/// P0, convex, the same in all frames, and what decides the directions that the data leave open.
///
/// Solved by a barrier method of our own: the cone solver of this workspace takes
/// positive-semidefinite constraints only with a BLAS and LAPACK beside it (a Fortran or C build on
/// every user's machine), and the divergence, being the barrier itself, makes this program as small
/// as Newton's method on a hundred unknowns.
#[derive(Debug, Clone)]
pub struct Feasible<'a> {
    /// The data, rows in units of their standard deviation; its first 10 n columns are the links'
    /// parameters.
    pub data: &'a Triangle,
    /// Pseudo-inertias P0 of the prior, positive definite, one a link.
    pub prior: &'a [Matrix4<f64>],
    /// Weight s of the prior, above 0: a prior of 1 counts about as much as one independent sample.
    pub strength: f64,
    /// Columns that must be positive, such as motor inertias.
    pub positive: &'a [usize],
}

/// A solution of [`Feasible`].
#[derive(Debug, Clone)]
pub struct FeasiblePoint {
    /// The parameters.
    pub x: DVector<f64>,
    /// The objective is at most so far above its least value, by duality.
    pub gap: f64,
    /// Newton steps taken.
    pub steps: usize,
}

/// The pseudo-inertia of a link's ten parameters.
pub fn pseudo_inertia(link: &[f64]) -> Matrix4<f64> {
    let [m, hx, hy, hz, xx, xy, yy, xz, yz, zz] =
        *link.first_chunk().expect("ten parameters a link");
    let half = 0.5 * (xx + yy + zz);
    #[rustfmt::skip]
    let rows = Matrix4::new(
        half - xx, -xy, -xz, hx,
        -xy, half - yy, -yz, hy,
        -xz, -yz, half - zz, hz,
        hx, hy, hz, m,
    );
    rows
}

/// The ten parameters of a pseudo-inertia.
pub fn link_parameters(p: &Matrix4<f64>) -> [f64; PER_LINK] {
    let trace = p[(0, 0)] + p[(1, 1)] + p[(2, 2)];
    let [xx, yy, zz] = [0, 1, 2].map(|i| trace - p[(i, i)]);
    [p[(3, 3)], p[(0, 3)], p[(1, 3)], p[(2, 3)], xx, -p[(0, 1)], yy, -p[(0, 2)], -p[(1, 2)], zz]
}

impl Feasible<'_> {
    /// Solves the program from a start near the prior; none where the numbers do not allow it (data
    /// or prior not finite, prior not positive definite).
    pub fn solve(&self) -> Option<FeasiblePoint> {
        let basis = basis();
        let inverse: Vec<_> = self.prior.iter().map(|p| p.try_inverse()).collect::<Option<_>>()?;
        let mut x = self.start();
        let hessian = self.data.r.transpose() * &self.data.r;
        let inequalities = 4 * self.prior.len() + self.positive.len();
        // The first barrier weighs as much as the misfit at the start, or its minimum would be far
        // away.
        let mut barrier = (self.data.squares(&x) / inequalities as f64).max(1.0);
        let mut steps = 0;
        loop {
            barrier = (SHRINK * barrier).max(LAST_BARRIER);
            let mut decrement = f64::INFINITY;
            for _ in 0..MOST_STEPS {
                let step = self.newton_step(&x, barrier, &hessian, &inverse, &basis)?;
                (steps, decrement) = (steps + 1, step.decrement);
                let next = self.advance(&x, &step, barrier, &inverse)?;
                let stuck = next == x;
                x = next;
                if 0.5 * decrement < REACHED || stuck {
                    break;
                }
            }
            if barrier <= LAST_BARRIER {
                let point = FeasiblePoint { x, gap: barrier * inequalities as f64, steps };
                return (decrement < NEARLY).then_some(point);
            }
        }
    }

    /// The prior's links, and the least squares for the rest with the positive ones pushed inside.
    fn start(&self) -> DVector<f64> {
        let mut x = DVector::zeros(self.data.r.ncols());
        for (i, p) in self.prior.iter().enumerate() {
            x.rows_mut(PER_LINK * i, PER_LINK).copy_from_slice(&link_parameters(p));
        }
        self.positive.iter().for_each(|column| x[*column] = 1.0);
        x
    }

    /// Objective with its barrier; infinite outside the feasible set.
    fn value(&self, x: &DVector<f64>, barrier: f64, inverse: &[Matrix4<f64>]) -> f64 {
        let mut value = 0.5 * (&self.data.r * x - &self.data.z).norm_squared();
        for (i, prior) in inverse.iter().enumerate() {
            let p = pseudo_inertia(&x.as_slice()[PER_LINK * i..]);
            let Some(factor) = Cholesky::new(p) else { return f64::INFINITY };
            let log_det = 2.0 * factor.l_dirty().diagonal().map(f64::ln).sum();
            value += self.strength * (prior * p).trace() - (self.strength + barrier) * log_det;
        }
        let log =
            |column: &usize| if x[*column] > 0.0 { x[*column].ln() } else { f64::NEG_INFINITY };
        value - barrier * self.positive.iter().map(log).sum::<f64>()
    }

    fn newton_step(
        &self,
        x: &DVector<f64>,
        barrier: f64,
        squares: &DMatrix<f64>,
        inverse: &[Matrix4<f64>],
        basis: &[Matrix4<f64>; PER_LINK],
    ) -> Option<Step> {
        let mut hessian = squares.clone();
        let mut gradient = self.data.r.transpose() * (&self.data.r * x - &self.data.z);
        for (i, prior) in inverse.iter().enumerate() {
            let at = PER_LINK * i;
            // With P = L Lᵀ and W_k = L⁻¹ E_k L⁻ᵀ, tr(P⁻¹ E_k) = tr W_k and tr(P⁻¹ E_k P⁻¹ E_l) =
            // ⟨W_k, W_l⟩: never indefinite.
            let whiten = Cholesky::new(pseudo_inertia(&x.as_slice()[at..]))?.l().try_inverse()?;
            let turned = basis.map(|e| whiten * e * whiten.transpose());
            for k in 0..PER_LINK {
                gradient[at + k] += self.strength * (prior * basis[k]).trace()
                    - (self.strength + barrier) * turned[k].trace();
                for l in 0..PER_LINK {
                    hessian[(at + k, at + l)] +=
                        (self.strength + barrier) * turned[k].dot(&turned[l]);
                }
            }
        }
        for &column in self.positive {
            gradient[column] -= barrier / x[column];
            hessian[(column, column)] += barrier / x[column].powi(2);
        }
        Step::of(&hessian, &gradient)
    }

    /// The longest of 1, 1/2, 1/4, ... of a step that stays inside and descends enough; the point
    /// itself where rounding leaves nothing to gain.
    fn advance(
        &self,
        x: &DVector<f64>,
        step: &Step,
        barrier: f64,
        inverse: &[Matrix4<f64>],
    ) -> Option<DVector<f64>> {
        let here = self.value(x, barrier, inverse);
        let lengths = std::iter::successors(Some(1.0), |length| Some(0.5 * length)).take(50);
        let reach = |length: f64| x + length * &step.direction;
        let enough = |length: &f64| {
            self.value(&reach(*length), barrier, inverse) <= here - 0.1 * length * step.decrement
        };
        here.is_finite().then(|| lengths.into_iter().find(enough).map_or_else(|| x.clone(), reach))
    }
}

/// A Newton step and the square of its decrement.
struct Step {
    direction: DVector<f64>,
    decrement: f64,
}

impl Step {
    /// By Cholesky of the Hessian scaled to a unit diagonal; directions that nothing decides stay
    /// where they are.
    fn of(hessian: &DMatrix<f64>, gradient: &DVector<f64>) -> Option<Self> {
        let n = gradient.len();
        let scale = DVector::from_fn(n, |i, _| {
            if hessian[(i, i)] > 0.0 { hessian[(i, i)].sqrt().recip() } else { 1.0 }
        });
        let scaled = DMatrix::from_fn(n, n, |i, j| hessian[(i, j)] * scale[i] * scale[j]);
        // Near the boundary the Hessian's eigenvalues span more than doubles do; a ridge then
        // leaves a shorter step that still descends.
        let ridges = [1e-14, 1e-11, 1e-8].into_iter();
        let factor = ridges
            .filter_map(|ridge| Cholesky::new(&scaled + ridge * DMatrix::identity(n, n)))
            .next()?;
        let direction = -factor.solve(&gradient.component_mul(&scale)).component_mul(&scale);
        let decrement = -direction.dot(gradient);
        decrement.is_finite().then_some(Self { direction, decrement })
    }
}

/// dP / d(parameter), for each of the ten.
fn basis() -> [Matrix4<f64>; PER_LINK] {
    std::array::from_fn(|k| {
        let mut unit = [0.0; PER_LINK];
        unit[k] = 1.0;
        pseudo_inertia(&unit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SymmetricEigen;
    use proptest::prelude::*;

    fn ball() -> Matrix4<f64> {
        Matrix4::from_diagonal(&nalgebra::Vector4::new(0.02, 0.03, 0.04, 2.0))
    }

    /// Data that ask for x = target with unit weights.
    fn asking_for(target: &[f64]) -> Triangle {
        let n = target.len();
        let mut rows = vec![0.0; n * (n + 1)];
        for k in 0..n {
            rows[k * (n + 1) + k] = 100.0;
            rows[k * (n + 1) + n] = 100.0 * target[k];
        }
        Triangle::of(&rows, n)
    }

    #[test]
    fn parameters_and_pseudo_inertia_are_one() {
        let link = [2.0, 0.1, -0.2, 0.3, 0.5, 0.01, 0.6, -0.02, 0.03, 0.7];
        let back = link_parameters(&pseudo_inertia(&link));
        assert!(back.iter().zip(&link).all(|(a, b)| (a - b).abs() < 1e-15));
    }

    #[test]
    fn a_body_that_is_possible_is_found_as_it_is() {
        let target = link_parameters(&ball());
        let data = asking_for(&target);
        let point = Feasible { data: &data, prior: &[ball()], strength: 1e-6, positive: &[] }
            .solve()
            .unwrap();
        assert!(point.x.iter().zip(&target).all(|(a, b)| (a - b).abs() < 1e-3), "{}", point.x);
    }

    #[test]
    fn a_negative_mass_becomes_the_nearest_that_is_possible() {
        // With h = 0 the nearest link keeps its inertia and has (nearly) no mass.
        let mut target = link_parameters(&ball());
        target[0] = -1.0;
        let data = asking_for(&target);
        let point = Feasible { data: &data, prior: &[ball()], strength: 1e-6, positive: &[] }
            .solve()
            .unwrap();
        assert!(point.x[0] > 0.0 && point.x[0] < 1e-3, "{}", point.x);
        assert!((point.x[4] - target[4]).abs() < 1e-3);
    }

    #[test]
    fn positive_parameters_stay_positive() {
        let target = [link_parameters(&ball()).as_slice(), &[-0.5, 0.7]].concat();
        let data = asking_for(&target);
        let point = Feasible { data: &data, prior: &[ball()], strength: 1e-6, positive: &[10] }
            .solve()
            .unwrap();
        assert!(point.x[10] > 0.0 && point.x[10] < 1e-3 && (point.x[11] - 0.7).abs() < 1e-6);
    }

    #[test]
    fn what_the_data_leave_open_is_the_priors() {
        let data = Triangle::of(&[vec![0.0; 10], vec![0.0]].concat(), 10);
        let point = Feasible { data: &data, prior: &[ball()], strength: 1.0, positive: &[] }
            .solve()
            .unwrap();
        // s P0⁻¹ = (s + barrier) P⁻¹: the last barrier scales the prior by its own weight.
        let scaled = (1.0 + LAST_BARRIER) * ball();
        assert!((pseudo_inertia(point.x.as_slice()) - scaled).amax() < 1e-6);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// The projection theorem: the way from the solution to the target makes an obtuse angle
        /// with the way to any body.
        #[test]
        fn the_solution_is_nearest(target in prop::collection::vec(-1.0..1.0_f64, 10), other in prop::collection::vec(-1.0..1.0_f64, 16)) {
            let data = asking_for(&target);
            let point = Feasible { data: &data, prior: &[ball()], strength: 1e-9, positive: &[] }.solve().unwrap();
            let p = pseudo_inertia(point.x.as_slice());
            prop_assert!(SymmetricEigen::new(p).eigenvalues.min() > 0.0);
            let root = Matrix4::from_row_slice(&other);
            let body = DVector::from_row_slice(&link_parameters(&(root * root.transpose())));
            let to_target = DVector::from_row_slice(&target) - &point.x;
            // In units of the objective (weights 100²): at the last barrier's minimum it is barrier
            // · (tr(P⁻¹ B) - 4).
            let angle = 1e4 * to_target.dot(&(body - &point.x));
            prop_assert!(angle < 4.0 * point.gap, "{angle}");
        }
    }
}
