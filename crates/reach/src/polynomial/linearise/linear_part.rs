//! The linear part f* + A d + B e of f, with A and B in floating point.

use reachtube_scalar::Interval;

use crate::polynomial::system::PolynomialSystem;
use crate::sets::square_matrix::SquareMatrix;
use crate::upward::round_up_sum;

/// The linear part of f about a point, and the errors that rounding it to floating point leaves.
#[derive(Debug)]
pub(crate) struct LinearPart {
    /// f*, N entries.
    pub rate: Vec<Interval>,
    /// A, N x N.
    pub a: SquareMatrix,
    /// B without the inputs that a direction carries, N x m, column by column.
    b: Vec<f64>,
    /// Bounds of |e|, m entries.
    pub input_radius: Vec<f64>,
    /// Radius of f*, over all coefficients within their intervals.
    rate_error: Vec<f64>,
    /// Bounds of the errors of A and B, N x (N + m), row by row.
    slope_error: Vec<f64>,
    /// Scratch memory: middle of the remainder as a part of ẋ.
    centre: Vec<Interval>,
}

impl LinearPart {
    /// Allocates the linear part for N states and m inputs.
    pub(crate) fn new(n: usize, m: usize) -> Self {
        Self {
            rate: vec![Interval::ZERO; n],
            a: SquareMatrix::zero(n),
            b: vec![0.0; n * m],
            input_radius: vec![0.0; m],
            rate_error: vec![0.0; n],
            slope_error: vec![0.0; n * (n + m)],
            centre: vec![Interval::ZERO; n],
        }
    }

    /// Returns column j of B; zero for an input that a direction carries.
    pub(crate) fn column(&self, j: usize) -> &[f64] {
        let n = self.a.n;
        &self.b[j * n..(j + 1) * n]
    }

    /// Rounds f* and the enclosed `gradient`, N x (N + m), to their midpoints and keeps the errors.
    pub(crate) fn round(&mut self, system: &PolynomialSystem, gradient: &[Interval]) {
        let n = self.a.n;
        let variables = n + self.input_radius.len();
        for i in 0..n {
            self.rate_error[i] = self.rate[i].rad();
            self.rate[i] = Interval::point(self.rate[i].mid());
            for z in 0..variables {
                let (index, slope) = (i * variables + z, gradient[i * variables + z]);
                self.slope_error[index] = slope.rad();
                if z < n {
                    self.a.entries[i * n + z] = slope.mid();
                } else if system.carriers[z - n].is_none() {
                    self.b[(z - n) * n + i] = slope.mid();
                } else {
                    self.slope_error[index] = slope.mag();
                }
            }
        }
    }

    /// Bounds the effect of the rounding errors in component i of ẋ, over the offsets `tube` (N)
    /// and the input.
    pub(crate) fn rounding_error(&self, i: usize, tube: &[Interval]) -> f64 {
        let (n, variables) = (tube.len(), tube.len() + self.input_radius.len());
        let errors = &self.slope_error[i * variables..(i + 1) * variables];
        let states = errors.iter().zip(tube).map(|(error, d)| error * d.mag());
        let inputs = errors[n..].iter().zip(&self.input_radius).map(|(error, r)| error * r);
        round_up_sum(states.chain(inputs).sum::<f64>() + self.rate_error[i], variables + 1)
    }

    /// Bounds the sum of inputs and remainder along direction g: the inputs that it carries plus
    /// the radius of its remainder.
    pub(crate) fn along_direction(
        &self,
        system: &PolynomialSystem,
        g: usize,
        remainder: &[Interval],
    ) -> f64 {
        round_up_sum(self.carried(system, g) + remainder[self.a.n + g].rad(), 1)
    }

    /// Bounds the inputs that direction g carries.
    fn carried(&self, system: &PolynomialSystem, g: usize) -> f64 {
        let inputs = system.carriers.iter().zip(&self.input_radius);
        let own =
            inputs.filter_map(|(carrier, r)| carrier.filter(|c| c.direction == g).map(|c| (c, r)));
        round_up_sum(
            own.map(|(carrier, r)| carrier.factor.abs() * r).sum(),
            self.input_radius.len(),
        )
    }

    /// Sets `out` to an upper bound of |B| r + |N| |l|, with the `size` of each entry l of the
    /// remainder and the columns N of the directions.
    pub(crate) fn drive(
        &self,
        system: &PolynomialSystem,
        remainder: &[Interval],
        size: impl Fn(Interval) -> f64,
        out: &mut [f64],
    ) {
        let n = out.len();
        out.iter_mut().zip(remainder).for_each(|(out, l)| *out = size(*l));
        for (column, r) in self.b.chunks_exact(n.max(1)).zip(&self.input_radius) {
            out.iter_mut().zip(column).for_each(|(out, b)| *out += b.abs() * r);
        }
        for (g, direction) in system.directions.iter().enumerate() {
            let length = round_up_sum(self.carried(system, g) + size(remainder[n + g]), 1);
            out.iter_mut().zip(&direction.column).for_each(|(out, x)| *out += x.abs() * length);
        }
        let terms = self.input_radius.len() + system.directions.len();
        out.iter_mut().for_each(|out| *out = round_up_sum(*out, terms));
    }

    /// Encloses the middle of the remainder as a part of ẋ, N entries.
    pub(crate) fn remainder_centre(
        &mut self,
        system: &PolynomialSystem,
        remainder: &[Interval],
    ) -> &[Interval] {
        let n = self.centre.len();
        for (i, centre) in self.centre.iter_mut().enumerate() {
            *centre = Interval::point(remainder[i].mid());
            for (direction, l) in system.directions.iter().zip(&remainder[n..]) {
                if direction.column[i] != 0.0 {
                    *centre += Interval::point(direction.column[i]) * l.mid();
                }
            }
        }
        &self.centre
    }
}
