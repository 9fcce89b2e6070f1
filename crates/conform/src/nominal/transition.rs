//! The solution of a linear system over one step, to rounding.

use nalgebra::DMatrix;

/// Norm up to which the series is summed; larger matrices are halved before.
const LARGEST_NORM: f64 = 0.5;

/// Number of terms of the series: beyond them, the relative error is below 1e-16 for that norm.
const TERMS: usize = 13;

/// Φ = e^{Ah} and Γ = ∫₀ʰ e^{As} ds B of δẋ = A δx + B δu, held over a step of length h. Unrounded:
/// no proof rests on it.
///
/// The series of φ₁(X) = ∫₀¹ e^{Xs} ds is summed for a part of X = A h that is small enough, and
/// doubled: Φ = I + X φ₁, and φ₁(2X) = φ₁(X) (Φ(X) + I) / 2.
#[derive(Debug, Clone)]
pub(crate) struct Transition {
    states: usize,
    /// Row-major, states x states.
    pub phi: Vec<f64>,
    /// Row-major, states x inputs.
    pub gamma: Vec<f64>,
    x: Vec<f64>,
    integral: Vec<f64>,
    spare: Vec<f64>,
    driven: Vec<f64>,
}

impl Transition {
    pub(crate) fn new(states: usize, inputs: usize) -> Self {
        let square = || vec![0.0; states * states];
        let (gamma, driven) = (vec![0.0; states * inputs], vec![0.0; states * inputs]);
        let (phi, x, integral, spare) = (square(), square(), square(), square());
        Self { states, phi, gamma, x, integral, spare, driven }
    }

    /// Computes Φ and Γ for A, B and a step of length `h` (s).
    pub(crate) fn update(&mut self, a: &DMatrix<f64>, b: &DMatrix<f64>, h: f64) {
        let n = self.states;
        let Self { phi, gamma, x, integral, spare, driven, .. } = self;
        x.iter_mut().enumerate().for_each(|(at, x)| *x = a[(at / n, at % n)] * h);
        let norm = x.chunks_exact(n).map(|row| row.iter().map(|x| x.abs()).sum::<f64>());
        let norm = norm.fold(0.0, f64::max);
        let halvings = (norm / LARGEST_NORM).log2().ceil().clamp(0.0, 60.0) as i32;
        let part = 0.5f64.powi(halvings);
        x.iter_mut().for_each(|x| *x *= part);
        // Horner: φ₁ = I + X/2 (I + X/3 (...)).
        set_identity(integral, n);
        for i in (2..=TERMS + 1).rev() {
            product(x, integral, n, spare);
            integral.iter_mut().zip(&*spare).for_each(|(sum, x)| *sum = x / i as f64);
            integral.iter_mut().step_by(n + 1).for_each(|x| *x += 1.0);
        }
        product(x, integral, n, phi);
        phi.iter_mut().step_by(n + 1).for_each(|x| *x += 1.0);
        for _ in 0..halvings {
            product(phi, integral, n, spare);
            integral.iter_mut().zip(&*spare).for_each(|(own, x)| *own = 0.5 * (*own + x));
            product(phi, phi, n, spare);
            std::mem::swap(phi, spare);
        }
        // Γ = h φ₁ B.
        let inputs = b.ncols();
        driven.iter_mut().enumerate().for_each(|(at, x)| *x = h * b[(at / inputs, at % inputs)]);
        product(integral, driven, inputs, gamma);
    }
}

fn set_identity(square: &mut [f64], n: usize) {
    square.fill(0.0);
    square.iter_mut().step_by(n + 1).for_each(|x| *x = 1.0);
}

/// Sets `out` to the product of two matrices, row-major; `right` has `columns` columns.
fn product(left: &[f64], right: &[f64], columns: usize, out: &mut [f64]) {
    let inner = right.len() / columns;
    out.fill(0.0);
    for (row, out) in left.chunks_exact(inner).zip(out.chunks_exact_mut(columns)) {
        for (x, right) in row.iter().zip(right.chunks_exact(columns)) {
            out.iter_mut().zip(right).for_each(|(out, y)| *out += x * y);
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    use super::Transition;

    proptest! {
        #[test]
        fn it_is_the_exponential_of_the_augmented_matrix(
            entries in prop::collection::vec(-1.0..1.0_f64, 24),
            size in prop::sample::select(vec![0.0, 1e-3, 1.0, 30.0]),
            h in 1e-4..0.1_f64,
        ) {
            let a = DMatrix::from_column_slice(4, 4, &entries[..16]) * size;
            let b = DMatrix::from_column_slice(4, 2, &entries[16..]);
            let mut augmented = DMatrix::zeros(6, 6);
            augmented.view_mut((0, 0), (4, 4)).copy_from(&(&a * h));
            augmented.view_mut((0, 4), (4, 2)).copy_from(&(&b * h));
            let expected = augmented.exp();
            let mut found = Transition::new(4, 2);
            found.update(&a, &b, h);
            let phi = DMatrix::from_row_slice(4, 4, &found.phi);
            let gamma = DMatrix::from_row_slice(4, 2, &found.gamma);
            let largest = expected.amax();
            prop_assert!((phi - expected.view((0, 0), (4, 4))).amax() < 1e-14 * largest);
            prop_assert!((gamma - expected.view((0, 4), (4, 2))).amax() < 1e-14 * largest);
        }
    }
}
