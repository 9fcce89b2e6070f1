//! Identification of real robots: errors of the predicted torque in validation recordings.
//!
//! The recordings are expected in `../shared/data` beside the repository. The tests are ignored
//! unless requested.

use reachtube_identify::{Identification, IdentifySettings, JointError, identify};
use reachtube_robot::{ParameterKind, Robot};
use std::path::{Path, PathBuf};

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data");

fn identified(folder: &str, settings: &str) -> Identification {
    let folder = Path::new(DATA).join(folder);
    let settings = IdentifySettings::from_toml(settings, "settings").unwrap();
    let robot =
        Robot::load(&folder.join(settings.robot.as_ref().unwrap()).display().to_string()).unwrap();
    identify(&robot, &settings, &folder, &|_, _| {}).unwrap()
}

/// Asserts that no joint is predicted worse than by one plain weighted least-squares fit of inertia
/// and friction to the exciting motions.
///
/// Both use the same samples, since the settings give the speed limit of slow samples.
fn no_worse_than_one_joint_fit(found: &Identification, settings: &str) {
    let dynamic_only: Vec<&str> = settings
        .lines()
        .filter(|line| !line.contains("static =") && !line.contains("friction ="))
        .collect();
    let plain = "model.physical = false\nmodel.robust = false\nmodel.cubic = true\n\
                 model.saturating = false";
    let plain = identified("ur10e", &format!("{}\n{plain}", dynamic_only.join("\n")));
    let joints = |found: &Identification| found.validation.last().unwrap().joints.clone();
    let (joints, plain) = (joints(found), joints(&plain));
    assert_eq!([joints.len(), plain.len()], [6; 2]);
    for (joint, plain) in joints.iter().zip(&plain) {
        assert!(joint.residual < 1.01 * plain.residual, "{joint:?} {plain:?}");
    }
}

