//! Files that hold several recordings, one below the other.

use super::dialect::{Dialect, end_of_line, is_plain};

/// Names of columns whose values tell the recordings of a file apart.
const RUNS: [&str; 3] = ["run", "episode", "episode_index"];

/// Returns the column that tells the recordings of a file apart.
pub(super) fn run_column(dialect: &Dialect) -> Option<usize> {
    let is_run =
        |name: &String| RUNS.contains(&name.split(['[', '(']).next().unwrap_or_default().trim());
    dialect.names.iter().position(is_run)
}

/// The rows of one recording among others.
pub(super) struct RunRows {
    /// What the column of the recordings has for it.
    pub run: String,
    /// The header and the rows.
    pub text: Vec<u8>,
    /// Number of rows of other recordings between them.
    pub skipped: u64,
    /// The recording, if rows of it stand before others.
    pub continues: Option<String>,
}

/// Divides a file into its recordings, row after row; `None` if it has only one, or has quotes.
pub(super) fn parts(bytes: &[u8], dialect: &Dialect) -> Option<Vec<RunRows>> {
    let column = run_column(dialect)?;
    let rows = dialect.plain_rows(bytes).filter(|rows| is_plain(rows, false))?;
    let header = &bytes[..bytes.len() - rows.len()];
    let (mut parts, mut at, mut number) = (Vec::<RunRows>::new(), 0, 0);
    let mut fields = Vec::new();
    while at < rows.len() {
        let line = &rows[at..rows.len().min(at + end_of_line(&rows[at..]) + 1)];
        dialect.fields(line, &mut fields);
        let run = fields.get(column).map_or(String::new(), |of| String::from_utf8_lossy(of).into());
        match parts.last_mut() {
            Some(part) if part.run == run || fields.is_empty() => part.text.extend(line),
            None if fields.is_empty() => {}
            _ => {
                let continues = parts.iter().any(|part| part.run == run).then(|| run.clone());
                let text = [header, line].concat();
                parts.push(RunRows { run, text, skipped: number, continues });
            }
        }
        at += line.len();
        number += 1;
    }
    (parts.len() > 1).then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::{Dialect, parts};

    #[test]
    fn recordings_of_one_file_keep_their_header_and_their_lines() {
        let divided = |text: &str| {
            let dialect = Dialect::of("log.csv".as_ref(), text.as_bytes()).unwrap();
            let found = parts(text.as_bytes(), &dialect)?;
            let of = |part: super::RunRows| {
                (part.run, String::from_utf8(part.text).unwrap(), part.skipped)
            };
            Some(found.into_iter().map(of).collect::<Vec<_>>())
        };
        let part = |run: &str, text: &str, skipped| (run.to_string(), text.to_string(), skipped);
        let text = "# log\nt,episode_index,q\n0,3,1\n1,3,2\n\n0,5,7\n";
        let expected = [
            part("3", "# log\nt,episode_index,q\n0,3,1\n1,3,2\n\n", 0),
            part("5", "# log\nt,episode_index,q\n0,5,7\n", 3),
        ];
        assert_eq!(divided(text).unwrap(), expected);
        // A short line is of no recording; the reader names it.
        assert_eq!(divided("t,run,q\n0,1,2\n1\n").unwrap()[1], part("", "t,run,q\n1\n", 1));
        assert_eq!(divided("t,run,q\n0,1,2\n1,1,2\n"), None);
        assert_eq!(divided("t,run,q\n\n0,1,2\n1,2,2\n").unwrap()[0].2, 1);
        assert_eq!(divided("s,run,q\ns,-,rad\n0,1,2\n1,2,2\n").unwrap().len(), 2);
        assert_eq!(divided("t,run,q\n0,1,\"2\"\n0,2,2\n"), None);
        assert_eq!(divided("t,q\n0,1\n0,2\n"), None);
    }
}
