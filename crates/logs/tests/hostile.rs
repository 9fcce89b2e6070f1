//! Hostile input: readers never panic, are never slow, and take no more memory than their limit.

#[path = "../../reachtube/tests/hostile/mutation.rs"]
mod mutation;
#[path = "logs/support.rs"]
mod support;
use std::path::Path;

use mutation::attack;
use reachtube_logs::{Log, LogOptions};
use reachtube_recordings::Wanted;
use support::*;

/// Most memory that all inputs together may add, KiB. One chunk may have 256 MiB, twice while it
/// is decompressed.
const MEMORY: u64 = 600 << 10;

/// Returns the largest amount of memory that the process has had, KiB, where the system says so.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

/// Returns small logs of all formats.
fn seeds(folder: &Path) -> [Vec<Vec<u8>>; 2] {
    let mut messages = messages(&states(12));
    messages.push(Message::string(at_end(&messages), "A"));
    let kinds = ["unchunked", "none", "zstd", "lz4"];
    let mcap = kinds.map(|compression| mcap_bytes(compression, &messages));
    [mcap.into(), vec![std::fs::read(bag(folder, &messages)).unwrap()]]
}

fn at_end(messages: &[Message]) -> i64 {
    messages.last().unwrap().received + 1
}

/// Reads an input with and without recovery.
fn read_all(path: &Path, bytes: &[u8]) {
    std::fs::write(path, bytes).unwrap();
    let _ = reachtube_logs::read_commands(path, &Default::default(), &[], Wanted::Plan);
    for recover in [false, true] {
        let marker = Some("/marker".into());
        let log = Log::read(path, &LogOptions { recover, marker, ..options() });
        if let Ok(log) = log {
            let logs = [log];
            let cuts = reachtube_logs::Cutting::Marked.runs(&logs);
            let cuts = cuts.unwrap_or_else(|_| reachtube_logs::Cutting::Whole.runs(&logs).unwrap());
            let _ = reachtube_logs::convert(&logs, &cuts, Default::default());
        }
    }
}

fn attack_logs(count: u64) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log");
    let before = peak();
    let seeds = seeds(folder.path());
    for (name, seeds) in ["MCAP", "rosbag2"].iter().zip(&seeds) {
        attack(name, seeds, count, |bytes| read_all(&path, bytes));
    }
    // One byte at a time, so that lengths, counts and kinds are all met.
    for seed in seeds.concat() {
        for at in (0..seed.len()).step_by(seed.len().div_ceil(count as usize)) {
            let mut bytes = seed.clone();
            bytes[at] ^= 1 << (at % 8);
            read_all(&path, &bytes);
            bytes[at] = 0xff;
            read_all(&path, &bytes);
        }
    }
    if let (Some(before), Some(after)) = (before, peak()) {
        assert!(after - before < MEMORY, "{} KiB", after - before);
    }
}

#[test]
fn a_sample_of_hostile_logs_is_read_without_harm() {
    attack_logs(400);
}

#[test]
#[ignore = "takes long; REACHTUBE_HOSTILE_INPUTS sets the number of inputs"]
fn many_hostile_logs_are_read_without_harm() {
    let count = std::env::var("REACHTUBE_HOSTILE_INPUTS").ok();
    attack_logs(count.map_or(10_000, |count| count.parse().unwrap()));
}
