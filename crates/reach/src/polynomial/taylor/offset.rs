//! A small zonotope about 0 that interval matrices are applied to.

use reachtube_scalar::Interval;

use super::super::generators::Generators;
use super::super::rounded::{Square, raised};
use crate::matrix::IntervalMatrix;

/// {Σ β_l g_l + Σ β_i a_i e_i : |β| <= 1}: generators, and lengths along the axes.
#[derive(Debug, Clone)]
pub(super) struct Offset {
    generators: Generators,
    axes: Vec<f64>,
    /// That of the hull, from above.
    radius: Vec<f64>,
    most_generators: usize,
}

impl Offset {
    /// 0, in so many dimensions. Beyond that many generators, the oldest become a box.
    pub fn zero(n: usize, most_generators: usize) -> Self {
        Self {
            generators: Generators::new(n),
            axes: vec![0.0; n],
            radius: vec![0.0; n],
            most_generators,
        }
    }

    /// Number of generators.
    pub fn count(&self) -> usize {
        self.generators.len()
    }

    /// The generators, one after the other.
    pub fn generators(&self) -> impl Iterator<Item = f64> {
        (0..self.generators.len()).flat_map(|at| self.generators.get(at))
    }

    /// The length along axis i.
    pub fn along_axis(&self, i: usize) -> f64 {
        self.axes[i]
    }

    /// Becomes {J x + d : x in the set, |d_i| <= `more`_i}, for every J in `j`.
    ///
    /// Generators are mapped by the middle of J. What J is off by, and what rounding of the
    /// products with n terms is, at most n u / (1 - n u) of the absolute products, is bounded with
    /// the hull and goes along the axes.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn map(&mut self, j: &IntervalMatrix, more: &[f64]) {
        let n = self.axes.len();
        let mut middle = Square::zero(n);
        let mut next = more.to_vec();
        let rounding = (n + 2) as f64 * f64::EPSILON;
        for (i, next) in next.iter_mut().enumerate() {
            let mut sum = *next;
            for (k, radius) in self.radius.iter().enumerate() {
                let entry = j[(i, k)];
                middle.entries[i * n + k] = entry.mid();
                sum += (entry.rad() + rounding * entry.mag()) * radius;
            }
            *next = raised(sum, n + 2) + f64::MIN_POSITIVE * n as f64;
        }
        let mut sums = vec![0.0; n];
        self.generators.map(&middle, &mut sums);
        for (k, &length) in self.axes.iter().enumerate() {
            let image = (0..n).map(|i| middle.entries[i * n + k] * length);
            sums.iter_mut().zip(image.clone()).for_each(|(sum, x)| *sum += x.abs());
            self.generators.push(image);
        }
        self.axes = next;
        self.measure(&sums);
    }

    /// The radius, from `sums` = Σ |g| of the generators in floating point; the oldest of them
    /// become a box if there are too many.
    fn measure(&mut self, sums: &[f64]) {
        let terms = self.generators.len() + self.axes.len() + 64;
        for ((radius, axis), sum) in self.radius.iter_mut().zip(&self.axes).zip(sums) {
            *radius = raised(axis + sum, terms);
        }
        if self.generators.len() > self.most_generators {
            let surplus = self.generators.len() - self.most_generators + 15;
            self.generators.absorb_oldest(surplus, &mut self.axes);
        }
    }

    /// The hull.
    ///
    /// # Guarantee
    ///
    /// Outer.
    pub fn hull(&self) -> impl Iterator<Item = Interval> {
        self.radius.iter().map(|radius| Interval::centered(0.0, *radius))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;
    use crate::matrix::point;

    #[test]
    fn a_rotation_does_not_wrap() {
        let (sin, cos) = 0.1f64.sin_cos();
        let turn = point(&dmatrix![cos, -sin; sin, cos]);
        let mut offset = Offset::zero(2, usize::MAX);
        offset.map(&turn, &[1e-3; 2]);
        for _ in 0..1000 {
            offset.map(&turn, &[0.0; 2]);
        }
        // A box turned at each step would have grown by (cos + sin)^1000 = 1e41.
        assert!(offset.hull().all(|x| x.mag() >= 1e-3 && x.mag() < 2e-3), "{:?}", offset.radius);
    }
}
