use reachtube_conform::Answer;
use reachtube_conform::plausibility::PartWidth;
use schemars::JsonSchema;
use serde::Serialize;

use crate::allowance::Widened;
use crate::error::{Error, Result};
use crate::trial::Trial;
use crate::windows::Prepared;

/// The horizons that are tried, s.
const HORIZONS: [f64; 11] = [0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0];

/// Windows of a trial: more hardly change how wide sets are beside the motion.
pub(crate) const MOST_WINDOWS: usize = 200;

/// Longer horizons are not tried once the worst joint's set is wider than its motion by this
/// factor.
const TOO_WIDE: f64 = 1.5;

/// Widths of the sets at a horizon.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct HorizonWidths {
    /// The horizon, s.
    pub horizon: f64,
    /// Half the width of each joint's set by the joint's displacement, n; empty if no sets were
    /// found.
    #[schemars(with = "Vec<Option<f64>>")]
    pub ratios: Vec<f64>,
    /// The same of the sets without their allowance, n. Choices are made by these, because few
    /// windows ask for a larger allowance than all windows do.
    #[serde(skip)]
    pub(crate) smallest: Vec<f64>,
    /// The widest of these, with the factor for a motion that is left out.
    #[serde(skip)]
    pub(crate) foretold: f64,
    /// Why no sets were found.
    pub reason: Option<String>,
    /// Whether a fit was tried.
    pub with_fit: bool,
}

impl HorizonWidths {
    /// Returns the joint, from 0, whose set is widest beside its motion, and the ratio; infinite if
    /// no sets were found.
    #[must_use]
    pub(crate) fn worst(&self) -> (usize, f64) {
        worst_of(&self.ratios)
    }

    /// Makes the widths of the sets of all windows, by which the horizon is judged.
    pub(crate) fn of_all(horizon: f64, ratios: Vec<f64>, with_fit: bool) -> Self {
        let (smallest, foretold) = (ratios.clone(), f64::INFINITY);
        Self { horizon, smallest, ratios, foretold, reason: None, with_fit }
    }

    /// Does what [`worst`](Self::worst) does without the allowance.
    pub(crate) fn worst_smallest(&self) -> (usize, f64) {
        worst_of(&self.smallest)
    }

    /// Returns the widths that a step finds, with and without the allowance, if its job is not
    /// cancelled.
    fn of_step(
        trial: &Trial,
        name: &str,
        horizon: f64,
        find: impl FnOnce() -> Result<[Vec<f64>; 3]>,
    ) -> Result<Self> {
        // JSON has no infinite ratio, as where a set was lost.
        let finite = |ratio: f64| Some(ratio).filter(|ratio| ratio.is_finite());
        let all = |ratios: Vec<f64>| ratios.into_iter().map(finite).collect::<Vec<_>>();
        let (found, reason) = trial.journal.step(name, || match find() {
            Ok(found) => Ok((found.map(all), None)),
            Err(error) if trial.progress.is_cancelled() => Err(error),
            Err(error) => Ok(([vec![], vec![], vec![]], Some(error.to_string()))),
        })?;
        let [ratios, smallest, foretold]: [Vec<f64>; 3] = found.map(|ratios: Vec<Option<f64>>| {
            ratios.into_iter().map(|ratio| ratio.unwrap_or(f64::INFINITY)).collect()
        });
        let foretold = foretold.first().copied().unwrap_or(f64::INFINITY);
        Ok(Self { horizon, ratios, smallest, foretold, reason, with_fit: trial.fit.is_some() })
    }
}

fn worst_of(ratios: &[f64]) -> (usize, f64) {
    let ratios = ratios.iter().copied().enumerate();
    ratios.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, f64::INFINITY))
}

