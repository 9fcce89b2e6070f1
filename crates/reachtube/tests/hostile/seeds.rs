//! Texts of the shape of real files, from which hostile ones are made.

use reachtube::abstraction::{ExpansionPoint, ModelKind, PolynomialModel};
use reachtube::arm::{ArmSettings, setup};
use reachtube::conform::SuiteReach;
use reachtube::export::ExportError;
use reachtube::export::shield::{Shield, ShieldFile};
use reachtube::reach::StepBounds;
use reachtube::scalar::Interval;
use reachtube::verify::Capsules;
use reachtube::{Keep, MemoryRuns, Model, Problem, Robot, Run, Settings, Silent, Torque, conform};
use reachtube_robot::Urdf;

const ROBOT: &str = r#"schema_version = 1
name = "arm"
gravity = [0.0, 0.0, -9.81]

[[joint]]
name = "hinge"
placement = { translation = [0.0, 0.0, 1.0], rpy = [0.0, 0.1, 0.0] }
axis = [0.0, 1.0, 0.0]
mass = 1.0
com = [0.0, 0.0, -0.3]
inertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.01]
armature = 0.1
position_limits = [-1.0, 1.0]
velocity_limit = 3.0
friction = { viscous = [0.5, 0.0, 0.0], coulomb = [0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] }

[[joint]]
name = "elbow"
dh = { a = 0.3, alpha = 0.0, theta = 0.0, d = 0.1 }
mass = 0.5
com = [0.1, 0.0, 0.0]
inertia = [0.01, 0.0, 0.0, 0.01, 0.0, 0.01]
"#;

const URDF: &str = r#"<?xml version="1.0"?>
<robot name="pendulum">
  <link name="base"/>
  <link name="arm">
    <inertial>
      <origin xyz="0 0 -0.3" rpy="0 0 0"/>
      <mass value="1.0"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.01"/>
    </inertial>
  </link>
  <link name="tool"/>
  <joint name="hinge" type="revolute">
    <parent link="base"/><child link="arm"/>
    <origin xyz="0 0 1" rpy="0 0 0"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="1.5" velocity="3" effort="10"/>
    <dynamics damping="0.5" friction="0.1"/>
  </joint>
  <joint name="flange" type="fixed"><parent link="arm"/><child link="tool"/></joint>
</robot>
"#;

pub(crate) fn recordings() -> Vec<Vec<u8>> {
    let line =
        |k: usize| format!("{:.3},{:?},-1.5e-3,0.25,1,2,3\n", k as f64 * 0.01, 0.1 * k as f64);
    let samples: String = (0..12).map(line).collect();
    let plain = format!("t,q1,q2,qd1,qd2,tau1,tau2\n{samples}");
    let quoted = plain.replacen("0.010", "\"0.010\"", 1).replace('\n', "\r\n");
    [plain, quoted, "t,q1,qd1,tau1,note\n0,0,0,0,a\n1,0,0,0,\"b,c\"\n".into()]
        .map(String::into_bytes)
        .into()
}

pub(crate) fn indices() -> Vec<Vec<u8>> {
    [
        "file,suite\nrun.csv,A\n",
        "\u{feff}file,kind,suite,motion,temperature,sha256\r\nrun.csv,x,A,m,21.5,00ab\r\n",
    ]
    .map(Into::into)
    .into()
}

pub(crate) fn robots() -> Vec<Vec<u8>> {
    vec![ROBOT.into(), Robot::lwa4p().description().to_toml().into_bytes()]
}

pub(crate) fn urdfs() -> Vec<Vec<u8>> {
    vec![URDF.into()]
}

pub(crate) fn companions() -> Vec<Vec<u8>> {
    let urdf = Urdf::parse(URDF, "pendulum.urdf", &Default::default()).unwrap();
    vec![urdf.companion(urdf.robot()).into_bytes(), b"base = \"base\"\ntip = \"tool\"\n".into()]
}

pub(crate) fn settings() -> Vec<Vec<u8>> {
    let text = "robot = \"arm.urdf\"\nrest = [\"poses\"]\nexcitation = [\"a.csv\", { path = \
                \"b.csv\", from = 2.0, until = 4.5 }]\n\n[prepare]\ncut_off = 5.0\ngains = [1.0, \
                2]\n\n[model]\nmotor_inertia = false\nprior = \"none\"\nwindows = [0.5]\n";
    vec![text.into()]
}

pub(crate) fn models() -> Vec<Vec<u8>> {
    let robot = Robot::from_toml(ROBOT, "arm").unwrap();
    let mut runs = MemoryRuns::default();
    for offset in [0.0, 0.001] {
        let states = [offset, offset, 0.0, 0.0].repeat(3);
        let run = Run::new(2, vec![0.0, 0.01, 0.02], states, vec![0.0; 6]).unwrap();
        runs.push(&format!("run{offset}"), Some("A"), None, run);
    }
    let arm = ArmSettings::new(Torque::Compensated, 2);
    let setup = setup(robot, arm, Settings::default()).unwrap();
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap();
    vec![Model::new(&problem, &conform(&problem, &Silent, None).unwrap()).to_json().into_bytes()]
}

