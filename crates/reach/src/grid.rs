use reachtube_scalar::Interval;

use crate::error::ReachError;

/// Largest difference in s between a recorded time and the time k h that stands for it: the
/// picosecond to which times are rounded.
const PICOSECOND: f64 = 1e-12;

/// Sample times t_0 = 0 < t_1 < ... in s, measured from the first sample and rounded to a
/// picosecond.
///
/// The grid is uniform where the recorded times fit a fixed rate to a picosecond. There t_k is
/// *exactly* k h. The step h is a number of 12 significant digits or the reciprocal of a whole
/// number of hertz. The decimals 0.004, 0.008, 0.012 thus give the step 0.004 s. Times that deviate
/// by more from every such rate are kept as they were recorded.
///
/// # Examples
///
/// ```
/// use reachtube_reach::TimeGrid;
///
/// let grid = TimeGrid::from_times(&[10.0, 10.004, 10.008])?;
/// assert_eq!(grid.step(), Some(0.004));
/// assert_eq!(grid.times(), [0.0, 0.004, 0.008]);
/// # Ok::<(), reachtube_reach::ReachError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TimeGrid {
    times: Vec<f64>,
    step: Option<f64>,
}

impl TimeGrid {
    /// Builds the grid of recorded sample times in s.
    ///
    /// # Errors
    ///
    /// Returns [`ReachError::Times`] when a time is not finite or not at least a picosecond after
    /// the previous one.
    pub fn from_times(recorded: &[f64]) -> Result<Self, ReachError> {
        let origin = recorded.first().copied().unwrap_or(0.0);
        let mut times: Vec<f64> = Vec::with_capacity(recorded.len());
        for (index, &time) in recorded.iter().enumerate() {
            let since_first = ((time - origin) * 1e12).round() / 1e12;
            let follows = times.last().is_none_or(|&last| since_first > last);
            if !(follows && since_first.is_finite()) {
                let previous = recorded[index.saturating_sub(1)];
                return Err(ReachError::Times { index, time, previous });
            }
            times.push(since_first);
        }
        Ok(match uniform_step(&times) {
            Some(step) => Self::uniform(step, times.len()),
            None => Self { times, step: None },
        })
    }

    /// Builds the grid 0, h, 2h, ... of `count` samples with the step h in s.
    ///
    /// # Panics
    ///
    /// Panics when the step is not a finite number > 0.
    pub fn uniform(step: f64, count: usize) -> Self {
        assert!(
            step > 0.0 && step.is_finite(),
            "the step of a time grid is {step} s; it must be finite and above 0"
        );
        Self { times: (0..count).map(|k| k as f64 * step).collect(), step: Some(step) }
    }

    /// Returns the sample times in s, rounded to nearest.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the step h in s of a uniform grid.
    pub fn step(&self) -> Option<f64> {
        self.step
    }

    /// Returns the number of samples.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Encloses the time in s between samples k and k + 1.
    ///
    /// # Guarantee
    ///
    /// Exact on a uniform grid; otherwise an outer enclosure of the difference of the two recorded
    /// times.
    pub fn interval(&self, k: usize) -> Interval {
        match self.step {
            Some(h) => Interval::point(h),
            None => Interval::point(self.times[k + 1]) - Interval::point(self.times[k]),
        }
    }

    /// Returns an upper bound of the longest time in s between two samples; 0 for a single sample.
    pub fn longest_step(&self) -> f64 {
        (1..self.len()).map(|k| self.interval(k - 1).hi()).fold(0.0, f64::max)
    }

    /// Returns whether every sample of `self` is exactly the sample of the same index of `longer`.
    ///
    /// A uniform and a recorded grid share at most two samples: for k > 1 the rounded time k h may
    /// equal a recorded time although the exact k h does not.
    pub fn is_prefix_of(&self, longer: &Self) -> bool {
        if self.len() > longer.len() {
            return false;
        }
        match (self.step, longer.step) {
            (Some(h), Some(g)) if self.len() > 1 => h == g,
            (None, Some(_)) | (Some(_), None) if self.len() > 2 => false,
            _ => longer.times.starts_with(&self.times),
        }
    }

