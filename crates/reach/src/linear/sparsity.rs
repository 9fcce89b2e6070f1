//! Entries of e^{Aτ} and e^{Aτ} B that are zero for every τ by the structure of A and B.

use nalgebra::DMatrix;

use crate::linear::system::LinearSystem;

/// Marks the entries (i, j) that can be non-zero in some power of A: a path through non-zero
/// entries of A connects i with j.
pub(crate) fn connected(a: &DMatrix<f64>) -> DMatrix<bool> {
    let n = a.nrows();
    let mut linked = DMatrix::from_fn(n, n, |i, j| i == j || a[(i, j)] != 0.0);
    for via in 0..n {
        for i in 0..n {
            for j in 0..n {
                linked[(i, j)] |= linked[(i, via)] && linked[(via, j)];
            }
        }
    }
    linked
}

/// Marks the entries that can be non-zero in Aⁱ B for some i >= 0; with A in place of B, in some
/// power of A from the first on.
pub(crate) fn reached(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<bool> {
    let linked = connected(a);
    let reached =
        |i: usize, j: usize| (0..a.nrows()).any(|via| linked[(i, via)] && b[(via, j)] != 0.0);
    DMatrix::from_fn(a.nrows(), b.ncols(), reached)
}

/// Marks the entries of [e^{Aτ}, e^{Aτ} B], N x (N + m), that are zero for every τ.
pub(crate) fn always_zero(system: &LinearSystem) -> DMatrix<bool> {
    let (n, m) = (system.states(), system.inputs());
    let (linked, reached) = (connected(system.a()), reached(system.a(), system.b()));
    DMatrix::from_fn(n, n + m, |i, j| if j < n { !linked[(i, j)] } else { !reached[(i, j - n)] })
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    #[test]
    fn an_entry_is_linked_when_a_path_leads_there() {
        let chain = dmatrix![0.0, 1.0, 0.0; 0.0, 0.0, 1.0; 0.0, 0.0, 0.0];
        let expected = dmatrix![true, true, true; false, true, true; false, false, true];
        assert_eq!(connected(&chain), expected);
        let of_powers = dmatrix![false, true, true; false, false, true; false, false, false];
        assert_eq!(reached(&chain, &chain), of_powers);
    }
}
