//! Factorisation M = Lᵀ D L of a symmetric matrix, from the last row to the first.

use reachtube_scalar::Scalar;

/// Factors the symmetric n x n matrix `m`, stored row by row, in place as Lᵀ D L.
///
/// The function reads the lower triangle. L is unit lower triangular and overwrites the strict
/// lower triangle; D overwrites the diagonal; the upper triangle does not change (Featherstone,
/// Rigid Body Dynamics Algorithms, 2008, table 6.3, for a serial chain).
///
/// Pivot D_i of a mass matrix is the articulated inertia about joint i, which is the inertia that
/// torque on joint i feels while all later joints are free. M is positive definite if and only if
/// every pivot is positive. This function does not check that.
///
/// # Guarantee
///
/// Over `Interval`: each entry encloses the entry for every symmetric matrix in `m`, or is all
/// reals if a pivot encloses 0.
///
/// # Examples
///
/// ```
/// let mut m = [4.0, 2.0, 2.0, 2.0];
/// reachtube_robot::ltdl::factor(&mut m, 2);
/// assert_eq!((m[0], m[2], m[3]), (2.0, 1.0, 2.0)); // 4 = 2 + 1 * 2 * 1
/// let mut x = [6.0, 4.0];
/// reachtube_robot::ltdl::solve(&m, &mut x);
/// assert_eq!(x, [1.0, 1.0]);
/// ```
#[inline(always)]
pub fn factor<S: Scalar>(m: &mut [S], n: usize) {
    let m = &mut m[..n * n];
    for k in (1..n).rev() {
        let (before, row) = m.split_at_mut(k * n);
        let row = &mut row[..=k];
        let inverse = S::one() / row[k].clone();
        for i in (0..k).rev() {
            let ratio = row[i].clone() * inverse.clone();
            let target = &mut before[i * n..i * n + i + 1];
            for (t, r) in target.iter_mut().zip(row.iter()) {
                *t -= ratio.clone() * r.clone();
            }
            row[i] = ratio;
        }
    }
}

/// Solves M x = b in place with the factors from [`factor`]; n is the length of `x`.
///
/// # Guarantee
///
/// Over `Interval`: an outer enclosure of the solutions.
#[inline(always)]
pub fn solve<S: Scalar>(factors: &[S], x: &mut [S]) {
    let n = x.len();
    let factors = &factors[..n * n];
    for i in (0..n).rev() {
        let (before, rest) = x.split_at_mut(i);
        for (b, l) in before.iter_mut().zip(&factors[i * n..]) {
            *b -= l.clone() * rest[0].clone();
        }
    }
    for (i, x) in x.iter_mut().enumerate() {
        *x /= factors[i * n + i].clone();
    }
    for i in 0..n {
        let (before, rest) = x.split_at_mut(i);
        let row = &factors[i * n..=i * n + i];
        for (b, l) in before.iter().zip(row) {
            rest[0] -= l.clone() * b.clone();
        }
    }
}
