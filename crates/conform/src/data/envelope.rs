use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::data::side::Side;
use crate::data::stored::owners;

/// An envelope: the highest and lowest value over many runs, for each sample and state, and the run
/// that has it. It takes runs one by one, two envelopes merge into the envelope of the whole, and
/// it is as large as one run.
///
/// # Examples
///
/// ```
/// use reachtube_conform::data::Envelope;
///
/// let mut envelope = Envelope::new(1);
/// envelope.include(7, &[1.0, 5.0]);
/// envelope.include(8, &[2.0, 3.0]);
/// assert_eq!((envelope.upper(0, 0), envelope.upper(1, 0)), (2.0, 5.0));
/// assert_eq!((envelope.lower(0, 0), envelope.lower(1, 0)), (1.0, 3.0));
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Envelope {
    dimension: usize,
    upper: Vec<f64>,
    lower: Vec<f64>,
    /// Shared by an envelope and what [`map`](Self::map) makes of it.
    #[serde(with = "owners")]
    upper_run: Arc<Vec<u32>>,
    #[serde(with = "owners")]
    lower_run: Arc<Vec<u32>>,
}

impl Envelope {
    /// Returns the envelope of no run, for states of `dimension` entries.
    pub fn new(dimension: usize) -> Self {
        Self { dimension, ..Self::default() }
    }

    /// Returns the number of samples K of the longest run so far.
    pub fn len(&self) -> usize {
        self.upper.len() / self.dimension.max(1)
    }

