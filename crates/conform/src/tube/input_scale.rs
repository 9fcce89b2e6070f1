//! U that grows with the nominal motion: the faster its states change, the more its inputs are off.

use std::borrow::Cow;

use reachtube_reach::Hyperrectangle;
use reachtube_scalar::Interval;

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::data::signals::Part;
use crate::error::Result;
use crate::sets::{InputScale, UncertaintySets};
use crate::tube::deviation::Nominal;
use crate::tube::place::Place;

/// Factors of U are counted in these parts of 1.
const PARTS_OF_SCALE: f64 = 64.0;

/// Factors of U are no larger, whatever a nominal motion that diverges does.
const LARGEST_SCALE: f64 = 1e6;

impl InputScale {
    /// Returns the factors of U for rates of the nominal motion, where it is twice what it is at
    /// rest at the rates `doubling`: one for each input. They are multiples of 1/64, rounded up, so
    /// that two programs find the same from motions that differ by rounding.
    pub(crate) fn at(rates: impl Iterator<Item = f64>, doubling: &[f64]) -> Self {
        let factor = |(rate, doubles_at): (f64, &f64)| {
            let parts = (PARTS_OF_SCALE * rate / doubles_at).ceil();
            (1.0 + parts / PARTS_OF_SCALE).min(LARGEST_SCALE)
        };
        Self(rates.zip(doubling).map(factor).collect())
    }

    /// Returns the factors of U along a motion at some times: the largest rate of the last state of
    /// each part counts. `state` returns an enclosure of a state at a sample.
    pub(crate) fn along(
        times: &[f64],
        state: impl Fn(usize, usize) -> Interval,
        parts: &[Part],
        doubling: &[f64],
    ) -> Self {
        let rate = |part: &Part| {
            let last = part.states.last().copied().unwrap_or_default();
            let at = |k: usize| state(k, last).mid();
            let step = |k: usize| ((at(k) - at(k - 1)) / (times[k] - times[k - 1])).abs();
            (1..times.len()).map(step).fold(0.0, f64::max)
        };
        Self::at(parts.iter().map(rate), doubling)
    }
}

impl Problem {
    /// Returns the places of the strands of the linear model: its grids, or, where U is scaled,
    /// the places of its cases.
    pub(crate) fn places(&self) -> Result<Vec<Place>> {
        if self.settings().input_doubling.is_some() {
            return Ok(self.deviations_until()?.places.clone());
        }
        let of_grid = |grid| Place { grid, scale: InputScale::default(), cases: 1 };
        Ok((0..self.grids()?.as_slice().len()).map(of_grid).collect())
    }

    /// Returns the strand of a case of the linear model.
    pub(crate) fn strand_of(&self, case: &Case, nominal: &Nominal) -> Result<usize> {
        if self.settings().input_doubling.is_none() {
            return Ok(nominal.grid);
        }
        let scale = self.scale(case, nominal);
        Ok(Place::find(&self.deviations_until()?.places, nominal.grid, &scale))
    }

    /// Returns some sets as they are along the nominal motion of a case: with U at its scale.
    ///
    /// # Errors
    ///
    /// When the solution of the system cannot be enclosed over the case's grid.
    pub fn sets_along<'s>(
        &self,
        sets: &'s UncertaintySets,
        case: &Case,
    ) -> Result<Cow<'s, UncertaintySets>> {
        if self.settings().input_doubling.is_none() {
            return Ok(Cow::Borrowed(sets));
        }
        Ok(sets.along(&self.scale(case, &Nominal::new(self.grids()?, case))))
    }

    /// Returns the factors of U along the nominal motion of a case of the linear model.
    pub(crate) fn scale(&self, case: &Case, Nominal { trajectory, .. }: &Nominal) -> InputScale {
        let Some(doubling) = &self.settings().input_doubling else { return InputScale::default() };
        let times = &case.grid.times()[..trajectory.len().min(case.grid.len())];
        InputScale::along(times, |k, i| trajectory.state(k)[i], self.parts(), doubling)
    }

    /// Returns U where the states that the inputs drive change at the rates `rates` at most, such
    /// as decelerations. It is the model's U unless that grows with the nominal motion.
    #[must_use]
    pub fn input_set_at(&self, sets: &UncertaintySets, rates: &[f64]) -> Hyperrectangle {
        let scale = |doubling: &Vec<f64>| InputScale::at(rates.iter().copied(), doubling);
        let scale = self.settings().input_doubling.as_ref().map(scale).unwrap_or_default();
        sets.along(&scale).into_owned().input_set
    }
}
