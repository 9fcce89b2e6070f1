use crate::error::{Error, Result};
use crate::prepare::raw_log::RawLog;
use crate::prepare::settings::PrepareSettings;
use crate::prepare::survey::Survey;
use rayon::prelude::*;

/// Ratio of the cut-off to the bandwidth of the motion.
const BANDWIDTH_FACTOR: f64 = 1.5;

/// Lowest cut-off that is chosen \[Hz\]: a lower one would smear the step of Coulomb friction at a
/// reversal of the velocity.
const LOWEST: f64 = 3.0;

/// Highest cut-off that is chosen, as a share of the sample rate.
const HIGHEST_SHARE: f64 = 0.2;

/// Returns the cut-off frequency of the low-pass \[Hz\]: the one set, or else one chosen from
/// recordings with motion.
///
/// The choice is 1.5 times the weighted median of the joints' bandwidths. A bandwidth is the
/// frequency below which 99.9 % of the power of the velocity lies, without noise and frequencies at
/// which noise is stronger. Its weight is the variance of the position times the duration. The
/// choice is at least 3 Hz, so that the filtered torque still shows the step of Coulomb friction,
/// and at most a fifth of the lowest sample rate.
///
/// # Errors
///
/// [`Error::CutOff`] if the cut-off that is set is not between 0 and half the lowest sample rate.
pub fn cut_off(logs: &[&RawLog], settings: &PrepareSettings) -> Result<f64> {
    let surveys: Vec<Survey> = logs.par_iter().map(|log| Survey::of(log)).collect();
    chosen_cut_off(&surveys, settings)
}

/// Returns the cut-off frequency \[Hz\] for recordings as [`cut_off`] does.
pub(crate) fn chosen_cut_off(logs: &[Survey], settings: &PrepareSettings) -> Result<f64> {
    let step = |log: &Survey| log.step.unwrap_or(0.0);
    let slowest = logs.iter().max_by(|a, b| step(a).total_cmp(&step(b)));
    let lowest_rate = slowest.map_or(0.0, step).recip();
    if let Some(given) = settings.cut_off {
        let limit = 0.5 * lowest_rate;
        if !(given > 0.0 && given < limit) {
            let log = slowest.map_or_else(String::new, |log| log.name.clone());
            return Err(Error::CutOff { cut_off: given, limit, log });
        }
        return Ok(given);
    }
    let bandwidths = logs.iter().flat_map(|log| log.bandwidths.iter().copied()).collect();
    Ok(chosen(bandwidths, lowest_rate))
}

/// Returns the cut-off \[Hz\] for bandwidths with weights and the lowest sample rate \[Hz\].
fn chosen(mut bandwidths: Vec<(f64, f64)>, rate: f64) -> f64 {
    bandwidths.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * bandwidths.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut sum = 0.0;
    let median = bandwidths.iter().find(|(_, weight)| {
        sum += weight;
        sum >= half
    });
    let wanted = BANDWIDTH_FACTOR * median.map_or(0.0, |(bandwidth, _)| *bandwidth);
    wanted.max(LOWEST).min(HIGHEST_SHARE * rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_choice_stays_within_its_limits() {
        assert_eq!(chosen(vec![(0.4, 1.0), (0.5, 1.0), (0.6, 1.0)], 1000.0), 3.0);
        assert_eq!(chosen(vec![(4.0, 1.0), (6.0, 1.0), (60.0, 0.5)], 1000.0), 9.0);
        assert_eq!(chosen(vec![(4.0, 1.0)], 20.0), 4.0);
    }
}
