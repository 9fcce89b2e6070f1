//! The header of ARMOUR: read as its program reads it, and sampled arms within the proved bounds.

use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3};
use reachtube::Robot;
use reachtube::export::armour::{Armour, ArmourSettings};

use crate::cases::{Numbers, every_kind};
use crate::shield::{capsules, hinges};

/// An arm that stands, with motors and limits on all joints.
fn arm() -> Robot {
    let mut description = hinges().description().clone();
    description.gravity = [0.0, 0.0, -9.81];
    for joint in &mut description.joints {
        joint.velocity_limit = Some(2.0);
        joint.armature = Some(0.3);
    }
    description.joints[1].friction.viscous = [3.0, 0.2, -0.4];
    description.joints[1].friction.coulomb = [1.0, 0.1, -1.2, 0.1, -0.8, 0.0, 0.9, 0.0];
    Robot::from_description(&description).unwrap()
}

fn settings(uncertainty: f64) -> ArmourSettings {
    ArmourSettings { uncertainty, torque_limits: vec![50.0, 40.0, 20.0] }
}

fn written(robot: &Robot, uncertainty: f64) -> Armour {
    Armour::new(robot, &capsules(robot), &settings(uncertainty)).unwrap()
}

/// Reads the numbers of a constant as a C++ compiler does.
fn numbers(text: &str, name: &str) -> Vec<f64> {
    let (_, rest) = text
        .split_once(&format!(" {name}["))
        .or_else(|| text.split_once(&format!(" {name} =")))
        .unwrap_or_else(|| panic!("no {name}"));
    let (list, _) = rest.split_once(';').unwrap();
    let list = list.split_once('=').map_or(list, |(_, list)| list);
    let list = list.replace(['{', '}'], " ");
    list.split(',').map(|number| number.trim().parse().unwrap()).collect()
}

/// The arm of a header.
struct Header {
    rotations: Vec<Matrix3<f64>>,
    origins: Vec<Vector3<f64>>,
    masses: Vec<f64>,
    centres: Vec<Vector3<f64>>,
    inertias: Vec<Matrix3<f64>>,
    armatures: Vec<f64>,
    damping: Vec<f64>,
}

impl Header {
    fn read(text: &str) -> Self {
        let vectors = |name: &str| -> Vec<Vector3<f64>> {
            numbers(text, name).chunks_exact(3).map(Vector3::from_row_slice).collect()
        };
        let rotation = |a: &Vector3<f64>| {
            let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle).into_inner();
            about(Vector3::x_axis(), a.x)
                * about(Vector3::y_axis(), a.y)
                * about(Vector3::z_axis(), a.z)
        };
        Self {
            rotations: vectors("rots").iter().map(rotation).collect(),
            origins: vectors("trans"),
            masses: numbers(text, "mass"),
            centres: vectors("com"),
            inertias: numbers(text, "inertia")
                .chunks_exact(9)
                .map(Matrix3::from_row_slice)
                .collect(),
            armatures: numbers(text, "armature"),
            damping: numbers(text, "damping"),
        }
    }

    /// Returns axis, origin and rotation of each frame at `q`, in the base.
    fn frames(&self, q: &[f64]) -> Vec<(Vector3<f64>, Matrix3<f64>)> {
        let (mut origin, mut rotation) = (Vector3::zeros(), Matrix3::identity());
        let next = |(i, q): (usize, &f64)| {
            origin += rotation * self.origins[i];
            let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), *q).into_inner();
            rotation *= self.rotations[i] * turn;
            (origin, rotation)
        };
        q.iter().enumerate().map(next).collect()
    }

    /// Returns the mass matrix, by the bodies' Jacobians, and the torques that hold the arm.
    fn mass_matrix(&self, q: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let (n, frames) = (q.len(), self.frames(q));
        let mut m = DMatrix::from_diagonal(&DVector::from_vec(self.armatures.clone()));
        let mut gravity = DVector::zeros(n);
        for (i, (origin, rotation)) in frames.iter().enumerate() {
            let centre = origin + rotation * self.centres[i];
            let [mut linear, mut angular] = [DMatrix::zeros(3, n), DMatrix::zeros(3, n)];
            for (j, (joint, turn)) in frames[..=i].iter().enumerate() {
                let axis = turn.column(2).into_owned();
                linear.set_column(j, &axis.cross(&(centre - joint)));
                angular.set_column(j, &axis);
            }
            let inertia = rotation * self.inertias[i] * rotation.transpose();
            m += self.masses[i] * linear.transpose() * &linear;
            m += angular.transpose() * inertia * &angular;
            gravity += 9.81 * self.masses[i] * linear.row(2).transpose();
        }
        (m, gravity)
    }
}

#[test]
fn armours_formulas_give_our_torques_and_masses() {
    let robot = arm();
    let header = Header::read(&written(&robot, 0.03).files[0].text);
    let mut random = Numbers::new();
    for _ in 0..30 {
        let q = random.vector(3, 3.0);
        let (m, gravity) = header.mass_matrix(&q);
        assert!((m - robot.mass_matrix(&q)).amax() < 1e-12, "{q:?}");
        assert!((gravity - robot.gravity_torque(&q)).amax() < 1e-11, "{q:?}");
    }
}

