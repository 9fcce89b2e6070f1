//! Friction laws: the Stribeck effect, and friction that falls while a joint warms up.

use proptest::prelude::*;
use reachtube_robot::friction::{Coulomb, Friction, Stribeck, Viscous, Warming, WarmingBy};
use reachtube_robot::{DrivenBy, Robot, RobotField, Urdf, UrdfOptions};
use reachtube_scalar::Interval;

use reachtube_ode::VectorField;

const ARM: &str = r#"schema_version = 1
name = "arm"

[[joint]]
name = "hinge"
placement = { translation = [0.0, 0.0, 1.0] }
axis = [0.0, 1.0, 0.0]
mass = 2.0
com = [0.0, 0.0, -0.5]
inertia = [0.1, 0.0, 0.0, 0.1, 0.0, 0.02]
friction = { coulomb = [3.0, 0.1, -3.0, 0.1, -2.0, 0.0, 2.0, 0.0], viscous = [6.0, 0.5,-0.4], LAWS }
"#;

const LAWS: &str = "stribeck = { excess = 0.8, speed = 0.05 }, warming = { by = \"temperature\", \
                    reference = 30.0, coulomb = 0.006, viscous = 0.012 }";

fn arm(laws: &str) -> Result<Robot, String> {
    Robot::from_toml(&ARM.replace("LAWS", laws), "arm.toml").map_err(|error| error.to_string())
}

/// Returns friction by the formulas of the documentation, written out anew.
fn oracle(load: f64, v: f64, temperature: f64) -> f64 {
    let warm = temperature - 30.0;
    let coulomb = match (v > 0.0, load > 0.0) {
        (true, true) => 3.0 + 0.1 * load,
        (true, false) => 2.0,
        (false, false) => -3.0 + 0.1 * load,
        (false, true) => -2.0,
    };
    let rise = 0.8 / (v * v / 0.0025).exp() * v / v.abs();
    (coulomb + rise) / (0.006 * warm).exp()
        + (6.0 * v + 0.5 * v * v - 0.4 * v * v * v) / (0.012 * warm).exp()
}

proptest! {
    #[test]
    fn friction_at_a_temperature_follows_the_formulas(
        q in -1.5..1.5f64, v in -0.3..0.3f64, temperature in 0.0..80.0f64,
    ) {
        prop_assume!(v != 0.0 && q.abs() > 1e-3);
        let robot = arm(LAWS).unwrap().at_temperature(&[temperature]);
        let found = robot.coulomb_torque(&[q], &[v])[0] + robot.viscous_torque(&[v])[0];
        let expected = oracle(robot.gravity_torque(&[q])[0], v, temperature);
        prop_assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{expected}");
        prop_assert_eq!(robot.warms_by(), vec![]);
        prop_assert_eq!(robot.at_temperature(&[3.0]), robot);
    }

    #[test]
    fn the_equation_of_motion_has_the_friction_of_the_formulas(
        q in -1.5..1.5f64, v in -0.3..0.3f64, torque in -20.0..20.0f64,
    ) {
        prop_assume!(v != 0.0 && q.abs() > 1e-3);
        let robot = arm(LAWS).unwrap();
        let mut field = RobotField::<f64>::new(&robot, DrivenBy::Motor);
        let mut rate = [0.0; 2];
        field.rate(0.0, &[q, v], &[torque], &mut rate);
        let gravity = robot.gravity_torque(&[q])[0];
        let inertia = robot.mass_matrix(&[q])[(0, 0)];
        let expected = (torque - oracle(gravity, v, 30.0) - gravity) / inertia;
        prop_assert!((rate[1] - expected).abs() < 1e-9 * (1.0 + expected.abs()));
    }

    #[test]
    fn laws_by_runs_follow_their_formulas(run in 1.0..200.0f64, tau in 0.5..50.0f64) {
        let law = |text: &str| {
            let laws = format!("warming = {{ {text}, reference = 4.0, viscous = 0.3 }}");
            let robot = arm(&laws).unwrap();
            robot.at_run(run).viscous_torque(&[0.5])[0] / robot.viscous_torque(&[0.5])[0]
        };
        let by_runs = law("by = \"runs\"");
        prop_assert!((by_runs - (4.0 / run).powf(0.3)).abs() < 1e-12);
        // The state of x' = (1 - x)/τ from 0, by many small steps.
        let state = |end: f64| {
            let steps = 20_000;
            let h = (end - 1.0) / f64::from(steps);
            (0..steps).fold(0.0, |x, _| x + h * (1.0 - x - 0.5 * h * (1.0 - x) / tau) / tau)
        };
        let thermal = law(&format!("by = \"thermal\", time_constant = {tau}"));
        let expected = (-0.3 * (state(run) - state(4.0))).exp();
        prop_assert!((thermal - expected).abs() < 1e-5, "{thermal} {expected}");
    }

    #[test]
    fn descriptions_with_laws_survive_their_file(
        excess in 0.0..5.0f64, speed in 1e-4..1.0f64, coulomb in -0.4..0.4f64, tau in 0.1..99.0f64,
        by in prop::sample::select(
            vec![WarmingBy::Temperature, WarmingBy::Runs, WarmingBy::Thermal],
        ),
    ) {
        let mut description = arm(LAWS).unwrap().description().clone();
        let time_constant = (by == WarmingBy::Thermal).then_some(tau);
        let law = Warming { by, reference: 1.0 + tau, time_constant, coulomb, viscous: -coulomb };
        description.joints[0].friction.stribeck = Some(Stribeck { excess, speed });
        description.joints[0].friction.warming = Some(law);
        let robot = Robot::from_description(&description).unwrap();
        prop_assert_eq!(&Robot::from_toml(&description.to_toml(), "copy").unwrap(), &robot);
        let json = serde_json::to_string(&description).unwrap();
        let back: reachtube_robot::RobotDescription = serde_json::from_str(&json).unwrap();
        prop_assert_eq!(back, description);
        prop_assert_eq!(robot.warms_by(), vec![by]);
    }
}

