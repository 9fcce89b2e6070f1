//! Dense output: the solution inside an accepted step.

use crate::tableau::{INTERPOLANT_WEIGHTS, weighted_sum};

/// An accepted step, with the solution inside it.
#[derive(Clone, Copy, Debug)]
pub struct DenseStep<'a> {
    /// Time at the start \[s\].
    pub(crate) start: f64,
    /// Time at the end \[s\].
    pub(crate) end: f64,
    /// Step size \[s\].
    pub(crate) size: f64,
    /// State at the start (n).
    pub(crate) before: &'a [f64],
    /// State at the end (n).
    pub(crate) after: &'a [f64],
    /// Slopes of the stages (n each).
    pub(crate) slopes: &'a [Vec<f64>; 7],
}

impl DenseStep<'_> {
    /// Returns the time at the start of the step \[s\].
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Returns the time at the end of the step \[s\].
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Writes the solution (n) at a time \[s\] inside the step into `x`, by an interpolant of order
    /// 4 (Hairer, Nørsett & Wanner, sec. II.6).
    pub fn at(&self, time: f64, x: &mut [f64]) {
        let h = self.size;
        let theta = (time - self.start) / h;
        let rest = 1.0 - theta;
        for (i, x) in x.iter_mut().enumerate() {
            let change = self.after[i] - self.before[i];
            let second = h * self.slopes[0][i] - change;
            let third = change - h * self.slopes[6][i] - second;
            let fourth = h * weighted_sum(&INTERPOLANT_WEIGHTS, self.slopes, i);
            *x = self.before[i]
                + theta * (change + rest * (second + theta * (third + rest * fourth)));
        }
    }
}
