//! Step size control from the errors of the last steps.

/// The tolerated local error of an adaptive step: absolute + relative · |x| for each entry of the
/// state, in the root mean square over the entries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Tolerated error relative to |x|, dimensionless, not negative.
    pub relative: f64,
    /// Tolerated absolute error in the units of x, positive, the same for all entries.
    pub absolute: f64,
}

impl Default for Tolerance {
    /// Returns 1e-8 for both.
    fn default() -> Self {
        Self { relative: 1e-8, absolute: 1e-8 }
    }
}

impl Tolerance {
    /// Returns the root mean square of `error` over the tolerated error at the larger of two
    /// states. A step is accepted where it is at most 1.
    pub(crate) fn norm(&self, error: impl Iterator<Item = f64>, from: &[f64], to: &[f64]) -> f64 {
        let tolerated =
            from.iter().zip(to).map(|(a, b)| self.absolute + self.relative * a.abs().max(b.abs()));
        let sum: f64 = error.zip(tolerated).map(|(e, s)| (e / s) * (e / s)).sum();
        (sum / from.len().max(1) as f64).sqrt()
    }
}

/// Proportional-integral control of the step size (Gustafsson, ACM TOMS 17, 1991), with the
/// constants of the code DOPRI5 (Hairer & Wanner, Solving Ordinary Differential Equations II, 1996,
/// sec. IV.2).
#[derive(Clone, Debug)]
pub(crate) struct StepControl {
    /// Size of the next attempt \[s\]; `None` before the first step.
    pub proposal: Option<f64>,
    /// Error of the last accepted step, at least [`MIN_ERROR`].
    previous_error: f64,
    /// Whether the last attempt was rejected.
    rejected: bool,
}

const SAFETY: f64 = 0.9;
/// Exponent of the error of the previous step.
const BETA: f64 = 0.04;
/// Exponent of the error of the step.
const ALPHA: f64 = 0.2 - 0.75 * BETA;
/// Smallest and largest ratio of a step size to the previous one.
const RATIO: [f64; 2] = [0.2, 10.0];
/// Lower limit of the stored error. Smaller errors do not predict the next one.
const MIN_ERROR: f64 = 1e-4;

impl StepControl {
    /// Returns the control before the first step.
    pub(crate) fn new() -> Self {
        Self { proposal: None, previous_error: MIN_ERROR, rejected: false }
    }

    /// Proposes the next step size after a step of size h \[s\] with an error of at most 1.
    ///
    /// A `shortened` step, which ends at the end of the span, does not reduce a longer proposal.
    pub(crate) fn accept(&mut self, h: f64, error: f64, shortened: bool) {
        let ratio = SAFETY * self.previous_error.powf(BETA) / error.powf(ALPHA);
        let max_ratio = if self.rejected { 1.0 } else { RATIO[1] };
        let next = h * ratio.clamp(RATIO[0], max_ratio);
        self.rejected = false;
        if shortened {
            self.proposal = Some(self.proposal.map_or(next, |p| p.max(next)));
        } else {
            self.proposal = Some(next);
            self.previous_error = error.max(MIN_ERROR);
        }
    }

    /// Proposes a smaller step size after a step of size h \[s\] with an error above 1, or NaN.
    pub(crate) fn reject(&mut self, h: f64, error: f64) {
        let ratio = SAFETY / error.powf(ALPHA);
        // A NaN compares false and gives the smallest ratio.
        self.proposal = Some(h * if ratio > RATIO[0] { ratio } else { RATIO[0] });
        self.rejected = true;
    }
}
