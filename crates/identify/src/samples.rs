use crate::prepare::log::PreparedLog;
use crate::prepare::rest::rest_intervals;
use crate::regression::triangular_factor::TriangularFactor;
use crate::stiction::{self, KnownFriction, Rests};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use reachtube_robot::{Parameter, ParameterKind, Regressor, Robot};
use std::ops::Range;

/// Samples of a group of recordings that are used: more would follow one another so closely that
/// they add no information.
const MOST_SAMPLES: usize = 30_000;

/// Speed up to which friction must rise without a velocity limit of the robot, in parts of the
/// highest recorded speed.
const BEYOND_RECORDED: f64 = 2.0;

/// Shortest rest that counts as a pose \[s\].
pub(crate) const SHORTEST_REST: f64 = 0.5;

/// Returns the number of samples that are used of a group of recordings with `total` samples.
pub(crate) fn most_samples(total: usize) -> usize {
    total.clamp(1, MOST_SAMPLES)
}

/// Rows of the regression τ = Y θ for a group of logs: n rows per sample, one per joint.
#[derive(Debug, Clone)]
pub(crate) struct Samples {
    /// Number of joints n.
    pub joints: usize,
    /// The columns of Y.
    pub columns: Vec<Parameter>,
    /// Y, row-major rows x columns.
    regressor: Vec<f64>,
    /// Torque of each row minus the known torque \[N m\].
    pub torque: Vec<f64>,
    /// Recorded torque of each row \[N m\].
    pub recorded: Vec<f64>,
    /// Whether a row is used; rows of slow joints are not, because friction has no unique value at
    /// rest.
    pub used: Vec<bool>,
    /// Range of the rows of each log.
    pub logs: Vec<Range<usize>>,
    /// Time of each sample in motion, counted from the first sample of its recording \[s\].
    pub times: Vec<f64>,
}

/// Rules for taking samples from logs.
#[derive(Debug, Clone)]
pub(crate) struct Sampling {
    /// Rate to which logs are downsampled \[Hz\].
    pub rate: f64,
    /// Speed below which a joint's row is not used \[rad/s\], n entries.
    pub slow: Vec<f64>,
    /// Time before and after a slow sample in which a joint's row is not used \[s\].
    pub margin: f64,
    /// Lowest and highest velocity of each joint in slow and in exciting motions \[rad/s\].
    pub velocities: Vec<[f64; 2]>,
}

impl Sampling {
    /// Returns the speed up to which the friction of a joint must rise \[rad/s\]: the velocity
    /// limit of the robot, or else twice the highest speed of the recordings.
    pub(crate) fn velocity_limit(&self, robot: &Robot, joint: usize) -> f64 {
        let [low, high] = self.velocities.get(joint).copied().unwrap_or_default();
        let (known, reached) = (robot.joints()[joint].velocity_limit, high.max(-low));
        known.map_or(BEYOND_RECORDED * reached, |limit| limit.max(reached))
    }

    pub(crate) fn velocity_limits(&self, robot: &Robot) -> Vec<f64> {
        (0..robot.joint_count()).map(|joint| self.velocity_limit(robot, joint)).collect()
    }

    /// Returns the number of samples of a log from one that is used to the next.
    pub(crate) fn stride(&self, log: &PreparedLog) -> usize {
        (1.0 / (self.rate * log.step)).floor().max(1.0) as usize
    }
}

impl Samples {
    /// Takes samples from logs of motions and subtracts the known torque.
    pub(crate) fn in_motion(
        robot: &Robot,
        columns: &[Parameter],
        logs: &[PreparedLog],
        sampling: &Sampling,
        known: &KnownTorque,
    ) -> Self {
        let total: usize = logs.iter().map(|log| log.len().div_ceil(sampling.stride(log))).sum();
        let stride = total.div_ceil(most_samples(total));
        let parts = logs.par_iter().enumerate().map(|(index, log)| {
            // Repeats of a motion are sampled at different times.
            let stride = stride * sampling.stride(log);
            let kept = ((index * sampling.stride(log)) % stride..log.len()).step_by(stride);
            Self::from_log(robot, columns, log, kept, sampling, known)
        });
        Self::joined(robot.joint_count(), columns, parts.collect())
    }