    /// Returns whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.upper.is_empty()
    }

    pub(crate) fn dimension(&self) -> usize {
        self.dimension
    }

    /// Includes run number `run` with the values `states`, row-major, samples x dimension. Ties
    /// keep the run of the smaller number, whatever the order of the runs.
    pub fn include(&mut self, run: u32, states: &[f64]) {
        self.include_bounds(run, states, states);
    }

    /// Includes a run whose values are known to lie between `lower` and `upper`, so that the
    /// envelope bounds the exact one from outside.
    ///
    /// # Guarantee
    ///
    /// Outer: exact comparisons, no rounding.
    pub fn include_bounds<'a>(&mut self, run: u32, lower: &'a [f64], upper: &'a [f64]) {
        self.extend(upper.len());
        let of_run = |values: &'a [f64]| values.iter().map(move |value| (*value, run));
        let (highest, lowest) = self.owned();
        extend_bounds(highest, of_run(upper), |new, old| new >= old);
        extend_bounds(lowest, of_run(lower), |new, old| new <= old);
    }

    /// Merges another envelope of the same states. Ties keep the run of the smaller number,
    /// whatever the order of merging.
    pub fn merge(&mut self, other: &Self) {
        self.extend(other.upper.len());
        let (highest, lowest) = self.owned();
        let above = other.upper.iter().copied().zip(other.upper_run.iter().copied());
        let below = other.lower.iter().copied().zip(other.lower_run.iter().copied());
        extend_bounds(highest, above, |new, old| new >= old);
        extend_bounds(lowest, below, |new, old| new <= old);
    }

    /// Returns the envelope of `others`, where this one is the envelope of these and of `left_out`.
    /// Only bounds that `left_out` reaches are looked for anew.
    pub(crate) fn without(&self, left_out: &[&Self], others: &[&Self]) -> Self {
        let mut rest = Self::new(self.dimension);
        let entries = others.iter().map(|other| other.upper.len()).max().unwrap_or(0);
        rest.extend(entries);
        let ((upper, upper_run), (lower, lower_run)) = rest.owned();
        upper.copy_from_slice(&self.upper[..entries]);
        lower.copy_from_slice(&self.lower[..entries]);
        upper_run.copy_from_slice(&self.upper_run[..entries]);
        lower_run.copy_from_slice(&self.lower_run[..entries]);
        for at in 0..entries {
            let reaches = |bounds: fn(&Self) -> &[f64]| {
                left_out.iter().any(|other| bounds(other).get(at) == Some(&bounds(self)[at]))
            };
            let having = others.iter().filter(|other| at < other.upper.len());
            if reaches(|of| &of.upper) {
                let bounds = having.clone().map(|of| (of.upper[at], of.upper_run[at]));
                (upper[at], upper_run[at]) = (f64::NEG_INFINITY, u32::MAX);
                let (bound, run) = (&mut upper[at..=at], &mut upper_run[at..=at]);
                bounds.for_each(|one| {
                    extend_bounds((&mut *bound, &mut *run), [one].into_iter(), |x, y| x >= y)
                });
            }
            if reaches(|of| &of.lower) {
                let bounds = having.map(|of| (of.lower[at], of.lower_run[at]));
                (lower[at], lower_run[at]) = (f64::INFINITY, u32::MAX);
                let (bound, run) = (&mut lower[at..=at], &mut lower_run[at..=at]);
                bounds.for_each(|one| {
                    extend_bounds((&mut *bound, &mut *run), [one].into_iter(), |x, y| x <= y)
                });
            }
        }
        rest
    }

    /// Returns the highest value at sample k in state i.
    pub fn upper(&self, k: usize, i: usize) -> f64 {
        self.upper[k * self.dimension + i]
    }

    /// Returns the lowest value at sample k in state i.
    pub fn lower(&self, k: usize, i: usize) -> f64 {
        self.lower[k * self.dimension + i]
    }

    /// Returns the envelope with each bound moved inward by `radius` of its sample and state,
    /// rounded to nearest.
    #[must_use]
    pub fn narrowed(&self, radius: impl Fn(usize, usize) -> f64) -> Self {
        self.map(|k, i, upper| upper - radius(k, i), |k, i, lower| lower + radius(k, i))
    }

    /// Returns the run that has the bound further from 0 at sample k in state i.
    pub fn furthest_run(&self, k: usize, i: usize) -> u32 {
        match self.upper(k, i) > -self.lower(k, i) {
            true => self.upper_run(k, i),
            false => self.lower_run(k, i),
        }
    }

    pub(crate) fn upper_run(&self, k: usize, i: usize) -> u32 {
        self.upper_run[k * self.dimension + i]
    }

    pub(crate) fn lower_run(&self, k: usize, i: usize) -> u32 {
        self.lower_run[k * self.dimension + i]
    }

    /// Returns the runs that have a bound, some of them more than once.
    pub(crate) fn owners(&self) -> impl Iterator<Item = u32> {
        self.upper_run.iter().chain(self.lower_run.iter()).copied()
    }

    /// Returns whether its parts fit together and have states of `dimension` entries.
    pub(crate) fn is_valid_for(&self, dimension: usize) -> bool {
        let entries = self.upper.len();
        let lengths = [self.lower.len(), self.upper_run.len(), self.lower_run.len()];
        self.dimension == dimension && entries.is_multiple_of(dimension) && lengths == [entries; 3]
    }

    /// Returns the envelope with each bound replaced by a function of (k, i, bound).
    pub(crate) fn map(
        &self,
        upper: impl Fn(usize, usize, f64) -> f64,
        lower: impl Fn(usize, usize, f64) -> f64,
    ) -> Self {
        let dimension = self.dimension;
        let shift = |values: &[f64], f: &dyn Fn(usize, usize, f64) -> f64| {
            values.iter().enumerate().map(|(at, &v)| f(at / dimension, at % dimension, v)).collect()
        };
        Self {
            upper: shift(&self.upper, &upper),
            lower: shift(&self.lower, &lower),
            ..self.clone()
        }
    }

    /// Moves one bound outward.
    pub(crate) fn widen(&mut self, k: usize, i: usize, side: Side, by: f64) {
        let at = k * self.dimension + i;
        match side {
            Side::Upper => self.upper[at] += by,
            Side::Lower => self.lower[at] -= by,
        }
    }

    fn extend(&mut self, entries: usize) {
        if entries > self.upper.len() {
            self.upper.resize(entries, f64::NEG_INFINITY);
            self.lower.resize(entries, f64::INFINITY);
            Arc::make_mut(&mut self.upper_run).resize(entries, u32::MAX);
            Arc::make_mut(&mut self.lower_run).resize(entries, u32::MAX);
        }
    }

    fn owned(&mut self) -> (Owned<'_>, Owned<'_>) {
        let Self { upper, lower, upper_run, lower_run, .. } = self;
        let (of_upper, of_lower) = (Arc::make_mut(upper_run), Arc::make_mut(lower_run));
        ((upper, of_upper), (lower, of_lower))
    }
}

