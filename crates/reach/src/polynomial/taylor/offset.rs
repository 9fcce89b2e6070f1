//! A small zonotope about 0 with products by interval matrices.

use reachtube_scalar::Interval;

use crate::sets::generators::Generators;
use crate::sets::interval_matrix::IntervalMatrix;
use crate::sets::square_matrix::SquareMatrix;
use crate::upward::round_up_sum;

/// The zonotope {Σ β_l g_l + Σ β_i a_i e_i : |β| <= 1} with generators g_l and lengths a_i along
/// the axes.
#[derive(Debug, Clone)]
pub(crate) struct Offset {
    generators: Generators,
    axis_lengths: Vec<f64>,
    /// Radius of the hull, rounded upward.
    radius: Vec<f64>,
    most_generators: usize,
}

impl Offset {
    /// Creates the point 0 in n dimensions.
    ///
    /// Beyond `most_generators` generators, the oldest become a box.
    pub(crate) fn zero(n: usize, most_generators: usize) -> Self {
        Self {
            generators: Generators::new(n),
            axis_lengths: vec![0.0; n],
            radius: vec![0.0; n],
            most_generators,
        }
    }

    /// Iterates over the entries of all generators, one generator after the other.
    pub(crate) fn generators(&self) -> impl Iterator<Item = f64> {
        (0..self.generators.len()).flat_map(|i| self.generators.get(i))
    }

    pub(crate) fn along_axis(&self, i: usize) -> f64 {
        self.axis_lengths[i]
    }

    /// Replaces the set by {J x + d : x in the set, |d_i| <= `more`_i}, for every J in `j`.
    ///
    /// The middle of J maps the generators. The hull bounds the effect of the radius of J and of
    /// the rounding of products with n terms, which is at most n u / (1 - n u) of the absolute
    /// products. Both go along the axes.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn map(&mut self, j: &IntervalMatrix, more: &[f64]) {
        let n = self.axis_lengths.len();
        let mut middle = SquareMatrix::zero(n);
        let mut next = more.to_vec();
        let rounding = (n + 2) as f64 * f64::EPSILON;
        for (i, next) in next.iter_mut().enumerate() {
            let mut sum = *next;
            for (k, radius) in self.radius.iter().enumerate() {
                let entry = j[(i, k)];
                middle.entries[i * n + k] = entry.mid();
                sum += (entry.rad() + rounding * entry.mag()) * radius;
            }
            // A row of the identity is exact.
            let keeps = |k: usize| j[(i, k)] == Interval::point(f64::from(i == k));
            if !(0..n).all(keeps) {
                *next = round_up_sum(sum, n + 2) + f64::MIN_POSITIVE * n as f64;
            }
        }
        let mut sums = vec![0.0; n];
        self.generators.map(&middle, &mut sums);
        for (k, &length) in self.axis_lengths.iter().enumerate() {
            let image = (0..n).map(|i| middle.entries[i * n + k] * length);
            sums.iter_mut().zip(image.clone()).for_each(|(sum, x)| *sum += x.abs());
            self.generators.push(image);
        }
        self.axis_lengths = next;
        self.measure(&sums);
    }

    /// Computes the radius from `sums` = Σ |g| of the generators in floating point; beyond the
    /// limit the oldest generators become a box.
    fn measure(&mut self, sums: &[f64]) {
        let terms = self.generators.len() + self.axis_lengths.len() + 64;
        for ((radius, axis), sum) in self.radius.iter_mut().zip(&self.axis_lengths).zip(sums) {
            let size = axis + sum;
            *radius = if size == 0.0 { 0.0 } else { round_up_sum(size, terms) };
        }
        if self.generators.len() > self.most_generators {
            let surplus = self.generators.len() - self.most_generators + 15;
            self.generators.absorb_oldest(surplus, &mut self.axis_lengths);
        }
    }

    /// Iterates over the sides of the interval hull, n intervals.
    ///
    /// # Guarantee
    ///
    /// Outer.
    pub(crate) fn hull(&self) -> impl Iterator<Item = Interval> {
        self.radius.iter().map(|radius| Interval::centred(0.0, *radius))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;
    use crate::sets::interval_matrix::point;

    #[test]
    fn a_rotation_does_not_wrap() {
        let (sin, cos) = 0.1f64.sin_cos();
        let turn = point(&dmatrix![cos, -sin; sin, cos]);
        let mut offset = Offset::zero(2, usize::MAX);
        offset.map(&turn, &[1e-3; 2]);
        for _ in 0..1000 {
            offset.map(&turn, &[0.0; 2]);
        }
        // A box, rotated at each step, would grow by the factor (cos + sin)^1000 = 1e41.
        assert!(offset.hull().all(|x| x.mag() >= 1e-3 && x.mag() < 2e-3), "{:?}", offset.radius);
    }

    #[test]
    fn a_row_of_the_identity_is_exact() {
        let shear = point(&dmatrix![1.0, 0.7; 0.0, 1.0]);
        let mut offset = Offset::zero(2, usize::MAX);
        for _ in 0..10 {
            offset.map(&shear, &[1e-3, 0.0]);
        }
        let sides: Vec<_> = offset.hull().collect();
        assert!(sides[0].contains(0.01) && sides[1] == Interval::ZERO, "{sides:?}");
        assert!(offset.along_axis(0) >= 1e-3 && offset.along_axis(1) == 0.0);
    }
}
