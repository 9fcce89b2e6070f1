//! The numbers of a Parquet file as text, which the reader of logs reads like any other.

use std::collections::BTreeMap;
use std::path::Path;

use parquet::basic::{ConvertedType, LogicalType, TimeUnit};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use serde_json::Value;

/// Names of the levels of a list, which are no part of a column's name.
const LEVELS: [&str; 5] = ["list", "element", "item", "array", "bag"];

/// Most numbers of a file: a small one can claim to hold any number of them.
const MOST_NUMBERS: i64 = 1 << 26;

/// Most values of a list that become columns: longer ones are images.
const LONGEST: usize = 1000;

/// The names that other files give to the values of lists, by the names of their columns.
type ListNames = BTreeMap<String, Vec<String>>;

/// The numbers of a column, row-major rows x width.
struct NumberColumn {
    name: String,
    /// Values of each row: 1, or the length of lists, which are equally long.
    width: usize,
    is_list: bool,
    values: Vec<Number>,
}

#[derive(Clone, Copy)]
enum Number {
    Float(f64),
    /// Counts of nanoseconds since 1970 have more digits than [`f64`].
    Integer(i64),
    Missing,
}

/// Returns the columns of numbers as text with commas. Lists of one length give a column for each
/// value, with the name that LeRobot's `info.json` beside the file, or in `meta` above it, has for
/// it. Other columns are left out. Notes name columns of numbers that are left out, and names that
/// are not used.
pub(super) fn text_of(path: &Path, bytes: Vec<u8>) -> Result<(Vec<u8>, Vec<String>), ParquetError> {
    let reader = SerializedFileReader::new(bytes::Bytes::from(bytes))?;
    let groups = reader.metadata().row_groups().iter();
    let held: i64 = groups.flat_map(|group| group.columns()).map(|of| of.num_values()).sum();
    if held > MOST_NUMBERS {
        return Err(ParquetError::General(format!("it has more than {MOST_NUMBERS} numbers")));
    }
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let (mut columns, mut left_out) = (Vec::new(), Vec::new());
    for (at, of) in schema.columns().iter().enumerate() {
        match numbers(&reader, at, of)? {
            ReadNumbers::Column(column) => columns.push(column),
            ReadNumbers::LeftOut(name) => left_out.push(name),
            ReadNumbers::None => {}
        }
    }
    let mut notes = Vec::new();
    if !left_out.is_empty() {
        notes.push(format!(
            "{}: {} have decimals, unsigned numbers, or lists that are long, nested or of several \
             lengths, and are left out",
            path.display(),
            left_out.join(", ")
        ));
    }
    let names = list_names(path).unwrap_or_else(|problem| {
        notes.push(format!("{problem}; the values of lists have numbers"));
        None
    });
    // LeRobot's times are in s.
    let of_time = columns.iter_mut().find(|of| names.is_some() && of.name == "timestamp");
    of_time.into_iter().for_each(|of| of.name += " [s]");
    let names = names.unwrap_or_default();
    let header: Vec<String> = columns.iter().flat_map(|column| column.header(&names)).collect();
    let mut text = header.join(",").into_bytes();
    text.push(b'\n');
    let rows = columns.first().map_or(0, NumberColumn::rows);
    if let Some(other) = columns.iter().find(|of| of.rows() != rows) {
        let problem = format!("{} rows of {} stand beside {rows}", other.rows(), other.name);
        return Err(ParquetError::General(problem));
    }
    for row in 0..rows {
        let of_row =
            columns.iter().flat_map(|of| of.values[row * of.width..].iter().take(of.width));
        of_row.for_each(|value| value.write(&mut text));
        text.pop();
        text.push(b'\n');
    }
    Ok((text, notes))
}

impl NumberColumn {
    fn rows(&self) -> usize {
        self.values.len() / self.width
    }

    fn header(&self, names: &ListNames) -> Vec<String> {
        // A separator or a quote in a name would divide the header elsewhere.
        let plain = |name: String| name.replace([',', ';', '\t', '"', '\n', '\r'], " ");
        let known = names.get(&self.name).filter(|names| names.len() == self.width);
        let of = |at: usize| match known {
            Some(names) => format!("{}_{}", self.name, names[at]),
            None => format!("{}_{at}", self.name),
        };
        match self.is_list {
            true => (0..self.width).map(|at| plain(of(at))).collect(),
            false => vec![plain(self.name.clone())],
        }
    }
}

impl Number {
    fn write(self, text: &mut Vec<u8>) {
        text.extend(match self {
            Self::Float(value) => format!("{value},").into_bytes(),
            Self::Integer(value) => format!("{value},").into_bytes(),
            Self::Missing => b",".to_vec(),
        });
    }
}

/// What a column has.
enum ReadNumbers {
    Column(NumberColumn),
    /// Numbers that are not read; the name of the column.
    LeftOut(String),
    None,
}

