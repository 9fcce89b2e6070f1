use reachtube_conform::Answer;

use crate::carried_over::Unseen;

/// The sets of a model at the horizon, as wide as a motion needs them that they have not seen.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Foretold {
    /// Half the width of the set of each joint's position for the recordings, n, rad (m).
    pub half_widths: Vec<f64>,
    /// The displacement of each joint, n, rad (m).
    displacements: Vec<f64>,
    /// The factor by which the sets of the other motions become wider that enclose each motion; at
    /// least 1, and infinite if none do.
    factor: f64,
    /// The geometric mean of these factors over the motions.
    mean_factor: f64,
}

impl Foretold {
    /// Takes the sets of an answer before they were widened, and motions that were left out.
    pub(crate) fn new(answer: &Answer, left_out: &[Unseen]) -> Self {
        let joints = &answer.found.usefulness.parts;
        let growths = || left_out.iter().map(|own| own.left_out.growth());
        let logarithms: f64 = growths().map(f64::ln).sum();
        Self {
            half_widths: joints.iter().map(|own| own.half_width.unwrap_or(f64::INFINITY)).collect(),
            displacements: joints.iter().map(|own| own.displacement).collect(),
            factor: growths().fold(1.0, f64::max),
            mean_factor: (logarithms / left_out.len().max(1) as f64).exp(),
        }
    }

    pub(crate) fn half_width(&self, joint: usize) -> f64 {
        self.factor * self.half_widths[joint]
    }

    /// Returns half the width of each joint's set by the joint's displacement, without the factor.
    pub(crate) fn smallest(&self) -> Vec<f64> {
        let pairs = self.half_widths.iter().zip(&self.displacements);
        pairs.map(|(half_width, displacement)| half_width / displacement).collect()
    }

    /// Returns half the width of the widest set by the joint's displacement.
    pub(crate) fn widest(&self) -> f64 {
        self.ratio(self.widest_joint())
    }

    /// Returns half the width of the widest set by the joint's displacement, with the mean factor
    /// of the motions. A single motion decides the largest factor.
    pub(crate) fn typical(&self) -> f64 {
        self.smallest().into_iter().fold(0.0, f64::max) * self.mean_factor
    }

    /// Returns the joint, from 0, of the widest set.
    pub(crate) fn widest_joint(&self) -> usize {
        let joints = 0..self.half_widths.len();
        joints.max_by(|a, b| self.ratio(*a).total_cmp(&self.ratio(*b))).unwrap_or(0)
    }

    fn ratio(&self, joint: usize) -> f64 {
        self.half_width(joint) / self.displacements[joint]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_have_the_factor_of_motions_that_were_left_out() {
        let foretold = |half_width, factor| Foretold {
            half_widths: vec![half_width, 0.1],
            displacements: vec![2.0, 1.0],
            factor,
            mean_factor: 1.0,
        };
        assert_eq!(foretold(0.4, 1.5).widest(), 0.30000000000000004);
        assert_eq!(foretold(0.1, 2.0).widest(), 0.2);
        assert_eq!(foretold(0.1, f64::INFINITY).widest(), f64::INFINITY);
    }
}
