//! Models over recorded inputs: of the embedded robot with made-up recordings, of the paper's robot
//! and of a UR10e.

use std::path::{Path, PathBuf};

use reachtube::arm::{ArmSettings, setup};
use reachtube::conform::{Settings, Tube, UncertaintySets};
use reachtube::export::{ExportCase, ExportFile, InputForm, Tool, files};
use reachtube::recordings::DataSet;
use reachtube::{
    Abstraction, ExpansionPoint, Hyperrectangle, Keep, MemoryRuns, ModelKind, Problem, Robot, Run,
    RunSource, Silent, Torque,
};

/// Models and orders that every test takes: affine, cubic, and with sines and cosines.
pub(crate) const MODELS: [(ModelKind, u32); 3] =
    [(ModelKind::One, 1), (ModelKind::One, 3), (ModelKind::Two, 3)];

/// Numbers without short decimals, the same everywhere.
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new() -> Self {
        Self(9)
    }

    /// Returns a number in (-1, 1).
    pub(crate) fn signed(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11;
        bits as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self, count: usize, radius: f64) -> Vec<f64> {
        (0..count).map(|_| radius * self.signed()).collect()
    }
}

/// Returns the cases of a model over recordings, with sets of radius about 1e-4.
pub(crate) fn cases_of(
    robot: &Robot,
    (model, order): (ModelKind, u32),
    point: ExpansionPoint,
    source: Box<dyn RunSource>,
    [suites, until]: [Option<&str>; 2],
) -> Vec<ExportCase> {
    let n = robot.joint_count();
    let mut arm = ArmSettings::new(Torque::Compensated, n);
    (arm.abstraction, arm.expansion_point) = (Abstraction { model, order }, point);
    let until = until.map(|seconds| seconds.parse().unwrap());
    let setup = setup(robot.clone(), arm, Settings { until, ..Settings::default() }).unwrap();
    let names: Vec<String> = suites.iter().map(|name| (*name).to_string()).collect();
    let problem = Problem::read(setup, source, &names, Keep::Needed, &Silent).unwrap();
    let mut numbers = Numbers::new();
    let mut some_box = |count: usize, scale: f64| Hyperrectangle {
        centre: numbers.vector(count, scale),
        radius: numbers.vector(count, scale).iter().map(|r| r.abs()).collect(),
    };
    let (initial_set, input_set) = (some_box(2 * n, 1e-4), some_box(n, 1e-2));
    let sets = UncertaintySets { initial_set, input_set, noise_set: None };
    let tube = Tube::new(&problem, sets).unwrap();
    ExportCase::all(&problem, &tube).unwrap()
}

/// Returns two runs of `samples` samples at these times with the same made-up input.
pub(crate) fn made_up(joints: usize, times: &[f64]) -> Box<dyn RunSource> {
    let mut numbers = Numbers::new();
    let inputs = numbers.vector(joints * times.len(), 3.0);
    let mut runs = MemoryRuns::default();
    for name in ["first", "second"] {
        let states = numbers.vector(2 * joints * times.len(), 0.3);
        let run = Run::new(joints, times.to_vec(), states, inputs.clone()).unwrap();
        runs.push(name, Some("A"), None, run);
    }
    Box::new(runs)
}

/// Returns the embedded robot's model over a made-up recording.
pub(crate) fn lwa4p(model: (ModelKind, u32)) -> ExportCase {
    let point = ExpansionPoint::zero(6);
    let source = made_up(6, &[0.0, 0.004, 0.008, 0.012]);
    cases_of(&Robot::lwa4p(), model, point, source, [None; 2]).remove(0)
}

/// Returns a model about a point with velocities and inputs, so that its terms have origins.
pub(crate) fn about_a_moving_point() -> ExportCase {
    let mut numbers = Numbers::new();
    let point = ExpansionPoint::from_values(&numbers.vector(18, 0.4), 6).unwrap();
    let source = made_up(6, &[0.0, 0.004, 0.008]);
    cases_of(&Robot::lwa4p(), (ModelKind::Three, 2), point, source, [None; 2]).remove(0)
}

