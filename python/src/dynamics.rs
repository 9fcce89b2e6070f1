//! Dynamics of many states at once, four in the lanes of a vector register, on all cores.

use rayon::prelude::*;
use reachtube::Robot;
use reachtube::robot::{Parameter, Regressor, Workspace};
use reachtube::scalar::{Lanes, Lanewise};

/// States in one vector.
const LANES: usize = 4;

type Lane = Lanes<LANES>;

/// States that one core takes at once.
const CHUNK: usize = 64 * LANES;

/// Scratch memory for one vector of states: sines, cosines, and the arguments after q, n each.
pub(crate) struct Scratch {
    pub sin: Vec<Lane>,
    pub cos: Vec<Lane>,
    pub arguments: Vec<Vec<Lane>>,
    pub workspace: Workspace<Lane>,
    result: Vec<Lane>,
}

/// An algorithm on one vector of states, which writes its result to the last slice.
pub(crate) type Kernel<'a> = &'a (dyn Fn(&mut Scratch, &mut [Lane]) + Sync);

/// Runs an algorithm over `count` states. `arguments` are q and what follows it, each count x n;
/// the result is count x `width`.
pub(crate) fn over_states(
    robot: &Robot,
    arguments: &[Vec<f64>],
    width: usize,
    run: Kernel,
) -> Vec<f64> {
    let n = robot.joint_count();
    let count = arguments[0].len() / n.max(1);
    let mut results = vec![0.0; count * width];
    let chunks = results.par_chunks_mut((CHUNK * width).max(1)).enumerate();
    chunks.for_each_init(
        || Scratch {
            sin: vec![Lane::from(0.0); n],
            cos: vec![Lane::from(0.0); n],
            arguments: vec![vec![Lane::from(0.0); n]; arguments.len() - 1],
            workspace: Workspace::new(robot),
            result: vec![Lane::from(0.0); width],
        },
        |scratch, (chunk, results)| {
            for (place, rows) in results.chunks_mut(LANES * width).enumerate() {
                let first = chunk * CHUNK + place * LANES;
                // The last vector repeats its last state.
                let last = first + rows.len() / width - 1;
                let of = |values: &[f64], i: usize| {
                    Lane::from_lanes(|lane| values[(first + lane).min(last) * n + i])
                };
                for (i, joint) in robot.joints().iter().enumerate() {
                    let angle = of(&arguments[0], i);
                    (scratch.sin[i], scratch.cos[i]) = joint.kind.sin_cos(&angle);
                    for (argument, values) in scratch.arguments.iter_mut().zip(&arguments[1..]) {
                        argument[i] = of(values, i);
                    }
                }
                let mut result = std::mem::take(&mut scratch.result);
                run(scratch, &mut result);
                for (lane, row) in rows.chunks_mut(width).enumerate() {
                    row.iter_mut().zip(&result).for_each(|(out, value)| *out = value.lane(lane));
                }
                scratch.result = result;
            }
        },
    );
    results
}

/// Returns the torques of viscous and of Coulomb friction, count x n each, for q and q̇, each
/// count x n.
pub(crate) fn friction(robot: &Robot, arguments: &[Vec<f64>]) -> [Vec<f64>; 2] {
    let n = robot.joint_count();
    let mut torques = [vec![0.0; arguments[0].len()], vec![0.0; arguments[0].len()]];
    let [viscous, coulomb] = &mut torques;
    let size = (CHUNK * n).max(1);
    let states = arguments[0].par_chunks(size).zip(arguments[1].par_chunks(size));
    let results = viscous.par_chunks_mut(size).zip(coulomb.par_chunks_mut(size));
    states.zip(results).for_each(|((q, qd), (viscous, coulomb))| {
        for first in (0..q.len()).step_by(n) {
            let [q, qd] = [&q[first..first + n], &qd[first..first + n]];
            viscous[first..first + n].copy_from_slice(robot.viscous_torque(qd).as_slice());
            coulomb[first..first + n].copy_from_slice(robot.coulomb_torque(q, qd).as_slice());
        }
    });
    torques
}

/// Returns the regressor of the inertial parameters, count x n x parameters, for q, q̇ and q̈,
/// each count x n.
pub(crate) fn regressors(robot: &Robot, parameters: &[Parameter], motion: &[Vec<f64>]) -> Vec<f64> {
    let n = robot.joint_count();
    let (count, width) = (motion[0].len() / n.max(1), n * parameters.len());
    let mut results = vec![0.0; count * width];
    results.par_chunks_mut(width.max(1)).enumerate().for_each_init(
        || Regressor::new(robot, parameters),
        |regressor, (k, row)| {
            let at = |values: &'_ Vec<f64>| values[k * n..(k + 1) * n].to_vec();
            regressor.fill(&at(&motion[0]), &at(&motion[1]), &at(&motion[2]), row);
        },
    );
    results
}
