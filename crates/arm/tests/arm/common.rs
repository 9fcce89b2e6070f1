//! Recordings of a linear system with known disturbances, written as a data set.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use nalgebra::DVector;
use reachtube_abstraction::{ExpansionPoint, linear_model};
use reachtube_arm::{ArmModel, ArmSettings};
use reachtube_conform::fleet::Fold;
use reachtube_conform::{
    Check, Conformance, Keep, Model, Problem, Settings, Setup, Silent, Tube, check, conform,
};
use reachtube_reach::{LinearSystem, TimeGrid};
use reachtube_recordings::{DataSet, RunSource, Torque};
use reachtube_robot::Robot;

/// Returns a folder of real recordings. Tests that need one are ignored unless asked for.
pub(crate) fn shared(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(folder)
}

/// Xorshift64*: enough for tests, the same everywhere.
pub(crate) struct Random(pub u64);

impl Random {
    /// Uniform in [-1, 1].
    pub(crate) fn signed(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11;
        bits as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// The setup of a robot whose recorded torques are compensated, unless `adjust` says otherwise.
pub(crate) fn setup(robot: &Robot, adjust: impl FnOnce(&mut ArmSettings, &mut Settings)) -> Setup {
    let mut arm = ArmSettings::new(Torque::Compensated, robot.joint_count());
    let mut settings = Settings::default();
    adjust(&mut arm, &mut settings);
    reachtube_arm::setup(robot.clone(), arm, settings).unwrap()
}

/// Reads the suites `names` of the data set in `folder` (all when none is named).
pub(crate) fn read(robot: &Robot, folder: &Path, names: &[&str], settings: &Settings) -> Problem {
    read_with(setup(robot, |_, sets| sets.clone_from(settings)), folder, names)
}

pub(crate) fn read_with(setup: Setup, folder: &Path, names: &[&str]) -> Problem {
    let names: Vec<String> = names.iter().map(|name| name.to_string()).collect();
    let data = DataSet::open(folder).unwrap();
    Problem::read(setup, Box::new(data), &names, Keep::Needed, &Silent).unwrap()
}

/// Finds and proves the smallest sets.
pub(crate) fn conform_all(problem: &Problem) -> Conformance {
    conform(problem, &Silent, None).unwrap()
}

/// Folds all recordings of a source.
pub(crate) fn fold_of(setup: &Setup, runs: &dyn RunSource) -> Fold {
    let mut fold = Fold::new(setup).unwrap();
    fold.take_source(runs, 0).unwrap();
    fold
}

/// Checks recordings against a model, as its file would.
pub(crate) fn check_against(model: &Model, folder: &Path, names: &[&str]) -> Check {
    let robot = Robot::from_description(&model.robot()).unwrap();
    let setup = reachtube_arm::setup(robot, model.arm().settings, model.settings.clone());
    let problem = read_with(setup.unwrap(), folder, names);
    let tube = Tube::new(&problem, model.sets()).unwrap();
    check(model, &problem, &tube).unwrap()
}

/// One run: times, states (K x 2n), torques (K x n).
#[derive(Clone)]
pub(crate) struct Recorded {
    pub times: Vec<f64>,
    pub states: Vec<f64>,
    pub torques: Vec<f64>,
}

/// Friction that bends and joints that move each other.
pub(crate) fn bent() -> Robot {
    let joint = |name: &str, mass: f64, viscous: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\n\
             dh = {{ a = 0.3, alpha = 0.0, theta = 0.0, d = 0.0 }}\n\
             mass = {mass}\ncom = [-0.15, 0.0, 0.0]\n\
             inertia = [0.01, 0.0, 0.0, 0.02, 0.0, 0.02]\narmature = 0.3\n\
             friction = {{ viscous = {viscous} }}\n"
        )
    };
    let text = format!(
        "schema_version = 1\nname = \"bent\"\n{}{}",
        joint("shoulder", 2.0, "[2.0, 0.2, -0.3]"),
        joint("elbow", 1.5, "[1.0, 0.0, 0.4]")
    );
    Robot::from_toml(&text, "bent").unwrap()
}