    fn from_log(
        robot: &Robot,
        columns: &[Parameter],
        log: &PreparedLog,
        kept: impl Iterator<Item = usize>,
        sampling: &Sampling,
        known: &KnownTorque,
    ) -> Self {
        let mut samples = Self::empty(robot.joint_count(), columns);
        let mut regressor = Regressor::new(robot, columns);
        let moves = log.moving_mask(&sampling.slow, sampling.margin);
        for k in kept {
            let state = [log.q(k), log.qd(k), log.qdd(k)];
            samples.push(&mut regressor, state, log.tau(k), known);
            samples.used.extend_from_slice(&moves[k * log.joints..(k + 1) * log.joints]);
            samples.times.push(log.time(k));
        }
        samples
    }

    /// Takes one sample per rest: the means of q and τ over an interval of at least 0.5 s in which
    /// no joint moves faster than `speed` \[rad/s\], without `margin` \[s\] at both ends.
    ///
    /// Columns of friction are 0. What friction that the joints keep may explain is taken out of
    /// the rows, see [`stiction`](crate::stiction). Returns the rests as well.
    pub(crate) fn at_rest(
        robot: &Robot,
        columns: &[Parameter],
        logs: &[PreparedLog],
        [speed, margin]: [f64; 2],
        known: Option<KnownFriction>,
    ) -> (Self, Rests) {
        let n = robot.joint_count();
        let mut all = Self::empty(n, columns);
        let mut regressor = Regressor::new(robot, columns);
        let still = vec![0.0; n];
        let mut rests = Rests { joints: n, ..Rests::default() };
        for log in logs {
            let first = all.torque.len();
            for rest in rest_intervals(&log.qd, n, speed, (SHORTEST_REST / log.step) as usize) {
                // The low-pass blurs the torque of the motions before and after.
                let blurred = ((margin / log.step) as usize).min((rest.len() - 1) / 2);
                let quiet = rest.start + blurred..rest.end - blurred;
                let mean = |values: &[f64]| -> Vec<f64> {
                    let sum =
                        |joint: usize| quiet.clone().map(|k| values[k * n + joint]).sum::<f64>();
                    (0..n).map(|joint| sum(joint) / quiet.len() as f64).collect()
                };
                let (q, tau) = (mean(&log.q), mean(&log.tau));
                all.push(&mut regressor, [&q, &still, &still], &tau, &KnownTorque::None);
                all.used.extend(vec![true; n]);
                rests.q.extend(q);
                rests.tau.extend(tau);
                rests.sides.extend(stiction::sides(log, rest.start, speed));
            }
            all.logs.push(first..all.torque.len());
        }
        // The offset of friction is the only friction column that is not 0 at zero velocity.
        let width = columns.len();
        let offsets = (0..width).filter(|c| columns[*c].kind == ParameterKind::Offset);
        offsets
            .for_each(|c| all.regressor.iter_mut().skip(c).step_by(width).for_each(|y| *y = 0.0));
        for joint in 0..n {
            let kept = rests.kept(known, joint);
            all.change_rows(joint, |rows| {
                let mut torque = rows.column_mut(width);
                torque.iter_mut().zip(&kept.mean).for_each(|(tau, kept)| *tau -= kept);
                stiction::discount(&kept.columns, rows);
            });
        }
        (all, rests)
    }

    /// Changes the rows \[y, torque\] of one joint.
    fn change_rows(&mut self, joint: usize, change: impl Fn(&mut DMatrix<f64>)) {
        let (n, width) = (self.joints, self.columns.len());
        let mut rows = DMatrix::from_fn(self.len() / n, width + 1, |k, column| {
            let r = k * n + joint;
            if column < width { self.regressor[r * width + column] } else { self.torque[r] }
        });
        change(&mut rows);
        for (k, row) in rows.row_iter().enumerate() {
            let r = k * n + joint;
            let own = &mut self.regressor[r * width..(r + 1) * width];
            own.iter_mut().zip(row.iter()).for_each(|(own, value)| *own = *value);
            self.torque[r] = row[width];
        }
    }

    fn empty(joints: usize, columns: &[Parameter]) -> Self {
        let columns = columns.to_vec();
        Self {
            joints,
            columns,
            regressor: vec![],
            torque: vec![],
            recorded: vec![],
            used: vec![],
            logs: vec![],
            times: vec![],
        }
    }

