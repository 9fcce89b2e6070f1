//! Loads of gravity near a motion.

use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::{Lanes, Lanewise};

/// How far joints are moved for a difference, rad or m.
const STEP: f64 = 1e-6;

/// Positions that are evaluated at once.
const AT_ONCE: usize = 8;

/// The gravity torque of a robot to first order about the positions of a motion. Floating point: no
/// proof rests on it.
#[derive(Debug)]
pub(super) struct LoadsNear {
    joints: usize,
    /// For each sample q, g(q) and the columns of ∂g/∂q.
    samples: Vec<f64>,
}

impl LoadsNear {
    /// Expands the loads of `robot` about the `states` of a motion, samples x 2n.
    pub(super) fn along(robot: &Robot, states: &[f64]) -> Self {
        let n = robot.joint_count();
        let mut samples = Vec::with_capacity(states.len() / 2 * (n + 2));
        let mut workspace = Workspace::<Lanes<AT_ONCE>>::new(robot);
        let [mut sin, mut cos, mut load] = [(); 3].map(|()| vec![Lanes::from(0.0); n]);
        for x in states.chunks_exact(2 * n) {
            let (q, start) = (&x[..n], samples.len());
            samples.extend(q);
            // Column 0 is the load itself, and column j + 1 has joint j moved.
            for first in (0..=n).step_by(AT_ONCE) {
                for (j, (joint, q)) in robot.joints().iter().zip(q).enumerate() {
                    let [own, moved] = [0.0, STEP].map(|step| joint.kind.sin_cos(&(q + step)));
                    let pick = |own, moved| {
                        Lanes::from_lanes(|lane| if first + lane == j + 1 { moved } else { own })
                    };
                    (sin[j], cos[j]) = (pick(own.0, moved.0), pick(own.1, moved.1));
                }
                robot.gravity(&sin, &cos, &mut workspace, &mut load);
                let columns = 0..AT_ONCE.min(n + 1 - first);
                samples.extend(columns.flat_map(|lane| load.iter().map(move |g| g.lane(lane))));
            }
            let (load, columns) = samples[start + n..].split_at_mut(n);
            for column in columns.chunks_exact_mut(n) {
                column.iter_mut().zip(&*load).for_each(|(x, g)| *x = (*x - g) / STEP);
            }
        }
        Self { joints: n, samples }
    }

    /// Computes the loads at `q`, near sample `k`, into `load` (n, N m).
    pub(super) fn at(&self, k: usize, q: &[f64], load: &mut [f64]) {
        let n = self.joints;
        let sample = &self.samples[k * n * (n + 2)..][..n * (n + 2)];
        let (about, rest) = sample.split_at(n);
        let (value, columns) = rest.split_at(n);
        load.copy_from_slice(value);
        for ((column, q), about) in columns.chunks_exact(n).zip(q).zip(about) {
            let moved = q - about;
            load.iter_mut().zip(column).for_each(|(load, slope)| *load += slope * moved);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::LoadsNear;
    use reachtube_robot::Robot;

    #[test]
    fn loads_near_a_motion_are_those_of_gravity_to_second_order() {
        let robot = Robot::lwa4p();
        let q = |k: usize, j: usize| (1.3 * k as f64 + 0.7 * j as f64).sin();
        let states: Vec<f64> =
            (0..3).flat_map(|k| (0..12).map(move |j| if j < 6 { q(k, j) } else { 0.4 })).collect();
        let near = LoadsNear::along(&robot, &states);
        for (k, distance) in (0..3).flat_map(|k| [(k, 0.0), (k, 1e-4), (k, 1e-2)]) {
            let at: Vec<f64> =
                (0..6).map(|j| q(k, j) + distance * if j % 2 == 0 { 1.0 } else { -0.5 }).collect();
            let mut load = [0.0; 6];
            near.at(k, &at, &mut load);
            let exact = robot.gravity_torque(&at);
            let off = load.iter().zip(&exact).map(|(a, b)| (a - b).abs());
            let off = off.max_by(f64::total_cmp).unwrap();
            assert!(off < 1e-4 * distance + 300.0 * distance * distance + 1e-12, "{k} {off}");
        }
    }
}