#[test]
fn a_description_without_laws_is_written_as_before() {
    let text = arm("").unwrap().description().to_toml();
    assert!(!text.contains("stribeck") && !text.contains("warming"), "{text}");
    let robot = Robot::lwa4p();
    assert_eq!(robot.at_temperature(&[50.0; 6]), robot);
    assert_eq!(robot.at_run(7.0), robot);
}

#[test]
fn laws_that_cannot_be_are_refused_with_joint_and_remedy() {
    let refused = |laws: &str| arm(laws).unwrap_err();
    let place = "arm.toml:11: joint `hinge`: ";
    for (laws, problem) in [
        (
            "stribeck = { excess = -4.0, speed = 0.1 }",
            "stribeck: with excess = -4 N m, friction drives near standstill",
        ),
        ("stribeck = { excess = 1.0, speed = 0.0 }", "stribeck: speed = 0 rad/s is not positive"),
        ("stribeck = { excess = nan, speed = 0.1 }", "friction contains NaN"),
        ("warming = { by = \"runs\", reference = 0.0 }", "warming: reference = 0 is no run"),
        (
            "warming = { by = \"temperature\", reference = 30.0, viscous = 2.0 }",
            "warming: viscous = 2 exceeds ±0.5 1/K",
        ),
        (
            "warming = { by = \"thermal\", reference = 1.0 }",
            "warming: `time_constant` does not suit `by`",
        ),
        (
            "warming = { by = \"runs\", reference = 1.0, time_constant = 3.0 }",
            "warming: `time_constant` does not suit `by`",
        ),
        (
            "warming = { by = \"thermal\", reference = 1.0, time_constant = -3.0 }",
            "warming: time_constant = -3 runs is not positive",
        ),
    ] {
        let error = refused(laws);
        assert!(error.starts_with(&format!("{place}{problem}; ")), "{error}");
    }
    assert!(refused("warming = { by = \"mood\", reference = 1.0 }").contains("mood"));
}

#[test]
fn the_companion_of_a_urdf_carries_the_laws() {
    const URDF: &str = include_str!("arm.urdf");
    let urdf = Urdf::parse_with(URDF, "arm.urdf", "", &UrdfOptions::default()).unwrap();
    let mut description = urdf.robot().description().clone();
    description.joints[1].friction = arm(LAWS).unwrap().description().joints[0].friction;
    let robot = Robot::from_description(&description).unwrap();
    let (text, companion) = (urdf.updated(&robot).unwrap(), urdf.companion(&robot));
    let alone = Urdf::parse_with(&text, "new.urdf", "", &UrdfOptions::default()).unwrap();
    assert_eq!(alone.robot().joints()[1].friction.stribeck, None);
    let back = Urdf::parse_with(&text, "new.urdf", &companion, &UrdfOptions::default()).unwrap();
    assert_eq!(back.robot().joints()[1].friction, robot.joints()[1].friction);
}

