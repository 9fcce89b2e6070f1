//! Systems that are seen through their outputs.

mod arx;
mod by_hand;
mod crowd;
mod files;
mod gray;

use std::path::Path;

use reachtube_systems::{OutputSystem, SystemRun};

/// Returns the system of a description in TOML.
fn system(text: &str) -> OutputSystem {
    OutputSystem::new(toml::from_str(text).unwrap()).unwrap()
}

/// Returns a run of samples that are one time apart.
fn run(name: &str, step: f64, inputs: &[f64], outputs: &[f64], width: usize) -> SystemRun {
    let times = (0..outputs.len() / width).map(|k| k as f64 * step).collect();
    SystemRun::of_numbers(name, times, inputs.to_vec(), outputs.to_vec(), None)
}

/// Reads a description, and returns what is wrong with it.
fn wrong(text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("system.toml");
    std::fs::write(&path, text).unwrap();
    OutputSystem::open(Path::new(&path)).unwrap_err().to_string()
}
