use nalgebra::DMatrix;

use crate::description::{ScaleOf, SetDescription, ShapedSet, SimpleSet};

/// The form of a set: all sums of generators, each times a number between plus and minus its
/// factor. Factors are found, one for each generator or one for all, or they are 1.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GeneratorForm {
    /// The generators as columns, dimension x their number.
    pub generators: DMatrix<f64>,
    /// For each generator, the number of the factor that it has; `None` for 1.
    pub factor: Vec<Option<usize>>,
    /// The number of factors to be found.
    pub factors: usize,
    /// Whether it is a box with a centre that may be found.
    pub is_box: bool,
}

impl GeneratorForm {
    /// Returns the form that a description gives a set of `dimension` entries.
    ///
    /// # Errors
    ///
    /// What is wrong with it.
    pub(crate) fn new(
        description: &SetDescription,
        dimension: usize,
        name: &str,
    ) -> Result<Self, String> {
        let shaped = match description {
            SetDescription::Simple(SimpleSet::None) => {
                let generators = DMatrix::zeros(dimension, 0);
                return Ok(Self { generators, factor: vec![], factors: 0, is_box: false });
            }
            SetDescription::Simple(SimpleSet::Box) => {
                let generators = DMatrix::identity(dimension, dimension);
                let factor = (0..dimension).map(Some).collect();
                return Ok(Self { generators, factor, factors: dimension, is_box: true });
            }
            SetDescription::Shaped(shaped) => shaped,
        };
        let ShapedSet { generators, radius, scale, fixed } = shaped;
        let columns = match (generators.is_empty(), radius.is_empty()) {
            (false, true) => generators.clone(),
            (true, false) => {
                let one = |i: usize| {
                    let mut column = vec![0.0; radius.len()];
                    column[i] = radius[i];
                    column
                };
                (0..radius.len()).map(one).collect()
            }
            _ => return Err(format!("{name} needs generators or a radius, and not both")),
        };
        if let Some(wrong) = columns.iter().find(|column| column.len() != dimension) {
            let found = wrong.len();
            return Err(format!("{name} needs {dimension} entries in each generator, not {found}"));
        }
        if radius.iter().any(|radius| *radius < 0.0) {
            return Err(format!("{name} has a radius below 0"));
        }
        if !columns.iter().flatten().all(|entry| entry.is_finite()) {
            return Err(format!("{name} has an entry that is not finite"));
        }
        let count = columns.len();
        let generators = DMatrix::from_iterator(dimension, count, columns.into_iter().flatten());
        let factor: Vec<Option<usize>> = match (fixed, scale) {
            (true, _) => vec![None; count],
            (false, ScaleOf::Common) => vec![Some(0); count],
            (false, ScaleOf::Each) => (0..count).map(Some).collect(),
        };
        let factors = factor.iter().flatten().max().map_or(0, |last| last + 1);
        Ok(Self { generators, factor, factors, is_box: false })
    }

    /// Returns the set with these factors, and a centre if it is a box.
    pub(crate) fn with(&self, centre: &[f64], factors: &[f64]) -> ScaledSet {
        let scale = self.factor.iter().map(|factor| factor.map_or(1.0, |at| factors[at]));
        ScaledSet {
            centre: if self.is_box { centre.to_vec() } else { vec![0.0; self.generators.nrows()] },
            generators: self
                .generators
                .column_iter()
                .map(|c| c.iter().copied().collect())
                .collect(),
            scale: scale.collect(),
        }
    }
}

/// The set {c + Σ s_j ξ_j g_j : |ξ_j| <= 1}.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScaledSet {
    /// The centre c.
    pub centre: Vec<f64>,
    /// The generators g_j, each with an entry for each dimension.
    pub generators: Vec<Vec<f64>>,
    /// The factors s_j >= 0.
    pub scale: Vec<f64>,
}

impl ScaledSet {
    /// Returns half of the width of the set in each dimension, to nearest.
    #[must_use]
    pub fn radius(&self) -> Vec<f64> {
        let of = |i: usize| {
            let terms = self.generators.iter().zip(&self.scale);
            terms.map(|(generator, scale)| (generator[i] * scale).abs()).sum()
        };
        (0..self.centre.len()).map(of).collect()
    }

    /// Returns whether it is a set of a form, with numbers that are finite.
    pub(crate) fn has_form(&self, form: &GeneratorForm) -> bool {
        let Self { centre, generators, scale } = self;
        let is_finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
        let same = form.generators.column_iter().zip(generators);
        generators.len() == form.generators.ncols()
            && same.into_iter().all(|(own, column)| own.iter().eq(column))
            && (scale.len(), centre.len()) == (generators.len(), form.generators.nrows())
            && is_finite(centre)
            && is_finite(scale)
            && scale.iter().all(|scale| *scale >= 0.0)
    }
}
