//! Hostile files: every reader of a file refuses them in bounded time and memory, without a panic.
//!
//! `cargo test` tries a sample. `REACHTUBE_HOSTILE_INPUTS=10000000 cargo test --release
//! -p reachtube --test hostile -- --ignored` tries that many for each reader.
//! `REACHTUBE_HOSTILE_READERS=capsules,brakes` tries only these two.

mod mutation;
mod seeds;

use std::path::Path;

use mutation::attack;
use reachtube::Robot;
use reachtube::abstraction::PolynomialModel;
use reachtube::identify::IdentifySettings;
use reachtube::pipeline::Choices;
use reachtube::recordings::{DataSet, ReadOptions, read_csv};
use reachtube::verify::{Brakes, Capsules, Scenario};
use reachtube_robot::{Urdf, UrdfOptions};

/// Number of inputs for each reader in every test run.
const SAMPLE: u64 = 2000;

/// Memory that reading all of the inputs may reserve, bytes.
const MOST_MEMORY: u64 = 1 << 30;

/// Tries `count` inputs on each reader, and checks the memory that this takes.
fn try_all(count: u64) {
    let memory_before = reserved_memory();
    assert!(memory_before > 0 || cfg!(not(target_os = "linux")), "the memory is not known");
    let memory = Path::new("/dev/shm");
    let folder = if memory.is_dir() { memory.into() } else { std::env::temp_dir() };
    let folder = tempfile::tempdir_in(folder).unwrap();
    try_texts(count);
    try_files(count, folder.path());
    let grown = reserved_memory().saturating_sub(memory_before);
    assert!(grown < MOST_MEMORY, "reading reserved {grown} bytes");
}

/// Returns whether a reader is to be tried.
fn is_asked(name: &str) -> bool {
    let names = std::env::var("REACHTUBE_HOSTILE_READERS");
    names.map_or(true, |names| names.split(',').any(|asked| asked == name))
}

/// Tries the readers of text.
fn try_texts(count: u64) {
    let try_text = |name: &str, seeds: Vec<Vec<u8>>, read: &dyn Fn(&str)| {
        let count = if is_asked(name) { count } else { 0 };
        attack(name, &seeds, count, |bytes| read(&String::from_utf8_lossy(bytes)));
    };
    let options = UrdfOptions::default();
    try_text("toml", seeds::robots(), &|text| drop(Robot::from_toml(text, "robot.toml")));
    try_text("urdf", seeds::urdfs(), &|text| drop(Urdf::parse(text, "robot.urdf", &options)));
    let urdf = String::from_utf8(seeds::urdfs().remove(0)).unwrap();
    try_text("companion", seeds::companions(), &|text| {
        drop(Urdf::parse_with(&urdf, "robot.urdf", text, &options));
    });
    try_text("settings", seeds::settings(), &|text| {
        drop(IdentifySettings::from_toml(text, "settings.toml"));
    });
    try_text("choices", seeds::choices(), &|text| drop(Choices::from_toml(text)));
    let arm = seeds::arm();
    try_text("capsules", seeds::capsules(), &|text| {
        drop(Capsules::from_toml(text, "capsules.toml", &arm));
    });
    try_text("brakes", seeds::brakes(), &|text| {
        drop(Brakes::from_toml(text, "brakes.toml", &arm));
    });
    try_text("scenario", seeds::scenarios(), &|text| {
        let scenario = Scenario::parse(text.into(), "scenario.toml", Path::new(""));
        drop(scenario.and_then(|scenario| scenario.scene(&arm)));
    });
    let reached = seeds::reached();
    let shield = |text: &str| drop(seeds::shield(&arm, &reached, text.into()));
    try_text("shield", seeds::shields(), &shield);
}

/// Tries the readers of files, in a folder.
fn try_files(count: u64, folder: &Path) {
    let try_file = |name: &str, seeds: Vec<Vec<u8>>, read: &dyn Fn(&Path)| {
        let path = folder.join(name);
        let count = if is_asked(name) { count } else { 0 };
        attack(name, &seeds, count, |bytes| {
            std::fs::write(&path, bytes).unwrap();
            read(&path);
        });
    };
    let options = ReadOptions::default();
    try_file("run.csv", seeds::recordings(), &|path| drop(read_csv(path, &options)));
    // The index lists a recording that is there.
    std::fs::write(folder.join("run.csv"), seeds::recordings().remove(0)).unwrap();
    try_file("runs.csv", seeds::indices(), &|_| drop(DataSet::open(folder)));
    try_file("model.json", seeds::models(), &|path| drop(reachtube::arm::open(path)));
    try_file("abstraction.json", seeds::abstractions(), &|path| drop(PolynomialModel::load(path)));
}

/// Returns the most memory that the process has reserved, bytes; 0 if that is not known.
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

#[test]
fn files_are_read_before_they_are_made_hostile() {
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let (arm, options) = (seeds::arm(), UrdfOptions::default());
    for robot in seeds::robots() {
        Robot::from_toml(&text(robot), "robot.toml").unwrap();
    }
    let urdf = text(seeds::urdfs().remove(0));
    Urdf::parse(&urdf, "robot.urdf", &options).unwrap();
    for companion in seeds::companions() {
        Urdf::parse_with(&urdf, "robot.urdf", &text(companion), &options).unwrap();
    }
    for settings in seeds::settings() {
        IdentifySettings::from_toml(&text(settings), "settings.toml").unwrap();
    }
    for choices in seeds::choices() {
        Choices::from_toml(&text(choices)).unwrap();
    }
    for capsules in seeds::capsules() {
        Capsules::from_toml(&text(capsules), "capsules", &arm).unwrap();
    }
    for brakes in seeds::brakes() {
        Brakes::from_toml(&text(brakes), "brakes", &arm).unwrap();
    }
    for scenario in seeds::scenarios() {
        let scenario = Scenario::parse(text(scenario), "scenario", Path::new("")).unwrap();
        scenario.scene(&arm).unwrap();
    }
    for shield in seeds::shields() {
        seeds::shield(&arm, &seeds::reached(), text(shield)).unwrap();
    }
}

#[test]
fn recordings_and_models_are_read_before_they_are_made_hostile() {
    let folder = tempfile::tempdir().unwrap();
    let written = |name: &str, bytes: Vec<u8>| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    for recording in seeds::recordings() {
        read_csv(&written("run.csv", recording), &ReadOptions::default()).unwrap();
    }
    for index in seeds::indices() {
        written("runs.csv", index);
        DataSet::open(folder.path()).unwrap();
    }
    for model in seeds::models() {
        reachtube::arm::open(&written("model.json", model)).unwrap();
    }
    for abstraction in seeds::abstractions() {
        PolynomialModel::load(&written("abstraction.json", abstraction)).unwrap();
    }
}
