//! Time of the identification of a UR10e from recordings.
//!
//! The recordings are expected in `../shared/data/ur10e` beside the repository. Without them
//! nothing is measured.

use divan::Bencher;
use reachtube_identify::{IdentifySettings, identify};
use reachtube_robot::Robot;
use std::path::Path;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/ur10e");

const SETTINGS: &str = r#"
    rest = ["static"]
    one_joint = ["friction"]
    excitation = ["excitation"]
    validate = ["loaded", "repeated"]
    prepare.cut_off = 6.0
"#;

fn main() {
    divan::main();
}

/// Measures the whole job for 29 recordings of 15 minutes in total: reading, preparation, three
/// fits, physically consistent links, prediction and simulation.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn all_ur10e_logs(bencher: Bencher) {
    let folder = Path::new(FOLDER);
    if !folder.exists() {
        println!("skipped: {FOLDER} does not exist");
        return;
    }
    let robot = Robot::load(&folder.join("ur10e.urdf").display().to_string()).unwrap();
    let settings = IdentifySettings::from_toml(SETTINGS, "settings").unwrap();
    bencher.bench(|| identify(&robot, &settings, folder, &|_, _| {}).unwrap());
}