/// Finds how the sets grow with the horizon, up to the one at which they are useless.
///
/// # Errors
///
/// [`Error::NoSets`] if none were found over the shortest horizon.
pub(crate) fn try_horizons(trial: &Trial, recordings: &Prepared) -> Result<Vec<HorizonWidths>> {
    let tried = try_longer(trial, recordings, 0.0, TOO_WIDE)?;
    match tried.first() {
        Some(HorizonWidths { reason: None, .. }) => Ok(tried),
        Some(HorizonWidths { horizon, reason: Some(reason), .. }) => {
            Err(Error::NoSets { shortest: *horizon, reason: reason.clone() })
        }
        None => Err(Error::NoWindow { horizon: HORIZONS[0] }),
    }
}

/// Returns the horizons that are tried and are longer than `than` \[s\], the shortest first.
pub(crate) fn longer_horizons(recordings: &Prepared, than: f64) -> Vec<f64> {
    let steps = recordings.logs.iter().map(|log| log.step);
    let shortest = (3.0 * steps.fold(0.0, f64::max)).max(recordings.shortest);
    let whole = recordings.from_start.then(|| recordings.longest());
    let shorter = HORIZONS.into_iter().filter(|horizon| whole.is_none_or(|end| *horizon < end));
    let longer = |horizon: &f64| *horizon > than && *horizon >= shortest;
    shorter.chain(whole).filter(longer).collect()
}

/// Finds how the sets grow over horizons longer than `than` \[s\], up to the one at which the
/// worst joint's set is wider than its motion by the factor `most`. Recordings that count from
/// their start are tried over all longer horizons.
///
/// # Errors
///
/// A job that was cancelled.
pub(crate) fn try_longer(
    trial: &Trial,
    recordings: &Prepared,
    than: f64,
    most: f64,
) -> Result<Vec<HorizonWidths>> {
    let mut tried: Vec<HorizonWidths> = Vec::new();
    for horizon in longer_horizons(recordings, than) {
        match try_horizon(trial, recordings, horizon, MOST_WINDOWS)? {
            Some(widths) => tried.push(widths),
            None => break,
        }
        let is_too_wide = tried.last().is_some_and(|widths| widths.worst_smallest().1 > most);
        // A recording that counts from its start moves most in its middle.
        if is_too_wide && !recordings.from_start {
            break;
        }
    }
    Ok(tried)
}

/// Finds how wide the sets are at a horizon, over at most `most` windows; `None` if no recording is
/// as long.
pub(crate) fn try_horizon(
    trial: &Trial,
    recordings: &Prepared,
    horizon: f64,
    most: usize,
) -> Result<Option<HorizonWidths>> {
    match recordings.cut_some(horizon, most, |_| false) {
        Err(Error::NoWindow { .. }) => return Ok(None),
        other => other?,
    };
    let name = format!("{horizon} s, {most} windows, {}", trial.name());
    let widths = |found: Widened| {
        let foretold = vec![found.foretold.typical()];
        Ok([ratios(&found.answer), found.foretold.smallest(), foretold])
    };
    let found = || Widened::of_some(trial, recordings, horizon, most).and_then(widths);
    HorizonWidths::of_step(trial, &name, horizon, found).map(Some)
}

/// Sets over all windows.
pub(crate) struct Longest {
    pub found: Widened,
    pub horizon: f64,
    /// The other horizons at which the sets of all windows are too wide, the longest first.
    pub wide: Vec<HorizonWidths>,
}

