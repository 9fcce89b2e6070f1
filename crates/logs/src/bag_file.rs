//! rosbag2 files in SQLite: the tables `topics` and `messages`.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::OpenOptions;
use std::io::Read;
use std::path::{Path, PathBuf};

use rusqlite::{Connection, OpenFlags, limits::Limit};

use crate::bag_state::{BagJournal, BagState};
use crate::container::{Contents, Damage, LogFile, RawMessage, Receive, Role, Topic, WantedTopics};
use crate::error::{Error, Result};
use crate::loss::Loss;

/// Longest message that is read, bytes.
const LARGEST: i32 = 1 << 26;

/// First bytes of a message that rosbag2 compressed by itself.
const ZSTD: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Reads a file and passes the messages of the topics `wanted` on, in the order of the file.
///
/// # Errors
///
/// [`Error::Damaged`] for the first part that cannot be read, unless `recover`; then such parts
/// are listed in the result.
pub(crate) fn scan(
    LogFile { path, content }: LogFile<'_>,
    wanted: WantedTopics<'_>,
    recover: bool,
    receive: &mut Receive<'_>,
) -> Result<Contents> {
    let state = BagState::of(content)?;
    let mut damage = Damage::new(recover);
    state.losses(path).into_iter().try_for_each(|loss| damage.add(loss))?;
    // SQLite works on a copy where it has to undo or to apply a journal, or to end earlier.
    let copy = state.needs_copy().then(|| Copy::of(content, state)).transpose()?;
    let file = copy.as_ref().map_or(content, |copy| copy.file.as_path());
    let mut scan = Scan { path, page: state.page, recover, damage, contents: Contents::default() };
    let opened = open(file, copy.is_some(), recover).and_then(|connection| {
        let topics = topics(&connection)?;
        Ok((connection, topics))
    });
    let (connection, topics) = match opened {
        Ok(opened) => opened,
        Err(error) => return Err(scan.unusable(&error)),
    };
    scan.contents.notes = state.notes(path);
    scan.topics(&connection, topics, wanted, receive)?;
    scan.contents.losses = scan.damage.losses;
    Ok(scan.contents)
}

/// A copy of a file and its journal, which is deleted with this value.
struct Copy {
    file: PathBuf,
    _folder: tempfile::TempDir,
}

impl Copy {
    fn of(path: &Path, state: BagState) -> Result<Self> {
        let copy = || {
            let folder = tempfile::tempdir()?;
            let file = folder.path().join("bag.db3");
            std::fs::copy(path, &file)?;
            if state.journal != BagJournal::None {
                std::fs::copy(state.journal.beside(path), state.journal.beside(&file))?;
            }
            OpenOptions::new().write(true).open(&file)?.set_len(state.whole_pages())?;
            Ok(Self { file, _folder: folder })
        };
        copy().map_err(|source| {
            let remedy = "make room for a copy of it in the folder for temporary files";
            reachtube_files::Error::Read { path: path.into(), source, remedy }.into()
        })
    }
}

/// Opens a file, for writing where it is a copy.
fn open(file: &Path, is_copy: bool, recover: bool) -> rusqlite::Result<Connection> {
    let mode =
        if is_copy { OpenFlags::SQLITE_OPEN_READ_WRITE } else { OpenFlags::SQLITE_OPEN_READ_ONLY };
    let connection = Connection::open_with_flags(file, mode | OpenFlags::SQLITE_OPEN_NO_MUTEX)?;
    connection.set_limit(Limit::SQLITE_LIMIT_LENGTH, LARGEST)?;
    // Views and triggers of an untrusted file call no functions.
    connection.pragma_update(None, "trusted_schema", false)?;
    if recover {
        // Otherwise, SQLite opens no file that is shorter than its header announces.
        connection.pragma_update(None, "writable_schema", true)?;
    }
    Ok(connection)
}

fn topics(connection: &Connection) -> rusqlite::Result<Vec<(i64, Topic)>> {
    let mut query = connection
        .prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id")?;
    let topic = |row: &rusqlite::Row<'_>| {
        let topic = Topic { name: row.get(1)?, kind: row.get(2)?, encoding: row.get(3)? };
        Ok((row.get(0)?, topic))
    };
    query.query_map([], topic)?.collect()
}

/// The state of reading a file.
struct Scan<'a> {
    path: &'a Path,
    /// Size of a page, bytes.
    page: u64,
    recover: bool,
    damage: Damage,
    contents: Contents,
}

