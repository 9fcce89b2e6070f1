use reachtube_scalar::{Dispatch, Kernel, Lanes as Vector};

use crate::sets::membership::rows::GeneratorRows;

/// Number of generators in one block.
const LANES: usize = 8;

/// One value for each generator of a block.
pub(super) type Lanes = [f64; LANES];

/// Runs a kernel over lanes with the widest instructions that give the same bits.
pub(super) fn vectorised<K: Kernel>(kernel: K) -> K::Output {
    Vector::<LANES>::dispatch(kernel)
}

/// Generators in blocks, so that one pass through memory serves all states; zeros fill up the last
/// block.
#[derive(Debug, Clone)]
pub(super) struct Blocks {
    dimension: usize,
    /// Block after block; within a block, state after state.
    entries: Vec<Lanes>,
}

impl Blocks {
    /// Lays out generators with each state multiplied by its `scale`, a power of two, which is
    /// exact.
    pub(super) fn new(rows: &GeneratorRows, scale: &[f64]) -> Self {
        let dimension = rows.dimension();
        let mut entries = vec![[0.0; LANES]; rows.count().div_ceil(LANES) * dimension];
        for (i, scale) in scale.iter().enumerate() {
            for (j, x) in rows.row(i).iter().enumerate() {
                entries[j / LANES * dimension + i][j % LANES] = x * scale;
            }
        }
        Self { dimension, entries }
    }

    pub(super) fn len(&self) -> usize {
        self.entries.len() / self.dimension.max(1)
    }

    #[inline(always)]
    fn iter(&self) -> impl Iterator<Item = &[Lanes]> {
        self.entries.chunks_exact(self.dimension.max(1))
    }

    /// Writes z = Gᵀ y to `along`.
    pub(super) fn along(&self, y: &[f64], along: &mut [Lanes]) {
        vectorised(Along { blocks: self, y, along });
    }

    /// Writes z = Gᵀ y to `along`, the factors clip(z) to `factors` and G clip(z) to `product`, and
    /// returns Σ |z|.
    pub(super) fn pass(
        &self,
        y: &[f64],
        along: &mut [Lanes],
        factors: &mut [Lanes],
        product: &mut [Lanes],
    ) -> f64 {
        vectorised(Pass { blocks: self, y, along, factors, product })
    }

    /// Writes G α to `product`.
    pub(super) fn product(&self, factors: &[Lanes], product: &mut [Lanes]) {
        vectorised(Product { blocks: self, factors, product });
    }

    /// Adds Σ w_j g_j g_jᵀ over the generators with weights w = 1 where |z| < 1, and 0 beyond, to
    /// the lower triangle of `sums`, row by row.
    pub(super) fn add_gram_of_free(&self, along: &[Lanes], sums: &mut [Lanes]) {
        vectorised(GramOfFree { blocks: self, along, sums });
    }
}

struct Along<'a> {
    blocks: &'a Blocks,
    y: &'a [f64],
    along: &'a mut [Lanes],
}

impl Kernel for Along<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (block, along) in self.blocks.iter().zip(self.along) {
            *along = combine(block, self.y);
        }
    }
}

struct Pass<'a> {
    blocks: &'a Blocks,
    y: &'a [f64],
    along: &'a mut [Lanes],
    factors: &'a mut [Lanes],
    product: &'a mut [Lanes],
}

impl Kernel for Pass<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let Self { blocks, y, along, factors, product } = self;
        let mut reach = [0.0; LANES];
        product.fill([0.0; LANES]);
        for ((block, along), factors) in blocks.iter().zip(along).zip(factors) {
            let z = combine(block, y);
            let mut clipped = z;
            for lane in 0..LANES {
                reach[lane] += z[lane].abs();
                clipped[lane] = clipped[lane].clamp(-1.0, 1.0);
            }
            (*along, *factors) = (z, clipped);
            add_products(product, block, &clipped);
        }
        reach.iter().sum()
    }
}

struct Product<'a> {
    blocks: &'a Blocks,
    factors: &'a [Lanes],
    product: &'a mut [Lanes],
}

impl Kernel for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.product.fill([0.0; LANES]);
        for (block, factors) in self.blocks.iter().zip(self.factors) {
            add_products(self.product, block, factors);
        }
    }
}

struct GramOfFree<'a> {
    blocks: &'a Blocks,
    along: &'a [Lanes],
    sums: &'a mut [Lanes],
}

impl Kernel for GramOfFree<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (block, z) in self.blocks.iter().zip(self.along) {
            let free = z.map(|z| if z.abs() < 1.0 { 1.0 } else { 0.0 });
            if free == [0.0; LANES] {
                continue;
            }
            let mut sums = self.sums.iter_mut();
            for (i, row) in block.iter().enumerate() {
                let mut masked = *row;
                masked.iter_mut().zip(&free).for_each(|(x, free)| *x *= free);
                for (other, sum) in block[..=i].iter().zip(&mut sums) {
                    add_product(sum, &masked, other);
                }
            }
        }
    }
}

/// Σ_i y_i x_i of a block with states x_i.
#[inline(always)]
fn combine(block: &[Lanes], y: &[f64]) -> Lanes {
    let mut sum = [0.0; LANES];
    for (row, y) in block.iter().zip(y) {
        for lane in 0..LANES {
            sum[lane] += y * row[lane];
        }
    }
    sum
}

#[inline(always)]
fn add_products(product: &mut [Lanes], block: &[Lanes], factors: &Lanes) {
    product.iter_mut().zip(block).for_each(|(sum, row)| add_product(sum, row, factors));
}

/// Adds a product, lane by lane. The sum is copied, since the compiler takes wide instructions only
/// if nothing else can change it.
#[inline(always)]
fn add_product(sum: &mut Lanes, x: &Lanes, y: &Lanes) {
    let mut new = *sum;
    for lane in 0..LANES {
        new[lane] += x[lane] * y[lane];
    }
    *sum = new;
}

/// The sum of all lanes.
pub(super) fn total(lanes: &Lanes) -> f64 {
    lanes.iter().sum()
}
