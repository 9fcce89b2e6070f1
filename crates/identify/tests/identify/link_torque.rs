//! A 7-joint arm whose torque is measured behind the gears, with the errors of real sensors.
//!
//! Physical links must predict held-out torque as well as plain least squares with the same
//! filter, on every joint.

use crate::lab::geometry;
use crate::virtual_robot::{Random, STEP, excitation};
use reachtube_identify::{Identification, IdentifySettings, LogValidation, identify};
use reachtube_robot::Robot;
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;
use std::path::Path;

const JOINTS: usize = 7;

/// Modified Denavit-Hartenberg parameters a \[m\], alpha \[π/2\] and d \[m\], mass \[kg\] and
/// centre of mass \[m\] of each link.
type Link = ([f64; 3], f64, [f64; 3]);

const LINKS: [Link; JOINTS] = [
    ([0.0, 0.0, 0.34], 4.2, [0.0, -0.03, -0.12]),
    ([0.0, -1.0, 0.0], 4.0, [0.0, -0.06, 0.04]),
    ([0.0, 1.0, 0.4], 3.1, [0.02, 0.03, -0.1]),
    ([0.06, 1.0, 0.0], 2.8, [-0.03, 0.07, 0.03]),
    ([-0.06, -1.0, 0.39], 1.9, [0.0, 0.02, -0.15]),
    ([0.0, 1.0, 0.0], 1.5, [0.04, 0.0, 0.0]),
    ([0.08, 1.0, 0.05], 0.7, [0.01, 0.01, 0.06]),
];

/// Standard deviation of each sensor's noise \[N m\].
const NOISE: [f64; JOINTS] = [0.25, 0.25, 0.2, 0.2, 0.1, 0.1, 0.08];

/// Returns the arm: no motors, and a little friction of bearings behind the gears.
fn arm() -> Robot {
    let link = |(k, ([a, turns, d], mass, com)): (usize, &Link)| {
        let inertia = [0.011 * mass, 0.0, 0.0, 0.009 * mass, 0.001 * mass, 0.006 * mass];
        let (dry, viscous) = (0.02 * NOISE[k] * 20.0, 0.1);
        format!(
            "[[joint]]\nname = \"joint{}\"\ndh = {{ a = {a:?}, alpha = {:?}, theta = 0.0, d = \
             {d:?} }}\nmass = {mass:?}\ncom = {com:?}\ninertia = {inertia:?}\n\
             [joint.friction]\ncoulomb = [{dry:?}, 0.0, {:?}, 0.0, {:?}, 0.0, {dry:?}, 0.0]\n\
             viscous = [{viscous:?}, 0.0, 0.0]\n",
            k + 1,
            turns * FRAC_PI_2,
            -dry,
            -dry
        )
    };
    let links: String = LINKS.iter().enumerate().map(link).collect();
    let head = "schema_version = 1\nname = \"link torque\"\nconvention = \"modified\"\n";
    Robot::from_toml(&format!("{head}{links}"), "arm.toml").unwrap()
}

/// Records a motion with the errors of link-side sensors: white noise, an offset, hysteresis of
/// the flexure, crosstalk of the joint before, and encoder steps.
fn record(robot: &Robot, path: &Path, duration: f64, seed: u64) {
    let columns =
        ["q", "qd", "tau"].map(|c| (1..=JOINTS).map(|i| format!(",{c}{i}")).collect::<String>());
    let mut text = format!("t{}\n", columns.concat());
    let (motion, mut random) = (excitation(JOINTS, seed), Random::new(100 + seed));
    for k in 0..(duration / STEP) as usize {
        let [q, qd, qdd] = motion(k as f64 * STEP);
        let clean = robot.inverse_dynamics(&q, &qd, &qdd)
            + robot.viscous_torque(&qd)
            + robot.coulomb_torque(&q, &qd);
        let _ = write!(text, "{:.4}", k as f64 * STEP);
        // Encoders of 16 bits behind the gear, and speeds that are smoothed by the drive.
        q.iter().for_each(|q| write!(text, ",{:.9}", (q * 1e4).round() / 1e4).unwrap());
        qd.iter().for_each(|v| write!(text, ",{:.9}", v + 2e-3 * random.normal()).unwrap());
        for (j, tau) in clean.iter().enumerate() {
            let before = if j > 0 { clean[j - 1] } else { 0.0 };
            let hysteresis = 0.3 * NOISE[j] * (tau / (4.0 * NOISE[j])).tanh();
            let measured = tau + hysteresis + 2e-3 * before + 0.5 * NOISE[j];
            let _ = write!(text, ",{:.6}", measured + NOISE[j] * random.normal());
        }
        text.push('\n');
    }
    std::fs::write(path, text).unwrap();
}

fn settings(model: &str) -> IdentifySettings {
    let text = format!(
        "excitation = [\"a.csv\", \"b.csv\"]\nvalidate = [\"c.csv\"]\nprepare.cut_off = 6.0\n\
         model.motor_inertia = false\nmodel.windows = []\n{model}"
    );
    IdentifySettings::from_toml(&text, "settings").unwrap()
}

/// Returns the errors over all held-out recordings.
fn held_out(found: &Identification) -> &LogValidation {
    assert!(found.held_out);
    found.validation.last().unwrap()
}

/// In three rounds of other motions and noise, since on a single recording either of the two may
/// come out a few percent ahead on a joint.
#[test]
fn physical_links_predict_link_torque_as_well_as_plain_least_squares() {
    let truth = arm();
    let robot = geometry(&truth);
    let mut squares = [[0.0; 2]; JOINTS];
    for round in 0..3 {
        let folder = tempfile::tempdir().unwrap();
        for (name, duration, seed) in [("a", 12.0, 1), ("b", 12.0, 2), ("c", 8.0, 3)] {
            let path = folder.path().join(format!("{name}.csv"));
            record(&truth, &path, duration, 10 * round + seed);
        }
        let identified =
            |model: &str| identify(&robot, &settings(model), folder.path(), &|_, _| {}).unwrap();
        let physical = identified("");
        let plain = identified("model.physical = false\nmodel.robust = false");
        assert!(physical.inertia.physical.is_some() && plain.inertia.physical.is_none());
        // The last link has hardly any inertia, which so short a motion shows to a half.
        let is_about_last = |warning: &String| warning.contains("the motor of joint7 moves (0.00");
        assert!(physical.warnings.iter().all(is_about_last), "{:?}", physical.warnings);
        let joints = held_out(&physical).joints.iter().zip(&held_out(&plain).joints);
        for (squares, (physical, plain)) in squares.iter_mut().zip(joints) {
            squares[0] += physical.residual.powi(2);
            squares[1] += plain.residual.powi(2);
        }
    }
    let ratios = squares.map(|[physical, plain]| (physical / plain).sqrt());
    assert!(ratios.iter().all(|ratio| *ratio < 1.02), "{ratios:?}");
    assert!(ratios.iter().sum::<f64>() < JOINTS as f64, "{ratios:?}");
}