pub(crate) fn abstractions() -> Vec<Vec<u8>> {
    let robot = Robot::from_toml(ROBOT, "arm").unwrap();
    let point = ExpansionPoint::from_values(&[], 2).unwrap();
    let make = |kind, order| PolynomialModel::new(&robot, kind, order, &point).unwrap();
    [make(ModelKind::One, 2), make(ModelKind::Two, 3), make(ModelKind::Three, 2)]
        .map(|model| model.to_json().into_bytes())
        .into()
}

/// Returns an arm of two hinges.
pub(crate) fn arm() -> Robot {
    Robot::from_toml(ROBOT, "arm.toml").unwrap()
}

pub(crate) fn choices() -> Vec<Vec<u8>> {
    let text = "robot = \"arm.urdf\"\ntorque = \"motor\"\nlock = [\"a\", \"b=1.5\"]\nhorizon = \
                0.3\nallowance = [0.0, 0.1]\nequations = \"robot\"\nfit = [\"inertia\"]\n\
                expansion = [0.1, -2]\ncut-off = 5.0\n";
    vec![text.into(), format!("# horizon: two words\n{text}").into_bytes()]
}

const CAPSULES: &str = "[[capsule]]\nlink = 1\nfrom = [0.0, 0, 0]\nto = [0.1, 0.1, 0.3]\nradius = \
                        0.05\n\n[[capsule]]\nlink = \"elbow\"\nfrom = [0.0, 0, 0]\nto = \
                        [-0.3, 0, 0]\nradius = 0.07\n";

pub(crate) fn capsules() -> Vec<Vec<u8>> {
    vec![CAPSULES.into()]
}

pub(crate) fn brakes() -> Vec<Vec<u8>> {
    let text = "torque = [[40, 60.5], [20, 30]]\ndelay = [0.01, 0.03]\nerror = [0.5, 0.1]\n\
                deceleration = [2.0, 3]\n\n[payload]\nmass = 1.5\ncentre = [0, 0.1, -0.05]\n";
    vec![text.into(), b"torque = [[40, 60], [20, 30]]\ndelay = [0, 0]\n".into()]
}

pub(crate) fn scenarios() -> Vec<Vec<u8>> {
    let text = "model = \"model.json\"\ndata = \"recordings\"\nsuites = [\"A\"]\nuntil = \
                0.5\nclearance = 0.02\nrefine = 4\n\n[[obstacle]]\nname = \"table\"\nbox = { \
                centre = [0, 0, -0.5], size = [1.0, 1, 0.02], rpy = [0, 0, 0.1] }\n\n[[obstacle]]\n\
                name = \"post\"\ncapsule = { from = [1, 0, 0], to = [1, 0, 2], radius = 0.1 }\n\
                speed = 0.1\n\n[[person]]\nname = \"p\"\nsphere = { centre = [2, 0, 1], radius = \
                0.3 }\n";
    vec![text.into()]
}

/// Returns the robot's file of the shield as the export writes it, and its trajectory's file.
pub(crate) fn shields() -> Vec<Vec<u8>> {
    let (arm, capsules) = (arm(), Capsules::from_toml(CAPSULES, "capsules", &arm()).unwrap());
    let own = Shield::new(&arm, Some(&capsules), &[], &[]).unwrap();
    let trajectory = "# limits\nv_max_allowed: [1.0, 2]\na_max_allowed: [10.0, 5]\n\
                      a_max_ltt: [2, 2]\nj_max_allowed: [400, 400]\n";
    vec![own.files[0].text.clone().into_bytes(), trajectory.into()]
}

/// Reads a file of the shield: the robot's, or the one of trajectories, whose limits are compared
/// with `reached`.
pub(crate) fn shield(
    arm: &Robot,
    reached: &SuiteReach,
    text: String,
) -> Result<Shield, ExportError> {
    let capsules = Capsules::from_toml(CAPSULES, "capsules", arm).unwrap();
    let update = ShieldFile { name: "parameters.yaml".into(), text };
    Shield::new(arm, Some(&capsules), std::slice::from_ref(reached), &[update])
}

/// Returns the set of a short motion of both hinges.
pub(crate) fn reached() -> SuiteReach {
    let nominal = vec![0.3, 0.3, 0.5, 0.5, 0.31, 0.31, 0.7, 0.7];
    let shifted = |by: f64| nominal.iter().map(|x| x + by).collect();
    let step = [[Interval::centred(0.3, 0.1); 2], [Interval::centred(0.6, 0.3); 2]].concat();
    SuiteReach {
        suite: "A".into(),
        run: None,
        times: vec![0.0, 0.02],
        lower: shifted(-0.01),
        upper: shifted(0.01),
        nominal,
        tube: StepBounds::from_boxes(4, step),
        dimension: 4,
        lost: None,
    }
}
