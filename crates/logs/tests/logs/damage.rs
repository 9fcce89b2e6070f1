//! Damaged logs: an error that names the place, and what `recover` keeps.

use std::path::{Path, PathBuf};

use crate::support::*;
use mcap::records::op;
use reachtube_logs::{Log, LogOptions};
use reachtube_recordings::{GapLimit, ReadOptions, RunSource};

/// Returns kind, offset and whole length of every record of an MCAP file.
fn records(bytes: &[u8]) -> Vec<(u8, usize, usize)> {
    let mut found = vec![];
    let mut at = 8;
    while at + 9 < bytes.len() {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize + 9;
        found.push((bytes[at], at, length));
        at += length;
    }
    found
}

/// Returns offset and length of the records of one kind.
fn of_kind(bytes: &[u8], kind: u8) -> Vec<(usize, usize)> {
    let all = records(bytes).into_iter().filter(|record| record.0 == kind);
    all.map(|(_, offset, length)| (offset, length)).collect()
}

fn recover(path: &Path) -> Log {
    Log::read(path, &LogOptions { recover: true, ..options() }).unwrap()
}

/// Checks that a log holds the first of these states, and returns their number.
fn is_start_of(log: &Log, states: &[State]) -> usize {
    let logs = std::slice::from_ref(log);
    let cuts = reachtube_logs::Cutting::Whole.runs(logs).unwrap();
    if cuts.is_empty() {
        return 0;
    }
    let runs = reachtube_logs::convert(logs, &cuts, GapLimit::Usual).unwrap().into_runs();
    let run = runs.read(0, &ReadOptions::default()).unwrap();
    assert!(run.len() <= states.len());
    for (k, state) in states.iter().enumerate().take(run.len()) {
        assert_eq!([run.state(k), run.torque(k)].concat(), expected(state));
    }
    run.len()
}

/// Writes bytes to a file `log` in a folder.
fn file(folder: &Path, bytes: &[u8]) -> PathBuf {
    let path = folder.join("log");
    std::fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn a_file_that_ends_in_a_chunk_keeps_the_chunks_before() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(200);
    for compression in ["none", "zstd", "lz4"] {
        let bytes = mcap_bytes(compression, &messages(&states));
        let chunks = of_kind(&bytes, op::CHUNK);
        let (offset, length) = chunks[chunks.len() / 2];
        let path = file(folder.path(), &bytes[..offset + length * 3 / 4]);
        let text = error(&path);
        let place = format!("log: byte {offset}: the file ends in the middle of a chunk of ");
        assert!(text.contains(&place) && text.contains("--recover keeps"), "{text}");
        let log = recover(&path);
        let kept = is_start_of(&log, &states);
        assert!(kept > 50 && kept < 150, "{kept}");
        let [loss] = log.losses() else { panic!("{:?}", log.losses()) };
        assert_eq!((loss.offset, loss.bytes), (Some(offset as u64), Some(length as u64 * 3 / 4)));
        assert_eq!(loss.received.unwrap()[0], states[kept].stamp + 1_000_000);
        if compression == "none" {
            assert!(loss.messages > 3, "{loss}");
        }
    }
}

#[test]
fn a_file_without_footer_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(60);
    let bytes = mcap_bytes("zstd", &messages(&states));
    let (end, _) = of_kind(&bytes, op::DATA_END)[0];
    for (length, words) in [
        (end, "the file ends without its footer, for example after a loss of power"),
        (end + 4, "the file ends in the middle of a record"),
        (bytes.len() - 1, "the data is whole, but the file ends without its footer"),
    ] {
        let path = file(folder.path(), &bytes[..length]);
        let text = error(&path);
        assert!(text.contains(&format!("byte {end}: {words}")), "{text}");
        let log = recover(&path);
        assert_eq!(is_start_of(&log, &states), 60);
        assert!(log.losses()[0].bytes.unwrap() <= 4, "{:?}", log.losses());
    }
}

#[test]
fn a_file_that_ends_in_zeros_keeps_what_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(60);
    let mut bytes = mcap_bytes("lz4", &messages(&states));
    let (offset, length) = of_kind(&bytes, op::CHUNK)[3];
    let next = records(&bytes).iter().find(|record| record.1 > offset).unwrap().1;
    assert_eq!(next, offset + length);
    bytes[next..].fill(0);
    let path = file(folder.path(), &bytes);
    let text = error(&path);
    assert!(text.contains(&format!("byte {next}: no record starts here")), "{text}");
    assert!(is_start_of(&recover(&path), &states) > 20);
}

#[test]
fn a_changed_byte_costs_one_chunk() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(200);
    for compression in ["none", "zstd", "lz4"] {
        let mut bytes = mcap_bytes(compression, &messages(&states));
        let (offset, length) = of_kind(&bytes, op::CHUNK)[5];
        bytes[offset + length / 2] ^= 0x10;
        let path = file(folder.path(), &bytes);
        let text = error(&path);
        assert!(text.contains(&format!("byte {offset}: the chunk that starts here")), "{text}");
        let log = recover(&path);
        assert_eq!(log.losses().len(), 1, "{:?}", log.losses());
        assert!((180..200).contains(&log.len()), "{}", log.len());
        // The hole is a gap, which a run may not have.
        let cuts = reachtube_logs::Cutting::Whole.runs(std::slice::from_ref(&log)).unwrap();
        let text = reachtube_logs::convert(&[log], &cuts, GapLimit::Usual).unwrap_err().to_string();
        assert!(text.contains("there is a gap of 0."), "{text}");
    }
}

