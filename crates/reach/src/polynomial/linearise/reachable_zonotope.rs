//! The reachable set at one sample, stored so that the next step can update it.

use reachtube_scalar::rounding::{add_up, mul_up};

use crate::sets::generators::Generators;
use crate::sets::square_matrix::SquareMatrix;
use crate::sets::zonotope::Zonotope;
use crate::upward::{UNDERFLOW, round_up_sum};

/// A zonotope of stored generators, which have been through a step, and recent ones.
///
/// The recent generators are multiples of fixed vectors: of directions, of columns of B and of
/// axes. The input adds along the same vectors at the end of a step and at the start of the next,
/// so the next step lengthens the recent generators before it stores them.
#[derive(Debug)]
pub(crate) struct ReachableZonotope {
    pub centre: Vec<f64>,
    /// Stored generators.
    pub generators: Generators,
    /// Lengths of the recent generators along the directions of the system.
    pub direction_lengths: Vec<f64>,
    /// Columns of B of the last step, one after the other.
    pub columns: Vec<f64>,
    /// Lengths of the recent generators along these columns.
    pub column_lengths: Vec<f64>,
    /// Lengths of the recent generators along the axes.
    pub axis_lengths: Vec<f64>,
    /// Radius of the hull of the whole set, rounded upward.
    pub radius: Vec<f64>,
    /// Radius of the part of the set not yet stored as generators, rounded upward.
    pub recent_radius: Vec<f64>,
}

impl ReachableZonotope {
    /// Creates the box {c + d : |d_i| <= r_i}.
    pub(crate) fn new(
        centre: Vec<f64>,
        radius: Vec<f64>,
        inputs: usize,
        directions: usize,
    ) -> Self {
        let n = centre.len();
        Self {
            centre,
            generators: Generators::new(n),
            direction_lengths: vec![0.0; directions],
            columns: vec![0.0; n * inputs],
            column_lengths: vec![0.0; inputs],
            axis_lengths: radius.clone(),
            recent_radius: radius.clone(),
            radius,
        }
    }

    /// Maps the recent generators by Φ and stores the images.
    ///
    /// An axis that Φ maps to itself stays recent. Adds Σ |Φ g| of the stored images to `sums`, in
    /// floating point.
    pub(crate) fn store(
        &mut self,
        phi: &SquareMatrix,
        directions: &[&[f64]],
        image: &mut [f64],
        sums: &mut [f64],
    ) {
        let n = self.centre.len();
        for (direction, &length) in directions.iter().zip(&self.direction_lengths) {
            phi.apply(direction, image);
            push(&mut self.generators, image, length, sums);
        }
        for j in 0..self.column_lengths.len() {
            self.store_column(j, phi, image, sums);
        }
        for (i, length) in self.axis_lengths.iter_mut().enumerate() {
            if (0..n).any(|row| phi.row(row)[i] != f64::from(row == i)) {
                (0..n).for_each(|row| image[row] = phi.row(row)[i]);
                push(&mut self.generators, image, *length, sums);
                *length = 0.0;
            }
        }
    }

    /// Maps the recent generator along column j by Φ and stores the image.
    pub(crate) fn store_column(
        &mut self,
        j: usize,
        phi: &SquareMatrix,
        image: &mut [f64],
        sums: &mut [f64],
    ) {
        let n = self.centre.len();
        phi.apply(&self.columns[j * n..(j + 1) * n], image);
        push(&mut self.generators, image, self.column_lengths[j], sums);
    }

    /// Computes the radii from `sums` = Σ |g| of the stored generators in floating point.
    ///
    /// Beyond `most` stored generators, the oldest become a box.
    pub(crate) fn measure(&mut self, directions: &[&[f64]], sums: &[f64], most: usize) {
        self.measure_recent(directions);
        let terms = self.generators.len() + self.radius.len() + 64;
        for ((radius, recent), sum) in self.radius.iter_mut().zip(&self.recent_radius).zip(sums) {
            *radius = round_up_sum(recent + sum, terms);
        }
        if self.generators.len() > most {
            let surplus = self.generators.len() - most + 15;
            self.generators.absorb_oldest(surplus, &mut self.axis_lengths);
            self.measure_recent(directions);
        }
    }

    fn measure_recent(&mut self, directions: &[&[f64]]) {
        let n = self.centre.len();
        for i in 0..n {
            let along = directions.iter().zip(&self.direction_lengths);
            let along = along.map(|(d, length)| d[i].abs() * length);
            let columns = self.columns.chunks_exact(n).zip(&self.column_lengths);
            let along_columns = columns.map(|(column, length)| column[i].abs() * length);
            let sum = along.chain(along_columns).sum::<f64>() + self.axis_lengths[i];
            let terms = self.direction_lengths.len() + self.column_lengths.len();
            self.recent_radius[i] = round_up_sum(sum, terms);
        }
    }

    /// Returns a copy as a plain zonotope.
    ///
    /// # Guarantee
    ///
    /// Outer: it contains this set. The rounding of the products of lengths and vectors goes along
    /// the axes.
    pub(crate) fn zonotope(&self, directions: &[&[f64]]) -> Zonotope {
        let n = self.centre.len();
        let mut generators: Vec<f64> =
            (0..self.generators.len()).flat_map(|i| self.generators.get(i)).collect();
        let along = directions.iter().copied().zip(&self.direction_lengths);
        let columns = self.columns.chunks_exact(n.max(1)).zip(&self.column_lengths);
        let recent: Vec<(&[f64], &f64)> =
            along.chain(columns).filter(|(_, length)| **length > 0.0).collect();
        let mut sizes = vec![0.0; n];
        for (vector, length) in &recent {
            let image = vector.iter().map(|x| x * *length);
            sizes.iter_mut().zip(image.clone()).for_each(|(size, x)| *size += x.abs());
            generators.extend(image);
        }
        for (i, (length, size)) in self.axis_lengths.iter().zip(&sizes).enumerate() {
            let rounding = if recent.is_empty() {
                0.0
            } else {
                add_up(mul_up(f64::EPSILON, round_up_sum(*size, recent.len())), UNDERFLOW)
            };
            let length = add_up(*length, rounding);
            if length > 0.0 {
                generators.extend((0..n).map(|row| if row == i { length } else { 0.0 }));
            }
        }
        Zonotope::new(self.centre.clone(), generators)
    }
}

fn push(generators: &mut Generators, image: &[f64], length: f64, sums: &mut [f64]) {
    if length > 0.0 {
        generators.push(image.iter().map(|x| x * length));
        sums.iter_mut().zip(image).for_each(|(sum, x)| *sum += (x * length).abs());
    }
}