/// Finds the sets over all windows of the longest of the horizons `candidates`, the longest first,
/// at which none is wider beside the motion than `largest`; if there is none, of the one at which
/// the worst set is narrowest.
///
/// # Errors
///
/// As [`Widened::new`] for the horizon that is returned; a job that was cancelled.
pub(crate) fn longest_of_all(
    trial: &Trial,
    recordings: &Prepared,
    candidates: &[f64],
    largest: f64,
) -> Result<Longest> {
    let (last, longer) = candidates.split_last().expect("a horizon was tried");
    let mut wide = Vec::new();
    for &horizon in longer {
        // A job that continues does not find sets again that were too wide.
        let mut found = None;
        let name = format!("{horizon} s, all windows, {}", trial.name());
        let widths = HorizonWidths::of_step(trial, &name, horizon, || {
            let widened = Widened::new(trial, recordings, horizon)?;
            let widened = found.insert(widened);
            let ratios = ratios(&widened.answer);
            Ok([ratios.clone(), ratios, vec![widened.foretold.typical()]])
        })?;
        if widths.worst().1 > largest {
            wide.push(widths);
            continue;
        }
        let found = found.map_or_else(|| Widened::new(trial, recordings, horizon), Ok)?;
        return Ok(Longest { found, horizon, wide });
    }
    let found = Widened::new(trial, recordings, *last)?;
    let (ratios, with_fit) = (ratios(&found.answer), trial.fit.is_some());
    wide.push(HorizonWidths::of_all(*last, ratios, with_fit));
    let HorizonWidths { horizon, .. } = wide.remove(narrowest(&wide));
    let found = if horizon == *last { found } else { Widened::new(trial, recordings, horizon)? };
    Ok(Longest { found, horizon, wide })
}

/// Returns the index of the horizon at which the worst set is narrowest, the last one of several.
fn narrowest(tried: &[HorizonWidths]) -> usize {
    let order = |a: &usize, b: &usize| tried[*a].worst().1.total_cmp(&tried[*b].worst().1);
    (0..tried.len()).rev().min_by(order).expect("a horizon was tried")
}

pub(crate) fn ratios(answer: &Answer) -> Vec<f64> {
    answer.found.usefulness.parts.iter().map(PartWidth::ratio).collect()
}

/// Returns the horizons that may be chosen, the longest first: the longest at which no set is wider
/// beside the motion than `largest`, and the shorter ones.
pub(crate) fn candidates(tried: &[HorizonWidths], largest: f64) -> Vec<f64> {
    let longest = longest(tried, largest).horizon;
    let shorter = tried.iter().rev().filter(|widths| widths.horizon < longest);
    let narrow = shorter.take_while(|widths| widths.worst_smallest().1 <= largest);
    std::iter::once(longest).chain(narrow.map(|widths| widths.horizon)).collect()
}

/// Returns the longest horizon at which no set is wider beside the motion than `largest`; if there
/// is none, the horizon at which the worst set is narrowest.
pub(crate) fn longest(tried: &[HorizonWidths], largest: f64) -> &HorizonWidths {
    let fitting = tried.iter().rev().find(|widths| widths.worst_smallest().1 <= largest);
    let narrowest =
        || tried.iter().min_by(|a, b| a.worst_smallest().1.total_cmp(&b.worst_smallest().1));
    fitting.or_else(narrowest).expect("a horizon was tried")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_horizon_whose_sets_are_narrow_is_chosen() {
        let widths =
            |horizon: f64, ratio: f64| HorizonWidths::of_all(horizon, vec![0.1, ratio], false);
        let tried = [widths(0.05, 0.2), widths(0.1, 0.4), widths(0.2, 0.6), widths(0.3, 0.7)];
        assert_eq!(longest(&tried, 0.5).horizon, 0.1);
        assert_eq!(longest(&tried, 0.1).horizon, 0.05);
        assert_eq!(longest(&[widths(0.05, 3.0), widths(0.1, 2.0)], 0.5).horizon, 0.1);
        assert_eq!(narrowest(&[widths(0.2, 0.6), widths(0.1, 0.55), widths(0.05, 0.7)]), 1);
        assert_eq!(narrowest(&[widths(0.2, 0.6), widths(0.1, 0.6)]), 1);
        // An allowance of few windows decides nothing.
        let wider = HorizonWidths { ratios: vec![0.1, 0.9], ..widths(0.2, 0.4) };
        assert_eq!(longest(&[widths(0.1, 0.4), wider], 0.5).horizon, 0.2);
        let lost = HorizonWidths::of_all(1.0, vec![], false);
        assert_eq!([lost.worst().1, lost.worst_smallest().1], [f64::INFINITY; 2]);
    }
}
