//! Bad recordings and indices.

use super::{CHECK, CONFORM, Case, INSPECT};
use crate::fixture::{Lab, cell, set_cell};

fn lines(lab: &Lab, change: impl FnOnce(&mut Vec<String>)) {
    lab.edit("data/A_2.csv", change);
}

fn index(lab: &Lab, change: impl FnOnce(&mut Vec<String>)) {
    lab.edit("data/runs.csv", change);
}

/// Replaces a column of A_2.csv, but for its header.
fn column(lab: &Lab, column: usize, new: impl Fn(f64) -> f64) {
    lines(lab, |lines| {
        for line in &mut lines[1..] {
            let value = format!("{:?}", new(cell(line, column)));
            set_cell(line, column, &value);
        }
    });
}

/// Returns a case that `conform` refuses.
const fn refused(what: &'static str, spoil: fn(&Lab), words: &'static [&'static str]) -> Case {
    Case::refused(what, spoil, CONFORM, words)
}

pub(super) const CASES: &[Case] = &[
    refused(
        "a value that is no number",
        |lab| lines(lab, |l| set_cell(&mut l[9], 3, "NaN")),
        &["data/A_2.csv:10: joint 1: qd1 is \"NaN\", not a finite number", "record again"],
    ),
    refused(
        "an infinite value",
        |lab| lines(lab, |l| set_cell(&mut l[9], 1, "1e999")),
        &["data/A_2.csv:10: joint 1: q1 is \"1e999\", not a finite number"],
    ),
    refused(
        "an empty value",
        |lab| lines(lab, |l| set_cell(&mut l[9], 5, "")),
        &["data/A_2.csv:10: joint 1: tau1 is empty"],
    ),
    refused(
        "a decimal comma",
        |lab| lines(lab, |l| l[9] = l[9].replacen("0.", "0,", 1)),
        &["data/A_2.csv:10: the line has 8 fields, but the header has 7"],
    ),
    refused(
        "a value with a unit",
        |lab| lines(lab, |l| set_cell(&mut l[9], 2, "1.5rad")),
        &["data/A_2.csv:10: joint 2: q2 is \"1.5rad\", not a finite number"],
    ),
    refused(
        "an escape code as a value",
        |lab| lines(lab, |l| set_cell(&mut l[9], 2, "\u{1b}[2J")),
        &["q2 is \"\\u{1b}[2J\", not a finite number"],
    ),
    refused(
        "a line cut short",
        |lab| lines(lab, |l| l[51].truncate(20)),
        &["data/A_2.csv:52: the line has 2 fields", "cut short"],
    ),
    refused(
        "a missing column",
        |lab| lines(lab, |l| l[0] = l[0].replace(",tau2", "")),
        &["data/A_2.csv:1: column 7 of the header is missing, expected \"tau2\""],
    ),
    refused(
        "swapped columns",
        |lab| lines(lab, |l| l[0] = "t,qd1,qd2,q1,q2,tau1,tau2".into()),
        &["data/A_2.csv:1: column 2 of the header is \"qd1\", expected \"q1\""],
    ),
    refused(
        "no header",
        |lab| lines(lab, |l| drop(l.remove(0))),
        &["data/A_2.csv:1: the first line holds numbers, so the header is missing"],
    ),
    refused(
        "101 joints",
        |lab| {
            let names = (1..=101).map(|i| format!(",q{i}")).collect::<String>();
            lab.write("data/A_2.csv", format!("t{names}\n"));
        },
        &["data/A_2.csv:1: the header has 101 joints, but at most 100 are read"],
    ),
    refused(
        "semicolons",
        |lab| lab.write("data/A_2.csv", lab.read("data/A_2.csv").replace(',', ";")),
        &["data/A_2.csv:1: the columns are separated by ';'", "separate them by commas"],
    ),
    refused(
        "UTF-16",
        |lab| lab.write("data/A_2.csv", b"\xff\xfet\0,\0"),
        &["data/A_2.csv:1: the file is UTF-16 text; save it as CSV in UTF-8"],
    ),
    refused(
        "a binary file",
        |lab| lab.write("data/A_2.csv", [0u8, 159, 146, 150]),
        &["data/A_2.csv:1: the file is not text"],
    ),
    refused(
        "an empty file",
        |lab| lab.write("data/A_2.csv", ""),
        &["data/A_2.csv:1: the file is empty"],
    ),
    refused(
        "no sample",
        |lab| lines(lab, |l| l.truncate(1)),
        &["data/A_2.csv: there is no sample after the header"],
    ),
    refused(
        "a time twice",
        |lab| lines(lab, |l| l.insert(10, l[9].clone())),
        &["data/A_2.csv:11: t = 0.080 s is the time of the line above", "sort the samples"],
    ),
    refused(
        "times that run backward",
        |lab| lines(lab, |l| l.swap(10, 11)),
        &["data/A_2.csv:12: t = 0.090 s is earlier than the line above"],
    ),
    refused(
        "a missing sample",
        |lab| lines(lab, |l| drop(l.remove(10))),
        &["data/A_2.csv:11: there is a gap of 0.020000 s", "--max-gap SECONDS"],
    ),
    refused(
        "q in degrees",
        |lab| [1, 2].into_iter().for_each(|c| column(lab, c, f64::to_degrees)),
        &["data/A_2.csv: joint 1: q moves 57.", "q looks like degrees"],
    ),
    refused(
        "speeds beyond the limit",
        |lab| [1, 3].into_iter().for_each(|c| column(lab, c, |x| 50.0 * x)),
        &["data/A_2.csv: joint 1: qd reaches", "the joint's limit is 3 rad/s"],
    ),
    refused(
        "a recording of another robot",
        |lab| lab.write("data/A_2.csv", "t,q1,qd1,tau1\n0,0,0,0\n"),
        &["data/A_2.csv:1: the recording has 1 joints, but the robot has 2"],
    ),
    refused(
        "a recording that is a folder",
        |lab| {
            std::fs::remove_file(lab.path("data/A_2.csv")).unwrap();
            std::fs::create_dir(lab.path("data/A_2.csv")).unwrap();
        },
        &["data/runs.csv:3: \"A_2.csv\" is not a file in data", "take the line out"],
    ),
    refused(
        "a recording that is a device",
        |lab| index(lab, |l| l[2] = "/dev/zero,A,motion A".into()),
        &["data/runs.csv:3: \"/dev/zero\" is not a file in data"],
    ),
    refused(
        "no index",
        |lab| std::fs::remove_file(lab.path("data/runs.csv")).unwrap(),
        &["data/runs.csv: cannot read", "give the folder that holds the recordings"],
    ),
    refused(
        "an index without a column",
        |lab| index(lab, |l| l[0] = "path,suite,motion".into()),
        &["data/runs.csv:1: there is no column \"file\""],
    ),
    refused(
        "an index that lists nothing",
        |lab| index(lab, |l| l.truncate(1)),
        &["data/runs.csv: no run is listed"],
    ),
    refused(
        "a line of the index cut short",
        |lab| index(lab, |l| l[2] = "A_2.csv".into()),
        &["data/runs.csv:3: the line has 1 fields, but the header has 3"],
    ),
    refused(
        "a run listed twice",
        |lab| index(lab, |l| l.push("A_1.csv,B,motion B".into())),
        &["data/runs.csv:8: \"A_1.csv\" is listed on line 2 already"],
    ),
    refused(
        "a suite of two motions",
        |lab| index(lab, |l| l[2] = "A_2.csv,A,other".into()),
        &["data/runs.csv:3: suite A has the motion \"other\" here and \"motion A\" on line 2"],
    ),
    refused(
        "no suite",
        |lab| index(lab, |l| l[1..].iter_mut().for_each(|l| *l = format!("{},,", &l[..7]))),
        &["no run has a suite", "by the column suite"],
    ),
    refused(
        "an index that is no text",
        |lab| lab.write("data/runs.csv", b"file,suite\n\xff\xfe,A\n"),
        &["data/runs.csv:2: the line is not UTF-8 text"],
    ),
    Case {
        what: "recordings outside the model's set",
        spoil: |lab| column(lab, 1, |q| q + 0.5),
        command: CHECK,
        code: 1,
        words: &["not conformant: 6 recordings", "A_2.csv, 0.000 s: q1 by 0.50 rad"],
    },
    Case {
        what: "many gaps, inspected",
        spoil: |lab| {
            lines(lab, |l| {
                l.remove(30);
                l.remove(10);
            })
        },
        command: INSPECT,
        code: 2,
        words: &["2 defects in 1 recording", "--max-gap 0.02 accepts all"],
    },
];
