//! The size of the next step, from the errors of the last ones.

/// What an adaptive step may add to the error of each entry of the state: absolute + relative ·
/// |x|, in the root mean square over the entries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Per |x| (dimensionless).
    pub relative: f64,
    /// In the units of x, positive; the same for all entries.
    pub absolute: f64,
}

impl Default for Tolerance {
    /// 1e-8 each.
    fn default() -> Self {
        Self { relative: 1e-8, absolute: 1e-8 }
    }
}

impl Tolerance {
    /// Root mean square of `error` over the tolerated error at the larger of two states; at most 1
    /// is good.
    pub(crate) fn norm(&self, error: impl Iterator<Item = f64>, from: &[f64], to: &[f64]) -> f64 {
        let tolerated =
            from.iter().zip(to).map(|(a, b)| self.absolute + self.relative * a.abs().max(b.abs()));
        let sum: f64 = error.zip(tolerated).map(|(e, s)| (e / s) * (e / s)).sum();
        (sum / from.len().max(1) as f64).sqrt()
    }
}

/// Proportional-integral control of the step (Gustafsson, ACM TOMS 17, 1991), with the constants of
/// the code DOPRI5 of Hairer & Wanner (Solving Ordinary Differential Equations II, 1996, sec.
/// IV.2).
#[derive(Clone, Debug)]
pub(crate) struct StepControl {
    /// Size to try next \[s\]; `None` before the first step.
    pub proposal: Option<f64>,
    error_before: f64,
    rejected: bool,
}

const SAFETY: f64 = 0.9;
/// Exponents of the error of the step before, and of the step.
const BETA: f64 = 0.04;
const ALPHA: f64 = 0.2 - 0.75 * BETA;
/// Least and largest ratio of a step to the one before.
const RATIO: [f64; 2] = [0.2, 10.0];
/// An error below it says nothing about the next one.
const LEAST_ERROR: f64 = 1e-4;

impl StepControl {
    pub fn new() -> Self {
        Self { proposal: None, error_before: LEAST_ERROR, rejected: false }
    }

    /// After a step of h whose error is within the tolerance. `cut` says that it was cut short to
    /// end where time ends: it then does not speak against a longer proposal.
    pub fn accept(&mut self, h: f64, error: f64, cut: bool) {
        let ratio = SAFETY * self.error_before.powf(BETA) / error.powf(ALPHA);
        let most = if self.rejected { 1.0 } else { RATIO[1] };
        let next = h * ratio.clamp(RATIO[0], most);
        self.rejected = false;
        if cut {
            self.proposal = Some(self.proposal.map_or(next, |p| p.max(next)));
        } else {
            self.proposal = Some(next);
            self.error_before = error.max(LEAST_ERROR);
        }
    }

    /// After a step of h whose error is too large, infinite or NaN.
    pub fn reject(&mut self, h: f64, error: f64) {
        let ratio = SAFETY / error.powf(ALPHA);
        // A NaN compares false, and gives the least ratio.
        self.proposal = Some(h * if ratio > RATIO[0] { ratio } else { RATIO[0] });
        self.rejected = true;
    }
}
