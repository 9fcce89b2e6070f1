//! The files of the shield: read back by the shield's own formulas, and changed without a loss.

use nalgebra::{Matrix4, Vector3, Vector4};
use reachtube::Robot;
use reachtube::conform::SuiteReach;
use reachtube::export::shield::{Shield, ShieldFile};
use reachtube::reach::StepBounds;
use reachtube::scalar::Interval;
use reachtube::verify::Capsules;

use crate::cases::{Numbers, every_kind};

/// An arm of three hinges whose axes and frames lie askew.
pub(crate) fn hinges() -> Robot {
    let mut description = every_kind().description().clone();
    description.joints[1].kind = description.joints[0].kind;
    description.joints[1].axis = Some([0.6, 0.0, 0.8]);
    Robot::from_description(&description).unwrap()
}

/// Two capsules on the first link, one on each other.
pub(crate) fn capsules(robot: &Robot) -> Capsules {
    let capsule = |link: usize, to: f64, radius: f64| {
        format!(
            "[[capsule]]\nlink = {link}\nfrom = [0.02, 0, 0]\nto = [{to}, 0.1, 0.3]\n\
             radius = {radius}\n"
        )
    };
    let text = [
        capsule(1, 0.1, 0.05),
        capsule(1, -0.3, 0.04),
        capsule(2, 0.2, 0.06),
        capsule(3, 0.0, 0.07),
    ];
    Capsules::from_toml(&text.concat(), "arm", robot).unwrap()
}

/// Two samples: a motion of 0.01 rad in 0.02 s, and sets of `radius` rad about it.
fn reached(radius: f64) -> SuiteReach {
    let n = 3;
    let row = |q: f64, v: f64| [vec![q; n], vec![v; n]].concat();
    let (nominal, size) = ([row(0.3, 0.5), row(0.31, 0.7)].concat(), row(radius, 0.1).repeat(2));
    let shifted = |sign: f64| nominal.iter().zip(&size).map(|(x, r)| x + sign * r).collect();
    let step = [vec![Interval::ENTIRE; n], vec![Interval::centred(0.5, 0.01); n]].concat();
    SuiteReach {
        suite: "A".into(),
        run: None,
        times: vec![0.0, 0.02],
        lower: shifted(-1.0),
        upper: shifted(1.0),
        nominal,
        tube: StepBounds::from_boxes(2 * n, step),
        dimension: 2 * n,
        lost: None,
    }
}

/// Reads the numbers of a key as the shield does.
fn numbers(text: &str, key: &str) -> Vec<f64> {
    let (_, rest) = text.split_once(&format!("\n{key}: [")).unwrap_or_else(|| panic!("no {key}"));
    let (list, _) = rest.split_once(']').unwrap();
    list.split(',').map(|number| number.trim().parse().unwrap()).collect()
}

/// Returns the secure radius in a file.
fn secure_radius(text: &str) -> f64 {
    let line = text.lines().find(|line| line.starts_with("secure_radius:")).unwrap();
    line["secure_radius:".len()..].split('#').next().unwrap().trim().parse().unwrap()
}

/// Returns the frames of the links by the formula of the shield's `forwardKinematic`.
fn frames(text: &str, q: &[f64]) -> Vec<Matrix4<f64>> {
    let mut frame = Matrix4::identity();
    let matrices = numbers(text, "transformation_matrices");
    let of = |(entries, q): (&[f64], &f64)| {
        frame *= Matrix4::from_row_slice(entries) * Matrix4::new_rotation(Vector3::z() * *q);
        frame
    };
    matrices.chunks_exact(16).zip(q).map(of).collect()
}

fn written(robot: &Robot) -> Shield {
    Shield::new(robot, Some(&capsules(robot)), &[reached(0.01)], &[]).unwrap()
}