    /// Returns the grid of the first `count` samples.
    pub fn prefix(&self, count: usize) -> Self {
        Self { times: self.times[..count.min(self.len())].to_vec(), step: self.step }
    }

    /// Divides every step into `parts`, a power of two; the times of the samples stay the same.
    #[must_use]
    pub(crate) fn refined(&self, parts: usize) -> Self {
        let count = self.len().saturating_sub(1) * parts + 1;
        if let Some(h) = self.step {
            return Self::uniform(h / parts as f64, count);
        }
        let time = |index: usize| match (index / parts, index % parts) {
            (k, 0) => self.times[k],
            (k, part) => {
                self.times[k] + (self.times[k + 1] - self.times[k]) * (part as f64 / parts as f64)
            }
        };
        Self { times: (0..count).map(time).collect(), step: None }
    }
}

/// Returns the step that all times fit: of 12 significant digits, or the step of a rate in whole
/// hertz.
fn uniform_step(times: &[f64]) -> Option<f64> {
    let intervals = times.len().checked_sub(1).filter(|&n| n > 0)?;
    let mean = times[intervals] / intervals as f64;
    let decimal: f64 = format!("{mean:.11e}").parse().ok()?;
    let of_rate = mean.recip().round().recip();
    let fits = |(k, &t): (usize, &f64), step: f64| {
        (t - k as f64 * step).abs() <= PICOSECOND + 2.0 * f64::EPSILON * t
    };
    let is_step = |step: &f64| {
        *step > 0.0 && step.is_finite() && times.iter().enumerate().all(|pair| fits(pair, *step))
    };
    [of_rate, decimal].into_iter().find(is_step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimal_times_of_a_fixed_rate_are_uniform_whatever_their_length() {
        for count in [2, 3, 937, 1088] {
            let times: Vec<f64> =
                (0..count).map(|k| format!("{:.3}", k as f64 * 0.004).parse().unwrap()).collect();
            assert_eq!(TimeGrid::from_times(&times).unwrap().step(), Some(0.004));
        }
    }

    #[test]
    fn rates_in_whole_hertz_are_uniform_and_share_their_step() {
        for count in [2, 3, 240, 24_001] {
            let times: Vec<f64> = (0..count).map(|k| f64::from(k) / 240.0).collect();
            assert_eq!(TimeGrid::from_times(&times).unwrap().step(), Some(1.0 / 240.0));
        }
    }

    #[test]
    fn times_that_are_off_by_more_than_a_picosecond_are_kept() {
        let times: Vec<f64> =
            (0..11).map(|k| 0.3 * f64::from(k) + if k == 7 { 225e-9 } else { 0.0 }).collect();
        let grid = TimeGrid::from_times(&times).unwrap();
        assert_eq!(grid.step(), None);
        assert!((grid.times()[7] - times[7]).abs() <= 1e-12);
    }

    #[test]
    fn jitter_and_gaps_are_not_uniform() {
        let grid = TimeGrid::from_times(&[0.0, 0.010, 0.021, 0.031]).unwrap();
        assert_eq!(grid.step(), None);
        let difference = Interval::point(0.021) - 0.010;
        assert_eq!(grid.interval(1), difference);
        assert!((difference - 0.011).mag() < 1e-17);
        assert_eq!(TimeGrid::from_times(&[0.0, 0.004, 0.012]).unwrap().step(), None);
    }

    #[test]
    fn shorter_grids_of_the_same_rate_are_prefixes() {
        let (short, long) = (TimeGrid::uniform(0.004, 10), TimeGrid::uniform(0.004, 20));
        assert!(short.is_prefix_of(&long) && !long.is_prefix_of(&short));
        assert!(!TimeGrid::uniform(0.005, 10).is_prefix_of(&long));
    }

    #[test]
    fn times_that_do_not_increase_are_an_error() {
        let error = TimeGrid::from_times(&[0.0, 0.1, 0.1]).unwrap_err();
        assert_eq!(error, ReachError::Times { index: 2, time: 0.1, previous: 0.1 });
        assert!(TimeGrid::from_times(&[0.0, f64::NAN]).is_err());
    }
}
