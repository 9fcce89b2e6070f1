//! Base parameters against the counts of Pinocchio's regressor (`shared/oracle`, `base_parameters`)
//! and the paper's Table III.

use crate::shared::{oracle, oracle_robot};
use reachtube_robot::{BaseParameters, Column, ColumnKind, Regressor, Robot};

/// The 23 combinations of `shared/lwa4p/README.md`, in the words that Table III has for them.
const TABLE_III: [&str; 23] = [
    "Iyy1 + J1 + Iyy2 - Izz2 - J2 + Izz3",
    "m2 - Izz2/0.35² - J2/0.35² + m3 + m4 + m5 + m6",
    "mx2 + Izz2/0.35 + J2/0.35",
    "mz2 - Ixz2/0.35 - my3",
    "Ixx2 - Iyy2 + Izz2 + J2",
    "mz3 + 0.3012 m4 + 0.3012 m5 + 0.3012 m6 + my4",
    "Ixx3 - Izz3 + Izz4 + 0.3012² m4 + 0.3012² m5 + 0.3012² m6 + 0.6024 my4",
    "Iyy3 + Izz4 + 0.3012² m4 + 0.3012² m5 + 0.3012² m6 + 0.6024 my4",
    "Iyz3",
    "J3",
    "mz4 - my5",
    "Ixx4 - Izz4 + Izz5",
    "Iyy4 + Izz5",
    "Iyz4",
    "J4",
    "mz5 + 0.1548 m6 + mz6",
    "Ixx5 - Izz5 + Iyy6 + 0.1548² m6 + 0.3096 mz6",
    "Iyy5 + Iyy6 + 0.1548² m6 + 0.3096 mz6",
    "Iyz5",
    "J5",
    "Ixx6 - Iyy6",
    "Izz6",
    "J6",
];

/// A coefficient as it is printed, times or over a number or its square.
fn number(text: &str) -> f64 {
    match text.strip_suffix('²') {
        Some(root) => root.parse::<f64>().unwrap().powi(2),
        None => text.parse().unwrap(),
    }
}

/// A combination in words (without brackets) as a row over the columns.
fn row(words: &str, columns: &[Column]) -> Vec<f64> {
    let (mut row, mut sign, mut factor) = (vec![0.0; columns.len()], 1.0, 1.0);
    for word in words.split_whitespace() {
        match word {
            "+" => sign = 1.0,
            "-" => sign = -1.0,
            _ if word.starts_with(|c: char| c.is_ascii_digit()) => factor = number(word),
            _ => {
                let (name, over) =
                    word.split_once('/').map_or((word, 1.0), |(name, over)| (name, number(over)));
                let k = columns.iter().position(|c| c.to_string() == name).unwrap();
                row[k] = sign * factor / over;
                factor = 1.0;
            }
        }
    }
    row
}

fn all_columns() -> Vec<Column> {
    Column::of_joints(6, &[&ColumnKind::INERTIAL[..], &[ColumnKind::MotorInertia]].concat())
}

fn named_columns() -> Vec<Column> {
    let named = |c: &Column| {
        TABLE_III.iter().any(|r| r.split([' ', '/']).any(|word| word == c.to_string()))
    };
    all_columns().into_iter().filter(named).collect()
}

/// The robot of Table III whose gravity acts on its inertial parameters, as in its regressor.
#[test]
fn table_iii_lies_in_the_row_space() {
    let robot = Robot::lwa4p();
    let columns = named_columns();
    let base = BaseParameters::of_robot(&robot, &columns);
    assert_eq!(base.count(), 23);
    assert!(base.gap()[0] > 1e-3 && base.gap()[1] < 1e-14, "{:?}", base.gap());
    let residual = |words: &str| {
        let row = row(words, &columns);
        let leaders: Vec<_> = base.independent().iter().map(|k| row[*k]).collect();
        let found = base.combinations().tr_mul(&nalgebra::DVector::from_vec(leaders));
        (found - nalgebra::DVector::from_vec(row)).amax()
    };
    for words in TABLE_III {
        assert!(residual(words) < 1e-12, "{words}: {:e}", residual(words));
    }
    // As printed in the paper: with a minus that motion does not show.
    assert!(residual("m2 - Izz2/0.35² + J2/0.35² + m3 + m4 + m5 + m6") > 1.0);
}

