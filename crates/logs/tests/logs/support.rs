//! Logs for tests, written by the crates `mcap` and `rusqlite` with messages encoded here.

#![allow(dead_code, reason = "each test uses a part")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions, Writer};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use reachtube_logs::{Error, Log, LogOptions};

pub(crate) const JOINT_STATE: &str = "sensor_msgs/msg/JointState";
pub(crate) const TOPIC: &str = "/joint_states";
pub(crate) const SECOND: i64 = 1_000_000_000;

/// An encoder of CDR in either byte order.
pub(crate) struct Encoder {
    bytes: Vec<u8>,
    big: bool,
}

impl Encoder {
    pub(crate) fn new(big: bool) -> Self {
        Self { bytes: vec![0, u8::from(!big), 0, 0], big }
    }

    fn align(&mut self, size: usize) {
        while !(self.bytes.len() - 4).is_multiple_of(size) {
            self.bytes.push(0);
        }
    }

    pub(crate) fn u32(mut self, value: u32) -> Self {
        self.align(4);
        self.bytes.extend(if self.big { value.to_be_bytes() } else { value.to_le_bytes() });
        self
    }

    pub(crate) fn string(mut self, text: &str) -> Self {
        self = self.u32(text.len() as u32 + 1);
        self.bytes.extend(text.bytes().chain([0]));
        self
    }

    pub(crate) fn doubles(mut self, values: &[f64]) -> Self {
        self = self.u32(values.len() as u32);
        for value in values {
            self.align(8);
            self.bytes.extend(if self.big { value.to_be_bytes() } else { value.to_le_bytes() });
        }
        self
    }

    pub(crate) fn byte(mut self, byte: u8) -> Self {
        self.bytes.push(byte);
        self
    }

    pub(crate) fn end(self) -> Vec<u8> {
        self.bytes
    }
}

/// A joint state before it is encoded.
#[derive(Debug, Clone)]
pub(crate) struct State {
    /// Stamp, ns.
    pub stamp: i64,
    pub names: Vec<String>,
    /// Positions, velocities and efforts.
    pub values: [Vec<f64>; 3],
}

impl State {
    pub(crate) fn new(stamp: i64, names: &[&str], values: [&[f64]; 3]) -> Self {
        let names = names.iter().map(|name| (*name).into()).collect();
        Self { stamp, names, values: values.map(<[f64]>::to_vec) }
    }

    pub(crate) fn encode(&self, big: bool) -> Vec<u8> {
        let mut out = Encoder::new(big)
            .u32((self.stamp / SECOND) as u32)
            .u32((self.stamp % SECOND) as u32)
            .string("base_link")
            .u32(self.names.len() as u32);
        for name in &self.names {
            out = out.string(name);
        }
        self.values.iter().fold(out, |out, values| out.doubles(values)).end()
    }
}

/// A message of a log.
#[derive(Debug, Clone)]
pub(crate) struct Message {
    pub topic: String,
    pub kind: String,
    /// Time at which the log received it, ns.
    pub received: i64,
    pub data: Vec<u8>,
}

impl Message {
    pub(crate) fn new(topic: &str, kind: &str, received: i64, data: Vec<u8>) -> Self {
        Self { topic: topic.into(), kind: kind.into(), received, data }
    }

    pub(crate) fn string(received: i64, text: &str) -> Self {
        let data = Encoder::new(false).string(text).end();
        Self::new("/marker", "std_msgs/msg/String", received, data)
    }
}

/// Returns messages of [`TOPIC`], received 1 ms after their stamps.
pub(crate) fn messages(states: &[State]) -> Vec<Message> {
    let message = |state: &State| {
        Message::new(TOPIC, JOINT_STATE, state.stamp + 1_000_000, state.encode(false))
    };
    states.iter().map(message).collect()
}

/// Returns the options to write an MCAP file: `none`, `zstd`, `lz4`, or `unchunked`.
pub(crate) fn mcap_options(compression: &str) -> WriteOptions {
    let options = WriteOptions::new().chunk_size(Some(2000));
    match compression {
        "zstd" => options.compression(Some(Compression::Zstd)),
        "lz4" => options.compression(Some(Compression::Lz4)),
        "none" => options.compression(None),
        "unchunked" => options.compression(None).use_chunks(false),
        _ => unreachable!("no such compression"),
    }
}

