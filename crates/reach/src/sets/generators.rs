//! Generators of a zonotope, stored so that a matrix product with all of them streams through
//! memory.

use rayon::prelude::*;

use super::square_matrix::SquareMatrix;
use crate::upward::round_up_sum;

/// Number of generators in one block.
const LANES: usize = 16;

/// One coordinate of all generators of a block.
type Lanes = [f64; LANES];

/// Number of blocks in one task of a thread; their work exceeds the cost of waking the thread.
const BLOCKS_PER_TASK: usize = 64;

/// A list of generators, oldest first; zeros fill up the last block.
#[derive(Debug, Clone)]
pub(crate) struct Generators {
    n: usize,
    count: usize,
    /// Block after block; within a block, coordinate after coordinate.
    blocks: Vec<Lanes>,
    /// Scratch memory: Σ |g| of each task.
    partial: Vec<Vec<f64>>,
}

impl Generators {
    pub(crate) fn new(n: usize) -> Self {
        Self { n, count: 0, blocks: Vec::new(), partial: Vec::new() }
    }

    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Appends a generator (n entries), unless it is zero.
    pub(crate) fn push(&mut self, generator: impl Iterator<Item = f64> + Clone) {
        if generator.clone().all(|x| x == 0.0) {
            return;
        }
        let lane = self.count % LANES;
        if lane == 0 {
            self.blocks.resize(self.blocks.len() + self.n, [0.0; LANES]);
        }
        let block = self.blocks.len() - self.n;
        self.blocks[block..].iter_mut().zip(generator).for_each(|(lanes, x)| lanes[lane] = x);
        self.count += 1;
    }

    /// Returns generator `index`, n entries.
    pub(crate) fn get(&self, index: usize) -> impl Iterator<Item = f64> + Clone {
        let block = index / LANES * self.n;
        self.blocks[block..block + self.n].iter().map(move |lanes| lanes[index % LANES])
    }

    /// Replaces every generator g by Φ g and sets `sums` (n) to Σ |Φ g|, both in floating point.
    pub(crate) fn map(&mut self, phi: &SquareMatrix, sums: &mut [f64]) {
        let n = self.n;
        let rows = Rows::new(phi);
        let chunks = self.blocks.len().div_ceil(BLOCKS_PER_TASK * n.max(1));
        self.partial.resize_with(chunks, || vec![0.0; n]);
        let work = |(blocks, sums): (&mut [Lanes], &mut Vec<f64>)| rows.map(blocks, n, sums);
        let chunk = (BLOCKS_PER_TASK * n).max(1);
        if chunks > 1 {
            self.blocks.par_chunks_mut(chunk).zip(&mut self.partial).for_each(work);
        } else {
            self.blocks.chunks_mut(chunk).zip(&mut self.partial).for_each(work);
        }
        sums.fill(0.0);
        for partial in &self.partial {
            sums.iter_mut().zip(partial).for_each(|(sum, x)| *sum += x);
        }
    }

    /// Removes the first `surplus` generators, rounded down to whole blocks, and adds the radius of
    /// their box to `radius`, rounded upward.
    pub(crate) fn absorb_oldest(&mut self, surplus: usize, radius: &mut [f64]) {
        let blocks = surplus.min(self.count) / LANES;
        for (i, radius) in radius.iter_mut().enumerate() {
            let lanes = self.blocks[..blocks * self.n].iter().skip(i).step_by(self.n);
            let sum = lanes.map(|lanes| lanes.iter().map(|x| x.abs()).sum::<f64>()).sum::<f64>();
            *radius = round_up_sum(*radius + sum, blocks * LANES);
        }
        self.blocks.drain(..blocks * self.n);
        self.count -= blocks * LANES;
    }
}

/// Non-zero entries of Φ, row by row.
struct Rows {
    entries: Vec<(usize, f64)>,
    ends: Vec<usize>,
}

impl Rows {
    fn new(phi: &SquareMatrix) -> Self {
        let (mut entries, mut ends) =
            (Vec::with_capacity(phi.entries.len()), Vec::with_capacity(phi.n));
        for i in 0..phi.n {
            let row = phi.row(i).iter().copied().enumerate();
            entries.extend(row.filter(|(_, x)| *x != 0.0));
            ends.push(entries.len());
        }
        Self { entries, ends }
    }

    fn map(&self, blocks: &mut [Lanes], n: usize, sums: &mut [f64]) {
        let mut image = vec![[0.0; LANES]; n];
        let mut totals = vec![[0.0; LANES]; n];
        for block in blocks.chunks_exact_mut(n) {
            let mut start = 0;
            for (image, &end) in image.iter_mut().zip(&self.ends) {
                *image = combination(&self.entries[start..end], block);
                start = end;
            }
            for (total, image) in totals.iter_mut().zip(&image) {
                total.iter_mut().zip(image).for_each(|(total, x)| *total += x.abs());
            }
            block.copy_from_slice(&image);
        }
        sums.iter_mut().zip(&totals).for_each(|(sum, total)| *sum = total.iter().sum());
    }
}

/// Computes Σ φ_j g_j for one row and all lanes.
#[inline]
fn combination(row: &[(usize, f64)], block: &[Lanes]) -> Lanes {
    let mut sum = [0.0; LANES];
    for &(j, phi) in row {
        let g = &block[j];
        for lane in 0..LANES {
            sum[lane] += phi * g[lane];
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generators_are_mapped_summed_and_absorbed() {
        let mut generators = Generators::new(2);
        for k in 0..40 {
            generators.push([f64::from(k), -1.0].into_iter());
        }
        generators.push([0.0, 0.0].into_iter());
        assert_eq!(generators.len(), 40);
        let mut sums = [0.0; 2];
        generators.map(&SquareMatrix { n: 2, entries: vec![1.0, 2.0, 0.0, 3.0] }, &mut sums);
        let expected = (0..40).map(|k| f64::from(k - 2).abs()).sum();
        assert_eq!(sums, [expected, 120.0]);
        assert_eq!(generators.get(39).collect::<Vec<_>>(), [37.0, -3.0]);
        let mut radius = [1.0, 0.0];
        generators.absorb_oldest(37, &mut radius);
        assert_eq!(generators.len(), 8);
        assert!(radius[1] >= 96.0 && radius[1] < 96.0 + 1e-9 && radius[0] >= 1.0 + 2.0 + 1.0);
        assert_eq!(generators.get(7).collect::<Vec<_>>(), [37.0, -3.0]);
    }
}
