//! Offsets of positions, estimated together with the parameters of the robot.

use crate::prepare::log::{PreparedLog, spread};
use crate::regression::residuals::{autocorrelation_time, root_mean_square};
use crate::samples::{KnownTorque, Samples, Sampling};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;
use reachtube_diagnose::Hypothesis;
use reachtube_robot::{BaseParameters, Parameter, Robot};
use schemars::JsonSchema;
use serde::Serialize;

/// Largest number of samples with which offsets are estimated.
const MOST_SAMPLES: f64 = 3000.0;

/// Largest number of recordings with which offsets are estimated.
const MOST_LOGS: usize = 64;

/// Largest number of recordings in each of which an offset of its own is searched.
const MOST_OWN: usize = 16;

/// Step of the difference quotient over a position \[rad or m\].
const STEP: f64 = 1e-4;

/// Number of stretches of the recordings whose scores show the error of an offset.
const STRETCHES: usize = 24;

/// Part of the effect of an offset that parameters must leave for the offset to be identifiable.
const MIN_LEFT: f64 = 1e-3;

/// Standard errors by which an offset must differ from 0 to be reported.
const SIGNIFICANT: f64 = 6.0;

/// Offset that compliance and errors of the geometry may imitate \[rad or m\]: the Panda's
/// recordings show 0.02 rad.
const IMITATED: f64 = 0.02;

/// Standard errors by which a reported offset exceeds what may be imitated.
const CLEAR: f64 = 3.0;

/// Rounds of Gauss and Newton for the size of an offset that is reported.
const ROUNDS: usize = 3;

/// The offset of a joint's position that explains the torque best, if no other joint has one.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PositionOffset {
    /// Name of the joint.
    pub joint: String,
    /// Recorded minus true position \[rad; m\]; `None` if parameters of the robot, or nothing, have
    /// the same effect on the torque as an offset.
    pub offset: Option<f64>,
    /// Standard error of the offset \[rad; m\].
    pub standard_error: Option<f64>,
    /// Size beyond which an offset is reported \[rad; m\].
    pub limit: Option<f64>,
}

/// An offset of a joint's position, in all recordings or in one.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    joint: usize,
    /// Index of the recording, if only one has the offset.
    log: Option<usize>,
}

/// The size of an offset and its standard error \[rad; m\].
#[derive(Debug, Clone, Copy)]
struct Estimate {
    offset: f64,
    error: f64,
}

impl Estimate {
    /// Returns the size beyond which an offset with this error is reported.
    fn limit(self) -> f64 {
        (SIGNIFICANT * self.error).max(IMITATED + CLEAR * self.error)
    }

    fn is_reported(self) -> bool {
        self.offset.abs() > self.limit()
    }
}

/// The offsets of all joints, and the one that is reported.
pub(crate) struct Offsets {
    /// Offsets that all recordings share, one entry per joint; empty for too few samples.
    pub joints: Vec<PositionOffset>,
    /// The most significant offset.
    found: Option<(Candidate, Estimate)>,
}

/// The recordings in which offsets are estimated.
pub(crate) struct OffsetSearch<'a> {
    robot: &'a Robot,
    columns: Vec<Parameter>,
    logs: Vec<PreparedLog>,
    sampling: Sampling,
    known: &'a KnownTorque<'a>,
}

impl<'a> OffsetSearch<'a> {
    /// Prepares a search with the columns of the fit and the torque that is known.
    pub(crate) fn new(
        robot: &'a Robot,
        columns: &[Parameter],
        logs: &[PreparedLog],
        sampling: &Sampling,
        known: &'a KnownTorque<'a>,
    ) -> Self {
        let logs: Vec<PreparedLog> = spread(logs, MOST_LOGS).into_iter().cloned().collect();
        let samples = |log: &PreparedLog| log.len().div_ceil(sampling.stride(log));
        let total: usize = logs.iter().map(samples).sum();
        let thinned = (MOST_SAMPLES / total.max(1) as f64).min(1.0);
        let sampling = Sampling { rate: sampling.rate * thinned, ..sampling.clone() };
        Self { robot, columns: independent_columns(robot, columns), logs, sampling, known }
    }

