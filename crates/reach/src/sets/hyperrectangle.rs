use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An axis-aligned box {c + d : |d_i| <= r_i} with centre c and radius r >= 0.
///
/// Its image under a matrix E has the centre E c and the radius |E| r, whatever the signs in E
/// (docs/method.md, correction A).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hyperrectangle {
    /// Centre c, one entry per dimension.
    pub centre: Vec<f64>,
    /// Radius r, one entry >= 0 per dimension.
    #[schemars(inner(range(min = 0.0)))]
    pub radius: Vec<f64>,
}

impl Hyperrectangle {
    /// Returns the single point 0 in `dimension` dimensions.
    #[must_use]
    pub fn zero(dimension: usize) -> Self {
        Self { centre: vec![0.0; dimension], radius: vec![0.0; dimension] }
    }

    /// Returns the number of dimensions.
    pub fn dimension(&self) -> usize {
        self.centre.len()
    }

    /// Returns whether centre and radius have the same length and are finite, and no radius is
    /// negative.
    pub fn is_valid(&self) -> bool {
        self.centre.len() == self.radius.len()
            && self.centre.iter().all(|c| c.is_finite())
            && self.radius.iter().all(|r| r.is_finite() && *r >= 0.0)
    }

    /// Returns the bounds (lowest, highest) of dimension `index`, rounded to nearest.
    pub fn bounds(&self, index: usize) -> (f64, f64) {
        (self.centre[index] - self.radius[index], self.centre[index] + self.radius[index])
    }
}