/// Returns whether friction of a joint, from 0, was made to rise with speed.
fn is_rising(found: &Identification, joint: usize) -> bool {
    let name = &found.description.joints[joint].name;
    found.inertia.falling.iter().any(|falling| falling.joint == *name)
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn the_ur10e_predicts_validation_recordings() {
    let settings = r#"
        robot = "ur10e.urdf"
        rest = ["static"]
        one_joint = ["friction"]
        excitation = [
            "excitation/20_02_12-50sec_12harm.csv",
            "excitation/20_02_10-30sec_12harm.csv",
        ]
        validate = [
            "excitation/20_02_12-40sec_12harm.csv",
            "excitation/20_02_19_14harm50sec.csv",
            "excitation/20_02_10-20sec_7harm.csv",
        ]
        prepare.cut_off = 6.0
        model.slow = 0.02
    "#;
    let found = identified("ur10e", settings);
    no_worse_than_one_joint_fit(&found, settings);
    assert!(found.friction.len() == 6 && found.friction.iter().all(|fit| fit.joint.r2 > 0.99));
    let all = found.validation.last().unwrap();
    assert_eq!(all.log, "all");
    for (j, joint) in all.joints.iter().enumerate() {
        assert!(joint.relative.unwrap() < 0.1, "joint {}: {joint:?}", j + 1);
        // Friction of joint 1 would fall beyond 1.6 rad/s, and rises at a price.
        let most = if is_rising(&found, j) { 1.5 } else { 1.05 };
        assert!(
            joint.relative.unwrap() < most * joint.relative_plain.unwrap(),
            "as good as plain least squares: {joint:?}"
        );
    }
    let robot = Robot::from_description(&found.description).unwrap();
    assert!(matches!(robot.check_physical(), Ok(reachtube_robot::Physicality::Links { .. })));
    // The literature counts 58 combinations of inertia, motors, viscous and Coulomb friction and
    // offset for this arm. A cubic term is added for each joint whose friction does not saturate,
    // and a quadratic term for each joint that keeps the friction of its slow motions.
    let quadratic = found.inertia.columns.iter().filter(|c| c.kind == ParameterKind::Viscous2);
    let cubic = 6 - found.saturating.len();
    assert_eq!(found.inertia.parameters.len(), 58 + cubic + quadratic.count());
    // Friction of joint 1 levels off, and the cubic that rises explains it a third worse.
    let law = found.saturating.iter().find(|law| law.joint == "shoulder_pan_joint").unwrap();
    assert!(law.held_out[1] < 0.85 * law.held_out[0], "{law:?}");
    let without = identified("ur10e", &format!("{settings}\nmodel.saturating = false"));
    let first = |found: &Identification| found.validation.last().unwrap().joints[0].residual;
    assert!(first(&found) < 0.85 * first(&without), "{} {}", first(&found), first(&without));
    let half_second = &found.windows[0];
    assert!(
        half_second.diverged == 0 && half_second.q.iter().all(|q| *q < 0.05),
        "{half_second:?}"
    );
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn healthy_suites_that_determine_little_have_no_faults() {
    // Three short motions, each repeated; every joint turns little, and some one way only.
    for [a, b, held_out] in ["AEB", "ABE", "BEA"].map(|s| [&s[..1], &s[1..2], &s[2..]]) {
        for cut_off in ["", "prepare.cut_off = 6.0"] {
            let suite = |s: &str| format!("{{ path = \"suite_{s}\", compensated = true }}");
            let settings = format!(
                "excitation = [{}, {}]\nvalidate = [{}]\nmodel.physical = true\n{cut_off}\n",
                suite(a),
                suite(b),
                suite(held_out)
            );
            let settings = IdentifySettings::from_toml(&settings, "settings").unwrap();
            let folder = Path::new(DATA).join("schunk_lwa4p");
            let found = identify(&Robot::lwa4p(), &settings, &folder, &|_, _| {}).unwrap();
            let is_fault = |warning: &&String| {
                ["swapped", "sign of", " lags ", " leads ", "offset", "in degrees", "in N mm"]
                    .iter()
                    .any(|words| warning.contains(words))
            };
            let faults: Vec<&String> = found.warnings.iter().filter(is_fault).collect();
            assert!(faults.is_empty(), "{a} {b}: {faults:?}");
            assert!(found.warnings.iter().any(|w| w.contains("do not determine")));
        }
    }
}

/// Modified Denavit-Hartenberg parameters a \[m\], alpha \[π/2\] and d \[m\] of the Panda's joints.
const PANDA: [[f64; 3]; 7] = [
    [0.0, 0.0, 0.333],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.316],
    [0.0825, 1.0, 0.0],
    [-0.0825, -1.0, 0.384],
    [0.0, 1.0, 0.0],
    [0.088, 1.0, 0.0],
];

/// Returns the geometry of the Panda.
fn panda() -> Robot {
    let joint = |(k, [a, quarter_turns, d]): (usize, &[f64; 3])| {
        let alpha = quarter_turns * std::f64::consts::FRAC_PI_2;
        format!(
            "[[joint]]\nname = \"joint{}\"\n\
             dh = {{ a = {a:?}, alpha = {alpha:?}, theta = 0.0, d = {d:?} }}\n",
            k + 1
        )
    };
    let text = format!(
        "schema_version = 1\nname = \"panda\"\nparameters = \"base\"\n\
         convention = \"modified\"\n{}",
        PANDA.iter().enumerate().map(joint).collect::<String>()
    );
    Robot::from_toml(&text, "panda.toml").unwrap()
}

/// The Panda's recording.
const EXCITING: &str = "panda/excitation/traj1_000_015s.csv";

/// Each second is held out in turn. On a single part, chance decides which of the two is ahead on
/// a joint by some percent; over all parts no joint may be behind by more than chance explains.
#[test]
#[ignore = "needs the recordings in ../shared"]
fn physical_links_of_the_panda_predict_as_well_as_least_squares() {
    // For each part and joint, the squared errors of physical links and of least squares.
    let parts: Vec<Vec<[f64; 2]>> = (0..15).map(errors_of_the_held_out_second).collect();
    let mut ratios = Vec::new();
    for joint in 0..7 {
        let of_joint = parts.iter().map(|part| part[joint]);
        let [physical, plain] = [0, 1].map(|at| of_joint.clone().map(|both| both[at]).sum::<f64>());
        let more: Vec<f64> = of_joint.map(|[physical, plain]| physical - plain).collect();
        let mean = more.iter().sum::<f64>() / more.len() as f64;
        let squares: f64 = more.iter().map(|x| (x - mean).powi(2)).sum();
        let error = (squares / (more.len() * (more.len() - 1)) as f64).sqrt();
        eprintln!("joint {}: {:.3}, {:.1}", joint + 1, (physical / plain).sqrt(), mean / error);
        assert!(mean < 2.0 * error, "joint {}: {mean} ± {error}", joint + 1);
        ratios.push((physical / plain).sqrt());
    }
    assert!(ratios.iter().sum::<f64>() < 7.0, "{ratios:?}");
}

/// Returns the sums of squared torque errors in one second of the Panda's motion, when the rest is
/// fitted: physical links and least squares, for each joint.
fn errors_of_the_held_out_second(second: u32) -> Vec<[f64; 2]> {
    let (from, until) = (f64::from(second), f64::from(second + 1));
    let mut fitted = vec![];
    if second > 0 {
        fitted.push(format!("{{ path = \"{EXCITING}\", until = {from:?} }}"));
    }
    if second < 14 {
        fitted.push(format!("{{ path = \"{EXCITING}\", from = {until:?} }}"));
    }
    let settings = format!(
        "excitation = [{}]\nvalidate = [{{ path = \"{EXCITING}\", from = {from:?}, until = \
         {until:?} }}]\nprepare.cut_off = 6.0\nmodel.motor_inertia = false\nmodel.windows = \
         []\nmodel.physical = true",
        fitted.join(", ")
    );
    let settings = IdentifySettings::from_toml(&settings, "settings").unwrap();
    let found = identify(&panda(), &settings, &PathBuf::from(DATA), &|_, _| {}).unwrap();
    let of_joint = |joint: &JointError| {
        let size = joint.torque.powi(2) * joint.samples as f64;
        // A joint that does not move for a second has no errors.
        let squared = |relative: Option<f64>| size * relative.unwrap_or(0.0).powi(2);
        [squared(joint.relative), squared(joint.relative_plain)]
    };
    found.validation[0].joints.iter().map(of_joint).collect()
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn half_of_the_pandas_motion_predicts_the_other_half() {
    let file = EXCITING;
    let settings = format!(
        "excitation = [{{ path = \"{file}\", until = 7.5 }}]\n\
         validate = [{{ path = \"{file}\", from = 7.5 }}]\n\
         prepare.cut_off = 6.0\nmodel.motor_inertia = false\nmodel.physical = false\n\
         model.windows = []"
    );
    let mut settings = IdentifySettings::from_toml(&settings, "settings").unwrap();
    let robot = panda();
    // Base parameters stay equal to least squares, but for friction that would fall.
    let base = identify(&robot, &settings, &PathBuf::from(DATA), &|_, _| {}).unwrap();
    let falls = (0..7).any(|joint| is_rising(&base, joint));
    for joint in &base.validation[0].joints {
        let ratio = joint.relative.unwrap() / joint.relative_plain.unwrap();
        assert!(if falls { ratio < 1.05 } else { (ratio - 1.0).abs() < 1e-6 }, "{joint:?}");
    }
    assert!(base.warnings.iter().any(|w| w.contains("cannot exist")), "{:?}", base.warnings);
    settings.model.physical = Some(true);
    let found = identify(&robot, &settings, &PathBuf::from(DATA), &|_, _| {}).unwrap();
    let physical = found.inertia.physical.as_ref().unwrap();
    assert!(physical.plain_impossible.is_some(), "least squares must give no physical robot");
    for joint in Robot::from_description(&found.description).unwrap().description().joints.iter() {
        assert!(joint.mass > 0.0);
    }
    let limits = [0.09, 0.03, 0.03, 0.04, 0.13, 0.1, 0.22];
    let joints = &found.validation[0].joints;
    assert_eq!(joints.len(), limits.len());
    joints
        .iter()
        .zip(limits)
        .for_each(|(joint, limit)| assert!(joint.relative.unwrap() < limit, "{joints:?}"));
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn the_double_pendulum_is_identified_up_to_its_friction() {
    let settings = r#"
        robot = "acrobot.urdf"
        excitation = ["openloop", "swing"]
        validate = [{ path = "repeats_acrobot/acrobot_01.csv", until = 4.0 }]
        prepare.cut_off = 6.0
    "#;
    let found = identified("double_pendulum", settings);
    let joints = &found.validation[0].joints;
    assert!(joints[0].relative.unwrap() < 0.5 && joints[1].relative.unwrap() < 0.2, "{joints:?}");
    assert!(
        found.warnings.iter().any(|w| w.contains("Joint1") && w.contains("is not explained")),
        "{:?}",
        found.warnings
    );
    // The authors of the data give second moments about the joints of 0.03 to 0.05 kg m².
    let inertia = found.inertia.parameters.iter().find(|p| p.name == "Ixx2").unwrap();
    assert!((0.03..0.06).contains(&inertia.value), "{inertia:?}");
}