#[test]
fn the_shields_formulas_put_each_link_where_ours_do() {
    let robot = hinges();
    let (shield, all) = (written(&robot), capsules(&robot));
    let text = &shield.files[0].text;
    let enclosures = numbers(text, "enclosures");
    let centres = numbers(text, "link_centers_of_mass");
    let mut random = Numbers::new();
    for _ in 0..30 {
        let q = random.vector(3, 3.0);
        let (ours, theirs) = (robot.link_placements(&q), frames(text, &q));
        for (j, (link, frame)) in ours.iter().zip(&theirs).enumerate() {
            let point = |p: &[f64]| (frame * Vector4::new(p[0], p[1], p[2], 1.0)).xyz();
            let capsule = &enclosures[7 * j..7 * j + 7];
            let ends = [point(&capsule[..3]), point(&capsule[3..6])];
            // The shield's one capsule contains each end with its radius.
            for own in all.as_slice().iter().filter(|own| own.joint == j) {
                for end in [own.from, own.to] {
                    let end = link.rotation * Vector3::from(end) + link.translation;
                    let along = ends[1] - ends[0];
                    let s = ((end - ends[0]).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                    let distance = (end - ends[0] - s * along).norm();
                    assert!(distance + own.radius <= capsule[6] + 1e-12, "link {j} at {q:?}");
                    assert!(j == 0 || distance < 1e-12, "link {j} at {q:?}: {distance}");
                }
            }
            let com = robot.description().joints[j].com.unwrap();
            let com = link.rotation * Vector3::from(com) + link.translation;
            assert!((point(&centres[6 * j..6 * j + 3]) - com).norm() < 1e-12, "mass {j} at {q:?}");
        }
    }
    assert_eq!(numbers(text, "link_masses"), [2.0, 1.5, 0.7]);
    // The trace of an inertia does not depend on the frame.
    let inertias = numbers(text, "link_inertias");
    assert!((inertias[0] + inertias[3] + inertias[5] - 0.075).abs() < 1e-15);
}

#[test]
fn the_secure_radius_contains_sampled_deviations() {
    let robot = hinges();
    let shield = written(&robot);
    let text = &shield.files[0].text;
    assert_eq!(secure_radius(text), shield.secure_radius);
    let ends = numbers(text, "enclosures");
    let (mut random, mut largest) = (Numbers::new(), 0.0_f64);
    for _ in 0..2000 {
        let moved: Vec<f64> =
            random.vector(3, 0.01).iter().map(|e| 0.3 + 0.01 * e.signum()).collect();
        let [nominal, moved] = [vec![0.3; 3], moved].map(|q| frames(text, &q));
        for j in 0..3 {
            for end in [0, 3] {
                let p = Vector4::new(
                    ends[7 * j + end],
                    ends[7 * j + end + 1],
                    ends[7 * j + end + 2],
                    1.0,
                );
                largest = largest.max(((nominal[j] - moved[j]) * p).norm());
            }
        }
    }
    assert!(largest <= shield.secure_radius, "{largest} of {}", shield.secure_radius);
    assert!(largest > 0.8 * shield.secure_radius, "{largest} of {}", shield.secure_radius);
    assert_eq!(shield.margins.len(), 3);
    assert!(shield.margins.iter().all(|margin| margin.distance <= shield.secure_radius));
}

#[test]
fn the_shields_own_file_gets_another_secure_radius_and_nothing_else() {
    let robot = hinges();
    let first = written(&robot);
    let old = first.files[0].text.replace("link_masses", "# mine\nlink_masses");
    let file = ShieldFile { name: "robot_parameters_arm.yaml".into(), text: old.clone() };
    let changed = Shield::new(&robot, None, &[reached(0.02)], &[file]).unwrap();
    assert_eq!(changed.files[0].name, "robot_parameters_arm.yaml");
    let body = |text: &str| -> Vec<String> {
        text.lines().filter(|line| !line.starts_with('#')).map(String::from).collect()
    };
    let (before, after) = (body(&old), body(&changed.files[0].text));
    let changes: Vec<_> = before.iter().zip(&after).filter(|(a, b)| a != b).collect();
    assert_eq!((before.len(), changes.len()), (after.len(), 1), "{changes:?}");
    assert!(changed.files[0].text.contains("# mine\n"));
    // The first link has one capsule there that contains the two of before.
    let ratio = changed.secure_radius / first.secure_radius;
    assert!((1.7..2.3).contains(&ratio), "{ratio}");
    // The comment of an earlier export is replaced.
    assert_eq!(changed.files[0].text.matches("secure_radius of").count(), 1);
}

const TRAJECTORY: &str = "robot_name: \"arm\"\n\nmax_s_stop: 0.2\nv_max_allowed: [1.0, 0.6, 0.7]\n\
    a_max_allowed: [10, 10, # the last\n  4]\na_max_ltt: [2, 2, 2]\nj_max_ltt: [15, 15, 15]\n\
    v_safe: 0.1\n";

fn trajectory(text: &str) -> ShieldFile {
    ShieldFile { name: "trajectory_parameters_arm.yaml".into(), text: text.into() }
}

#[test]
fn limits_are_cut_to_what_the_motions_reach() {
    let robot = hinges();
    let arm = capsules(&robot);
    let files = [trajectory(TRAJECTORY)];
    let shield = Shield::new(&robot, Some(&arm), &[reached(0.01)], &files).unwrap();
    assert_eq!(shield.files[1].name, "trajectory_parameters_arm.yaml");
    let text = &shield.files[1].text;
    // The nominal motion reaches 0.7 rad/s and (0.7 - 0.5)/0.02 = 10 rad/s².
    assert_eq!(numbers(text, "v_max_allowed"), [0.7, 0.6, 0.7]);
    let acceleration = numbers(text, "a_max_allowed");
    assert!(acceleration[0] <= 10.0 && acceleration[0] > 9.99 && acceleration[2] == 4.0);
    assert_eq!(numbers(text, "a_max_ltt"), [2.0, 2.0, 2.0]);
    for kept in ["max_s_stop: 0.2\n", "j_max_ltt: [15, 15, 15]\n", "v_safe: 0.1\n"] {
        assert!(text.contains(kept), "{text}");
    }
}

#[test]
fn what_the_shield_cannot_have_is_refused_by_name() {
    let (robot, reach) = (hinges(), [reached(0.01)]);
    let arm = capsules(&robot);
    let refusal = |robot: &Robot, capsules: Option<&Capsules>, files: &[ShieldFile]| {
        Shield::new(robot, capsules, &reach, files).unwrap_err().to_string()
    };
    let contains = |error: String, parts: &[&str]| {
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    };
    contains(refusal(&every_kind(), Some(&arm), &[]), &["slide", "turn"]);
    contains(refusal(&robot, None, &[]), &["no capsules", "robot file"]);
    let one = "[[capsule]]\nlink = 1\nfrom = [0, 0, 0]\nto = [0, 0, 0.1]\nradius = 0.1\n";
    let one = Capsules::from_toml(one, "arm", &robot).unwrap();
    contains(refusal(&robot, Some(&one), &[]), &["slide", "no capsule"]);
    let short = TRAJECTORY.replace("[1.0, 0.6, 0.7]", "[1.0, 0.6]");
    contains(
        refusal(&robot, Some(&arm), &[trajectory(&short)]),
        &["trajectory_parameters_arm.yaml:4", "v_max_allowed", "2 numbers"],
    );
    let word = TRAJECTORY.replace("0.6", "fast");
    contains(refusal(&robot, Some(&arm), &[trajectory(&word)]), &[":4", "`fast` is no number"]);
    let none = TRAJECTORY.replace("a_max_ltt", "a_max");
    contains(refusal(&robot, Some(&arm), &[trajectory(&none)]), &["a_max_ltt", "no such key"]);
    let text = written(&robot).files[0].text.clone();
    let misspelt = text.replace("enclosures: [\n  ", "enclosures: [\n  x");
    let file = |text: String| ShieldFile { name: "robot.yaml".into(), text };
    contains(refusal(&robot, None, &[file(misspelt)]), &["robot.yaml", "is no number"]);
    let mut description = robot.description().clone();
    // The file of another arm.
    description.joints[2].axis = Some([1.0, 2.0, -2.0]);
    let bent = Robot::from_description(&description).unwrap();
    contains(refusal(&bent, None, &[file(text)]), &["robot.yaml", "last", "lies elsewhere"]);
    let mut lost = reached(0.01);
    lost.nominal.iter_mut().skip(3).step_by(6).for_each(|v| *v = 0.0);
    let files = [trajectory(TRAJECTORY)];
    let error = Shield::new(&robot, Some(&arm), &[lost], &files).unwrap_err().to_string();
    contains(error, &["joint turn", "rests"]);
}
