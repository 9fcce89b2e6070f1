//! The text of the header.

use std::fmt::Write;

use reachtube_files::{MARK, TOOL};
use reachtube_robot::Robot;

use super::arm::Arm;
use super::friction::JointFriction;
use super::settings::ArmourSettings;
use crate::export::text::{comment, harmless, number, numbers};

/// Writes the header.
pub(super) fn text(
    robot: &Robot,
    arm: &Arm,
    settings: &ArmourSettings,
    [least, largest]: [f64; 2],
    friction: &[JointFriction],
) -> String {
    let n = arm.links.len();
    let mut text = about(robot, settings.uncertainty);
    let _ = writeln!(
        text,
        "#ifndef ROBOT_INFO_H\n#define ROBOT_INFO_H\n\n#include \"Headers.h\"\n\n\
         #define NUM_JOINTS {n}\n#define NUM_FACTORS {n}\n\n// Each joint turns about z\n\
         const int axes[NUM_JOINTS] = {{ {} }};\n",
        vec!["3"; n].join(", ")
    );
    let origins = arm.frames.iter().flat_map(|frame| frame.origin);
    list(
        &mut text,
        "Origin of each frame in the one before, and of the tip in the last, m",
        "trans[(NUM_JOINTS + 1) * 3]",
        &mut origins.chain([0.0; 3]),
    );
    list(
        &mut text,
        "Roll, pitch and yaw of each frame in the one before, rad: R = Rx(roll) Ry(pitch) Rz(yaw)",
        "rots[NUM_JOINTS * 3]",
        &mut arm.frames.iter().flat_map(|frame| frame.angles),
    );
    list(&mut text, "kg", "mass[NUM_JOINTS]", &mut arm.links.iter().map(|link| link.mass));
    list(
        &mut text,
        "Centre of mass in the link's frame, m",
        "com[NUM_JOINTS * 3]",
        &mut arm.links.iter().flat_map(|link| link.com),
    );
    list(
        &mut text,
        "About the centre of mass, kg m^2",
        "inertia[NUM_JOINTS * 9]",
        &mut arm.links.iter().flat_map(|link| symmetric(&link.inertia)),
    );
    limits(&mut text, robot, arm, settings, friction);
    text + &shapes(arm) + &scalars(robot, settings.uncertainty, [least, largest])
}

/// Writes friction, motors and limits.
fn limits(
    text: &mut String,
    robot: &Robot,
    arm: &Arm,
    settings: &ArmourSettings,
    friction: &[JointFriction],
) {
    list(
        text,
        "Bound of the friction that is no line, N m: proved up to the limits below",
        "friction[NUM_JOINTS]",
        &mut friction.iter().map(|friction| friction.dry),
    );
    list(
        text,
        "N m s/rad",
        "damping[NUM_JOINTS]",
        &mut friction.iter().map(|friction| friction.damping),
    );
    list(
        text,
        "Motor inertia on the link side, kg m^2",
        "armature[NUM_JOINTS]",
        &mut arm.links.iter().map(|link| link.armature),
    );
    let limits = || robot.joints().iter().map(|joint| joint.position_limits);
    list(text, "rad", "state_limits_lb[NUM_FACTORS]", &mut limits().map(|[low, _]| low));
    list(text, "rad", "state_limits_ub[NUM_FACTORS]", &mut limits().map(|[_, high]| high));
    list(
        text,
        "rad/s",
        "speed_limits[NUM_FACTORS]",
        &mut friction.iter().map(|friction| friction.speed),
    );
    list(text, "N m", "torque_limits[NUM_FACTORS]", &mut settings.torque_limits.iter().copied());
}

/// Writes an array, three numbers a line.
fn list(text: &mut String, about: &str, name: &str, values: &mut dyn Iterator<Item = f64>) {
    let values: Vec<f64> = values.map(|x| x + 0.0).collect();
    let rows: Vec<String> =
        values.chunks(3).map(|row| numbers(row.iter().copied(), ", ")).collect();
    let _ = writeln!(text, "// {about}\nconst double {name} = {{\n  {} }};\n", rows.join(",\n  "));
}

/// Returns the entries of a symmetric matrix, row by row.
fn symmetric(i: &nalgebra::Matrix3<f64>) -> [f64; 9] {
    let [xy, xz, yz] = [i[(0, 1)], i[(0, 2)], i[(1, 2)]];
    [i[(0, 0)], xy, xz, xy, i[(1, 1)], yz, xz, yz, i[(2, 2)]]
}

/// Returns the comment that says what is proved.
fn about(robot: &Robot, ratio: f64) -> String {
    let lines = [
        format!("{MARK} ({TOOL}): {} for the planner ARMOUR.", harmless(robot.name())),
        format!(
            "Proved: M_min and M_max bound the eigenvalues of the mass matrix with the motor \
             inertias at all positions within the limits, for every arm whose masses and entries \
             of inertia differ by at most the ratio {} from the numbers here.",
            number(ratio)
        ),
        "Not proved: the ratios mass_uncertainty and inertia_uncertainty. They were given to the \
         command; torques determine sums of masses and inertias only, and the model's U covers \
         what the robot does otherwise. com_uncertainty is 0, as ARMOUR's program does not read \
         it."
        .into(),
        "alpha, V_m and K are settings of ARMOUR's controller, as in its own files: set yours."
            .into(),
    ];
    comment("//", &lines)
}

/// Returns the boxes around the links.
fn shapes(arm: &Arm) -> String {
    let part = |k: usize| {
        let rows =
            arm.boxes.iter().map(|of| format!("{{ {} }}", numbers(of[k].map(|x| x + 0.0), ", ")));
        rows.collect::<Vec<_>>().join(",\n  ")
    };
    format!(
        "// Boxes that contain the capsules: centre and half widths in the link's frame, m\n\
         const double link_zonotope_center[NUM_JOINTS][3] = {{\n  {} }};\n\n\
         const double link_zonotope_generators[NUM_JOINTS][3] = {{\n  {} }};\n\n",
        part(0),
        part(1)
    )
}

/// Returns the ratios, gravity and the ultimate bound.
fn scalars(robot: &Robot, ratio: f64, [least, largest]: [f64; 2]) -> String {
    let ratio = number(ratio);
    format!(
        "const double mass_uncertainty = {ratio};\nconst double com_uncertainty = 0.0;\n\
         const double inertia_uncertainty = {ratio};\n\n// Along -z of the base, m/s^2\n\
         const double gravity = {};\n\n// kg m^2\nconst double M_max = {};\n\
         const double M_min = {};\n\nconst double alpha = 1.0;\nconst double V_m = 1e-2;\n\
         const double eps = sqrt(2 * V_m / M_min);\nconst double K = 10.0;\n\
         const double qe = eps / K;\nconst double qde = 2 * eps;\nconst double qdae = eps;\n\
         const double qddae = 2 * K * eps;\n\n#endif\n",
        number(-robot.gravity_acceleration()[2] + 0.0),
        number(largest),
        number(least)
    )
}
