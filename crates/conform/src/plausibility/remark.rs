use crate::result::code::Code;

/// What is remarked of one part.
#[derive(Debug, Clone, PartialEq)]
pub struct Remark {
    /// What it is about.
    pub code: Code,
    /// The part, from 1.
    pub part: usize,
    /// The state or part with its sizes.
    pub text: String,
}
