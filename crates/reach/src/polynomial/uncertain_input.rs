use reachtube_scalar::Interval;

use crate::sets::hyperrectangle::Hyperrectangle;

/// An uncertain input u(t) ∈ u_m(t) + U: a measured input, held from sample to sample, and a set
/// that contains its error at every time.
#[derive(Debug, Clone, Copy)]
pub struct UncertainInput<'a> {
    /// Measured input u_m, row-major, one row of m entries per sample.
    ///
    /// A row holds until the next sample. The row of the last sample has no effect and may be
    /// missing.
    pub measured: &'a [f64],
    /// U, m dimensions; the error of the input is any measurable function with values in U.
    pub set: &'a Hyperrectangle,
}

impl UncertainInput<'_> {
    /// Writes the range of each input over step k to `out`, m intervals.
    pub(crate) fn over_step(&self, k: usize, out: &mut [Interval]) {
        let m = out.len();
        for (j, out) in out.iter_mut().enumerate() {
            let centre = Interval::point(self.measured[k * m + j]) + self.set.centre[j];
            *out = centre + Interval::centred(0.0, self.set.radius[j]);
        }
    }
}