impl Scan<'_> {
    /// Reads the messages of the topics that are wanted.
    fn topics(
        &mut self,
        connection: &Connection,
        topics: Vec<(i64, Topic)>,
        wanted: WantedTopics<'_>,
        receive: &mut Receive<'_>,
    ) -> Result<()> {
        let mut roles = BTreeMap::new();
        for (number, topic) in topics {
            if let Some(role) = wanted.role(self.path, &topic)? {
                roles.insert(number, (role, topic.name.clone(), 0));
            }
            self.contents.topics.push(topic);
        }
        if !self.recover {
            self.check(connection)?;
        }
        let mut last = None;
        let read = self.messages(connection, &mut roles, &mut last, receive);
        read.or_else(|stop| match stop {
            Stop::Job(error) => Err(error),
            Stop::File(error) => {
                let loss = self.rest(connection, &error, &roles, last);
                self.damage.add(loss)
            }
        })
    }

    /// Lets SQLite check the structure of the messages, so that no page is read for another.
    fn check(&mut self, connection: &Connection) -> Result<()> {
        let found = connection
            .query_row("PRAGMA quick_check(1)", [], |row| row.get::<_, String>(0))
            .unwrap_or_else(|error| error.to_string());
        if found == "ok" {
            return Ok(());
        }
        self.damage.add(Loss::new(
            self.path,
            self.offset_of(&found),
            format!(
                "SQLite finds that the file is damaged ({}), for example after a loss of power",
                found.trim().replace('\n', " ")
            ),
        ))
    }

    /// Returns the offset of the page that a message of SQLite names, bytes.
    fn offset_of(&self, message: &str) -> Option<u64> {
        let lower = message.to_lowercase();
        let (_, after) = lower.split_once("page ")?;
        let digits = after.split(|c: char| !c.is_ascii_digit()).next()?;
        digits.parse::<u64>().ok()?.checked_sub(1)?.checked_mul(self.page)
    }

    /// Passes the messages on in the order in which they were written. `last` becomes the number
    /// and time of the latest.
    fn messages(
        &mut self,
        connection: &Connection,
        roles: &mut BTreeMap<i64, (Role, String, u64)>,
        last: &mut Option<(i64, i64)>,
        receive: &mut Receive<'_>,
    ) -> Result<(), Stop> {
        let numbers: Vec<String> = roles.keys().map(i64::to_string).collect();
        let mut query = connection.prepare(&format!(
            "SELECT id, topic_id, timestamp, data FROM messages WHERE topic_id IN ({}) ORDER BY id",
            numbers.join(",")
        ))?;
        let mut rows = query.query([])?;
        while let Some(row) = rows.next()? {
            let (id, log_time) = (row.get(0)?, row.get(2)?);
            let Some((role, topic, number)) = roles.get_mut(&row.get::<_, i64>(1)?) else {
                continue;
            };
            *number += 1;
            let received = match row.get_ref(3)?.as_blob() {
                Ok(data) => plain(data)
                    .and_then(|data| receive(RawMessage { role: *role, log_time, data: &data })),
                Err(_) => Err("it is not binary".into()),
            };
            if let Err(problem) = received {
                let problem = format!("message {number} of {topic} cannot be read: {problem}");
                let mut loss = Loss::new(self.path, None, problem);
                loss.count(log_time);
                self.damage.add(loss).map_err(Stop::Job)?;
            }
            *last = Some((id, log_time));
        }
        Ok(())
    }

    /// Returns the loss of all messages after the last one that was read. The index of times counts
    /// the messages that it still holds.
    fn rest(
        &self,
        connection: &Connection,
        error: &rusqlite::Error,
        roles: &BTreeMap<i64, (Role, String, u64)>,
        last: Option<(i64, i64)>,
    ) -> Loss {
        let after = last.map_or_else(
            || "no message could be read".into(),
            |(id, _)| format!("the messages after row {id} of the table cannot be read"),
        );
        let mut loss = Loss::new(self.path, None, format!("{after}: {error}"));
        let mut count = || -> rusqlite::Result<()> {
            let mut query = connection.prepare(
                "SELECT id, timestamp FROM messages INDEXED BY timestamp_idx WHERE timestamp >= ?",
            )?;
            let mut rows = query.query([last.map_or(i64::MIN, |(_, time)| time)])?;
            while let Some(row) = rows.next()? {
                if last.is_none_or(|(id, _)| row.get(0).is_ok_and(|other: i64| other > id)) {
                    loss.count(row.get(1)?);
                }
            }
            Ok(())
        };
        count().ok();
        // The index does not distinguish topics.
        if roles.len() < self.contents.topics.len() {
            loss.messages = 0;
        }
        loss
    }

    /// Returns the error of a file whose tables cannot be read at all.
    fn unusable(&self, error: &rusqlite::Error) -> Error {
        let problem = match error.sqlite_error_code() {
            Some(rusqlite::ErrorCode::NotADatabase | rusqlite::ErrorCode::DatabaseCorrupt) => {
                "so its messages cannot be recovered; use a copy or another log"
            }
            _ => {
                "so it is no rosbag2 file in SQLite, or it is damaged; give the .db3 file of a bag"
            }
        };
        Error::Format {
            path: self.path.into(),
            problem: format!("its tables cannot be read ({error}), {problem}"),
        }
    }
}

/// Returns a message that rosbag2 compressed by itself as it was; any other as it is. Plain CDR
/// starts with a byte of 0.
fn plain(data: &[u8]) -> Result<Cow<'_, [u8]>, String> {
    if !data.starts_with(&ZSTD) {
        return Ok(data.into());
    }
    let damaged = |fault| format!("its compression by zstd is damaged ({fault})");
    let decoder = zstd::Decoder::with_buffer(data).map_err(damaged)?;
    let mut message = Vec::new();
    decoder.take(LARGEST as u64 + 1).read_to_end(&mut message).map_err(damaged)?;
    if message.len() > LARGEST as usize {
        return Err(format!("it has more than {LARGEST} bytes"));
    }
    Ok(message.into())
}

/// The reason why the reading of messages ended.
enum Stop {
    /// The file.
    File(rusqlite::Error),
    /// An error of the job.
    Job(Error),
}

impl From<rusqlite::Error> for Stop {
    fn from(error: rusqlite::Error) -> Self {
        Self::File(error)
    }
}