    /// Estimates the offset of each joint in all recordings, and in each recording alone.
    pub(crate) fn run(&self) -> Offsets {
        let none = Offsets { joints: vec![], found: None };
        let Some(fit) = Regression::new(self, &self.logs) else { return none };
        let own = if (2..=MOST_OWN).contains(&self.logs.len()) { self.logs.len() } else { 0 };
        let of_joint = |joint: usize| {
            let effect = fit.effect(self, &self.logs, joint);
            let all = std::iter::once(None).chain((0..own).map(Some));
            all.map(|log| (Candidate { joint, log }, fit.estimate(&effect, log))).collect()
        };
        let joints = 0..self.robot.joint_count();
        let all: Vec<Vec<(Candidate, Option<Estimate>)>> =
            joints.into_par_iter().map(of_joint).collect();
        let size = |estimate: &Estimate| (estimate.offset / estimate.error).abs();
        let found = all.iter().flatten().filter_map(|(at, estimate)| Some((*at, (*estimate)?)));
        let found = found.filter(|(_, estimate)| estimate.is_reported());
        let found = found.max_by(|a, b| size(&a.1).total_cmp(&size(&b.1)));
        let joints = all.iter().map(|of_joint| {
            let (Candidate { joint, .. }, estimate) = of_joint[0];
            PositionOffset {
                joint: self.robot.joints()[joint].name.clone(),
                offset: estimate.map(|estimate| estimate.offset),
                standard_error: estimate.map(|estimate| estimate.error),
                limit: estimate.map(Estimate::limit),
            }
        });
        Offsets { joints: joints.collect(), found: found.map(|found| self.refined(found)) }
    }

    /// Returns the offset with the nonlinear part of its effect.
    fn refined(&self, (at, mut estimate): (Candidate, Estimate)) -> (Candidate, Estimate) {
        for _ in 0..ROUNDS {
            let logs = self.corrected(&self.logs, at, estimate.offset);
            let Some(fit) = Regression::new(self, &logs) else { break };
            let effect = fit.effect(self, &logs, at.joint);
            let Some(rest) = fit.estimate(&effect, at.log) else { break };
            estimate = Estimate { offset: estimate.offset + rest.offset, error: rest.error };
        }
        (at, estimate)
    }

    /// Returns the recordings without the offset that is reported, and the warning about it.
    pub(crate) fn reported(&self, offsets: &Offsets) -> Option<(Vec<PreparedLog>, String)> {
        let (at, estimate) = offsets.found?;
        let joint = &self.robot.joints()[at.joint];
        let (name, unit) = (&joint.name, joint.kind.position_unit());
        let Estimate { offset, error } = estimate;
        let [_, remedy] = Hypothesis::Offset(at.joint, offset).probably(self.robot);
        let (place, remedy) = match at.log {
            None => (String::new(), remedy),
            Some(log) => (
                format!(" in {} against the other recordings", self.logs[log].name),
                format!("correct q{} there, or leave the recording out", at.joint + 1),
            ),
        };
        let warning = format!(
            "the position of {name} probably has an offset of {offset:.3} ± {error:.3} \
             {unit}{place}: the torque is explained better without it; {remedy}"
        );
        Some((self.corrected(&self.logs, at, offset), warning))
    }

    /// Returns logs without an offset.
    fn corrected(&self, logs: &[PreparedLog], at: Candidate, offset: f64) -> Vec<PreparedLog> {
        let n = self.robot.joint_count();
        let of_log = |(k, log): (usize, &PreparedLog)| {
            let mut log = log.clone();
            if at.log.is_none_or(|own| own == k) {
                log.q.iter_mut().skip(at.joint).step_by(n).for_each(|q| *q -= offset);
            }
            log
        };
        logs.iter().enumerate().map(of_log).collect()
    }
}

/// A weighted least-squares fit of the torque of all used rows to independent columns.
struct Regression {
    samples: Samples,
    /// Indices of the m rows that are used.
    rows: Vec<usize>,
    /// Weight of each of these rows: the reciprocal residual of its joint.
    weights: Vec<f64>,
    /// Y, weighted, m x columns.
    y: DMatrix<f64>,
    /// Factor of YᵀY.
    normal: Cholesky<f64, Dyn>,
    theta: DVector<f64>,
    /// Residuals, weighted, m entries.
    residual: DVector<f64>,
}

impl Regression {
    /// Fits the columns to recordings; `None` for too few samples.
    fn new(search: &OffsetSearch, logs: &[PreparedLog]) -> Option<Self> {
        let OffsetSearch { robot, columns, sampling, known, .. } = search;
        let samples = Samples::in_motion(robot, columns, logs, sampling, known);
        let (n, p) = (samples.joints, columns.len());
        let rows: Vec<usize> = (0..samples.len()).filter(|r| samples.used[*r]).collect();
        if rows.len() < 4 * p {
            return None;
        }
        let sizes = |values: &[f64]| -> Vec<f64> {
            let of_joint =
                |j| root_mean_square(samples.joint_values(values, j).concat().into_iter());
            (0..n).map(|j| of_joint(j).max(f64::MIN_POSITIVE)).collect()
        };
        // The second of two fits weights each joint by its residuals.
        let mut size = sizes(&samples.torque);
        let (mut theta, mut residuals) = (DVector::zeros(p), vec![]);
        for _ in 0..2 {
            let weights: Vec<f64> = (0..samples.len()).map(|r| size[r % n].recip()).collect();
            let factor = samples.weighted_factor(&weights);
            theta = factor.r.solve_upper_triangular(&factor.z)?;
            residuals = samples.residuals(&theta);
            size = sizes(&residuals);
        }
        let weights: Vec<f64> = rows.iter().map(|r| size[r % n].recip()).collect();
        let y = DMatrix::from_fn(rows.len(), p, |i, c| weights[i] * samples.row(rows[i])[c]);
        let normal = Cholesky::new(y.tr_mul(&y))?;
        let mut residual = DVector::from_fn(rows.len(), |i, _| weights[i] * residuals[rows[i]]);
        residual = without(&y, &normal, residual);
        Some(Self { samples, rows, weights, y, normal, theta, residual })
    }

