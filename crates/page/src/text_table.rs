//! Tables of text.

use schemars::JsonSchema;
use serde::Serialize;

/// A table of texts: the first column names the row.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct TextTable {
    /// What the table shows.
    pub title: String,
    /// The names of the columns.
    pub header: Vec<String>,
    /// The rows, each as long as the header.
    pub rows: Vec<Vec<String>>,
}

/// Returns by how much a value differs from a reference, in percent with its sign.
pub(super) fn change(value: f64, reference: f64) -> String {
    // The sum with 0 turns a negative zero into a positive one.
    let tenths = (1e3 * (value / reference - 1.0)).round() + 0.0;
    format!("{:+.1} %", tenths / 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_that_rounds_to_zero_is_not_negative() {
        let changes = [0.99999, 1.0, 1.00001, 0.9994, 1.25].map(|value| change(value, 1.0));
        assert_eq!(changes, ["+0.0 %", "+0.0 %", "+0.0 %", "-0.1 %", "+25.0 %"]);
    }
}
