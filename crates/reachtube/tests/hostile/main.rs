//! Hostile files: every reader of a file refuses them in bounded time and memory, without a panic.
//!
//! `cargo test` tries a sample. `REACHTUBE_HOSTILE_INPUTS=10000000 cargo test --release -p reachtube
//! --test hostile -- --ignored` tries that many for each reader.

mod mutation;
mod seeds;

use std::path::Path;

use mutation::attack;
use reachtube::abstraction::PolynomialModel;
use reachtube::identify::IdentifySettings;
use reachtube::recordings::{DataSet, ReadOptions, read_csv};
use reachtube::{Model, Robot};
use reachtube_robot::{Urdf, UrdfEnds};

/// Number of inputs for each reader in every test run.
const SAMPLE: u64 = 2000;

/// Memory that reading all of the inputs may reserve, bytes.
const MOST_MEMORY: u64 = 1 << 30;

/// Runs a reader of text; bytes that are not text are no input for it.
fn of_text(read: impl Fn(&str)) -> impl FnMut(&[u8]) {
    move |bytes| read(&String::from_utf8_lossy(bytes))
}

/// Runs a reader of files.
fn of_file(path: &Path, read: impl Fn(&Path)) -> impl FnMut(&[u8]) {
    move |bytes| {
        std::fs::write(path, bytes).unwrap();
        read(path);
    }
}

/// Tries `count` inputs on each reader.
fn try_all(count: u64) {
    let memory_before = reserved_memory();
    let memory = Path::new("/dev/shm");
    let folder =
        tempfile::tempdir_in(if memory.is_dir() { memory.into() } else { std::env::temp_dir() });
    let folder = folder.unwrap();
    let at = |name: &str| folder.path().join(name);
    let csv = at("run.csv");
    attack(
        "csv",
        &seeds::recordings(),
        count,
        of_file(&csv, |path| {
            let _ = read_csv(path, &ReadOptions::default());
        }),
    );
    std::fs::write(&csv, seeds::recordings().remove(0)).unwrap();
    attack(
        "index",
        &seeds::indices(),
        count,
        of_file(&at("runs.csv"), |path| {
            let _ = DataSet::open(path.parent().unwrap());
        }),
    );
    attack(
        "toml",
        &seeds::robots(),
        count,
        of_text(|text| {
            let _ = Robot::from_toml(text, "robot.toml");
        }),
    );
    attack(
        "urdf",
        &seeds::urdfs(),
        count,
        of_text(|text| {
            let _ = Urdf::parse(text, "robot.urdf", &UrdfEnds::default());
        }),
    );
    attack(
        "companion",
        &seeds::companions(),
        count,
        of_text(|text| {
            let urdf = String::from_utf8(seeds::urdfs().remove(0)).unwrap();
            let _ = Urdf::parse_with(&urdf, "robot.urdf", text, &UrdfEnds::default());
        }),
    );
    attack(
        "settings",
        &seeds::settings(),
        count,
        of_text(|text| {
            let _ = IdentifySettings::from_toml(text, "settings.toml");
        }),
    );
    attack(
        "model",
        &seeds::models(),
        count,
        of_file(&at("model.json"), |path| {
            let _ = Model::open(path);
        }),
    );
    attack(
        "abstraction",
        &seeds::abstractions(),
        count,
        of_file(&at("a.json"), |path| {
            let _ = PolynomialModel::load(path);
        }),
    );
    let grown = reserved_memory().saturating_sub(memory_before);
    assert!(grown < MOST_MEMORY, "reading reserved {grown} bytes");
}

/// Returns the most memory that the process has reserved, bytes; 0 where that is not known.
fn reserved_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmPeak:"));
    let kilobytes = peak.and_then(|peak| peak.split_whitespace().next()?.parse::<u64>().ok());
    1024 * kilobytes.unwrap_or(0)
}

#[test]
fn a_sample_of_hostile_files_is_read_without_harm() {
    try_all(SAMPLE);
}

#[test]
#[ignore = "takes long; REACHTUBE_HOSTILE_INPUTS sets the number of inputs"]
fn many_hostile_files_are_read_without_harm() {
    let count = std::env::var("REACHTUBE_HOSTILE_INPUTS").ok();
    try_all(count.map_or(10 * SAMPLE, |count| count.parse().unwrap()));
}