/// Returns the bytes of an MCAP file.
pub(crate) fn mcap_bytes(compression: &str, messages: &[Message]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(vec![]);
    let mut writer = Writer::with_options(&mut bytes, mcap_options(compression)).unwrap();
    let mut channels = BTreeMap::new();
    for (sequence, message) in messages.iter().enumerate() {
        let channel_id = *channels.entry(&message.topic).or_insert_with(|| {
            let schema = writer.add_schema(&message.kind, "ros2msg", b"").unwrap();
            writer.add_channel(schema, &message.topic, "cdr", &BTreeMap::new()).unwrap()
        });
        let (log_time, sequence) = (message.received as u64, sequence as u32);
        let header = MessageHeader { channel_id, sequence, log_time, publish_time: log_time };
        writer.write_to_known_channel(&header, &message.data).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    bytes.into_inner()
}

/// Writes an MCAP file.
pub(crate) fn mcap(folder: &Path, compression: &str, messages: &[Message]) -> PathBuf {
    let path = folder.join(format!("{compression}.mcap"));
    std::fs::write(&path, mcap_bytes(compression, messages)).unwrap();
    path
}

/// The tables of rosbag2, schema version 4.
pub(crate) const TABLES: &str = "
    CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
    CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL,
        metadata TEXT NOT NULL);
    CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
        serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
        type_description_hash TEXT NOT NULL);
    CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
        timestamp INTEGER NOT NULL, data BLOB NOT NULL);
    CREATE INDEX timestamp_idx ON messages (timestamp ASC);
    INSERT INTO schema(schema_version, ros_distro) VALUES (4, 'rolling');";

/// Opens a new .db3 file with small pages and the tables of rosbag2.
pub(crate) fn bag_connection(path: &Path, journal: &str) -> rusqlite::Connection {
    let connection = rusqlite::Connection::open(path).unwrap();
    let set_up = format!(
        "PRAGMA page_size = 512; PRAGMA journal_mode = {journal}; PRAGMA synchronous = OFF; \
         {TABLES}"
    );
    connection.execute_batch(&set_up).unwrap();
    connection
}

/// Adds messages to a .db3 file.
pub(crate) fn add_to_bag(connection: &rusqlite::Connection, messages: &[Message]) {
    let mut topics = BTreeMap::new();
    for message in messages {
        let next = topics.len() as i64 + 1;
        let topic = *topics.entry(&message.topic).or_insert_with(|| {
            let add = "INSERT OR IGNORE INTO topics VALUES (?, ?, ?, 'cdr', '', '')";
            connection.execute(add, (next, &message.topic, &message.kind)).unwrap();
            next
        });
        let add = "INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)";
        connection.execute(add, (topic, message.received, &message.data)).unwrap();
    }
}

/// Writes a .db3 file.
pub(crate) fn bag(folder: &Path, messages: &[Message]) -> PathBuf {
    let path = folder.join("bag.db3");
    let connection = bag_connection(&path, "DELETE");
    connection.execute_batch("BEGIN").unwrap();
    add_to_bag(&connection, messages);
    connection.execute_batch("COMMIT").unwrap();
    path
}

/// Returns options for the joints a, b and c of [`TOPIC`].
pub(crate) fn options() -> LogOptions {
    LogOptions {
        topics: vec![TOPIC.into()],
        joints: ["a", "b", "c"].map(String::from).into(),
        ..LogOptions::default()
    }
}

pub(crate) fn read(path: &Path) -> Result<Log, Error> {
    Log::read(path, &options())
}

/// Returns the message of the error that reading gives.
pub(crate) fn error(path: &Path) -> String {
    read(path).unwrap_err().to_string()
}

/// Returns `count` states at 100 Hz from 1.7e9 s, with numbers of all digits. The order of the
/// joints is another in every message, and a gripper is among them.
pub(crate) fn states(count: usize) -> Vec<State> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    let state = |k: usize| {
        let mut order = ["a", "b", "c", "gripper"];
        order.rotate_left(k % 4);
        let values = [0, 1, 2].map(|_| order.map(|_| random.random_range(-2.0..2.0)).to_vec());
        let stamp = 1_700_000_000 * SECOND + 10_000_000 * k as i64 + (k as i64 * 7919) % 1000;
        State { stamp, names: order.map(String::from).into(), values }
    };
    (0..count).map(state).collect()
}

/// Returns the values of a state in the order of a, b and c: positions, velocities, efforts.
pub(crate) fn expected(state: &State) -> Vec<f64> {
    let of = |quantity: usize, joint: &str| {
        let place = state.names.iter().position(|name| name == joint).unwrap();
        state.values[quantity][place]
    };
    (0..3).flat_map(|quantity| ["a", "b", "c"].map(|joint| of(quantity, joint))).collect()
}
