use nalgebra::DMatrix;
use reachtube_scalar::rounding::{add_up, mul_up, sub_up};

use crate::sets::membership::blocks::{Lanes, total};
use crate::sets::membership::locate::{Membership, MembershipWorkspace};
use crate::upward::{relative_error, round_up_sum};

/// Data for the proof that points lie in a zonotope, besides their factors.
///
/// Factors α that were found in floating point leave a residual e = d - G α. With N about (G Gᵀ)⁻¹,
/// the correction δ = Gᵀ N t of the factors gives G δ = e where K t = e, K = G Gᵀ N. If |1 - K| is
/// small then K is invertible, t is about e, and |δ| is bounded. The point lies in the zonotope if
/// |α| + |δ| <= 1.
#[derive(Debug, Clone)]
pub struct MembershipProof<'a> {
    set: &'a Membership,
    /// The sum of |1 - K| in each row, below 1/2.
    defect: Vec<f64>,
    /// The largest |Gᵀ N| of each column.
    gain: Vec<f64>,
    /// Σ_j |g_j| of each state, rounded up.
    sums: Vec<f64>,
}

impl<'a> MembershipProof<'a> {
    /// Prepares the proof for a zonotope; `None` if its generators do not span the states well
    /// enough.
    #[must_use]
    pub fn new(set: &'a Membership) -> Option<Self> {
        let (dimension, terms) = (set.scale.len(), set.count);
        let inverse = set.gram.clone().try_inverse()?;
        let sums: Vec<f64> = set.sums.iter().map(|sum| round_up_sum(*sum, terms)).collect();
        // The largest entry of each column of Gᵀ N, rounded up.
        let mut along = vec![[0.0; 8]; set.blocks.len()];
        let mut gain_of = |l: usize| {
            set.blocks.along(inverse.column(l).as_slice(), &mut along);
            let size = |sum, i: usize| add_up(sum, mul_up(set.longest[i], inverse[(i, l)].abs()));
            let size = (0..dimension).fold(0.0, size);
            add_up(largest(&along), mul_up(relative_error(dimension), size))
        };
        let gain: Vec<f64> = (0..dimension).map(&mut gain_of).collect();
        // 1 - G Gᵀ N: the computed product, its rounding, the rounding of the Gram matrix, and the
        // errors of the generators.
        let product = &set.gram * &inverse;
        let defect = DMatrix::from_fn(dimension, dimension, |i, l| {
            let one = if i == l { 1.0 } else { 0.0 };
            let term = |sum: f64, j: usize| {
                let of_product = mul_up(relative_error(dimension), set.gram[(i, j)].abs());
                let of_gram = mul_up(relative_error(terms), mul_up(sums[i], set.longest[j]));
                add_up(sum, mul_up(add_up(of_product, of_gram), inverse[(j, l)].abs()))
            };
            let rounding = (0..dimension).fold(mul_up(set.errors[i], gain[l]), term);
            let difference = sub_up(product[(i, l)], one).max(sub_up(one, product[(i, l)]));
            add_up(difference, rounding)
        });
        let sum = |i: usize| defect.row(i).iter().fold(0.0, |sum, x| add_up(sum, *x));
        let defect: Vec<f64> = (0..dimension).map(sum).collect();
        defect.iter().all(|defect| *defect < 0.5).then_some(Self { set, defect, gain, sums })
    }

    /// Returns whether the factors that the workspace has, times `limit`, prove that every point
    /// within `radius` of `point` lies in the zonotope. The factors are what [`Membership::locate`]
    /// found for the point over `limit`.
    ///
    /// # Guarantee
    ///
    /// True only if every such point lies in the exact zonotope: directed rounding, and bounds of
    /// the rounding of sums.
    #[must_use]
    pub fn holds(
        &self,
        point: &[f64],
        radius: &[f64],
        limit: f64,
        work: &mut MembershipWorkspace,
    ) -> bool {
        let (set, terms) = (self.set, self.set.count);
        work.factors.iter_mut().flatten().for_each(|factor| *factor *= limit);
        set.blocks.product(&work.factors, &mut work.product);
        // The residual from outside, in scaled states.
        let residual = |i: usize| {
            let scaled = point[i] * set.scale[i];
            let difference = (scaled - total(&work.product[i])).abs();
            let size = add_up(scaled.abs(), self.sums[i]);
            let rounding = mul_up(relative_error(terms + 2), size);
            let given = add_up(set.errors[i], mul_up(radius[i], set.scale[i]));
            add_up(difference, add_up(rounding, given))
        };
        let residual: Vec<f64> = (0..set.scale.len()).map(residual).collect();
        let most = residual.iter().copied().fold(0.0, f64::max);
        // |t| <= |e| + |1 - K| |t|, so that no entry of t is above 2 max |e|.
        let of_state = |i: usize| {
            let t = add_up(residual[i], mul_up(self.defect[i], 2.0 * most));
            mul_up(self.gain[i], t)
        };
        let correction = (0..residual.len()).fold(0.0, |sum, i| add_up(sum, of_state(i)));
        add_up(largest(&work.factors), correction) <= 1.0
    }
}

/// The largest absolute value; NaN if there is one.
fn largest(values: &[Lanes]) -> f64 {
    let larger = |max: f64, x: &f64| if x.abs() <= max || max.is_nan() { max } else { x.abs() };
    values.iter().flatten().fold(0.0, larger)
}
