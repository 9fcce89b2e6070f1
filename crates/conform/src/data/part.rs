/// A part of a system: a joint of an arm, whose states are its position and its velocity.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Part {
    /// Its states, by their indices.
    pub states: Vec<usize>,
}
