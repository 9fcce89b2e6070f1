use crate::friction::sample::{FrictionSample, quadrant_counts};
use reachtube_robot::FrictionDescription;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Share of a joint's samples that a quadrant must exceed to be fitted.
const MIN_SHARE: f64 = 0.02;

/// Number of samples that a quadrant must exceed to be fitted.
const MIN_SAMPLES: f64 = 8.0;

/// Range of the load that determines a slope, relative to the median of the friction.
const LOAD_RANGE: f64 = 0.3;

/// Columns of viscous friction and of the joint's inertia: q̇, q̇², q̇³, q̈.
const OTHER_COLUMNS: usize = 4;

/// The dependence of Coulomb friction on the load.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum CoulombForm {
    /// A line in the load for each of the four quadrants, (6) to (9).
    Quadrants,
    /// sign(q̇) (a + b |load|) + offset; at least one quadrant has too few samples or loads.
    Symmetric,
    /// One value per direction; the load does not vary enough for a slope.
    Constant,
}

impl CoulombForm {
    /// Returns the richest form that the samples determine.
    ///
    /// Quadrants need enough samples and a range of loads each, the symmetric form a range of loads
    /// over all samples.
    pub(super) fn determined_by(samples: &[FrictionSample]) -> Self {
        let counts = quadrant_counts(samples);
        let range = |quadrant: Option<usize>| {
            let loads = samples
                .iter()
                .filter(|s| quadrant.is_none_or(|q| s.quadrant() == q))
                .map(|s| s.load.abs());
            loads.clone().fold(0.0, f64::max) - loads.fold(f64::INFINITY, f64::min)
        };
        let mut sizes: Vec<f64> = samples.iter().map(|s| s.torque.abs()).collect();
        let middle = sizes.len() / 2;
        let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
        let varies = |range: f64| range > LOAD_RANGE * median;
        let enough =
            |q: usize| counts[q] as f64 > (MIN_SHARE * samples.len() as f64).max(MIN_SAMPLES);
        if (0..4).all(|q| enough(q) && varies(range(Some(q)))) {
            Self::Quadrants
        } else if varies(range(None)) {
            Self::Symmetric
        } else {
            Self::Constant
        }
    }

    fn coulomb_columns(self) -> usize {
        match self {
            Self::Quadrants => 8,
            Self::Symmetric => 3,
            Self::Constant => 2,
        }
    }

    pub(super) fn columns(self) -> usize {
        self.coulomb_columns() + OTHER_COLUMNS
    }

    pub(super) fn viscous(self) -> [usize; 3] {
        [4, 3, 2].map(|before| self.columns() - before)
    }

    pub(super) fn inertia(self) -> usize {
        self.columns() - 1
    }

    /// Returns the row of the regression: Coulomb columns, q̇, q̇², q̇³, q̈.
    pub(super) fn row(self, s: &FrictionSample) -> Vec<f64> {
        let mut row = vec![0.0; self.coulomb_columns()];
        let sign = s.qd.signum();
        match self {
            Self::Quadrants => (row[2 * s.quadrant()], row[2 * s.quadrant() + 1]) = (1.0, s.load),
            Self::Symmetric => row.copy_from_slice(&[sign, sign * s.load.abs(), 1.0]),
            Self::Constant => row[usize::from(sign < 0.0)] = 1.0,
        }
        row.extend([s.qd, s.qd.powi(2), s.qd.powi(3), s.qdd]);
        row
    }

    /// Returns a1 to a8 and v1 to v3 of a solution.
    pub(super) fn description(self, x: &[f64]) -> FrictionDescription {
        let coulomb = match self {
            Self::Quadrants => *x.first_chunk().expect("eight columns"),
            Self::Symmetric => {
                let (f, b, o) = (x[0], x[1], x[2]);
                [o + f, b, o - f, b, o - f, -b, o + f, -b]
            }
            Self::Constant => [x[0], 0.0, x[1], 0.0, x[1], 0.0, x[0], 0.0],
        };
        self.with_viscous(coulomb, x)
    }

    /// Returns the standard errors of a1 to a8 and v1 to v3, given the errors of a solution.
    pub(super) fn errors(self, e: &[f64]) -> FrictionDescription {
        match self {
            Self::Symmetric => {
                let (level, slope) = (e[0].hypot(e[2]), e[1]);
                self.with_viscous([level, slope, level, slope, level, slope, level, slope], e)
            }
            Self::Quadrants | Self::Constant => self.description(e),
        }
    }

    fn with_viscous(self, coulomb: [f64; 8], x: &[f64]) -> FrictionDescription {
        let v = self.coulomb_columns();
        let viscous = [x[v], x[v + 1], x[v + 2]];
        FrictionDescription { coulomb, viscous, ..FrictionDescription::default() }
    }
}
