//! Columns that settings name by `NAME_{}`.

use super::joints::Column;

/// Returns the columns whose names are `pattern` with a number in place of `{}`, in the order of
/// the numbers, which follow one another from `first` on, or from 0 or 1. A pattern without `{}` is
/// the name of one column.
pub(super) fn by_pattern(columns: &[Column], pattern: &str, first: Option<usize>) -> Vec<Column> {
    let Some((before, after)) = pattern.split_once("{}") else {
        return columns.iter().filter(|column| column.text == pattern).cloned().collect();
    };
    let number = |column: &Column| -> Option<usize> {
        column.text.strip_prefix(before)?.strip_suffix(after)?.parse().ok()
    };
    let column = |wanted: usize| columns.iter().find(|column| number(column) == Some(wanted));
    let first = first.unwrap_or_else(|| usize::from(column(0).is_none()));
    (first..).map_while(column).cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logged::name::ColumnName;

    #[test]
    fn numbers_stand_in_place_of_the_braces() {
        let names = ["m2_pos", "m1_pos", "m3_pos", "m5_pos", "other"];
        let column = |(at, text): (usize, &&str)| Column {
            file: 0,
            at,
            text: (*text).into(),
            name: ColumnName::new(text),
        };
        let columns: Vec<Column> = names.iter().enumerate().map(column).collect();
        let found = |pattern, first| -> Vec<usize> {
            by_pattern(&columns, pattern, first).iter().map(|column| column.at).collect()
        };
        assert_eq!(found("m{}_pos", None), [1, 0, 2]);
        assert_eq!(found("m{}_pos", Some(5)), [3]);
        assert_eq!(found("m{}_pos", Some(0)), [0; 0]);
        assert_eq!(found("other", None), [4]);
    }
}
