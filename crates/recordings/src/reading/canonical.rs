//! Recordings with the header `t,q1..qn,qd1..qdn,tau1..taun`, in s, rad, rad/s and N m.

use std::path::Path;

use reachtube_files::hex;
use sha2::{Digest, Sha256};

use super::content::{Content, content};
use super::dialect::Dialect;
use super::name::Quantity;
use super::table::{ReadColumn, Table};
use super::time_column::TimeColumns;
use super::unit::TimeUnit;
use crate::defect::{Defect, DefectKind};
use crate::run::{Run, column_names};
use crate::source::ReadOptions;
use crate::text::quoted;

const HEADER: &str = "the header must be t,q1..qn,qd1..qdn,tau1..taun, in s, rad, rad/s and N m \
                      (m, m/s and N for a prismatic joint)";

const TEMPERATURES: &str = "give one temperature per joint, temp1..tempn in °C, one after another, \
                            or give the column another name";

/// Temperatures that a joint can have, °C. Values in kelvin are beyond them.
const JOINT_TEMPERATURES: [f64; 2] = [-100.0, 250.0];

/// Largest number of joints of a recording; a header with more is a mistake.
const MOST_JOINTS: usize = 100;

/// Reads the recording in the file `path`.
///
/// # Errors
///
/// Every defect of the file, with its line and joint.
pub fn read_csv(path: &Path, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
    let Content { text, digest, .. } = content(path)?;
    parse(path, &text, digest, options)
}

/// Reads the recording in the content of a CSV file, which messages call `name`.
///
/// # Errors
///
/// Every defect of the content, with its line and joint.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::{ReadOptions, parse_csv};
///
/// let content = b"t,q1,qd1,tau1\n0.0,0.1,0.0,2.0\n0.1,0.1,0.0,2.0\n";
/// let run = parse_csv("run.csv".as_ref(), content, &ReadOptions::default()).unwrap();
/// assert_eq!((run.joints, run.len()), (1, 2));
/// ```
pub fn parse_csv(name: &Path, content: &[u8], options: &ReadOptions) -> Result<Run, Vec<Defect>> {
    parse(name, content, Sha256::new_with_prefix(content), options)
}

fn parse(
    name: &Path,
    text: &[u8],
    digest: Sha256,
    options: &ReadOptions,
) -> Result<Run, Vec<Defect>> {
    let dialect = Dialect::of(name, text).map_err(|defect| vec![*defect])?;
    let (mut run, _) = recording(name, text, &dialect, (&[], None), options)?;
    run.sha256 = hex(&digest.finalize());
    run.truncate(options.until);
    Ok(run)
}

/// Returns whether a header starts with `t,q1..qn,qd1..qdn,tau1..taun`.
pub(super) fn is_recording(dialect: &Dialect) -> bool {
    let names = &dialect.names;
    let n = joints_of(names);
    n > 0 && !dialect.is_comment && dialect.separator == b',' && first_wrong(names, n).is_none()
}

/// Reads a whole recording, of which joint i of the result is joint `places[i]` of the file, from
/// 0; without places, all are in the order of the file. Positions must lie within `limits`, if they
/// are given. The SHA-256 of the result is empty.
pub(super) fn recording(
    path: &Path,
    bytes: &[u8],
    dialect: &Dialect,
    (places, limits): (&[usize], Option<[f64; 2]>),
    options: &ReadOptions,
) -> Result<(Run, Table), Vec<Defect>> {
    let (n, temperatures) = joints(dialect, options.joints).map_err(|wrong| {
        let Wrong(kind, problem, remedy) = *wrong;
        vec![Defect::new(path, Some(dialect.line), problem, remedy).of_kind(kind)]
    })?;
    let time = TimeColumns {
        at: 0,
        nanoseconds: None,
        unit: Some(TimeUnit::Seconds),
        name: dialect.names[0].clone(),
    };
    let columns = columns(dialect, n, temperatures, limits);
    let (table, mut defects) = Table::read(path, bytes, dialect, &time, columns);
    defects.extend(table.gaps(path, 1, options.gap_limit));
    if !defects.is_empty() {
        defects.sort_by_key(|defect| defect.line);
        return Err(defects);
    }
    let in_order: Vec<usize> = (0..n).collect();
    let places = if places.is_empty() { &in_order } else { places };
    let from = |first: usize| places.iter().map(move |place| first + place);
    let states: Vec<usize> = from(1).chain(from(1 + n)).collect();
    let values = |columns: Vec<usize>| table.values(&columns);
    let run = Run {
        joints: n,
        start: table.first().unwrap_or_default(),
        times: table.seconds(1),
        states: values(states),
        torques: values(from(1 + 2 * n).collect()),
        temperatures: temperatures.map_or(vec![], |first| values(from(first).collect())),
        before: vec![],
        sha256: String::new(),
    };
    Ok((run, table))
}

