//! Descriptions of robots, and the errors of invalid ones.

use reachtube_robot::{Robot, RobotDescription};

const PENDULUM: &str = r#"schema_version = 1
name = "pendulum"

[[joint]]
name = "hinge"
placement = { translation = [0.0, 0.0, 1.0] }
axis = [0.0, 2.0, 0.0]
mass = 2.0
com = [0.0, 0.0, -0.5]
inertia = [0.1, 0.0, 0.0, 0.1, 0.0, 0.02]
"#;

fn error_of(text: &str) -> String {
    Robot::from_toml(text, "pendulum.toml").unwrap_err().to_string()
}

/// Returns the error after one line of the pendulum is replaced.
fn error_with(line: &str, by: &str) -> String {
    assert!(PENDULUM.contains(line));
    error_of(&PENDULUM.replace(line, by))
}

#[test]
fn errors_name_line_joint_value_and_remedy() {
    let mass = error_with("mass = 2.0", "mass = -2.0");
    assert_eq!(
        mass,
        "pendulum.toml:8: joint `hinge`: mass = -2 kg is negative; correct the value, or set \
         parameters = \"base\" if only the base parameters have a meaning"
    );
    let axis = error_with("axis = [0.0, 2.0, 0.0]", "axis = [0.0, 0.0, 0.0]");
    assert!(
        axis.starts_with(
            "pendulum.toml:7: joint `hinge`: the axis [0.0, 0.0, 0.0] has no direction"
        ),
        "{axis}"
    );
    let com = error_with("com = [0.0, 0.0, -0.5]", "com = [0.0, nan, -0.5]");
    assert!(
        com.starts_with("pendulum.toml:9: joint `hinge`: com contains NaN; give finite"),
        "{com}"
    );
    let inertia = error_with(
        "inertia = [0.1, 0.0, 0.0, 0.1, 0.0, 0.02]",
        "inertia = [0.1, 0.0, 0.0, 0.1, 0.0, 0.3]",
    );
    assert!(
        inertia
            .starts_with("pendulum.toml:10: joint `hinge`: inertia [0.1, 0.0, 0.0, 0.1, 0.0, 0.3]"),
        "{inertia}"
    );
    assert!(inertia.contains("exceeds the sum of the other two by 1.000e-1 kg m²"), "{inertia}");
    let version = error_with("schema_version = 1", "schema_version = 7");
    assert!(
        version.starts_with("pendulum.toml:1: schema_version 7 is not supported, only 1 is"),
        "{version}"
    );
}

#[test]
fn the_parser_names_line_and_field() {
    let unknown = error_with("mass = 2.0", "mas = 2.0");
    assert!(unknown.contains("line 8") && unknown.contains("`mas`"), "{unknown}");
    let count = error_with("com = [0.0, 0.0, -0.5]", "com = [0.0, 0.0]");
    assert!(count.contains("line 9"), "{count}");
}

#[test]
fn invalid_geometry_and_drives_are_refused() {
    let skew = "placement = { rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.1], [0.0, 0.0, 1.0]] }";
    let placement = "placement = { translation = [0.0, 0.0, 1.0] }";
    assert!(
        error_with(placement, skew)
            .contains("joint `hinge`: `rotation` is not a rotation matrix: |R Rᵀ - 1| = 1.0e-1")
    );
    let mirror = skew.replace("0.1]", "0.0]").replace("[1.0, 0.0, 0.0]", "[-1.0, 0.0, 0.0]");
    assert!(error_with(placement, &mirror).contains("det R = -1"));
    let both = format!("{placement}\ndh = {{ a = 0.0, alpha = 0.0, theta = 0.0, d = 0.0 }}");
    assert!(error_with(placement, &both).contains("give either `dh` or `placement`"));
    assert!(
        error_with("mass = 2.0", "mass = 2.0\narmature = -0.1")
            .contains("armature = -0.1 is negative")
    );
    assert!(
        error_with("mass = 2.0", "mass = 2.0\nrotor_inertia = 0.1").contains("add `gear_ratio`")
    );
    let no_gear = error_with("mass = 2.0", "mass = 2.0\nrotor_inertia = 0.1\ngear_ratio = 0.0");
    assert!(no_gear.contains(":10: joint `hinge`: gear_ratio = 0 leaves no motor"), "{no_gear}");
    assert!(
        error_with("mass = 2.0", "mass = 2.0\nposition_limits = [1.0, 1.0]")
            .contains("position_limits [1, 1] rad: the lower limit is not less")
    );
    assert!(
        error_with("mass = 2.0", "mass = 2.0\nvelocity_limit = 0.0")
            .contains("velocity_limit = 0 rad/s is not positive")
    );
    let twice = format!("{PENDULUM}\n{}", PENDULUM.split_once("\n\n").unwrap().1);
    assert!(error_of(&twice).starts_with("pendulum.toml:13: joint `hinge`: the name occurs twice"));
}

