use crate::data::settings::Settings;
use crate::error::{Error, Result};
use crate::model::file::Model;

/// Number of windows that are open at once, unless another time between them is given.
const OVERLAP: f64 = 4.0;

/// The longest time between two samples, in steps: as recordings at a fixed rate may have.
const LONGEST_GAP: f64 = 1.9;

/// Most samples of a window: their matrices take 2 kB each for six parts.
const MOST_SAMPLES: f64 = 1e5;

/// When the windows of a monitor begin, and how long they are.
///
/// Windows overlap, so that a fault is met by young windows, whose sets are small, and by old ones,
/// in which its effect has grown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// Time between two samples, s. Samples at other times are interpolated linearly.
    pub step: f64,
    /// Length of a window, s, rounded to whole steps.
    pub horizon: f64,
    /// Time from the beginning of one window to the beginning of the next, s, rounded to whole
    /// steps; at most the horizon, so that every sample lies in a window.
    pub every: f64,
    /// The longest time between two samples, s.
    pub longest_gap: f64,
}

impl Schedule {
    /// Returns the schedule of a model for samples that are `step` \[s\] apart: windows as long as
    /// its recordings were used, of which four are open at once.
    #[must_use]
    pub fn new(model: &Model, step: f64) -> Self {
        Self::with_horizon(horizon(model), step)
    }

    /// Returns the schedule of windows of a length \[s\], of which four are open at once.
    #[must_use]
    pub fn with_horizon(horizon: f64, step: f64) -> Self {
        Self { step, horizon, every: horizon / OVERLAP, longest_gap: LONGEST_GAP * step }
    }

    /// Returns the number of steps of a window, and from one beginning to the next.
    ///
    /// # Errors
    ///
    /// [`Error::SettingRange`] for times that are not possible.
    pub(crate) fn steps(&self) -> Result<[usize; 2]> {
        let Self { step, horizon, every, longest_gap } = *self;
        let check = |setting, value: f64, low: f64, high: f64| match (low..=high).contains(&value) {
            true => Ok(()),
            false => Err(Error::SettingRange { setting, index: None, value, low, high }),
        };
        check("time between samples", step, 1e-6, 10.0)?;
        check("horizon", horizon, step, MOST_SAMPLES * step)?;
        check("time between windows", every, 0.0, horizon)?;
        check("longest gap", longest_gap, step, f64::MAX)?;
        let count = |time: f64| ((time / step).round() as usize).max(1);
        Ok([count(horizon), count(every).min(count(horizon))])
    }
}

/// Returns the time up to which a model's recordings were used, s.
fn horizon(model: &Model) -> f64 {
    let Settings { until, .. } = &model.settings;
    let window = model.preparation.as_ref().and_then(|known| known.window);
    let longest = model.data.suites.iter().flat_map(|suite| &suite.runs);
    let longest = longest.map(|run| run.duration).fold(0.0, f64::max);
    let useful = model.usefulness.as_ref().map(|known| known.horizon);
    until.or(window).or(useful).unwrap_or(longest)
}
