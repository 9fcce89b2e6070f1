//! The generators of a zonotope, stored so that a matrix times all of them streams through memory.

use rayon::prelude::*;

use super::rounded::{Square, raised};

/// Generators that are handled at once.
const LANES: usize = 16;

/// One coordinate of as many generators.
type Lanes = [f64; LANES];

/// Blocks that one thread takes at a time: as much work as it costs to wake it up, a few times
/// over.
const BLOCKS: usize = 64;

/// A list of generators, oldest first; the last block may be filled up with zeros.
#[derive(Debug, Clone)]
pub(super) struct Generators {
    n: usize,
    count: usize,
    /// Block by block, coordinate by coordinate.
    blocks: Vec<Lanes>,
    /// Scratch: Σ |g| of each chunk.
    partial: Vec<Vec<f64>>,
}

impl Generators {
    pub fn new(n: usize) -> Self {
        Self { n, count: 0, blocks: Vec::new(), partial: Vec::new() }
    }

    pub fn len(&self) -> usize {
        self.count
    }

    /// Appends a generator (n), unless it is zero.
    pub fn push(&mut self, generator: impl Iterator<Item = f64> + Clone) {
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

    /// Generator `at`, n entries.
    pub fn get(&self, at: usize) -> impl Iterator<Item = f64> + Clone {
        let block = at / LANES * self.n;
        self.blocks[block..block + self.n].iter().map(move |lanes| lanes[at % LANES])
    }

    /// Every generator g becomes Φ g, in floating point; `sums` (n) becomes Σ |Φ g|, in floating
    /// point.
    pub fn map(&mut self, phi: &Square, sums: &mut [f64]) {
        let n = self.n;
        let rows = Rows::new(phi);
        let chunks = self.blocks.len().div_ceil(BLOCKS * n.max(1));
        self.partial.resize_with(chunks, || vec![0.0; n]);
        let work = |(blocks, sums): (&mut [Lanes], &mut Vec<f64>)| rows.map(blocks, n, sums);
        let chunk = (BLOCKS * n).max(1);
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

    /// Removes the first `surplus` generators, whole blocks of them, and adds the box around them
    /// to `radius`, rounded upward.
    pub fn absorb_oldest(&mut self, surplus: usize, radius: &mut [f64]) {
        let blocks = surplus.min(self.count) / LANES;
        for (i, radius) in radius.iter_mut().enumerate() {
            let lanes = self.blocks[..blocks * self.n].iter().skip(i).step_by(self.n);
            let sum = lanes.map(|lanes| lanes.iter().map(|x| x.abs()).sum::<f64>()).sum::<f64>();
            *radius = raised(*radius + sum, blocks * LANES);
        }
        self.blocks.drain(..blocks * self.n);
        self.count -= blocks * LANES;
    }
}

/// The non-zero entries of Φ, row by row.
struct Rows {
    entries: Vec<(usize, f64)>,
    ends: Vec<usize>,
}

impl Rows {
    fn new(phi: &Square) -> Self {
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

/// Σ φ_j g_j for one row, over the lanes.
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
        generators.map(&Square { n: 2, entries: vec![1.0, 2.0, 0.0, 3.0] }, &mut sums);
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
