//! The powers of one variable, Σ c_e dᵉ with e >= 2, against the line that fits them best.

use std::collections::BTreeMap;

use reachtube_scalar::Interval;

/// Pieces of an interval over which powers above the square are bounded.
const PIECES: usize = 16;

/// Parts of its width that a set is moved by in a second, up to which a cruder bound does.
const NEGLIGIBLE: f64 = 1e-9;

/// Where the coefficients of d², d³, ... are.
#[derive(Debug, Clone)]
pub(super) struct Univariate {
    pub variable: usize,
    places: Vec<usize>,
}

impl Univariate {
    /// The powers of a variable among monomials, if there are any.
    pub fn of(variable: usize, place: &BTreeMap<&[u8], usize>) -> Option<Self> {
        let mut monomial = place.keys().next()?.to_vec();
        let mut at = |exponent: u8| {
            monomial.fill(0);
            monomial[variable] = exponent;
            place.get(monomial.as_slice()).copied()
        };
        let places: Vec<usize> = (2..).map_while(&mut at).collect();
        (!places.is_empty()).then_some(Self { variable, places })
    }

    /// The slope of the line that fits best over |d| <= r: that of the first Chebyshev polynomial.
    /// For d³ it is 3/4 r², which leaves a quarter of r³.
    pub fn slope(&self, coefficients: &[f64], r: f64) -> f64 {
        let (mut slope, mut factor) = (0.0, 1.0);
        // C(e, (e - 1)/2) / 2^{e-1} r^{e-1} for odd e.
        for (place, exponent) in self.places.iter().zip(2..).skip(1).step_by(2) {
            factor *= f64::from(exponent) / f64::from(exponent + 1) * r * r;
            slope += coefficients[*place] * factor;
        }
        if slope.is_finite() { slope } else { 0.0 }
    }

    /// Σ c_e dᵉ - slope d over `side`, in the mean value form on pieces of it.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn range(
        &self,
        coefficient: &impl Fn(usize) -> Interval,
        slope: f64,
        side: Interval,
    ) -> Interval {
        if self.places.len() == 1 {
            return coefficient(self.places[0]) * side.sqr() - side * slope;
        }
        let whole = self.range_of_piece(coefficient, slope, side);
        if whole.width() <= NEGLIGIBLE * side.width() {
            return whole;
        }
        let end = |at: usize| match at {
            0 => side.lo(),
            PIECES => side.hi(),
            at => (side.lo() + (side.hi() - side.lo()) * (at as f64 / PIECES as f64))
                .clamp(side.lo(), side.hi()),
        };
        let piece = |at: usize| match Interval::new(end(at), end(at + 1)) {
            Some(piece) if piece.mag().is_finite() => {
                self.range_of_piece(coefficient, slope, piece)
            }
            _ => Interval::ENTIRE,
        };
        (1..PIECES).fold(piece(0), |hull, at| hull.hull(piece(at)))
    }

    fn range_of_piece(
        &self,
        coefficient: &impl Fn(usize) -> Interval,
        slope: f64,
        piece: Interval,
    ) -> Interval {
        let middle = Interval::point(piece.mid());
        let powers = || self.places.iter().zip(0..self.places.len()).rev();
        let value =
            powers().fold(Interval::ZERO, |sum, (place, _)| sum * middle + coefficient(*place));
        let derivative = powers().fold(Interval::ZERO, |sum, (place, exponent)| {
            sum * piece + coefficient(*place) * (exponent + 2) as f64
        });
        (value * middle - slope) * middle + (derivative * piece - slope) * (piece - middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_is_within_a_quarter_of_its_line() {
        let keys: Vec<Vec<u8>> = (0..4).map(|e| vec![e]).collect();
        let place = keys.iter().enumerate().map(|(at, key)| (key.as_slice(), at)).collect();
        let cube = Univariate::of(0, &place).unwrap();
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
            Univariate::of(
                0,
                &keys[..2].iter().enumerate().map(|(at, key)| (key.as_slice(), at)).collect()
            )
            .is_none()
        );
    }
}
