//! Conformance of models that are not linear, on the paper's recordings
//! (../shared/data/schunk_lwa4p; without them there is nothing to measure).

use std::path::Path;

use divan::Bencher;
use reachtube_abstraction::{Abstraction, ModelKind};
use reachtube_conform::{Method, Settings, Tolerance, Watch, conform};
use reachtube_recordings::{DataSet, Torque};
use reachtube_robot::Robot;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/schunk_lwa4p");

fn main() {
    divan::main();
}

/// Suites A, B, D and E: 73 recordings of up to 4.35 s at 250 Hz.
fn run(bencher: Bencher, adjust: impl Fn(Settings) -> Settings) {
    if !Path::new(FOLDER).exists() {
        println!("{FOLDER} is lacking");
        return;
    }
    let (robot, data) = (Robot::lwa4p(), DataSet::open(FOLDER).unwrap());
    let names: Vec<String> = ["A", "B", "D", "E"].map(String::from).to_vec();
    let settings = adjust(Settings::new(Torque::Compensated, 6));
    bencher.bench(|| conform(&robot, &data, &names, &settings, &Watch::SILENT).unwrap());
}

/// Model and order.
#[divan::bench(args = [(1, 3), (2, 3), (2, 5)], sample_count = 5, sample_size = 1)]
fn programs(bencher: Bencher, (model, order): (u32, u32)) {
    let model = ModelKind::try_from(model).unwrap();
    run(bencher, |settings| Settings { abstraction: Abstraction { model, order }, ..settings });
}

#[divan::bench(sample_count = 1, sample_size = 1)]
fn bisection_of_model_1_of_order_3(bencher: Bencher) {
    let abstraction = Abstraction { model: ModelKind::One, order: 3 };
    run(bencher, |settings| Settings { abstraction, method: Method::Bisection, ..settings });
}

/// The linear model, and the closest motion to each of the 73 recordings.
#[divan::bench(sample_count = 3, sample_size = 1)]
fn explanations(bencher: Bencher) {
    run(bencher, |settings| Settings { explain: Some(Tolerance::default()), ..settings });
}
