use std::path::Path;

use crate::defect::{Defect, DefectKind};

/// A longer step than this multiple of the usual one is a gap at a fixed rate. A missing sample
/// makes the step twice as long, a late one less.
const FIXED_RATE_GAP: f64 = 1.9;

/// The same multiple where the times jitter.
const JITTER_GAP: f64 = 10.0;

/// Share of the steps that must equal the usual one for the rate to be fixed.
const FIXED_RATE_SHARE: f64 = 0.9;

/// Longest time between two samples.
///
/// The input is held from each sample to the next, so within a gap it is only a guess.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum GapLimit {
    /// 1.9 times the usual (median) time between samples at a fixed rate, and 10 times where the
    /// times jitter.
    #[default]
    Usual,
    /// This many seconds.
    Seconds(f64),
}

impl From<Option<f64>> for GapLimit {
    /// Takes a limit in seconds; without one, the usual one counts.
    fn from(seconds: Option<f64>) -> Self {
        seconds.map_or(Self::Usual, Self::Seconds)
    }
}

impl GapLimit {
    /// Returns a defect for each of a run's steps, s, that is too long. A step has the line of the
    /// sample after it, if the run is a file.
    pub(crate) fn gaps(self, name: &Path, steps: Vec<(Option<u64>, f64)>) -> Vec<Defect> {
        let longest = self.longest_step(steps.iter().map(|(_, step)| *step).collect());
        let defect = |(k, (line, step)): (usize, (Option<u64>, f64))| {
            let (sample, accept) = match line {
                Some(_) => ("this sample".into(), "accept it with --max-gap SECONDS"),
                None => (format!("sample {}", k + 1), "raise the gap limit"),
            };
            let problem = format!(
                "there is a gap of {step:.6} s before {sample}, but the limit is {longest:.6} s"
            );
            let remedy = format!(
                "samples are missing and the input there is unknown: record again, cut the run, \
                 or {accept}"
            );
            Defect::new(name, line, problem, remedy).of_kind(DefectKind::gap(step))
        };
        steps.into_iter().enumerate().filter(|(_, (_, step))| *step > longest).map(defect).collect()
    }

    /// Returns the longest step allowed, s, in a run with these steps, s, in any order.
    #[must_use]
    pub fn longest_step(self, mut steps: Vec<f64>) -> f64 {
        if let Self::Seconds(seconds) = self {
            return seconds * (1.0 + 1e-9);
        }
        if steps.is_empty() {
            return f64::INFINITY;
        }
        let middle = steps.len() / 2;
        let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
        let same = steps.iter().filter(|&&step| (step - usual).abs() <= 1e-3 * usual).count();
        let fixed_rate = same as f64 >= FIXED_RATE_SHARE * steps.len() as f64;
        usual * if fixed_rate { FIXED_RATE_GAP } else { JITTER_GAP }
    }
}

#[cfg(test)]
mod tests {
    use super::GapLimit;

    #[test]
    fn jitter_allows_longer_steps_than_a_fixed_rate() {
        assert_eq!(GapLimit::Usual.longest_step(vec![0.5; 10]), 0.95);
        assert_eq!(GapLimit::Usual.longest_step(vec![0.5, 0.25, 1.0, 0.75, 0.5]), 5.0);
        assert_eq!(GapLimit::Usual.longest_step(vec![]), f64::INFINITY);
        assert!(GapLimit::Seconds(0.5).longest_step(vec![0.1; 10]) >= 0.5);
    }
}