/// Returns the torques at both ends of the directions, which friction at standstill lies between.
fn friction() -> Friction {
    Friction {
        coulomb: Coulomb::from_coefficients([3.0, 0.1, -3.0, 0.1, -2.0, -0.3, 2.0, 0.2]),
        viscous: Viscous { v1: 6.0, v2: 0.5, v3: -0.4 },
        stribeck: Some(Stribeck { excess: 0.8, speed: 0.05 }),
        warming: None,
    }
}

#[test]
fn the_range_near_zero_holds_a_million_samples() {
    let friction = friction();
    let mut random = 7u64;
    let mut uniform = |low: f64, high: f64| {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        low + (high - low) * ((random >> 11) as f64 / (1u64 << 53) as f64)
    };
    for _ in 0..1000 {
        let (a, b) = (uniform(-0.2, 0.2), uniform(-0.2, 0.2));
        let (velocity, load) = (a.min(b)..a.max(b), uniform(-10.0, 5.0)..5.0);
        let interval =
            |range: &std::ops::Range<f64>| Interval::new(range.start, range.end).unwrap();
        let range = friction.range_near_zero(interval(&load), interval(&velocity));
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..1000 {
            let part = |range: &std::ops::Range<f64>, x: f64| match k {
                0 => range.start,
                1 => range.end,
                _ => x,
            };
            let v = part(&velocity, uniform(velocity.start, velocity.end));
            let load = part(&load, uniform(load.start, load.end));
            let torque = friction.dry_torque(load, v) + friction.viscous.torque(&v);
            // The sample itself is rounded: fewer than ten roundings of terms below 10 N m.
            let rounding = 10.0 * 10.0 * f64::EPSILON;
            assert!(
                (range.lo() - rounding..=range.hi() + rounding).contains(&torque),
                "{v} {load}"
            );
            (least, most) = (least.min(torque), most.max(torque));
        }
        // The range is not idle: little wider than what a thousand samples fill.
        if !interval(&velocity).contains_zero() {
            assert!(range.width() < 1.2 * (most - least) + 0.2, "{range:?} {least} {most}");
        }
    }
}

#[test]
fn friction_at_standstill_is_every_torque_up_to_breakaway() {
    let friction = friction();
    let zero = Interval::point(0.0);
    let range = friction.range_near_zero(Interval::point(2.0), zero);
    // Forward: 3 + 0.1 · 2 + 0.8; backward: -2 - 0.3 · 2 - 0.8.
    assert!((range.hi() - 4.0).abs() < 1e-14 && range.hi() >= 4.0, "{range:?}");
    assert!((range.lo() + 3.4).abs() < 1e-14 && range.lo() <= -3.4, "{range:?}");
    assert!(Friction::default().range_near_zero(zero, zero).contains(0.0));
}

#[test]
fn friction_that_rises_lies_between_its_values_at_both_ends() {
    let (load, velocity) = (Interval::point(2.0), Interval::new(0.1, 0.9).unwrap());
    for joint in Robot::lwa4p().joints() {
        let at = |v: f64| joint.friction.dry_torque(2.0, v) + joint.friction.viscous.torque(&v);
        let (least, most) = (at(0.1), at(0.9));
        let range = joint.friction.range_near_zero(load, velocity);
        assert!((range.lo() - least).abs() < 1e-13 && range.lo() <= least + 1e-14, "{range:?}");
        assert!((range.hi() - most).abs() < 1e-13 && range.hi() >= most - 1e-14, "{range:?}");
    }
    // The greatest torque of v - v³ lies between the ends, at 1/√3.
    let viscous = Viscous { v1: 1.0, v2: 0.0, v3: -1.0 };
    let friction = Friction { viscous, ..Friction::default() };
    let range = friction.range_near_zero(load, Interval::new(0.0, 1.0).unwrap());
    assert!(range.lo() <= 0.0 && (0.3849..0.45).contains(&range.hi()), "{range:?}");
}
