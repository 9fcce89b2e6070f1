//! The size of the identified gravity torque and inertia, which shows a wrong unit of the torque.

use crate::inertia::columns::inertia_part;
use crate::inertia::fit::InertiaFit;
use crate::plausibility::implausible::Implausible;
use crate::prepare::log::{PreparedLog, spread};
use crate::regression::residuals::root_mean_square;
use nalgebra::DVector;
use reachtube_diagnose::Hypothesis;
use reachtube_robot::{JointKind, Parameter, Regressor, Robot};
use std::cmp::Ordering;

/// Number of recorded positions at which gravity torques and inertias are computed, at least.
const POSITIONS: usize = 32;

/// Factor between identified and described values beyond which a warning is given.
///
/// Roughly described links are wrong by a factor of 5, and a wrong unit by one of 1000.
const MOST_TIMES: f64 = 30.0;

/// Mass over cubed length that arms have \[kg/m³\]. The mass is that which causes the gravity
/// torque or the inertia at the end of the outstretched arm.
///
/// The recorded arms have 0.26 to 7.4, a pendulum of two rods included. A unit wrong by 1000 gives
/// at least 260 or at most 0.0074.
const DENSITIES: [f64; 2] = [0.03, 50.0];

/// Largest gravity torque and inertia of the joints of a robot in the recorded positions.
#[derive(Debug, Clone, Copy)]
struct Size {
    /// Index of the revolute joint with the largest gravity torque, and its root mean square
    /// \[N m\].
    gravity: (usize, f64),
    /// Index of the revolute joint with the largest inertia about its axis, and that inertia
    /// \[kg m²\].
    inertia: (usize, f64),
}

impl Size {
    /// Returns the size for values of parameters of links and motors.
    fn new(
        robot: &Robot,
        columns: &[Parameter],
        values: &DVector<f64>,
        logs: &[PreparedLog],
    ) -> Self {
        let n = robot.joint_count();
        let unit = |j: Option<usize>| (0..n).map(|k| f64::from(u8::from(Some(k) == j))).collect();
        // Each position at rest, then with an acceleration of each joint alone.
        let accelerations = || std::iter::once(None).chain((0..n).map(Some));
        let at = |q: &[f64]| -> Vec<[Vec<f64>; 3]> {
            accelerations().map(|j| [q.to_vec(), vec![0.0; n], unit(j)]).collect()
        };
        let states: Vec<[Vec<f64>; 3]> = positions(logs).into_iter().flat_map(at).collect();
        let torques = Regressor::new(robot, columns).stacked(&states) * values;
        let rows = || (0..states.len() / (n + 1)).map(|k| k * (n + 1));
        let torque = |row: usize, joint: usize| torques[row * n + joint];
        let gravity = |j: usize| root_mean_square(rows().map(|row| torque(row, j)));
        let inertia =
            |j: usize| root_mean_square(rows().map(|row| torque(row + 1 + j, j) - torque(row, j)));
        let kinds = robot.kinds();
        let largest = |size: &dyn Fn(usize) -> f64| {
            let revolute = (0..n).filter(|j| kinds[*j] == JointKind::Revolute);
            let sizes = revolute.map(|j| (j, size(j)));
            sizes.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
        };
        Self { gravity: largest(&gravity), inertia: largest(&inertia) }
    }

    /// Returns on which side of `limits` both values lie relative to `unit`, if they do. A value
    /// counts only if it and its unit are not 0.
    fn side(self, unit: [f64; 2], limits: [f64; 2]) -> Option<Ordering> {
        let pairs = [self.gravity.1, self.inertia.1].into_iter().zip(unit);
        let counting = pairs.filter(|(own, unit)| *own > 0.0 && *unit > 0.0);
        let sides = counting.map(|(own, unit)| match own / unit {
            ratio if ratio < limits[0] => Ordering::Less,
            ratio if ratio > limits[1] => Ordering::Greater,
            _ => Ordering::Equal,
        });
        let same = sides.reduce(|a, b| if a == b { a } else { Ordering::Equal });
        same.filter(|side| *side != Ordering::Equal)
    }

    /// Returns the gravity torque with its unit, or the inertia.
    fn value(self, by_inertia: bool) -> String {
        let (value, unit) =
            if by_inertia { (self.inertia.1, "kg m²") } else { (self.gravity.1, "N m") };
        format!("{} {unit}", number(value))
    }