#[test]
fn combinations_read_like_table_iii() {
    let base = BaseParameters::of_robot(&Robot::lwa4p(), &named_columns());
    let names = base.names();
    assert_eq!(names[0], "Iyy1 + J1 + Iyy2 - Izz2 - J2 + Izz3");
    let expected = [
        "m2 + m3 + m4 + m5 + m6 - (Izz2 + J2)/0.35²",
        "mx2 + (Izz2 + J2)/0.35",
        "Ixx2 - Iyy2 + Izz2 + J2",
        "mz3 + my4 + 0.3012 (m4 + m5 + m6)",
        "Ixx3 - Izz3 + Izz4 + 0.3012² (m4 + m5 + m6) + 0.6024 my4",
        "mz5 + mz6 + 0.1548 m6",
        "Ixx6 - Iyy6",
    ];
    for words in expected {
        assert!(names.contains(&words.to_string()), "{words} is not among {names:#?}");
    }
}

/// The counts and gaps of Pinocchio's regressor over other random states.
#[test]
fn counts_and_gaps_agree_with_pinocchio() {
    for name in ["ur5", "dh6"] {
        let (Some(robot), Some(oracle)) =
            (oracle_robot(name), oracle(&format!("oracle/{name}.json")))
        else {
            return;
        };
        let inertial = Column::of_joints(6, &ColumnKind::INERTIAL);
        let check = |base: BaseParameters, key: &str| {
            let expected = &oracle["base_parameters"];
            assert_eq!(base.count() as u64, expected[key].as_u64().unwrap(), "{name} {key}");
            let [above, below] = base.gap();
            assert!(below < 1e-14, "{name} {key}: {below:e}");
            if let Some(gap) = expected[format!("{key}_sv_gap")].as_array() {
                let ratio = above / gap[0].as_f64().unwrap();
                assert!(
                    (0.2..5.0).contains(&ratio),
                    "{name} {key}: {above} is {ratio} of the oracle's"
                );
            }
        };
        check(BaseParameters::of_robot(&robot, &inertial), "inertial");
        check(BaseParameters::of_robot(&robot, &all_columns()), "inertial_plus_armature");
        check(
            BaseParameters::of_robot(&robot.with_gravity([0.0; 3]), &inertial),
            "inertial_no_gravity",
        );
        let tilted = robot.with_gravity([3.0, -2.0, -9.0]);
        check(BaseParameters::of_robot(&tilted, &inertial), "inertial_tilted_gravity");
        check(BaseParameters::at_rest(&robot, &inertial), "gravity_only_static");
    }
}

/// Y θ = Y_b K θ, at states that the base was not made from, friction and offsets included.
#[test]
fn the_base_regressor_gives_the_same_torque() {
    use ColumnKind::{Coulomb, MotorInertia, Offset, Viscous1, Viscous3};
    let robot = Robot::lwa4p();
    let kinds =
        [&ColumnKind::INERTIAL[..], &[MotorInertia, Viscous1, Viscous3, Coulomb, Offset]].concat();
    let columns = Column::of_joints(6, &kinds);
    let base = BaseParameters::of_robot(&robot, &columns);
    assert_eq!(base.count(), 40 + 4 * 6);
    let theta: Vec<_> = (0..columns.len()).map(|k| ((k * k) as f64).sin()).collect();
    let beta = base.reduce(&theta);
    let state = |k: usize| {
        [0.1, 0.7, 1.9].map(|a| (0..6).map(|i| (a * (i + 3 * k) as f64).cos()).collect())
    };
    let y = Regressor::new(&robot, &columns).stacked(&(0..20).map(state).collect::<Vec<_>>());
    let tau = &y * nalgebra::DVector::from_column_slice(&theta);
    let scale = tau.amax();
    assert!((base.select(&y) * &beta - &tau).amax() < 1e-11 * scale);
    let near = base.lift_near(beta.as_slice(), &vec![1.0; columns.len()]);
    for lifted in [base.lift(beta.as_slice()), near.clone()] {
        assert!((base.reduce(lifted.as_slice()) - &beta).amax() < 1e-12 * beta.amax());
        assert!((&y * lifted - &tau).amax() < 1e-11 * scale);
    }
    // Nearer to the prior than θ itself, which has the same base parameters.
    let distance = |x: &[f64]| x.iter().map(|x| (x - 1.0).powi(2)).sum::<f64>();
    assert!(distance(near.as_slice()) < distance(&theta));
    let invisible: Vec<_> = base.invisible().iter().map(Column::to_string).collect();
    assert_eq!(invisible.join(" "), "m1 mx1 my1 mz1 Ixx1 Ixy1 Ixz1 Iyz1 Izz1");
}