    /// Returns the change of the weighted torque by an offset of 1 rad or m of a joint in all
    /// recordings, m entries.
    fn effect(&self, search: &OffsetSearch, logs: &[PreparedLog], joint: usize) -> DVector<f64> {
        let OffsetSearch { robot, columns, sampling, .. } = search;
        let predicted = |offset: f64| {
            let logs = search.corrected(logs, Candidate { joint, log: None }, offset);
            let samples = Samples::in_motion(robot, columns, &logs, sampling, &KnownTorque::None);
            samples.predicted(&self.theta)
        };
        let [ahead, behind] = [STEP, -STEP].map(predicted);
        let change = |i: usize| (ahead[self.rows[i]] - behind[self.rows[i]]) / (2.0 * STEP);
        DVector::from_fn(self.rows.len(), |i, _| self.weights[i] * change(i))
    }

    /// Estimates an offset in all recordings, or in one; `None` if the columns have the same
    /// effect.
    fn estimate(&self, effect: &DVector<f64>, log: Option<usize>) -> Option<Estimate> {
        let in_log = |i: usize| log.is_none_or(|k| self.samples.logs[k].contains(&self.rows[i]));
        let part = |i: usize| if in_log(i) { effect[i] } else { 0.0 };
        let own = DVector::from_fn(effect.len(), |i, _| part(i));
        let whole = own.norm_squared();
        let left = without(&self.y, &self.normal, own);
        let information = left.norm_squared();
        if information <= MIN_LEFT.powi(2) * whole || information == 0.0 {
            return None;
        }
        let offset = left.dot(&self.residual) / information;
        let rest = &self.residual - offset * &left;
        let variance = self.by_stretches(&left, &rest).max(self.by_joints(&left, &rest));
        Some(Estimate { offset, error: variance.sqrt() / information })
    }

    /// Returns the variance of the score Σ left · rest from its sums over stretches of the
    /// recordings, which may have any correlation within.
    fn by_stretches(&self, left: &DVector<f64>, rest: &DVector<f64>) -> f64 {
        let scores: Vec<f64> = left.iter().zip(rest.iter()).map(|(l, r)| l * r).collect();
        let sums = scores.chunks(scores.len().div_ceil(STRETCHES)).map(|s| s.iter().sum::<f64>());
        let count = STRETCHES as f64;
        count / (count - 1.0) * sums.map(|sum| sum * sum).sum::<f64>()
    }

    /// Returns the variance of the score from the autocorrelation of each joint's residuals.
    fn by_joints(&self, left: &DVector<f64>, rest: &DVector<f64>) -> f64 {
        let mut all = vec![0.0; self.samples.len()];
        self.rows.iter().zip(rest.iter()).for_each(|(row, value)| all[*row] = *value);
        let n = self.samples.joints;
        let of_joint = |joint: usize| {
            let residuals = self.samples.joint_values(&all, joint);
            let series: Vec<&[f64]> = residuals.iter().map(Vec::as_slice).collect();
            let squares: f64 = (0..self.rows.len())
                .filter(|i| self.rows[*i] % n == joint)
                .map(|i| left[i] * left[i])
                .sum();
            let size = root_mean_square(residuals.concat().into_iter());
            autocorrelation_time(&series) * size * size * squares
        };
        (0..n).map(of_joint).sum()
    }
}

/// Returns what the columns of Y leave of a vector. The second pass removes the rounding of the
/// first.
fn without(y: &DMatrix<f64>, normal: &Cholesky<f64, Dyn>, vector: DVector<f64>) -> DVector<f64> {
    let pass = |vector: DVector<f64>| &vector - y * normal.solve(&y.tr_mul(&vector));
    pass(pass(vector))
}

/// Returns the parameters whose columns of the regressor are independent.
pub(super) fn independent_columns(robot: &Robot, columns: &[Parameter]) -> Vec<Parameter> {
    let base = BaseParameters::of_robot(robot, columns);
    base.independent().iter().map(|k| columns[*k]).collect()
}