/// Bounds and the runs that have them.
type Owned<'a> = (&'a mut [f64], &'a mut [u32]);

/// Moves bounds outward where `values` with their runs lie beyond them, and hands bounds that
/// `values` reach to the run of the smaller number: 0 and -0 are equal, and a bound has the bits of
/// its run. The pass has no branch, so that the compiler can use vector registers.
fn extend_bounds(
    (bounds, runs): Owned<'_>,
    values: impl Iterator<Item = (f64, u32)>,
    reaches: impl Fn(f64, f64) -> bool,
) {
    for ((bound, owner), (value, run)) in bounds.iter_mut().zip(runs.iter_mut()).zip(values) {
        let takes = reaches(value, *bound) & ((value != *bound) | (run < *owner));
        *bound = if takes { value } else { *bound };
        *owner = if takes { run } else { *owner };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn envelope_of(runs: &[(u32, Vec<f64>)]) -> Envelope {
        let mut envelope = Envelope::new(2);
        runs.iter().for_each(|(run, values)| envelope.include(*run, values));
        envelope
    }

    proptest! {
        #[test]
        fn merging_parts_in_any_order_is_the_whole(
            values in prop::collection::vec(prop::collection::vec(-3i8..3, 2..20), 1..8),
            cut in 0usize..8,
            order in Just((0..8).collect::<Vec<usize>>()).prop_shuffle(),
        ) {
            let runs: Vec<(u32, Vec<f64>)> = values
                .iter()
                .enumerate()
                .map(|(run, v)| {
                    let even = v.len() / 2 * 2;
                    (run as u32, v.iter().map(|&x| f64::from(x)).take(even).collect())
                })
                .collect();
            let (first, second) = runs.split_at(cut.min(runs.len()));
            let (mut a, mut b) = (envelope_of(first), envelope_of(second));
            let (first, second) = (a.clone(), b.clone());
            a.merge(&second);
            b.merge(&first);
            prop_assert_eq!(&a, &envelope_of(&runs));
            prop_assert_eq!(&a, &b);
            let singles: Vec<Envelope> =
                runs.iter().map(|run| envelope_of(std::slice::from_ref(run))).collect();
            let (out, others): (Vec<_>, Vec<_>) =
                singles.iter().enumerate().partition(|(at, _)| *at < cut);
            let [out, others] = [out, others].map(|part: Vec<(usize, &Envelope)>| -> Vec<_> {
                part.into_iter().map(|(_, one)| one).collect()
            });
            prop_assert_eq!(a.without(&out, &others), envelope_of(&runs[cut.min(runs.len())..]));
            let shuffled = order.iter().filter_map(|&run| runs.get(run)).cloned();
            prop_assert_eq!(a, envelope_of(&shuffled.collect::<Vec<_>>()));
        }
    }

    /// 0 and -0 are equal, but a file of the envelope shows which it was.
    #[test]
    fn the_bits_of_a_tie_are_those_of_the_run_of_the_smaller_number() {
        let runs = [(3, vec![-0.0, 0.0]), (1, vec![0.0, -0.0])];
        let mut merged = envelope_of(&runs[..1]);
        merged.merge(&envelope_of(&runs[1..]));
        for envelope in
            [envelope_of(&runs), envelope_of(&[runs[1].clone(), runs[0].clone()]), merged]
        {
            assert_eq!((envelope.upper_run(0, 0), envelope.lower_run(0, 1)), (1, 1));
            assert!(envelope.upper(0, 0).is_sign_positive());
            assert!(envelope.lower(0, 1).is_sign_negative());
        }
    }

    #[test]
    fn runs_of_different_lengths_share_the_samples_they_have() {
        let envelope = envelope_of(&[(0, vec![1.0, 1.0]), (1, vec![0.0, 2.0, -1.0, 3.0])]);
        assert_eq!(envelope.len(), 2);
        assert_eq!((envelope.upper(0, 0), envelope.lower(0, 0)), (1.0, 0.0));
        assert_eq!((envelope.upper_run(1, 1), envelope.lower_run(1, 1)), (1, 1));
    }
}
