/// How long the time between two samples may be.
///
/// The input is taken as held until the next sample, so a gap is a guess about the input.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum GapLimit {
    /// 1.9 times the usual time between samples at a fixed rate, 10 times where the times jitter.
    #[default]
    Usual,
    /// As many seconds as given.
    Seconds(f64),
}