fn numbers<R: FileReader>(
    reader: &R,
    at: usize,
    of: &ColumnDescriptor,
) -> Result<ReadNumbers, ParquetError> {
    let parts = of.path().parts().iter();
    let parts: Vec<&str> = parts.map(String::as_str).filter(|p| !LEVELS.contains(p)).collect();
    let name = parts.join(".") + unit_of(of);
    let is_other = matches!(of.converted_type(), ConvertedType::DECIMAL | ConvertedType::UINT_64);
    if is_other || of.max_rep_level() > 1 {
        return Ok(ReadNumbers::LeftOut(name));
    }
    let (mut values, mut lengths) = (Vec::new(), Vec::new());
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let rows = group.metadata().num_rows().try_into().unwrap_or_default();
        match group.get_column_reader(at)? {
            ColumnReader::Int32ColumnReader(column) => {
                read(column, of, rows, |v| Number::Integer(v.into()), &mut values, &mut lengths)?;
            }
            ColumnReader::Int64ColumnReader(column) => {
                read(column, of, rows, Number::Integer, &mut values, &mut lengths)?;
            }
            ColumnReader::FloatColumnReader(column) => {
                read(column, of, rows, |v| Number::Float(v.into()), &mut values, &mut lengths)?;
            }
            ColumnReader::DoubleColumnReader(column) => {
                read(column, of, rows, Number::Float, &mut values, &mut lengths)?;
            }
            _ => return Ok(ReadNumbers::None),
        }
    }
    let width = lengths.first().copied().unwrap_or(1);
    if width > LONGEST || lengths.iter().any(|length| *length != width) {
        return Ok(ReadNumbers::LeftOut(name));
    }
    let is_list = of.max_rep_level() > 0;
    Ok(ReadNumbers::Column(NumberColumn { name, width, is_list, values }))
}

/// Reads the rows of a column in one group of rows, and the number of values of each.
fn read<T: DataType>(
    mut column: ColumnReaderImpl<T>,
    of: &ColumnDescriptor,
    rows: usize,
    number: impl Fn(T::T) -> Number,
    values: &mut Vec<Number>,
    lengths: &mut Vec<usize>,
) -> Result<(), ParquetError>
where
    T::T: Copy,
{
    let (mut defined, mut repeated, mut present) = (Vec::new(), Vec::new(), Vec::new());
    let (records, _, levels) =
        column.read_records(rows, Some(&mut defined), Some(&mut repeated), &mut present)?;
    if records != rows {
        let problem = format!("{records} rows of {} stand in place of {rows}", of.name());
        return Err(ParquetError::General(problem));
    }
    let mut present = present.into_iter();
    for level in 0..levels {
        let is_defined = defined.get(level).is_none_or(|of_it| *of_it == of.max_def_level());
        let value = is_defined.then(|| present.next()).flatten();
        values.push(value.map_or(Number::Missing, &number));
        match repeated.get(level) {
            Some(1..) => *lengths.last_mut().unwrap_or(&mut 0) += 1,
            _ => lengths.push(1),
        }
    }
    Ok(())
}

/// Returns the unit of a column of times, as it stands in the names of columns.
fn unit_of(of: &ColumnDescriptor) -> &'static str {
    match of.logical_type_ref() {
        Some(LogicalType::Timestamp(time)) => match time.unit {
            TimeUnit::MILLIS => " [ms]",
            TimeUnit::MICROS => " [us]",
            TimeUnit::NANOS => " [ns]",
        },
        _ => "",
    }
}

/// Returns the names of the values of lists, if the file belongs to data that LeRobot describes.
fn list_names(path: &Path) -> Result<Option<ListNames>, String> {
    let path = &std::path::absolute(path).unwrap_or_else(|_| path.into());
    let above = path.ancestors().skip(1).take(4).map(|folder| folder.join("meta/info.json"));
    let mut places = std::iter::once(path.with_file_name("info.json")).chain(above);
    let Some(place) = places.find(|place| place.is_file()) else { return Ok(None) };
    let problem = |problem: String| format!("{}: {problem}", place.display());
    let text = reachtube_files::bytes(&place).map_err(|error| problem(error.to_string()))?;
    let info: Value = serde_json::from_slice(&text).map_err(|error| problem(error.to_string()))?;
    let features = info.get("features").and_then(Value::as_object);
    let named = |(name, of): (&String, &Value)| {
        let mut names = Vec::new();
        texts(of.get("names")?, &mut names).then_some((name.clone(), names))
    };
    Ok(features.map(|features| features.iter().filter_map(named).collect()))
}

/// Adds all texts in a value, which may be nested. Returns false if their order is unknown: of an
/// object with several keys.
fn texts(value: &Value, found: &mut Vec<String>) -> bool {
    match value {
        Value::String(text) => {
            found.push(text.clone());
            true
        }
        Value::Array(all) => all.iter().all(|value| texts(value, found)),
        Value::Object(all) => all.len() == 1 && all.values().all(|value| texts(value, found)),
        _ => true,
    }
}
