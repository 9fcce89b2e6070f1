//! What the widths of the reachable sets cost.

use std::collections::HashMap;

use crate::data::shape::Shape;
use crate::program::block::Block;

/// Returns, for each of several lists of sample times, how much each sample counts: samples at one
/// time together count 1.
pub(crate) fn shares<'t>(lists: impl Iterator<Item = &'t [f64]> + Clone) -> Vec<Vec<f64>> {
    let nanoseconds = |t: &f64| (t * 1e9).round() as i64;
    let mut counts = HashMap::new();
    lists.clone().flatten().for_each(|t| *counts.entry(nanoseconds(t)).or_insert(0.0) += 1.0);
    lists.map(|times| times.iter().map(|t| 1.0 / counts[&nanoseconds(t)]).collect()).collect()
}

/// Returns the cost of each radius (r_x, r_u), and of each noise radius, for the weight of each
/// state.
pub(super) fn cost(
    shape: Shape,
    blocks: &[Block],
    shares: &[Vec<f64>],
    weights: &[f64],
) -> (Vec<f64>, Vec<f64>) {
    let radii = shape.radii();
    let (mut cost, mut noise) = (vec![0.0; radii], vec![0.0; shape.states]);
    for (block, shares) in blocks.iter().zip(shares) {
        let samples = block.coefficients.chunks_exact(shape.entries());
        for (rows, share) in samples.zip(shares) {
            for (i, row) in rows.chunks_exact(2 * radii).enumerate() {
                let weight = 2.0 * share * weights[i];
                row[radii..].iter().zip(&mut cost).for_each(|(a, w)| *w += weight * a);
                noise[i] += weight;
            }
        }
    }
    (cost, noise)
}
