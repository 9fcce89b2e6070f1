//! Identification from recordings: all of the UR10e's (../shared/data/ur10e; without it there is
//! nothing to measure).

use divan::Bencher;
use reachtube_identify::{IdentifySettings, identify};
use reachtube_robot::Robot;
use std::path::Path;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/ur10e");

const SETTINGS: &str = r#"
    static = ["static"]
    friction = ["friction"]
    dynamic = ["excitation"]
    validate = ["loaded", "repeated"]
    prepare.cut_off = 6.0
"#;

fn main() {
    divan::main();
}

/// 29 recordings, 15 minutes: reading, preparing, three fits, bodies, prediction and simulation.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn all_ur10e_logs(bencher: Bencher) {
    let folder = Path::new(FOLDER);
    if !folder.exists() {
        println!("{FOLDER} is lacking");
        return;
    }
    let robot = Robot::load(&folder.join("ur10e.urdf").display().to_string()).unwrap();
    let settings = IdentifySettings::from_toml(SETTINGS, "settings").unwrap();
    bencher.bench(|| identify(&robot, &settings, folder, &|_, _| {}).unwrap());
}
