use crate::inertia::fit::InertiaFit;
use crate::prepare::log::PreparedLog;
use crate::regression::residuals::root_mean_square;
use crate::samples::{KnownTorque, Samples, Sampling};
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::Serialize;
use std::ops::Range;

/// Largest number of recordings whose torque over time is kept.
const MOST_TRACES: usize = 64;

/// Error of the predicted torque of one joint in one recording.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct JointError {
    /// Root mean square of the recorded torque while the joint moves \[N m\].
    pub torque: f64,
    /// Root mean square of recorded minus predicted torque while the joint moves \[N m\].
    pub residual: f64,
    /// Ratio of `residual` to `torque`; `None` if the joint does not move.
    pub relative: Option<f64>,
    /// The same ratio for the parameters of least squares, before links were made physically
    /// consistent.
    pub relative_plain: Option<f64>,
    /// The same ratio over all samples, including standstill.
    pub relative_all: Option<f64>,
    /// Share of the recorded torque's variance that is predicted while the joint moves; `None` if
    /// it does not move.
    pub r2: Option<f64>,
    /// Number of samples in which the joint moves.
    pub samples: usize,
}

/// Errors of the predicted torque in one validation recording.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LogValidation {
    /// Name of the recording; "all" stands for all of them together.
    pub log: String,
    /// Errors, one entry per joint.
    pub joints: Vec<JointError>,
}

/// The torque of one recording over time, for figures.
#[derive(Debug, Clone)]
pub struct TorqueTrace {
    /// Name of the recording.
    pub log: String,
    /// Times \[s\], K entries.
    pub times: Vec<f64>,
    /// Recorded torque \[N m\], one row of K entries per joint.
    pub recorded: Vec<Vec<f64>>,
    /// Predicted torque \[N m\], one row of K entries per joint.
    pub predicted: Vec<Vec<f64>>,
    /// Whether the joint moves, one row of K entries per joint.
    pub moves: Vec<Vec<bool>>,
}

/// Predicts the torque of recordings by the identified robot, and by plain least squares for
/// comparison.
///
/// Least squares uses the solution of `fit` and the friction of `known`. The errors are listed per
/// recording, and for more than one recording also over all of them.
pub(crate) fn predict_torque(
    found: &Robot,
    known: &Robot,
    logs: &[PreparedLog],
    sampling: &Sampling,
    fit: &InertiaFit,
) -> (Vec<LogValidation>, Vec<TorqueTrace>) {
    let friction = KnownTorque::Friction(known);
    let samples = Samples::in_motion(known, &fit.columns, logs, sampling, &friction);
    let residuals = Samples::in_motion(found, &[], logs, sampling, &KnownTorque::All(found)).torque;
    let plain = samples.residuals(&fit.fit.solution.x);
    let errors = |log: &str, rows: Range<usize>| LogValidation {
        log: log.into(),
        joints: (0..samples.joints)
            .map(|joint| joint_error(&samples, &residuals, &plain, rows.clone(), joint))
            .collect(),
    };
    let by_log = logs.iter().zip(&samples.logs);
    let mut validation: Vec<LogValidation> =
        by_log.clone().map(|(log, rows)| errors(&log.name, rows.clone())).collect();
    if logs.len() > 1 {
        validation.push(errors("all", 0..samples.len()));
    }
    let traces = by_log.take(MOST_TRACES);
    let traces = traces.map(|(log, rows)| trace(&samples, &residuals, log, rows.clone()));
    (validation, traces.collect())
}

fn joint_error(
    samples: &Samples,
    residuals: &[f64],
    plain: &[f64],
    rows: Range<usize>,
    joint: usize,
) -> JointError {
    let all: Vec<usize> = rows.skip(joint).step_by(samples.joints).collect();
    let moving: Vec<usize> = all.iter().copied().filter(|r| samples.used[*r]).collect();
    let size = |rows: &[usize], values: &[f64]| root_mean_square(rows.iter().map(|r| values[*r]));
    let ratio = |rows: &[usize], values: &[f64]| {
        let torque = size(rows, &samples.recorded);
        (torque > 0.0).then(|| size(rows, values) / torque)
    };
    let mean =
        moving.iter().map(|r| samples.recorded[*r]).sum::<f64>() / moving.len().max(1) as f64;
    let spread = root_mean_square(moving.iter().map(|r| samples.recorded[*r] - mean));
    let residual = size(&moving, residuals);
    JointError {
        torque: size(&moving, &samples.recorded),
        residual,
        relative: ratio(&moving, residuals),
        relative_plain: ratio(&moving, plain),
        relative_all: ratio(&all, residuals),
        r2: (spread > 0.0).then(|| 1.0 - (residual / spread).powi(2)),
        samples: moving.len(),
    }
}

fn trace(
    samples: &Samples,
    residuals: &[f64],
    log: &PreparedLog,
    rows: Range<usize>,
) -> TorqueTrace {
    let n = samples.joints;
    let column = |joint: usize, value: &dyn Fn(usize) -> f64| {
        rows.clone().skip(joint).step_by(n).map(value).collect()
    };
    TorqueTrace {
        log: log.name.clone(),
        times: samples.times[rows.start / n..rows.end / n].to_vec(),
        moves: (0..n)
            .map(|joint| rows.clone().skip(joint).step_by(n).map(|r| samples.used[r]).collect())
            .collect(),
        recorded: (0..n).map(|joint| column(joint, &|r| samples.recorded[r])).collect(),
        predicted: (0..n)
            .map(|joint| column(joint, &|r| samples.recorded[r] - residuals[r]))
            .collect(),
    }
}
