//! The state of a SQLite file before it is opened: whether it is whole, and what lies beside it.

use std::ffi::OsString;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::loss::Loss;

/// Length of the header of a SQLite file, bytes.
const HEADER: usize = 100;

/// Value of the header for a file that is written by a write-ahead log.
const WRITE_AHEAD: u8 = 2;

/// A file beside a SQLite file in which a recorder that was cut off left something to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BagJournal {
    /// There is none.
    None,
    /// A rollback journal, which undoes an unfinished transaction.
    Rollback,
    /// A write-ahead log, with transactions that are not in the file yet.
    WriteAhead,
}

impl BagJournal {
    /// Returns the path of this journal beside the file `path`.
    pub(crate) fn beside(self, path: &Path) -> PathBuf {
        let mut name = OsString::from(path);
        name.push(match self {
            Self::None => "",
            Self::Rollback => "-journal",
            Self::WriteAhead => "-wal",
        });
        name.into()
    }

    /// Returns whether this journal is there and in use.
    fn is_hot(self, path: &Path) -> bool {
        let mut first = [0; 1];
        let file = File::open(self.beside(path));
        // A finished transaction leaves a journal empty, or starting with zeros.
        file.and_then(|mut file| file.read_exact(&mut first)).is_ok() && first != [0]
    }
}

/// The state of a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BagState {
    /// Size of a page, bytes.
    pub(crate) page: u64,
    /// The files beside it.
    pub(crate) journal: BagJournal,
    /// Size that the header announces, where it does, bytes.
    announced: Option<u64>,
    length: u64,
    write_ahead: bool,
}

impl BagState {
    /// Reads the header of a file and looks for its journal.
    pub(crate) fn of(path: &Path) -> Result<Self, reachtube_files::Error> {
        let read = || {
            let mut file = File::open(path)?;
            let length = file.metadata()?.len();
            let mut header = [0; HEADER];
            let got = file.by_ref().take(HEADER as u64).read(&mut header)?;
            Ok((header, length, got))
        };
        let (header, length, got) = read().map_err(|source| reachtube_files::Error::Read {
            path: path.into(),
            source,
            remedy: "check the path and its permissions",
        })?;
        let number = |at: usize| {
            u64::from(u32::from_be_bytes(header[at..at + 4].try_into().expect("four bytes")))
        };
        let page = match u64::from(u16::from_be_bytes([header[16], header[17]])) {
            1 => 1 << 16,
            size => size,
        };
        // The number of pages counts where the two change counters agree.
        let counts = got == HEADER && number(24) == number(92) && number(28) > 0;
        let announced = counts.then(|| number(28) * page);
        let hot = |journal: &BagJournal| journal.is_hot(path);
        let journal = [BagJournal::Rollback, BagJournal::WriteAhead].into_iter().find(hot);
        Ok(Self {
            page,
            journal: journal.unwrap_or(BagJournal::None),
            announced,
            length,
            write_ahead: header[18] == WRITE_AHEAD,
        })
    }

    /// Returns the length of the pages that are there to their last byte. SQLite takes missing
    /// bytes of a page for zeros, which would be wrong values.
    pub(crate) fn whole_pages(self) -> u64 {
        self.length - self.length.checked_rem(self.page).unwrap_or(0)
    }

    /// Returns whether the file cannot be read in its place.
    pub(crate) fn needs_copy(self) -> bool {
        self.journal != BagJournal::None || self.whole_pages() != self.length
    }

    /// Returns what the header and the journal show to be lost.
    pub(crate) fn losses(self, path: &Path) -> Vec<Loss> {
        let mut losses = vec![];
        if let Some(announced) = self.announced.filter(|announced| *announced > self.length)
            // The write-ahead log may hold the rest.
            && self.journal != BagJournal::WriteAhead
        {
            let problem = format!(
                "the file ends here, but its header announces {announced} bytes, so it was cut \
                 short"
            );
            let mut loss = Loss::new(path, Some(self.length), problem);
            loss.bytes = Some(announced - self.length);
            losses.push(loss);
        }
        if self.journal == BagJournal::Rollback {
            let journal = self.journal.beside(path);
            let problem = format!(
                "the recorder was stopped in the middle of a write, which {} undoes (in a copy)",
                journal.display()
            );
            losses.push(Loss::new(path, None, problem));
        }
        losses
    }

    /// Returns notes about the write-ahead log.
    pub(crate) fn notes(self, path: &Path) -> Vec<String> {
        let wal = BagJournal::WriteAhead.beside(path);
        let (path, wal) = (path.display(), wal.display());
        match self.journal {
            BagJournal::WriteAhead => {
                vec![format!("{path}: messages in {wal} were read too, in a copy of both")]
            }
            _ if self.write_ahead => vec![format!(
                "{path}: the file was written with a write-ahead log; if the recorder was stopped \
                 by force, its latest messages are in {wal}, which is not there"
            )],
            _ => vec![],
        }
    }
}
