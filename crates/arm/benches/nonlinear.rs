//! Conformance of models that are not linear, on the paper's recordings in
//! ../shared/data/schunk_lwa4p. Without them there is nothing to measure.

use std::path::Path;

use divan::Bencher;
use reachtube_abstraction::{Abstraction, ModelKind};
use reachtube_arm::{ArmSettings, setup};
use reachtube_conform::settings::Method;
use reachtube_conform::{Keep, Problem, Settings, Silent, conform};
use reachtube_recordings::{DataSet, Torque};
use reachtube_robot::Robot;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/schunk_lwa4p");

fn main() {
    divan::main();
}

/// Reads suites A, B, D and E, 73 recordings of up to 4.35 s at 250 Hz, and finds their sets.
fn run(bencher: Bencher, abstraction: Abstraction, method: Method) {
    if !Path::new(FOLDER).exists() {
        println!("skipped: {FOLDER} does not exist");
        return;
    }
    let names = ["A", "B", "D", "E"].map(String::from);
    let arm = ArmSettings { abstraction, ..ArmSettings::new(Torque::Compensated, 6) };
    let settings = Settings { method, ..Settings::default() };
    bencher.bench(|| {
        let setup = setup(Robot::lwa4p(), arm.clone(), settings.clone()).unwrap();
        let source = Box::new(DataSet::open(FOLDER).unwrap());
        let problem = Problem::read(setup, source, &names, Keep::Needed, &Silent).unwrap();
        conform(&problem, &Silent, None).unwrap()
    });
}

/// Model and order.
#[divan::bench(args = [(1, 3), (2, 3), (2, 5)], sample_count = 5, sample_size = 1)]
fn programs(bencher: Bencher, (model, order): (u32, u32)) {
    let model = ModelKind::try_from(model).unwrap();
    run(bencher, Abstraction { model, order }, Method::Program);
}

#[divan::bench(sample_count = 1, sample_size = 1)]
fn bisection_of_model_1_of_order_3(bencher: Bencher) {
    let abstraction = Abstraction { model: ModelKind::One, order: 3 };
    run(bencher, abstraction, Method::Bisection);
}
