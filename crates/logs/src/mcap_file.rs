//! MCAP files: the messages in their records, most of them in compressed chunks.
//!
//! The crate `mcap` decompresses chunks, checks their checksums and parses records.

use std::collections::BTreeMap;
use std::path::Path;

use mcap::records::{ChunkHeader, MessageHeader, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};

use crate::container::{Contents, Damage, LogFile, RawMessage, Receive, Role, Topic, WantedTopics};
use crate::error::{Error, Result};
use crate::loss::Loss;
use crate::mcap_records::{HEAD, LARGEST, McapRecords, Piece, records_of};

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
    let unreadable = |source| reachtube_files::Error::Read {
        path: path.into(),
        source,
        remedy: "check the path and its permissions",
    };
    let mut scan = Scan {
        path,
        wanted,
        receive,
        damage: Damage::new(recover),
        schemas: BTreeMap::new(),
        channels: BTreeMap::new(),
        topics: vec![],
        numbers: BTreeMap::new(),
    };
    let mut records = McapRecords::open(content).map_err(unreadable)?;
    while let Some(piece) = records.next().map_err(unreadable)? {
        scan.piece(piece)?;
    }
    Ok(Contents { topics: scan.topics, notes: vec![], losses: scan.damage.losses })
}

/// The state of reading a file.
struct Scan<'a, 'b> {
    path: &'a Path,
    wanted: WantedTopics<'a>,
    receive: &'a mut Receive<'b>,
    damage: Damage,
    /// Names of the types, by the number of their schema.
    schemas: BTreeMap<u16, String>,
    /// Topic and role of each channel.
    channels: BTreeMap<u16, (usize, Option<Role>)>,
    topics: Vec<Topic>,
    /// Number of messages that were read of each topic.
    numbers: BTreeMap<usize, u64>,
}

/// The reason why the reading of a chunk ended.
enum Stop {
    /// Its bytes.
    Chunk(McapError),
    /// An error of the job.
    Job(Error),
}

impl From<McapError> for Stop {
    fn from(error: McapError) -> Self {
        Self::Chunk(error)
    }
}

impl Scan<'_, '_> {
    fn piece(&mut self, piece: Piece) -> Result<()> {
        let Piece { offset, bytes, fault } = piece;
        if let Some((problem, lost)) = fault {
            let mut loss = Loss::new(self.path, Some(offset), problem);
            loss.bytes = Some(lost);
            if !bytes.is_empty() {
                self.count_lost(&bytes, &mut loss);
            }
            return self.damage.add(loss);
        }
        let (kind, content) = (bytes[0], &bytes[HEAD..]);
        let read = match kind {
            op::CHUNK => self.chunk(&bytes, offset),
            _ => parse_record(kind, content)
                .map_err(Stop::Chunk)
                .and_then(|record| self.record(record, offset).map_err(Stop::Job)),
        };
        match read {
            Ok(()) => Ok(()),
            Err(Stop::Job(error)) => Err(error),
            Err(Stop::Chunk(error)) => {
                let what = if kind == op::CHUNK { "the chunk" } else { "the record" };
                let problem = format!("{what} that starts here cannot be read: {error}");
                let mut loss = Loss::new(self.path, Some(offset), problem);
                loss.bytes = Some(bytes.len() as u64);
                if kind == op::CHUNK {
                    self.count_lost(&bytes, &mut loss);
                }
                self.damage.add(loss)
            }
        }
    }

    /// Reads the records of a chunk after its checksum was found to be right.
    fn chunk(&mut self, bytes: &[u8], offset: u64) -> Result<(), Stop> {
        let (header, content) = chunk_parts(&bytes[HEAD..])?;
        if header.compression.is_empty() {
            let used: usize = records_of(content).map(|(_, record)| HEAD + record.len()).sum();
            if used != content.len() || header.compressed_size != content.len() as u64 {
                return Err(McapError::UnexpectedEoc.into());
            }
        }
        each_record(bytes, true, |kind, content| {
            self.record(parse_record(kind, content)?, offset).map_err(Stop::Job)
        })
    }

