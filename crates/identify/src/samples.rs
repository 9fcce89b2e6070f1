use super::prepare::{Log, rests};
use super::regression::Triangle;
use nalgebra::DVector;
use rayon::prelude::*;
use reachtube_robot::{Column, ColumnKind, Regressor, Robot};
use std::ops::Range;

/// Rows of the regression tau = Y θ of a group of logs: n rows a sample, one a joint.
#[derive(Debug, Clone)]
pub struct Samples {
    /// Number of joints n.
    pub joints: usize,
    /// What the columns of Y are.
    pub columns: Vec<Column>,
    /// Y, row-major.
    regressor: Vec<f64>,
    /// Torque of each row less what is known of it \[N m\].
    pub torque: Vec<f64>,
    /// Torque of each row as recorded \[N m\].
    pub recorded: Vec<f64>,
    /// Whether a row counts: not where its joint is too slow for friction to have a value.
    pub used: Vec<bool>,
    /// The rows of each log.
    pub logs: Vec<Range<usize>>,
}

/// How samples are taken from logs.
#[derive(Debug, Clone)]
pub struct Sampling {
    /// Rate of the samples \[Hz\]; logs are thinned to it.
    pub rate: f64,
    /// Speed below which a joint's row does not count \[rad/s\], n entries.
    pub slow: Vec<f64>,
    /// Time before and after a joint is slow in which its row does not count either \[s\].
    pub margin: f64,
}

impl Samples {
    /// Samples of logs with these columns, less a known torque, a function of q \[rad\] and q̇
    /// \[rad/s\].
    pub fn of(
        robot: &Robot,
        columns: &[Column],
        logs: &[Log],
        sampling: &Sampling,
        known: &Known,
    ) -> Self {
        let parts = logs.par_iter().map(|log| Self::of_log(robot, columns, log, sampling, known));
        Self::joined(robot.joint_count(), columns, parts.collect())
    }

    fn of_log(
        robot: &Robot,
        columns: &[Column],
        log: &Log,
        sampling: &Sampling,
        known: &Known,
    ) -> Self {
        let mut own = Self::empty(robot.joint_count(), columns);
        let mut regressor = Regressor::new(robot, columns);
        let moves = log.moves(&sampling.slow, sampling.margin);
        let stride = (1.0 / (sampling.rate * log.step)).floor().max(1.0) as usize;
        for k in (0..log.len()).step_by(stride) {
            own.push(&mut regressor, [log.q(k), log.qd(k), log.qdd(k)], log.tau(k), known);
            own.used.extend_from_slice(&moves[k * log.joints..(k + 1) * log.joints]);
        }
        own
    }

    /// One sample a rest: the means of q and tau where no joint moved faster than `speed` \[rad/s\]
    /// for half a second. Friction columns are 0.
    pub fn of_rests(robot: &Robot, columns: &[Column], logs: &[Log], speed: f64) -> Self {
        let n = robot.joint_count();
        let mut all = Self::empty(n, columns);
        let mut regressor = Regressor::new(robot, columns);
        let still = vec![0.0; n];
        for log in logs {
            let first = all.torque.len();
            for rest in rests(&log.qd, n, speed, (0.5 / log.step) as usize) {
                let mean = |values: &[f64]| -> Vec<f64> {
                    let sum =
                        |joint: usize| rest.clone().map(|k| values[k * n + joint]).sum::<f64>();
                    (0..n).map(|joint| sum(joint) / rest.len() as f64).collect()
                };
                all.push(
                    &mut regressor,
                    [&mean(&log.q), &still, &still],
                    &mean(&log.tau),
                    &Known::Nothing,
                );
                all.used.extend(vec![true; n]);
            }
            all.logs.push(first..all.torque.len());
        }
        let width = columns.len();
        let offsets = (0..width).filter(|c| columns[*c].kind == ColumnKind::Offset);
        offsets
            .for_each(|c| all.regressor.iter_mut().skip(c).step_by(width).for_each(|y| *y = 0.0));
        all
    }

    fn empty(joints: usize, columns: &[Column]) -> Self {
        let columns = columns.to_vec();
        Self {
            joints,
            columns,
            regressor: vec![],
            torque: vec![],
            recorded: vec![],
            used: vec![],
            logs: vec![],
        }
    }

    fn push(
        &mut self,
        regressor: &mut Regressor,
        [q, qd, qdd]: [&[f64]; 3],
        tau: &[f64],
        known: &Known,
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

    fn joined(joints: usize, columns: &[Column], parts: Vec<Self>) -> Self {
        let mut all = Self::empty(joints, columns);
        for mut part in parts {
            let first = all.torque.len();
            all.regressor.append(&mut part.regressor);
            all.torque.append(&mut part.torque);
            all.recorded.append(&mut part.recorded);
            all.used.append(&mut part.used);
            all.logs.push(first..all.torque.len());
        }
        all
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.torque.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.torque.is_empty()
    }

    /// Row r of Y.
    pub fn row(&self, r: usize) -> &[f64] {
        let width = self.columns.len();
        &self.regressor[r * width..(r + 1) * width]
    }

    /// Y θ \[N m\], row by row.
    pub fn predicted(&self, theta: &DVector<f64>) -> Vec<f64> {
        let row = |r: usize| self.row(r).iter().zip(theta.iter()).map(|(y, t)| y * t).sum();
        (0..self.len()).into_par_iter().map(row).collect()
    }

    /// Torque less Y θ \[N m\], row by row.
    pub fn residuals(&self, theta: &DVector<f64>) -> Vec<f64> {
        self.torque.iter().zip(self.predicted(theta)).map(|(tau, y)| tau - y).collect()
    }

    /// The triangular factor of the rows that count, each times its weight.
    pub fn triangle(&self, weights: &[f64]) -> Triangle {
        let counted: Vec<usize> =
            (0..self.len()).filter(|r| self.used[*r] && weights[*r] > 0.0).collect();
        let p = self.columns.len();
        Triangle::of_rows(&counted, p, |r, out| {
            out[..p].iter_mut().zip(self.row(r)).for_each(|(o, y)| *o = weights[r] * y);
            out[p] = weights[r] * self.torque[r];
        })
    }

    /// The values of one joint's rows that count, log by log.
    pub fn of_joint(&self, values: &[f64], joint: usize) -> Vec<Vec<f64>> {
        let own = |rows: &Range<usize>| {
            let rows = rows.clone().skip(joint).step_by(self.joints);
            rows.filter(|r| self.used[*r]).map(|r| values[r]).collect()
        };
        self.logs.iter().map(own).collect()
    }
}

/// Torque that is known before a fit.
#[derive(Debug, Clone, Copy)]
pub enum Known<'a> {
    /// None.
    Nothing,
    /// The friction of a robot, its gravity torque as the load.
    Friction(&'a Robot),
    /// All that a robot says of its torque.
    All(&'a Robot),
}

impl Known<'_> {
    fn torque(&self, [q, qd, qdd]: [&[f64]; 3]) -> Option<DVector<f64>> {
        let friction = |robot: &Robot| robot.coulomb_torque(q, qd) + robot.viscous_torque(qd);
        match self {
            Self::Nothing => None,
            Self::Friction(robot) => Some(friction(robot)),
            Self::All(robot) => Some(robot.inverse_dynamics(q, qd, qdd) + friction(robot)),
        }
    }
}