/// What is wrong with a header: its kind, the problem and the remedy.
struct Wrong(DefectKind, String, &'static str);

/// Returns the number of joints of a header, and the column of the first of n temperatures, if
/// `temp1` is among the columns after the torques.
fn joints(
    dialect: &Dialect,
    expected: Option<usize>,
) -> Result<(usize, Option<usize>), Box<Wrong>> {
    let names = &dialect.names;
    let wrong = |kind, problem, remedy| Err(Box::new(Wrong(kind, problem, remedy)));
    if dialect.separator != b',' {
        let problem = format!("the columns are separated by {:?}", char::from(dialect.separator));
        let remedy = "separate them by commas, and write numbers with a decimal point";
        return wrong(DefectKind::File, problem, remedy);
    }
    if dialect.is_comment {
        return wrong(DefectKind::Header, "the header is a comment".into(), HEADER);
    }
    let n = joints_of(names);
    if n > MOST_JOINTS {
        let problem = format!("the header has {n} joints, but at most {MOST_JOINTS} are read");
        return wrong(DefectKind::Header, problem, HEADER);
    }
    let differs = |at: usize, expected: &str| {
        let found = names.get(at).map_or("missing".into(), |found| quoted(found));
        format!("column {} of the header is {found}, expected \"{expected}\"", at + 1)
    };
    if let Some((at, name)) = first_wrong(names, n.max(1)) {
        return wrong(DefectKind::Header, differs(at, &name), HEADER);
    }
    if let Some(robot) = expected.filter(|robot| *robot != n) {
        let problem = format!("the recording has {n} joints, but the robot has {robot}");
        let remedy = "give the robot that was recorded, or the right data set";
        return wrong(DefectKind::Joints, problem, remedy);
    }
    let first = names.iter().position(|name| name == "temp1");
    let missing = first.and_then(|first| {
        let mut expected = (first..).zip((1..=n).map(|joint| format!("temp{joint}")));
        expected.find(|(at, name)| names.get(*at) != Some(name))
    });
    match missing {
        Some((at, name)) => wrong(DefectKind::Header, differs(at, &name), TEMPERATURES),
        None => Ok((n, first)),
    }
}

fn joints_of(names: &[String]) -> usize {
    let is_position = |name: &&String| {
        let number = name.strip_prefix('q').unwrap_or_default();
        !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
    };
    names.iter().skip(1).take_while(is_position).count()
}

/// Returns the first column that is not as expected for n joints, and its expected name.
fn first_wrong(names: &[String], n: usize) -> Option<(usize, String)> {
    let mut expected = std::iter::once("t".into()).chain(column_names(n)).enumerate();
    expected.find(|(at, name)| names.get(*at) != Some(name))
}

fn columns(
    dialect: &Dialect,
    n: usize,
    temperatures: Option<usize>,
    limits: Option<[f64; 2]>,
) -> Vec<ReadColumn<'_>> {
    let column = |at: usize, joint: usize, quantity: Quantity| ReadColumn {
        at,
        name: dialect.names[at].as_str().into(),
        joint: Some(joint).filter(|joint| *joint > 0),
        quantity,
        limits: match quantity {
            Quantity::Position => limits,
            Quantity::Temperature => Some(JOINT_TEMPERATURES),
            _ => None,
        },
    };
    let mut columns = vec![column(0, 0, Quantity::Time)];
    let firsts = [
        (Some(1), Quantity::Position),
        (Some(1 + n), Quantity::Velocity),
        (Some(1 + 2 * n), Quantity::Torque),
        (temperatures, Quantity::Temperature),
    ];
    for (first, quantity) in firsts {
        let first = first.into_iter().flat_map(|first| (first..first + n).zip(1..));
        columns.extend(first.map(|(at, joint)| column(at, joint, quantity)));
    }
    columns
}