    /// Reads a schema, a channel or a message. `offset` is its place in the file, or its chunk's
    /// place.
    fn record(&mut self, record: Record<'_>, offset: u64) -> Result<()> {
        match record {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let kind = self.schemas.get(&channel.schema_id);
                let kind = kind.cloned().unwrap_or_else(|| "without a name".into());
                let topic = Topic { name: channel.topic, kind, encoding: channel.message_encoding };
                let role = self.wanted.role(self.path, &topic)?;
                let known = self.topics.iter().position(|known| *known == topic);
                let index = known.unwrap_or_else(|| {
                    self.topics.push(topic);
                    self.topics.len() - 1
                });
                self.channels.insert(channel.id, (index, role));
            }
            Record::Message { header, data } => return self.message(&header, &data, offset),
            _ => {}
        }
        Ok(())
    }

    /// Passes a message on, where its topic is read.
    fn message(&mut self, header: &MessageHeader, data: &[u8], offset: u64) -> Result<()> {
        let Some(&(topic, role)) = self.channels.get(&header.channel_id) else {
            let problem = format!(
                "a message has the channel {}, which the file does not describe",
                header.channel_id
            );
            return self.damage.add(Loss::new(self.path, Some(offset), problem));
        };
        let Some(role) = role else { return Ok(()) };
        let number = self.numbers.entry(topic).or_default();
        *number += 1;
        let log_time = header.log_time.cast_signed();
        let message = RawMessage { role, log_time, data };
        let Err(problem) = (self.receive)(message) else { return Ok(()) };
        let name = &self.topics[topic].name;
        let problem = format!("message {number} of {name} cannot be read: {problem}");
        let mut loss = Loss::new(self.path, Some(offset), problem);
        loss.bytes = Some(data.len() as u64);
        loss.count(log_time);
        self.damage.add(loss)
    }

    /// Counts the messages of a damaged chunk as far as they can be decompressed.
    fn count_lost(&mut self, bytes: &[u8], loss: &mut Loss) {
        let mut count = |kind: u8, content: &[u8]| -> Result<(), Stop> {
            match parse_record(kind, content)? {
                Record::Message { header, .. } => {
                    let channel = self.channels.get(&header.channel_id);
                    if channel.is_some_and(|(_, role)| role.is_some()) {
                        loss.count(header.log_time.cast_signed());
                    }
                    Ok(())
                }
                // A later chunk repeats what it needs, or names channels that no one described.
                record => self.record(record, 0).map_err(Stop::Job),
            }
        };
        let Ok((header, content)) = chunk_parts(&bytes[HEAD..]) else { return };
        let (first, last) = (header.message_start_time, header.message_end_time);
        if header.compression.is_empty() {
            records_of(content).try_for_each(|(kind, record)| count(kind, record)).ok();
        } else {
            each_record(bytes, false, count).ok();
        }
        if first <= last && last > 0 {
            loss.received = Some([first.cast_signed(), last.cast_signed()]);
        }
    }
}

/// Splits a chunk, which may be cut short, into header and content.
fn chunk_parts(chunk: &[u8]) -> Result<(ChunkHeader, &[u8]), McapError> {
    // Two times, two sizes, a checksum, and the length of the name of the compression.
    const FIXED: usize = 40;
    const NAME_AT: usize = 28;
    let length = chunk.get(NAME_AT..NAME_AT + 4).ok_or(McapError::UnexpectedEof)?;
    let length = u32::from_le_bytes(length.try_into().expect("four bytes were taken"));
    let split = FIXED + usize::try_from(length).unwrap_or(usize::MAX).min(LARGEST);
    let (header, content) = chunk.split_at_checked(split).ok_or(McapError::UnexpectedEof)?;
    let mut whole = header.to_vec();
    // The crate parses a chunk only with its content, so an empty one stands for it.
    let size = u64::from_le_bytes(whole[split - 8..].try_into().expect("eight bytes were taken"));
    whole[split - 8..].fill(0);
    match parse_record(op::CHUNK, &whole)? {
        Record::Chunk { header, .. } => {
            Ok((ChunkHeader { compressed_size: size, ..header }, content))
        }
        _ => Err(McapError::UnexpectedEoc),
    }
}

/// Decompresses a chunk and calls `each` with kind and content of every record, after the
/// checksum was compared if `checked`.
fn each_record(
    chunk: &[u8],
    checked: bool,
    mut each: impl FnMut(u8, &[u8]) -> Result<(), Stop>,
) -> Result<(), Stop> {
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_prevalidate_chunk_crcs(checked)
        .with_record_length_limit(LARGEST);
    let mut reader = LinearReader::new_with_options(options);
    let mut rest = chunk;
    while let Some(event) = reader.next_event() {
        match event? {
            LinearReadEvent::ReadRequest(need) => {
                let (now, later) = rest.split_at(need.min(rest.len()));
                reader.insert(now.len()).copy_from_slice(now);
                reader.notify_read(now.len());
                rest = later;
            }
            LinearReadEvent::Record { opcode, data } => each(opcode, data)?,
        }
    }
    Ok(())
}
