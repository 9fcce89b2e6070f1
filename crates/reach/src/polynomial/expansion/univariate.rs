//! The powers Σ c_e dᵉ, e >= 2, of one variable, minus the line that fits them best.

use std::collections::BTreeMap;

use reachtube_scalar::Interval;

/// Number of pieces of an interval over which powers above the square are bounded.
const PIECES: usize = 16;

/// Width of the range in 1/s, relative to the width of the side, below which one piece suffices.
const NEGLIGIBLE: f64 = 1e-9;

/// Indices of the coefficients of d², d³, ... of one variable.
#[derive(Debug, Clone)]
pub(crate) struct Univariate {
    pub variable: usize,
    indices: Vec<usize>,
}

impl Univariate {
    /// Finds the powers of a variable among monomials; `None` if there are none.
    pub(crate) fn find(variable: usize, index: &BTreeMap<&[u8], usize>) -> Option<Self> {
        let mut monomial = index.keys().next()?.to_vec();
        let mut at = |exponent: u8| {
            monomial.fill(0);
            monomial[variable] = exponent;
            index.get(monomial.as_slice()).copied()
        };
        let indices: Vec<usize> = (2..).map_while(&mut at).collect();
        (!indices.is_empty()).then_some(Self { variable, indices })
    }

    /// Returns the slope of the line that fits the powers best over |d| <= r.
    ///
    /// It is the slope of the first Chebyshev polynomial. For d³ it is 3/4 r², and the difference
    /// is at most r³/4.
    pub(crate) fn slope(&self, coefficients: &[f64], r: f64) -> f64 {
        let (mut slope, mut factor) = (0.0, 1.0);
        // The term of odd e has the slope c_e C(e, (e - 1)/2) / 2^{e-1} r^{e-1}.
        for (index, exponent) in self.indices.iter().zip(2..).skip(1).step_by(2) {
            factor *= f64::from(exponent) / f64::from(exponent + 1) * r * r;
            slope += coefficients[*index] * factor;
        }
        if slope.is_finite() { slope } else { 0.0 }
    }

    /// Encloses Σ c_e dᵉ - slope d over `side`, in the mean value form on pieces of it.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn range(
        &self,
        coefficient: &impl Fn(usize) -> Interval,
        slope: f64,
        side: Interval,
    ) -> Interval {
        if self.indices.len() == 1 {
            return coefficient(self.indices[0]) * side.sqr() - side * slope;
        }
        let whole = self.range_of_piece(coefficient, slope, side);
        if whole.width() <= NEGLIGIBLE * side.width() {
            return whole;
        }
        let end = |part: usize| match part {
            0 => side.lo(),
            PIECES => side.hi(),
            part => (side.lo() + (side.hi() - side.lo()) * (part as f64 / PIECES as f64))
                .clamp(side.lo(), side.hi()),
        };
        let piece = |part: usize| match Interval::new(end(part), end(part + 1)) {
            Some(piece) if piece.mag().is_finite() => {
                self.range_of_piece(coefficient, slope, piece)
            }
            _ => Interval::ENTIRE,
        };
        (1..PIECES).fold(piece(0), |hull, part| hull.hull(piece(part)))
    }

    fn range_of_piece(
        &self,
        coefficient: &impl Fn(usize) -> Interval,
        slope: f64,
        piece: Interval,
    ) -> Interval {
        let middle = Interval::point(piece.mid());
        let powers = || self.indices.iter().zip(0..self.indices.len()).rev();
        let value =
            powers().fold(Interval::ZERO, |sum, (index, _)| sum * middle + coefficient(*index));
        let derivative = powers().fold(Interval::ZERO, |sum, (index, exponent)| {
            sum * piece + coefficient(*index) * (exponent + 2) as f64
        });
        (value * middle - slope) * middle + (derivative * piece - slope) * (piece - middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_line_is_within_a_quarter_of_the_cube() {
        let keys: Vec<Vec<u8>> = (0..4).map(|e| vec![e]).collect();
        let index = keys.iter().enumerate().map(|(at, key)| (key.as_slice(), at)).collect();
        let cube = Univariate::find(0, &index).unwrap();
        let coefficients = [0.0, 0.0, 0.0, -2.0];
        let coefficient = |at: usize| Interval::point(coefficients[at]);
        let slope = cube.slope(&coefficients, 0.5);
        assert_eq!(slope, -2.0 * 0.75 * 0.25);
        let range = cube.range(&coefficient, slope, Interval::new(-0.5, 0.5).unwrap());
        let quarter = 2.0 * 0.125 / 4.0;
        assert!(range.hi() >= quarter && range.hi() < 1.2 * quarter && range.lo() <= -quarter);
        let tilted = cube.range(&coefficient, 1.0, Interval::new(0.5, 1.0).unwrap());
        assert!(tilted.encloses(&Interval::new(-3.0, -0.75).unwrap()) && tilted.width() < 2.4);
        assert!(
            Univariate::find(
                0,
                &keys[..2].iter().enumerate().map(|(at, key)| (key.as_slice(), at)).collect()
            )
            .is_none()
        );
    }
}
