/// One run: where it starts, and the input it is driven by, held from sample to sample.
///
/// Runs that share a start or inputs borrow the same slice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run<'a> {
    /// x at the first sample (n).
    pub start: &'a [f64],
    /// Row-major, m a row, one row for each sample but the last: row k acts from sample k to sample
    /// k + 1. Empty where there is no input.
    pub inputs: &'a [f64],
}

impl<'a> Run<'a> {
    /// m, over samples at `times`.
    pub(crate) fn input_dimension(&self, times: &[f64]) -> usize {
        let (spans, numbers) = (times.len().saturating_sub(1).max(1), self.inputs.len());
        assert_eq!(
            numbers % spans,
            0,
            "{numbers} numbers are no input for each of {spans} spans between samples"
        );
        numbers / spans
    }

    /// The input (m) from sample k on.
    pub(crate) fn input(&self, k: usize, m: usize) -> &'a [f64] {
        &self.inputs[k * m..(k + 1) * m]
    }
}