/// An arm with every kind of placement, a slide, tilted gravity and motors.
pub(crate) fn every_kind() -> Robot {
    let text = r#"
        schema_version = 1
        name = "every <kind>"
        convention = "modified"
        gravity = [0.3, -1.1, -9.7]
        [[joint]]
        name = "turn"
        dh = { a = 0.1, alpha = 0.4, theta = 0.7, d = 0.3 }
        mass = 2.0
        com = [0.1, -0.2, 0.05]
        inertia = [0.02, 0.001, -0.002, 0.03, 0.003, 0.025]
        armature = 0.2
        [joint.friction]
        viscous = [1.5, 0.0, 0.0]
        coulomb = [2.0, 0.0, -2.0, 0.0, -2.0, 0.0, 2.0, 0.0]
        [[joint]]
        name = "slide"
        type = "prismatic"
        placement = { rpy = [0.2, 1.5707963267948966, -0.4], translation = [0.1, 0.2, 0.3] }
        axis = [0.6, 0.0, 0.8]
        position_limits = [-0.2, 0.5]
        mass = 1.5
        com = [0.0, 0.1, 0.0]
        inertia = [0.01, 0.0, 0.0, 0.02, 0.0, 0.02]
        armature = 0.4
        [[joint]]
        name = "last"
        placement = { rpy = [1.0, -0.3, 2.0], translation = [0.0, 0.0, 0.2] }
        axis = [1.0, 2.0, 2.0]
        mass = 0.7
        com = [0.02, 0.0, 0.1]
        inertia = [0.004, 0.0, 0.0, 0.005, 0.0, 0.003]
    "#;
    Robot::from_toml(text, "every kind").unwrap()
}

/// Returns a model with sines and cosines of an arm with a slide.
pub(crate) fn sliding() -> ExportCase {
    let source = made_up(3, &[0.0, 0.004, 0.008]);
    cases_of(&every_kind(), MODELS[2], ExpansionPoint::zero(3), source, [None; 2]).remove(0)
}

/// Returns the affine model at samples that are not equally spaced.
pub(crate) fn uneven() -> ExportCase {
    let source = made_up(6, &[0.0, 0.004, 0.0093, 0.012]);
    let robot = Robot::lwa4p();
    cases_of(&robot, MODELS[0], ExpansionPoint::zero(6), source, [None; 2]).remove(0)
}

/// Returns every model of the embedded robot, and of others, over made-up recordings.
pub(crate) fn in_clean_clones() -> Vec<ExportCase> {
    let mut cases: Vec<ExportCase> = MODELS.into_iter().map(lwa4p).collect();
    cases.push(about_a_moving_point());
    cases.push(sliding());
    cases
}

pub(crate) fn shared(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared").join(path)
}

/// Returns every model of the paper's robot over its recordings, and of the UR10e over a made-up
/// one.
pub(crate) fn recorded() -> Vec<ExportCase> {
    let ur10e = Robot::load(shared("data/ur10e/ur10e.urdf").to_str().unwrap()).unwrap();
    let of = |model| {
        let data = DataSet::open(shared("data/schunk_lwa4p")).unwrap();
        let (point, names) = (ExpansionPoint::zero(6), [Some("A"), Some("0.02")]);
        let source = made_up(6, &[0.0, 0.004, 0.008]);
        [
            cases_of(&Robot::lwa4p(), model, point.clone(), Box::new(data), names).remove(0),
            cases_of(&ur10e, model, point, source, [None; 2]).remove(0),
        ]
    };
    MODELS.into_iter().flat_map(of).collect()
}

/// Returns the text of one file of an export.
pub(crate) fn text(case: &ExportCase, tool: Tool, form: InputForm, name: &str) -> String {
    let written = files(case, tool, form).unwrap();
    let found = written.into_iter().find(|file: &ExportFile| file.name == name);
    found.unwrap_or_else(|| panic!("no {name}")).text
}
