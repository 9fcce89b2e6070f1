/// One run: its start and its input, which is held from sample to sample.
///
/// Runs with the same start or inputs can borrow the same slice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialValueProblem<'a> {
    /// State x at the first sample (n).
    pub start: &'a [f64],
    /// Inputs u, row-major, with one row of m entries per sample except the last. Row k acts from
    /// sample k to sample k + 1. It is empty if there is no input.
    pub inputs: &'a [f64],
}

impl<'a> InitialValueProblem<'a> {
    /// Returns the input dimension m for samples at `times`.
    ///
    /// # Panics
    ///
    /// Panics if the inputs do not form one row per span between samples.
    pub(crate) fn input_dimension(&self, times: &[f64]) -> usize {
        let (spans, entries) = (times.len().saturating_sub(1).max(1), self.inputs.len());
        assert_eq!(
            entries % spans,
            0,
            "{entries} input entries do not form one row for each of {spans} spans between samples"
        );
        entries / spans
    }

    /// Returns the input (m) that acts from sample k to sample k + 1.
    pub(crate) fn input(&self, k: usize, m: usize) -> &'a [f64] {
        &self.inputs[k * m..(k + 1) * m]
    }
}