#[test]
fn any_length_of_a_file_gives_an_error_and_its_first_samples() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(25);
    for compression in ["unchunked", "none", "zstd", "lz4"] {
        let bytes = mcap_bytes(compression, &messages(&states));
        assert_eq!(is_start_of(&recover(&file(folder.path(), &bytes)), &states), 25);
        let mut kept = 0;
        for length in (0..bytes.len()).step_by(7) {
            let path = file(folder.path(), &bytes[..length]);
            read(&path).unwrap_err();
            let log = Log::read(&path, &LogOptions { recover: true, ..options() });
            let count = log.map_or(0, |log| is_start_of(&log, &states));
            assert!(count >= kept, "{compression}: {length}");
            kept = count;
        }
        assert_eq!(kept, 25);
    }
}

#[test]
fn a_truncated_bag_keeps_its_first_messages() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(300);
    let bytes = std::fs::read(bag(folder.path(), &messages(&states))).unwrap();
    let length = bytes.len() * 6 / 10 + 100;
    let path = file(folder.path(), &bytes[..length]);
    let text = error(&path);
    let place = format!("log: byte {length}: the file ends here, but its header announces ");
    assert!(text.contains(&place) && text.contains("--recover keeps"), "{text}");
    let log = recover(&path);
    let kept = is_start_of(&log, &states);
    assert!((100..200).contains(&kept), "{kept}");
    let lost: Vec<String> = log.losses().iter().map(ToString::to_string).collect();
    assert!(lost[0].contains(&format!("lost: {} bytes", bytes.len() - length)), "{lost:?}");
    assert!(lost[1].contains(&format!("the messages after row {kept} of the table")), "{lost:?}");
}

#[test]
fn a_damaged_page_of_a_bag_has_a_place() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(300);
    let mut bytes = std::fs::read(bag(folder.path(), &messages(&states))).unwrap();
    // A page of messages in the middle, not of the index of times.
    let needle = states[150].values[0][0].to_le_bytes();
    let at = bytes.windows(8).position(|window| window == needle).unwrap() / 512 * 512;
    bytes[at..at + 8].fill(0xff);
    let path = file(folder.path(), &bytes);
    let text = error(&path);
    assert!(text.contains("SQLite finds that the file is damaged"), "{text}");
    let log = recover(&path);
    let kept = is_start_of(&log, &states);
    assert!((100..200).contains(&kept), "{kept}");
    assert!(log.losses()[0].messages >= 100, "{:?}", log.losses());
}

/// Copies a .db3 file and what lies beside it, as a computer that loses power leaves them.
fn snapshot(path: &Path, folder: &Path, beside: &str) -> PathBuf {
    let copy = folder.join("copy.db3");
    std::fs::copy(path, &copy).unwrap();
    let journal = |path: &Path| PathBuf::from(format!("{}{beside}", path.display()));
    if !beside.is_empty() {
        std::fs::copy(journal(path), journal(&copy)).unwrap();
    }
    copy
}

#[test]
fn an_unfinished_transaction_is_undone_in_a_copy() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(300);
    let path = folder.path().join("bag.db3");
    let connection = bag_connection(&path, "DELETE");
    // The cache is so small that pages are written before the transaction ends.
    connection.execute_batch("PRAGMA cache_size = 5; BEGIN").unwrap();
    add_to_bag(&connection, &messages(&states[..100]));
    connection.execute_batch("COMMIT; BEGIN").unwrap();
    add_to_bag(&connection, &messages(&states[100..]));
    let copy = snapshot(&path, folder.path(), "-journal");
    let before = std::fs::read(&copy).unwrap();
    let text = error(&copy);
    assert!(text.contains("copy.db3-journal undoes (in a copy)"), "{text}");
    let log = recover(&copy);
    assert_eq!(is_start_of(&log, &states), 100);
    assert_eq!(std::fs::read(&copy).unwrap(), before);
    // Without its journal, the file is as the recorder left it in the middle of a write.
    std::fs::remove_file(folder.path().join("copy.db3-journal")).unwrap();
    let text = error(&copy);
    assert!(text.contains("--recover keeps"), "{text}");
    assert!(is_start_of(&recover(&copy), &states) >= 90);
}

#[test]
fn a_write_ahead_log_is_read_with_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let states = states(200);
    let path = folder.path().join("bag.db3");
    let connection = bag_connection(&path, "WAL");
    connection.execute_batch("PRAGMA wal_autocheckpoint = 0").unwrap();
    add_to_bag(&connection, &messages(&states[..80]));
    connection.query_row("PRAGMA wal_checkpoint(TRUNCATE)", [], |_| Ok(())).unwrap();
    add_to_bag(&connection, &messages(&states[80..]));
    let copy = snapshot(&path, folder.path(), "-wal");
    let log = read(&copy).unwrap();
    assert_eq!(is_start_of(&log, &states), 200);
    assert!(log.notes()[0].contains("copy.db3-wal were read too"), "{:?}", log.notes());
    std::fs::remove_file(folder.path().join("copy.db3-wal")).unwrap();
    let log = read(&copy).unwrap();
    assert_eq!(is_start_of(&log, &states), 80);
    assert!(log.notes()[0].contains("copy.db3-wal, which is not there"), "{:?}", log.notes());
}