    /// Returns a clause that names the gravity torque, or the inertia.
    fn clause(self, robot: &Robot, by_inertia: bool) -> String {
        let value = self.value(by_inertia);
        let name = |joint: usize| &robot.joints()[joint].name;
        if by_inertia {
            format!("the identified inertia about the axis of {} is {value}", name(self.inertia.0))
        } else {
            format!(
                "the identified gravity torque of {} is {value} (root mean square over the \
                 recorded positions)",
                name(self.gravity.0)
            )
        }
    }
}

/// Returns a warning if gravity torques and inertias fit no such arm: far from the description's,
/// or, if it has no masses, from the values of arms of its length.
///
/// Both must be too large, or both too small: friction imitates one of them, and gravity is absent
/// where a controller compensates it.
pub(super) fn torque_unit_warning(
    robot: &Robot,
    fit: &InertiaFit,
    logs: &[PreparedLog],
) -> Option<Implausible> {
    // Least squares: a prior far from the data would hide how far it is.
    let (columns, values) = inertia_part(&fit.columns, &fit.fit.solution.x);
    let found = Size::new(robot, &columns, &values, logs);
    let described = DVector::from_vec(robot.parameter_values(&columns));
    let described = Size::new(robot, &columns, &described, logs);
    // Gravity torque and inertia of a mass of 1 kg/m³ times the cubed length at the arm's end.
    let length = length(robot);
    let usual = [gravity(robot) * length.powi(4), length.powi(5)];
    let by_length = found.side(usual, DENSITIES);
    let has_masses = described.gravity.1 > 0.0 || described.inertia.1 > 0.0;
    let by_inertia = found.gravity.1 == 0.0 || (has_masses && described.gravity.1 == 0.0);
    let clause = found.clause(robot, by_inertia);
    if !has_masses {
        let mass = if by_inertia {
            found.inertia.1 / length.powi(2)
        } else {
            found.gravity.1 / (gravity(robot) * length)
        };
        let clause = format!(
            "{clause}, as {} kg at the end of this arm of {length:.2} m would cause, which no such \
             arm has",
            number(mass)
        );
        return by_length.map(|side| wrong_unit(robot, &clause, side, false));
    }
    let limits = [MOST_TIMES.recip(), MOST_TIMES];
    let side = found.side([described.gravity.1, described.inertia.1], limits)?;
    let clause = format!("{clause}, where the description has {}", described.value(by_inertia));
    let mut found = wrong_unit(robot, &clause, side, false);
    if by_length != Some(side) && length != 0.0 {
        found.text = format!(
            "{clause}: arms of this length have such values; check the masses of the description, \
             and the units of tau (N m), q (rad) and qd (rad/s)"
        );
    }
    Some(found)
}

/// Formats a positive number with three digits or so.
pub(super) fn number(value: f64) -> String {
    match value {
        100.0.. => format!("{value:.0}"),
        0.1..100.0 => format!("{value:.2}"),
        _ => format!("{value:.1e}"),
    }
}

/// Makes the warning about a unit of the torques that makes values too large or too small, on which
/// `side` they are.
///
/// Gains would multiply the torque that controllers add as well.
pub(super) fn wrong_unit(
    robot: &Robot,
    clause: &str,
    side: Ordering,
    compensated: bool,
) -> Implausible {
    let unit = Hypothesis::TorqueUnit(if side == Ordering::Greater { 1e-3 } else { 1e3 });
    let [probably, remedy] = unit.probably(robot);
    let gains = if compensated { "" } else { ", for example with --gains or prepare.gains" };
    let text = format!("{clause}: {probably}; {remedy}{gains}");
    Implausible { text, columns: Some(unit) }
}

fn gravity(robot: &Robot) -> f64 {
    robot.gravity_acceleration().into_iter().map(|g| g * g).sum::<f64>().sqrt()
}

/// Returns the length of the outstretched arm \[m\]: the distances between its joints, and their
/// mean for the last link, whose end the description need not know.
fn length(robot: &Robot) -> f64 {
    let geometry = robot.geometry();
    let distances =
        geometry.iter().map(|g| g.before.translation.norm() + g.after.translation.norm());
    let known = geometry.len().saturating_sub(1).max(1) as f64;
    distances.sum::<f64>() * (1.0 + known.recip())
}

/// Returns at least [`POSITIONS`] positions, evenly spread over the logs \[rad\].
fn positions(logs: &[PreparedLog]) -> Vec<&[f64]> {
    let logs: Vec<&PreparedLog> =
        spread(logs, POSITIONS).into_iter().filter(|l| l.len() > 0).collect();
    let each = POSITIONS.div_ceil(logs.len().max(1));
    let position = |log: &'_ PreparedLog, k: usize| (2 * k + 1) * log.len() / (2 * each);
    logs.into_iter().flat_map(|log| (0..each).map(move |k| log.q(position(log, k)))).collect()
}
