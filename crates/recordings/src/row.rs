//! A row of CSV text that holds numbers and commas alone, read byte by byte.

use crate::decimal::picoseconds;
use crate::digits::Decimal;
use crate::lines::number;

/// What is read of a line.
pub(crate) struct Row {
    /// For each field of the header, whether it is read.
    is_read: Vec<bool>,
    /// The values of the fields that are read.
    pub values: Vec<f64>,
    /// The first of them, the time, in picoseconds.
    pub time: i128,
}

impl Row {
    /// Prepares a row of `fields` fields, of which `columns` are read, the first one among them.
    pub(crate) fn new(fields: usize, columns: &[usize]) -> Self {
        let mut is_read = vec![false; fields];
        columns.iter().for_each(|column| is_read[*column] = true);
        Self { is_read, values: vec![0.0; columns.len()], time: 0 }
    }

    /// Returns the number of fields of the header.
    pub(crate) fn fields(&self) -> usize {
        self.is_read.len()
    }

    /// Returns the columns that are read, in their order.
    pub(crate) fn columns(&self) -> impl Iterator<Item = usize> {
        (0..self.is_read.len()).filter(|column| self.is_read[*column])
    }

    /// Reads the line at the start of `text`, and returns its length with its end. `None` if one of
    /// the fields that are read is no finite number, or the line is otherwise than its header: with
    /// quotes, spaces, or more or fewer fields.
    pub(crate) fn read(&mut self, text: &[u8]) -> Option<usize> {
        let last = self.is_read.len() - 1;
        let mut values = self.values.iter_mut();
        let mut rest = text;
        for (column, is_read) in self.is_read.iter().enumerate() {
            let length = match (*is_read).then(|| values.next()).flatten() {
                None => field(rest).len(),
                Some(value) => match Decimal::leading(rest) {
                    Some(short) if ends(rest, short.length) => {
                        *value = short.value();
                        if column == 0 {
                            self.time = short.picoseconds()?;
                        }
                        short.length
                    }
                    _ => {
                        let field = field(rest);
                        *value = number(field)?;
                        if column == 0 {
                            self.time = time(field, *value);
                        }
                        field.len()
                    }
                },
            };
            rest = &rest[length..];
            rest = match (column == last, rest) {
                (false, [b',', rest @ ..])
                | (true, [b'\n', rest @ ..] | [b'\r', b'\n', rest @ ..] | rest @ []) => rest,
                _ => return None,
            };
        }
        Some(text.len() - rest.len())
    }
}

/// Returns the time that a field holds, whose value is known, in picoseconds.
pub(crate) fn time(field: &[u8], value: f64) -> i128 {
    let text = str::from_utf8(field).unwrap_or_default();
    picoseconds(text).unwrap_or((value * 1e12) as i128)
}

/// Returns the field at the start of some text.
pub(crate) fn field(text: &[u8]) -> &[u8] {
    let end = text.iter().position(|byte| matches!(byte, b',' | b'\n' | b'\r' | b'"'));
    &text[..end.unwrap_or(text.len())]
}

/// Returns whether a field ends at byte `at`.
#[inline]
fn ends(text: &[u8], at: usize) -> bool {
    text.get(at).is_none_or(|byte| matches!(byte, b',' | b'\n' | b'\r'))
}

#[cfg(test)]
mod tests {
    use super::Row;

    /// Reads the first, second and fourth field of a line of four.
    fn read(text: &str) -> Option<(usize, Vec<f64>, i128)> {
        let mut row = Row::new(4, &[0, 1, 3]);
        let length = row.read(text.as_bytes())?;
        Some((length, row.values, row.time))
    }

    #[test]
    fn fields_of_the_columns_are_read_up_to_the_end_of_the_line() {
        let expected = |length| Some((length, vec![0.004, -1.5, 2.0], 4_000_000_000));
        assert_eq!(read("0.004,-1.5,any text,2\n1"), expected(22));
        assert_eq!(read("0.004,-1.5,,2\r\n"), expected(15));
        assert_eq!(read("4e-3,-15e-1,0,2.0000000000000000000"), expected(35));
    }

    #[test]
    fn lines_that_differ_from_the_header_are_left_to_others() {
        let lines = ["", "\n", "0,1,2\n", "0,1,2,3,4\n", "0,1,2,x\n", "0,,2,3\n", "0,nan,2,3\n"];
        let quoted = ["0, 1,2,3\n", "0,1,\"2\",3\n", "0,1,2,3\r4", "0,1,\"a\n\",3\n"];
        for text in lines.into_iter().chain(quoted) {
            assert_eq!(read(text), None, "{text}");
        }
    }
}
