//! The reachable set at one sample, as the steps carry it.

use super::generators::Generators;
use super::rounded::{Square, raised};
use crate::Zonotope;

/// A zonotope about `center`, of the generators that have been through a step, and of those of the
/// last step, which the next one adds to before they are stored: what the input adds at the end of
/// a step and at the start of the next has the same direction.
#[derive(Debug)]
pub(super) struct Set {
    pub center: Vec<f64>,
    pub generators: Generators,
    /// Lengths along the system's directions.
    pub lengths: Vec<f64>,
    /// The columns of B of the last step, one after the other, and lengths along them.
    pub columns: Vec<f64>,
    pub column_lengths: Vec<f64>,
    /// Along the axes.
    pub axes: Vec<f64>,
    /// The radius of the hull of the whole, from above.
    pub radius: Vec<f64>,
    /// That of what is not in `generators`.
    pub recent_radius: Vec<f64>,
}

impl Set {
    /// The box {c + d : |d_i| <= r_i}.
    pub fn new(center: Vec<f64>, radius: Vec<f64>, inputs: usize, directions: usize) -> Self {
        let n = center.len();
        Self {
            center,
            generators: Generators::new(n),
            lengths: vec![0.0; directions],
            columns: vec![0.0; n * inputs],
            column_lengths: vec![0.0; inputs],
            axes: radius.clone(),
            recent_radius: radius.clone(),
            radius,
        }
    }

    /// Moves the recent generators through Φ into the stored ones, scaled by the lengths they have
    /// now. An axis that Φ leaves as it is stays. Adds Σ |Φ g| of what it stores to `sums`, in
    /// floating point.
    pub fn store(
        &mut self,
        phi: &Square,
        directions: &[&[f64]],
        image: &mut [f64],
        sums: &mut [f64],
    ) {
        let n = self.center.len();
        for (direction, &length) in directions.iter().zip(&self.lengths) {
            phi.apply(direction, image);
            push(&mut self.generators, image, length, sums);
        }
        for j in 0..self.column_lengths.len() {
            self.store_column(j, phi, image, sums);
        }
        for (i, length) in self.axes.iter_mut().enumerate() {
            if (0..n).any(|row| phi.row(row)[i] != f64::from(row == i)) {
                (0..n).for_each(|row| image[row] = phi.row(row)[i]);
                push(&mut self.generators, image, *length, sums);
                *length = 0.0;
            }
        }
    }

    /// Moves what lies along column j through Φ into the stored generators.
    pub fn store_column(&mut self, j: usize, phi: &Square, image: &mut [f64], sums: &mut [f64]) {
        let n = self.center.len();
        phi.apply(&self.columns[j * n..(j + 1) * n], image);
        push(&mut self.generators, image, self.column_lengths[j], sums);
    }

    /// The radii, from `sums` = Σ |g| of the stored generators in floating point; and the oldest
    /// generators turned into axes beyond `most`.
    pub fn measure(&mut self, directions: &[&[f64]], sums: &[f64], most: usize) {
        self.measure_recent(directions);
        let terms = self.generators.len() + self.radius.len() + 64;
        for ((radius, recent), sum) in self.radius.iter_mut().zip(&self.recent_radius).zip(sums) {
            *radius = raised(recent + sum, terms);
        }
        if self.generators.len() > most {
            self.generators.absorb_oldest(self.generators.len() - most + 15, &mut self.axes);
            self.measure_recent(directions);
        }
    }

    fn measure_recent(&mut self, directions: &[&[f64]]) {
        let n = self.center.len();
        for i in 0..n {
            let along = directions.iter().zip(&self.lengths).map(|(d, length)| d[i].abs() * length);
            let columns = self.columns.chunks_exact(n).zip(&self.column_lengths);
            let along_columns = columns.map(|(column, length)| column[i].abs() * length);
            let sum = along.chain(along_columns).sum::<f64>() + self.axes[i];
            self.recent_radius[i] = raised(sum, self.lengths.len() + self.column_lengths.len());
        }
    }

    /// A copy for others.
    pub fn zonotope(&self, directions: &[&[f64]]) -> Zonotope {
        let n = self.center.len();
        let mut generators: Vec<f64> =
            (0..self.generators.len()).flat_map(|at| self.generators.get(at)).collect();
        let mut push = |column: &[f64], length: f64| {
            if length > 0.0 {
                generators.extend(column.iter().map(|x| x * length));
            }
        };
        directions
            .iter()
            .zip(&self.lengths)
            .for_each(|(direction, length)| push(direction, *length));
        let columns = self.columns.chunks_exact(n.max(1)).zip(&self.column_lengths);
        columns.for_each(|(column, length)| push(column, *length));
        for (i, length) in self.axes.iter().enumerate() {
            let axis: Vec<f64> = (0..n).map(|row| f64::from(row == i)).collect();
            push(&axis, *length);
        }
        Zonotope::new(self.center.clone(), generators)
    }
}

fn push(generators: &mut Generators, image: &[f64], length: f64, sums: &mut [f64]) {
    if length > 0.0 {
        generators.push(image.iter().map(|x| x * length));
        sums.iter_mut().zip(image).for_each(|(sum, x)| *sum += (x * length).abs());
    }
}
