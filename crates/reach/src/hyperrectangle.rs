use serde::{Deserialize, Serialize};

/// An axis-aligned box {c + d : |d_i| <= r_i}, described by its centre and radius r >= 0
/// (correction A of the method: with centre and radius the image under E has centre E c and radius
/// |E| r, whatever the signs in E).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hyperrectangle {
    /// The centre, one entry a dimension.
    pub center: Vec<f64>,
    /// The radius, one entry >= 0 a dimension.
    pub radius: Vec<f64>,
}

impl Hyperrectangle {
    /// The single point 0 in `dimension` dimensions.
    pub fn zero(dimension: usize) -> Self {
        Self { center: vec![0.0; dimension], radius: vec![0.0; dimension] }
    }

    /// Number of dimensions.
    pub fn dimension(&self) -> usize {
        self.center.len()
    }

    /// Whether centre and radius have the same length, are finite, and no radius is negative.
    pub fn is_valid(&self) -> bool {
        self.center.len() == self.radius.len()
            && self.center.iter().all(|c| c.is_finite())
            && self.radius.iter().all(|r| r.is_finite() && *r >= 0.0)
    }

    /// The bounds (lowest, highest) of dimension `index`, rounded to nearest.
    pub fn bounds(&self, index: usize) -> (f64, f64) {
        (self.center[index] - self.radius[index], self.center[index] + self.radius[index])
    }
}