    fn push(
        &mut self,
        regressor: &mut Regressor,
        [q, qd, qdd]: [&[f64]; 3],
        tau: &[f64],
        known: &KnownTorque,
    ) {
        let at = self.regressor.len();
        self.regressor.resize(at + self.joints * self.columns.len(), 0.0);
        if !self.columns.is_empty() {
            regressor.fill(q, qd, qdd, &mut self.regressor[at..]);
        }
        let known = known.torque([q, qd, qdd]);
        self.recorded.extend_from_slice(tau);
        self.torque.extend(
            tau.iter().enumerate().map(|(j, tau)| tau - known.as_ref().map_or(0.0, |k| k[j])),
        );
    }

    fn joined(joints: usize, columns: &[Parameter], parts: Vec<Self>) -> Self {
        let mut all = Self::empty(joints, columns);
        for mut part in parts {
            let first = all.torque.len();
            all.regressor.append(&mut part.regressor);
            all.torque.append(&mut part.torque);
            all.recorded.append(&mut part.recorded);
            all.used.append(&mut part.used);
            all.times.append(&mut part.times);
            all.logs.push(first..all.torque.len());
        }
        all
    }

    pub(crate) fn len(&self) -> usize {
        self.torque.len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.torque.is_empty()
    }

    pub(crate) fn row(&self, r: usize) -> &[f64] {
        let width = self.columns.len();
        &self.regressor[r * width..(r + 1) * width]
    }

    /// Returns Y θ \[N m\], one entry per row.
    pub(crate) fn predicted(&self, theta: &DVector<f64>) -> Vec<f64> {
        let row = |r: usize| self.row(r).iter().zip(theta.iter()).map(|(y, t)| y * t).sum();
        (0..self.len()).into_par_iter().map(row).collect()
    }

    /// Returns the torque minus Y θ \[N m\], one entry per row.
    pub(crate) fn residuals(&self, theta: &DVector<f64>) -> Vec<f64> {
        self.torque.iter().zip(self.predicted(theta)).map(|(tau, y)| tau - y).collect()
    }

    /// Returns the used rows, joint by joint: the torque of a joint does not depend on the links
    /// before it, and rows that share columns of zeros are faster to factor.
    pub(crate) fn used_by_joint(&self) -> Vec<usize> {
        let of_joint = |joint: usize| (joint..self.len()).step_by(self.joints);
        (0..self.joints).flat_map(of_joint).filter(|r| self.used[*r]).collect()
    }

    /// Returns the triangular factor of the used rows, each multiplied by its entry of `weights`.
    pub(crate) fn weighted_factor(&self, weights: &[f64]) -> TriangularFactor {
        let mut used = self.used_by_joint();
        used.retain(|r| weights[*r] > 0.0);
        let p = self.columns.len();
        TriangularFactor::from_written_rows(&used, p, |r, out| {
            out[..p].iter_mut().zip(self.row(r)).for_each(|(o, y)| *o = weights[r] * y);
            out[p] = weights[r] * self.torque[r];
        })
    }

    /// Returns the values of one joint's used rows, one list per log.
    pub(crate) fn joint_values(&self, values: &[f64], joint: usize) -> Vec<Vec<f64>> {
        let in_log = |rows: &Range<usize>| {
            let rows = rows.clone().skip(joint).step_by(self.joints);
            rows.filter(|r| self.used[*r]).map(|r| values[r]).collect()
        };
        self.logs.iter().map(in_log).collect()
    }
}

/// Torque that is known before a fit and subtracted from the recorded torque.
#[derive(Debug, Clone, Copy)]
pub(crate) enum KnownTorque<'a> {
    /// No torque.
    None,
    /// The friction of a robot, with the robot's gravity torque as its load.
    Friction(&'a Robot),
    /// The whole torque of a robot: inverse dynamics and friction.
    All(&'a Robot),
}

impl KnownTorque<'_> {
    /// Returns the torque of all joints \[N m\].
    fn torque(&self, [q, qd, qdd]: [&[f64]; 3]) -> Option<DVector<f64>> {
        let friction = |robot: &Robot| robot.coulomb_torque(q, qd) + robot.viscous_torque(qd);
        match self {
            Self::None => None,
            Self::Friction(robot) => Some(friction(robot)),
            Self::All(robot) => Some(robot.inverse_dynamics(q, qd, qdd) + friction(robot)),
        }
    }
}
