use reachtube_conform::plausibility::JointWidth;
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

/// How wide the sets are at a horizon.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HorizonWidths {
    /// The horizon, s.
    pub horizon: f64,
    /// Half the width of each joint's set by the joint's displacement, n; empty where no sets were
    /// found.
    pub ratios: Vec<f64>,
    /// Why no sets were found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Whether a fit was tried.
    pub with_fit: bool,
}

impl HorizonWidths {
    /// Returns the joint, from 0, whose set is widest beside its motion, and the ratio; infinite
    /// where no sets were found.
    #[must_use]
    pub(crate) fn worst(&self) -> (usize, f64) {
        let ratios = self.ratios.iter().copied().enumerate();
        ratios.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, f64::INFINITY))
    }
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
    let steps = recordings.logs.iter().map(|log| log.step);
    let shortest = 3.0 * steps.fold(0.0, f64::max);
    // A recording that counts from its start moves most in its middle, so all horizons are tried.
    let whole = recordings.from_start.then(|| recordings.longest());
    let shorter = HORIZONS.into_iter().filter(|horizon| whole.is_none_or(|end| *horizon < end));
    let longer = |horizon: &f64| *horizon > than && *horizon >= shortest;
    for horizon in shorter.chain(whole).filter(longer) {
        match try_horizon(trial, recordings, horizon, MOST_WINDOWS)? {
            Some(widths) => tried.push(widths),
            None => break,
        }
        let is_too_wide = tried.last().is_some_and(|widths| widths.worst().1 > most);
        if is_too_wide && whole.is_none() {
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
    // JSON has no infinite ratio, as where a set was lost.
    let (ratios, reason) =
        trial.journal.step(&name, || match Widened::of_some(trial, recordings, horizon, most) {
            Ok(found) => Ok((ratios(&found.answer.found.usefulness.joints), None)),
            Err(error) if trial.progress.is_cancelled() => Err(error),
            Err(error) => Ok((Vec::new(), Some(error.to_string()))),
        })?;
    let ratios = ratios.into_iter().map(|ratio| ratio.unwrap_or(f64::INFINITY)).collect();
    Ok(Some(HorizonWidths { horizon, ratios, reason, with_fit: trial.fit.is_some() }))
}

fn ratios(joints: &[JointWidth]) -> Vec<Option<f64>> {
    joints.iter().map(|joint| Some(joint.ratio()).filter(|ratio| ratio.is_finite())).collect()
}

/// Returns the longest horizon at which no set is wider beside the motion than `largest`; if there
/// is none, the horizon at which the worst set is narrowest.
pub(crate) fn longest(tried: &[HorizonWidths], largest: f64) -> &HorizonWidths {
    let fitting = tried.iter().rev().find(|widths| widths.worst().1 <= largest);
    let narrowest = || tried.iter().min_by(|a, b| a.worst().1.total_cmp(&b.worst().1));
    fitting.or_else(narrowest).expect("a horizon was tried")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_horizon_whose_sets_are_narrow_is_chosen() {
        let widths = |horizon: f64, ratio: f64| HorizonWidths {
            horizon,
            ratios: vec![0.1, ratio],
            reason: None,
            with_fit: false,
        };
        let tried = [widths(0.05, 0.2), widths(0.1, 0.4), widths(0.2, 0.6), widths(0.3, 0.7)];
        assert_eq!(longest(&tried, 0.5).horizon, 0.1);
        assert_eq!(longest(&tried, 0.1).horizon, 0.05);
        assert_eq!(longest(&[widths(0.05, 3.0), widths(0.1, 2.0)], 0.5).horizon, 0.1);
        let lost = HorizonWidths { ratios: vec![], ..widths(1.0, 0.0) };
        assert_eq!(lost.worst().1, f64::INFINITY);
    }
}