#[test]
fn friction_that_drives_is_found_within_the_limit_only() {
    let drives_at = |friction: &str| {
        let hinge = format!("{PENDULUM}velocity_limit = 2.0\nfriction = {{ {friction} }}\n");
        Robot::from_toml(&hinge, "pendulum.toml").unwrap().joints()[0].friction_drives_at()
    };
    assert!(drives_at("coulomb = [-1.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0]").is_some());
    assert_eq!(drives_at("viscous = [-1.0, 0.0, 0.0]").map(f64::abs), Some(2.0));
    assert_eq!(drives_at("viscous = [1.0, -0.6, 0.0]"), Some(2.0));
    let brakes = [
        "",
        "viscous = [1.0, 0.0, -0.2]",
        // The lines of driving and braking cross away from no load.
        "coulomb = [1.0, 0.1, -1.0, 0.1, 0.2, -0.3, -0.2, -0.3]",
        // Identified with a constant torque.
        "coulomb = [3.0, 0.0, 2.0, 0.0, 2.0, 0.0, 3.0, 0.0]",
        "coulomb = [1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0, 0.0], viscous = [-0.4, 0.0, 0.0]",
    ];
    brakes.iter().for_each(|friction| assert_eq!(drives_at(friction), None, "{friction}"));
    assert!(Robot::lwa4p().joints().iter().all(|joint| joint.friction_drives_at().is_none()));
}

#[test]
fn base_parameters_need_not_belong_to_a_body() {
    let base =
        PENDULUM.replace("name = \"pendulum\"", "name = \"pendulum\"\nparameters = \"base\"");
    assert!(Robot::from_toml(&base.replace("mass = 2.0", "mass = -2.0"), "base").is_ok());
}

#[test]
fn a_missing_file_is_named_with_the_embedded_robots() {
    let error = Robot::load("no/such/robot.toml").unwrap_err().to_string();
    assert!(error.contains("`no/such/robot.toml`") && error.contains("lwa4p"), "{error}");
}

#[test]
fn descriptions_survive_json() {
    let robot = Robot::lwa4p();
    let json = serde_json::to_string(robot.description()).unwrap();
    let back: RobotDescription = serde_json::from_str(&json).unwrap();
    assert_eq!(Robot::from_description(&back).unwrap(), robot);
}

/// In Craig's convention, a and alpha belong to the next joint.
#[test]
fn both_conventions_give_the_same_robot() {
    let rows = [[0.3, 0.4, 0.1, 0.2], [0.5, -0.7, 0.2, 0.1], [0.2, 1.1, -0.3, 0.4]];
    let text = |convention: &str, shifted: bool| {
        let mut out =
            format!("schema_version = 1\nname = \"three\"\nconvention = \"{convention}\"\n");
        for (i, [a, alpha, theta, d]) in rows.iter().enumerate() {
            let (a, alpha) = match (shifted, i) {
                (false, _) => (*a, *alpha),
                (true, 0) => (0.0, 0.0),
                (true, _) => (rows[i - 1][0], rows[i - 1][1]),
            };
            out +=
                &format!("[[joint]]\nname = \"j{i}\"\nmass = {}\n", if i == 2 { 1.5 } else { 0.0 });
            out +=
                &format!("dh = {{ a = {a:?}, alpha = {alpha:?}, theta = {theta:?}, d = {d:?} }}\n");
        }
        out
    };
    let standard = Robot::from_toml(&text("standard", false), "standard").unwrap();
    let modified = Robot::from_toml(&text("modified", true), "modified").unwrap();
    let q = [0.3, -0.8, 1.2];
    // The last standard frame is a and alpha beyond the modified one.
    let last = &modified.link_placements(&q)[2];
    let end = last.translation + last.rotation * nalgebra::Vector3::new(rows[2][0], 0.0, 0.0);
    assert!((standard.link_placements(&q)[2].translation - end).norm() < 1e-15);
    let (x, y) = (standard.link_placements(&q)[1].clone(), modified.link_placements(&q)[2].clone());
    let offset = y.rotation.transpose() * (x.translation - y.translation);
    assert!((offset + nalgebra::Vector3::new(0.0, 0.0, rows[2][3])).norm() < 1e-15);
}
