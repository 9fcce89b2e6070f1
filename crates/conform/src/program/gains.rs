use std::ops::Range;

use crate::program::dot::dot;

/// What each radius adds to the reach of a row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gains<'a> {
    /// The entries of R_k.
    pub gains: &'a [f64],
    /// Their factors; empty if all are 1.
    pub scale: &'a [f64],
}

impl<'a> Gains<'a> {
    pub(crate) fn iter(self) -> impl Iterator<Item = f64> + use<'a> {
        let factors = self.scale.iter().copied().chain(std::iter::repeat(1.0));
        self.gains.iter().zip(factors).map(|(gain, factor)| gain * factor)
    }

    /// Returns the reach that some radii give.
    pub(crate) fn dot(self, radii: &[f64]) -> f64 {
        self.dot_of(0..radii.len(), radii)
    }

    /// Returns the reach that the radii in `part` give.
    pub(crate) fn dot_of(self, part: Range<usize>, radii: &[f64]) -> f64 {
        match self.scale {
            [] => dot(&self.gains[part.clone()], &radii[part]),
            _ => part.map(|j| self.gains[j] * self.scale[j] * radii[j]).sum(),
        }
    }
}