/// What moves the virtual arm.
pub(crate) struct Disturbed<'a> {
    pub robot: &'a Robot,
    pub times: &'a [f64],
    /// Radius of the initial states, rad and rad/s.
    pub start: f64,
    /// Radius of the input disturbance, N m, held over each sample.
    pub input: f64,
}

impl Disturbed<'_> {
    /// The recording of model 1 under a sine input that is the same for each `random`, and random
    /// disturbances.
    pub(crate) fn record(&self, random: &mut Random) -> Recorded {
        let n = self.robot.joint_count();
        let system = linear_model(self.robot, &ExpansionPoint::zero(n)).unwrap();
        let mut x = DVector::from_fn(2 * n, |_, _| self.start * random.signed());
        let (mut states, mut torques) = (Vec::new(), Vec::new());
        for (k, &t) in self.times.iter().enumerate() {
            let u = DVector::from_fn(n, |j, _| (3.0 * t + j as f64).sin());
            states.extend(x.iter());
            torques.extend(u.iter());
            let du = DVector::from_fn(n, |_, _| self.input * random.signed());
            if let Some(next) = self.times.get(k + 1) {
                x = step(&system, next - t, &x, &(u + du));
            }
        }
        Recorded { times: self.times.to_vec(), states, torques }
    }
}

/// One step by a Taylor series of the augmented matrix, independent of the library's enclosures.
pub(crate) fn step(
    system: &LinearSystem,
    h: f64,
    x: &DVector<f64>,
    u: &DVector<f64>,
) -> DVector<f64> {
    let mut term = (system.a() * x + system.b() * u) * h;
    let mut sum = x.clone();
    for i in 2..30 {
        sum += &term;
        term = system.a() * term * (h / i as f64);
    }
    sum
}

/// The grid of every suite of a test.
pub(crate) fn grid(step: f64, samples: usize) -> Vec<f64> {
    TimeGrid::uniform(step, samples).times().to_vec()
}

/// Writes suites, each with its runs and a motion of its own, and runs.csv.
pub(crate) fn write_data_set(folder: &Path, suites: &[(&str, Vec<Recorded>)]) {
    let mut index = String::from("file,suite,motion\n");
    for (suite, runs) in suites {
        for (repeat, run) in runs.iter().enumerate() {
            let file = format!("{suite}_{repeat:02}.csv");
            let _ = writeln!(index, "{file},{suite},{suite}");
            std::fs::write(folder.join(file), csv(run)).unwrap();
        }
    }
    std::fs::write(folder.join("runs.csv"), index).unwrap();
}

fn csv(run: &Recorded) -> String {
    let samples = run.times.len();
    let n = run.torques.len() / samples;
    let names =
        ["q", "qd", "tau"].iter().flat_map(|kind| (1..=n).map(move |i| format!("{kind}{i}")));
    let mut text = format!("t,{}\n", names.collect::<Vec<_>>().join(","));
    for k in 0..samples {
        let _ = write!(text, "{}", run.times[k]);
        let row =
            run.states[k * 2 * n..(k + 1) * 2 * n].iter().chain(&run.torques[k * n..(k + 1) * n]);
        row.for_each(|value| {
            let _ = write!(text, ",{value}");
        });
        text.push('\n');
    }
    text
}

/// Two coupled joints with viscous friction.
pub(crate) fn two_joints() -> Robot {
    let text = r#"
        schema_version = 1
        name = "two joints"
        [[joint]]
        name = "shoulder"
        dh = { a = 0.3, alpha = 0.0, theta = 0.0, d = 0.0 }
        mass = 2.0
        com = [-0.15, 0.0, 0.0]
        inertia = [0.01, 0.0, 0.0, 0.02, 0.0, 0.02]
        armature = 0.3
        friction = { viscous = [2.0, 0.0, 0.0] }
        [[joint]]
        name = "elbow"
        dh = { a = 0.25, alpha = 0.0, theta = 0.0, d = 0.0 }
        mass = 1.5
        com = [-0.12, 0.0, 0.0]
        inertia = [0.01, 0.0, 0.0, 0.02, 0.0, 0.02]
        armature = 0.2
        friction = { viscous = [1.0, 0.0, 0.0] }
    "#;
    Robot::from_toml(text, "two joints").unwrap()
}
