use reachtube_recordings::State;

/// A nominal motion that leaves every bound, without any disturbance.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Runaway {
    /// The suite or run.
    pub case: String,
    /// The last sample it could be followed to.
    pub sample: usize,
    /// The time of this sample, s.
    pub time: f64,
    /// The state that is furthest away at the next sample.
    pub state: State,
}