#[test]
fn sampled_arms_within_the_ratio_are_within_the_bounds() {
    let robot = arm();
    let mut random = Numbers::new();
    for ratio in [0.0, 0.03, 0.2] {
        let armour = written(&robot, ratio);
        let text = &armour.files[0].text;
        assert_eq!(numbers(text, "mass_uncertainty"), [ratio]);
        let [least, largest] = armour.mass_matrix;
        assert_eq!((numbers(text, "M_min"), numbers(text, "M_max")), (vec![least], vec![largest]));
        let [low, high] = ["lb", "ub"].map(|end| numbers(text, &format!("state_limits_{end}")));
        let limits = [0, 1, 2].map(|j| [low[j], high[j]]);
        let mut seen = [f64::INFINITY, 0.0_f64];
        for _ in 0..3000 {
            let mut header = Header::read(text);
            // Nearly all at an end of their ranges.
            let mut factor = || 1.0 + ratio * random.signed().signum();
            let one = factor();
            header.masses.iter_mut().for_each(|mass| *mass *= one);
            for inertia in &mut header.inertias {
                for (i, j) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)] {
                    let value = inertia[(i, j)] * factor();
                    (inertia[(i, j)], inertia[(j, i)]) = (value, value);
                }
            }
            let within = |(q, limits): (f64, [f64; 2])| {
                0.5 * (limits[0] + limits[1]) + 0.5 * (limits[1] - limits[0]) * q
            };
            let q: Vec<f64> = random.vector(3, 1.0).into_iter().zip(limits).map(within).collect();
            let values = header.mass_matrix(&q).0.symmetric_eigenvalues();
            seen = [seen[0].min(values.min()), seen[1].max(values.max())];
        }
        assert!(least <= seen[0] && seen[1] <= largest, "{ratio}: {least} {largest} {seen:?}");
        let slack = 0.02 + 2.0 * ratio;
        assert!(least > seen[0] * (1.0 - slack), "{ratio}: {least} of {}", seen[0]);
        assert!(largest < seen[1] * (1.0 + slack), "{ratio}: {largest} of {}", seen[1]);
    }
}

#[test]
fn the_rest_of_friction_is_within_its_bound() {
    let robot = arm();
    let armour = written(&robot, 0.03);
    let header = Header::read(&armour.files[0].text);
    assert_eq!(numbers(&armour.files[0].text, "friction"), armour.friction);
    let mut random = Numbers::new();
    for (j, joint) in robot.joints().iter().enumerate() {
        let mut largest = 0.0_f64;
        for _ in 0..5000 {
            let (load, v) =
                (settings(0.0).torque_limits[j] * random.signed(), 2.0 * random.signed());
            let friction = joint.friction.dry_torque(load, v) + joint.friction.viscous.torque(&v);
            largest = largest.max((friction - header.damping[j] * v).abs());
        }
        assert!(largest <= armour.friction[j], "{j}: {largest} of {}", armour.friction[j]);
        assert!(largest >= 0.7 * armour.friction[j], "{j}: {largest} of {}", armour.friction[j]);
    }
}

#[test]
fn the_boxes_contain_the_capsules() {
    let robot = arm();
    let text = &written(&robot, 0.0).files[0].text;
    let header = Header::read(text);
    let centres = numbers(text, "link_zonotope_center[NUM_JOINTS]");
    let widths = numbers(text, "link_zonotope_generators[NUM_JOINTS]");
    let q = [0.4, -1.1, 0.7];
    let frames = header.frames(&q);
    for capsule in capsules(&robot).as_slice() {
        let link = &robot.link_placements(&q)[capsule.joint];
        let (origin, rotation) = &frames[capsule.joint];
        for end in [capsule.from, capsule.to] {
            let end = link.rotation * Vector3::from(end) + link.translation;
            let end = rotation.transpose() * (end - origin);
            for k in 0..3 {
                let at = 3 * capsule.joint + k;
                // The first link has one capsule around two.
                let room = (end[k] - centres[at]).abs() + capsule.radius - widths[at];
                assert!(room < 1e-9, "{capsule:?}: {room}");
            }
        }
    }
}

#[test]
fn what_armour_cannot_have_is_refused_by_name() {
    let robot = arm();
    let refusal = |robot: &Robot, settings: &ArmourSettings, parts: &[&str]| {
        let error = Armour::new(robot, &capsules(robot), settings).unwrap_err().to_string();
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    };
    refusal(&robot, &settings(1.0), &["ratio 1", "0.03"]);
    refusal(&robot, &settings(-0.1), &["-0.1"]);
    let few = ArmourSettings { torque_limits: vec![1.0], ..settings(0.0) };
    refusal(&robot, &few, &["1 torque limits", "3 positive"]);
    refusal(&hinges(), &settings(0.0), &["gravity", "stands"]);
    let edited = |edit: &dyn Fn(&mut reachtube::robot::RobotDescription)| {
        let mut description = robot.description().clone();
        edit(&mut description);
        Robot::from_description(&description).unwrap()
    };
    let no_limit = edited(&|d| d.joints[2].velocity_limit = None);
    refusal(&no_limit, &settings(0.0), &["joint last", "velocity_limit"]);
    let light = edited(&|d| d.joints.iter_mut().for_each(|j| j.armature = Some(0.0)));
    refusal(&light, &settings(0.5), &["not proved positive definite", "armature"]);
    let mut upright = every_kind().description().clone();
    upright.gravity = [0.0, 0.0, -9.81];
    let slides = Robot::from_description(&upright).unwrap();
    refusal(&slides, &settings(0.0), &["slide", "turn"]);
}
