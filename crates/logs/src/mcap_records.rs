//! The records of an MCAP file, one after another, with their places in the file.

use std::fs::File;
use std::io::{BufReader, Error, ErrorKind, Read, Result, Seek, SeekFrom};
use std::path::Path;

use mcap::MAGIC;
use mcap::records::op;

/// Longest record that is read, bytes.
pub(crate) const LARGEST: usize = 1 << 28;

/// Length of the head of a record, its kind and length, bytes.
pub(crate) const HEAD: usize = 9;

/// A record, or what is there of it.
#[derive(Debug, Default)]
pub(crate) struct Piece {
    /// Where it starts in the file.
    pub(crate) offset: u64,
    /// Its bytes, with the head. Among broken records, only a chunk has its bytes.
    pub(crate) bytes: Vec<u8>,
    /// What is wrong, and the number of bytes that cannot be used for it.
    pub(crate) fault: Option<(String, u64)>,
}

/// The records of a file that matter: schemas, channels, messages and chunks, up to the end of
/// the data.
#[derive(Debug)]
pub(crate) struct McapRecords {
    file: BufReader<File>,
    position: u64,
    length: u64,
    finished: bool,
}

impl McapRecords {
    /// Opens a file that starts with the magic of MCAP.
    pub(crate) fn open(path: &Path) -> Result<Self> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        let mut file = BufReader::new(file);
        let position = MAGIC.len() as u64;
        file.seek(SeekFrom::Start(position))?;
        Ok(Self { file, position, length, finished: false })
    }

    /// Returns the next record, or a piece of the last one. A file that ends as it should gives
    /// `None`.
    pub(crate) fn next(&mut self) -> Result<Option<Piece>> {
        while !self.finished {
            let offset = self.position;
            let left = self.length.saturating_sub(offset);
            if left < HEAD as u64 {
                return Ok(Some(self.cut_off(left)));
            }
            let mut head = [0; HEAD];
            self.file.read_exact(&mut head).map_err(shrunk)?;
            let kind = head[0];
            let length = u64::from_le_bytes(head[1..].try_into().expect("eight bytes remain"));
            let whole = length.saturating_add(HEAD as u64);
            if kind == 0 {
                let problem = "no record starts here, for example because this part was never \
                    written"
                    .into();
                return Ok(Some(self.last(Piece::broken(offset, problem, left))));
            }
            if matches!(kind, op::DATA_END | op::FOOTER) && whole <= left {
                return self.end(offset);
            }
            if whole > left {
                return self.truncated(offset, &head, length).map(Some);
            }
            self.position = offset + whole;
            let matters = matches!(kind, op::SCHEMA | op::CHANNEL | op::MESSAGE | op::CHUNK);
            if matters && whole <= LARGEST as u64 {
                return self.read(offset, &head, length as usize).map(Some);
            }
            self.file.seek(SeekFrom::Start(self.position))?;
            if matters {
                let problem = format!(
                    "{} of {length} bytes starts here, but at most {LARGEST} are read",
                    name(kind)
                );
                return Ok(Some(Piece::broken(offset, problem, whole)));
            }
        }
        Ok(None)
    }

    /// Returns the piece after which there is nothing.
    fn last(&mut self, piece: Piece) -> Piece {
        self.finished = true;
        piece
    }

    /// Returns the piece at the end of a file that has no footer.
    fn cut_off(&mut self, left: u64) -> Piece {
        let problem = match left {
            0 => "the file ends without its footer, for example after a loss of power",
            _ => "the file ends in the middle of a record",
        };
        self.last(Piece::broken(self.position, problem.into(), left))
    }

    /// Checks the end of a file whose data ends at `offset`.
    fn end(&mut self, offset: u64) -> Result<Option<Piece>> {
        let mut magic = [0; MAGIC.len()];
        self.file.seek(SeekFrom::Start(self.length - MAGIC.len() as u64))?;
        self.file.read_exact(&mut magic).map_err(shrunk)?;
        self.finished = true;
        let problem =
            "the data is whole, but the file ends without its footer, because it was cut short";
        Ok((magic != MAGIC).then(|| Piece::broken(offset, problem.into(), 0)))
    }

    /// Returns what is there of a record that is longer than the file.
    fn truncated(&mut self, offset: u64, head: &[u8; HEAD], length: u64) -> Result<Piece> {
        let left = self.length - offset;
        let problem = format!(
            "the file ends in the middle of {} of {length} bytes, of which {} are there",
            name(head[0]),
            left - HEAD as u64
        );
        let mut piece = match usize::try_from(left) {
            Ok(left) if head[0] == op::CHUNK && left <= LARGEST => {
                self.read(offset, head, left - HEAD)?
            }
            _ => Piece { offset, ..Piece::default() },
        };
        piece.fault = Some((problem, left));
        Ok(self.last(piece))
    }

    /// Reads `length` bytes after the head. The file has as many.
    fn read(&mut self, offset: u64, head: &[u8; HEAD], length: usize) -> Result<Piece> {
        let mut bytes = vec![0; HEAD + length];
        bytes[..HEAD].copy_from_slice(head);
        self.file.read_exact(&mut bytes[HEAD..]).map_err(shrunk)?;
        Ok(Piece { offset, bytes, fault: None })
    }
}

impl Piece {
    fn broken(offset: u64, problem: String, lost: u64) -> Self {
        Self { offset, bytes: vec![], fault: Some((problem, lost)) }
    }
}

fn name(kind: u8) -> &'static str {
    match kind {
        op::SCHEMA => "a schema",
        op::CHANNEL => "a channel",
        op::MESSAGE => "a message",
        op::CHUNK => "a chunk",
        _ => "a record",
    }
}

/// Explains the error of a file that was longer when it was opened.
fn shrunk(error: Error) -> Error {
    match error.kind() {
        ErrorKind::UnexpectedEof => Error::other("it became shorter while it was read"),
        _ => error,
    }
}

/// Returns the records in the content of a chunk that is not compressed, as kind and content.
/// They end before a record that is longer than the chunk.
pub(crate) fn records_of(mut content: &[u8]) -> impl Iterator<Item = (u8, &[u8])> {
    std::iter::from_fn(move || {
        let (head, rest) = content.split_first_chunk::<HEAD>()?;
        let length = u64::from_le_bytes(head[1..].try_into().expect("eight bytes remain"));
        let (record, after) = rest.split_at_checked(usize::try_from(length).ok()?)?;
        content = after;
        Some((head[0], record))
    })
}
