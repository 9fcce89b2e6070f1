//! A reference motion, which gives the combinations of parameters a measure that does not depend on
//! the frames of the links.

use crate::fit::JointFit;
use crate::prepare::log::PreparedLog;
use crate::regression::residuals::root_mean_square;
use crate::regression::triangular_factor::TriangularFactor;
use reachtube_robot::{Parameter, Regressor, Robot};

/// Number of states of the reference motion, which gives several times as many rows as an arm has
/// parameters.
const STATES: usize = 400;

/// Least range of a joint's motion relative to the range of the joint that moves most.
const MIN_RANGE: f64 = 0.1;

/// Least standard deviation of a joint relative to its torque, for exact data.
const MIN_DEVIATION: f64 = 1e-6;

/// Returns the triangular factor of the regressor over a motion that excites all parameters.
///
/// The positions are spread evenly over the joints' limits, the velocities and accelerations over
/// the sizes that the recorded motions have. Each row is divided by its joint's standard deviation
/// in `joints`. The torque of this motion is the same in all frames, so that two factors over the
/// same motion differ between frames by the change of the parameters only.
pub(super) fn reference_factor(
    robot: &Robot,
    columns: &[Parameter],
    logs: &[PreparedLog],
    joints: &[JointFit],
) -> TriangularFactor {
    let n = robot.joint_count();
    let sizes = [ranges(logs, n, |log| &log.qd), ranges(logs, n, |log| &log.qdd)];
    let states: Vec<[Vec<f64>; 3]> = (0..STATES).map(|k| state(robot, &sizes, k)).collect();
    let stacked = Regressor::new(robot, columns).stacked(&states);
    let deviations = deviations(joints);
    let rows: Vec<usize> = (0..n).flat_map(|joint| (joint..stacked.nrows()).step_by(n)).collect();
    TriangularFactor::from_written_rows(&rows, columns.len(), |r, out| {
        out.iter_mut().zip(stacked.row(r).iter()).for_each(|(o, y)| *o = y / deviations[r % n]);
    })
}

/// Returns the standard deviation of each joint's torque \[N m\].
///
/// A joint without samples gets the largest one.
fn deviations(joints: &[JointFit]) -> Vec<f64> {
    let own = |joint: &JointFit| joint.residual.max(MIN_DEVIATION * joint.torque);
    let largest = joints.iter().map(own).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    joints.iter().map(|joint| if joint.rows == 0 { largest } else { own(joint) }).collect()
}

/// Returns state k: positions, velocities and accelerations of n joints.
fn state(robot: &Robot, [speeds, accelerations]: &[Vec<f64>; 2], k: usize) -> [Vec<f64>; 3] {
    let n = robot.joint_count();
    let symmetric = |part: usize, sizes: &[f64]| {
        (0..n).map(|j| sizes[j] * (2.0 * spread(k, part * n + j) - 1.0)).collect()
    };
    let position = |j: usize| {
        let [low, high] = robot.joints()[j].position_limits;
        low + (high - low) * spread(k, j)
    };
    [(0..n).map(position).collect(), symmetric(1, speeds), symmetric(2, accelerations)]
}

/// Returns number k of a sequence that fills 0..1 evenly; sequences with different `index` are
/// independent of each other (Weyl, with roots of primes).
fn spread(k: usize, index: usize) -> f64 {
    let is_prime = |number: &u32| (2..*number).all(|divisor| !number.is_multiple_of(divisor));
    let prime = (2..).filter(is_prime).nth(index).unwrap_or(2);
    ((k + 1) as f64 * f64::from(prime).sqrt()).fract()
}

/// Returns the range of values of each joint that has the root mean square of the recorded ones.
///
/// A joint at rest gets a share of the largest range, so that the reference shows its inertia.
fn ranges(logs: &[PreparedLog], n: usize, values: impl Fn(&PreparedLog) -> &Vec<f64>) -> Vec<f64> {
    let of_joint = |joint: usize| {
        let all: Vec<f64> = logs
            .iter()
            .flat_map(|log| values(log).iter().skip(joint).step_by(n).copied())
            .collect();
        3f64.sqrt() * root_mean_square(all.into_iter())
    };
    let own: Vec<f64> = (0..n).map(of_joint).collect();
    let least = MIN_RANGE * own.iter().copied().fold(0.0, f64::max);
    own.into_iter().map(|range| range.max(least)).collect()
}
