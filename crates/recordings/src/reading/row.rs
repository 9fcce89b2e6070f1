//! A row of text that holds numbers and separators alone, read byte by byte.

use super::digits::Decimal;
use super::number::number;
use crate::decimal::picoseconds;

/// The fields that are read from a line.
pub(super) struct Row {
    /// For each field of the header, whether it is read.
    is_read: Vec<bool>,
    separator: u8,
    /// The field with the time.
    time_at: usize,
    /// The values of the fields that are read, in their order.
    pub values: Vec<f64>,
    /// The time among them, in units of 1e-12 of its unit.
    pub time: i128,
}

impl Row {
    /// Prepares a row of `fields` fields, of which `columns` are read, and `time_at` among them.
    pub(super) fn new(fields: usize, columns: &[usize], time_at: usize, separator: u8) -> Self {
        let mut is_read = vec![false; fields];
        columns.iter().for_each(|column| is_read[*column] = true);
        Self { is_read, separator, time_at, values: vec![0.0; columns.len()], time: 0 }
    }

    pub(super) fn fields(&self) -> usize {
        self.is_read.len()
    }

    /// Reads the line at the start of `text`, and returns its length with its end. `None` if one of
    /// the fields that are read is no finite number, or the line is otherwise than its header: with
    /// quotes, spaces, or more or fewer fields.
    pub(super) fn read(&mut self, text: &[u8]) -> Option<usize> {
        let (last, separator) = (self.is_read.len() - 1, self.separator);
        let mut values = self.values.iter_mut();
        let mut rest = text;
        for (column, is_read) in self.is_read.iter().enumerate() {
            let length = match (*is_read).then(|| values.next()).flatten() {
                None => field(rest, separator).len(),
                Some(value) => match Decimal::leading(rest) {
                    Some(short) if ends(rest, short.length, separator) => {
                        *value = short.value();
                        if column == self.time_at {
                            self.time = short.picoseconds()?;
                        }
                        short.length
                    }
                    _ => {
                        let field = field(rest, separator);
                        *value = number(field)?;
                        if column == self.time_at {
                            self.time = time(field, *value);
                        }
                        field.len()
                    }
                },
            };
            rest = &rest[length..];
            rest = match (column == last, rest) {
                (false, [end, rest @ ..]) if *end == separator => rest,
                (true, [b'\n', rest @ ..] | [b'\r', b'\n', rest @ ..] | rest @ []) => rest,
                _ => return None,
            };
        }
        Some(text.len() - rest.len())
    }
}

/// Returns the time that a field holds, whose value is known, in units of 1e-12 of its unit.
pub(super) fn time(field: &[u8], value: f64) -> i128 {
    let text = str::from_utf8(field).unwrap_or_default();
    picoseconds(text).unwrap_or((value * 1e12) as i128)
}

fn field(text: &[u8], separator: u8) -> &[u8] {
    let is_end = |byte: &u8| *byte == separator || matches!(byte, b'\n' | b'\r' | b'"');
    let end = text.iter().position(is_end);
    &text[..end.unwrap_or(text.len())]
}

#[inline]
fn ends(text: &[u8], at: usize, separator: u8) -> bool {
    text.get(at).is_none_or(|byte| *byte == separator || matches!(byte, b'\n' | b'\r'))
}

#[cfg(test)]
mod tests {
    use super::Row;

    /// Reads the first, second and fourth field of a line of four.
    fn read(text: &str) -> Option<(usize, Vec<f64>, i128)> {
        let mut row = Row::new(4, &[0, 1, 3], 0, b',');
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
    fn other_separators_and_places_of_the_time_are_read() {
        let mut row = Row::new(3, &[0, 2], 2, b';');
        assert_eq!(row.read(b"-1.5;a,b;0.25\n"), Some(14));
        assert_eq!((row.values, row.time), (vec![-1.5, 0.25], 250_000_000_000));
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
