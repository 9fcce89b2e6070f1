use std::borrow::Cow;

use reachtube_recordings::Run;
use reachtube_robot::Robot;

use crate::prepare::derivative::derivative;
use crate::prepare::lag::Lag;
use crate::prepare::log::PreparedLog;
use crate::prepare::low_pass::LowPass;
use crate::prepare::past::Past;
use crate::prepare::raw_log::RawLog;
use crate::prepare::resample::resampled;

/// The signals of a recording at an even sample time, and their low-pass, if they have one.
pub(super) struct Signals<'a> {
    pub raw: &'a RawLog,
    pub filter: Option<LowPass>,
    pub step: f64,
}

impl<'a> Signals<'a> {
    fn even(&self, which: fn(&'a Run, usize) -> &'a [f64], joint: usize) -> Vec<f64> {
        resampled(&self.raw.run.times, self.raw.column(which, joint), self.step)
    }

    fn filtered(&self, mut values: Vec<f64>) -> Vec<f64> {
        self.filter.iter().for_each(|filter| filter.zero_phase(&mut values));
        values
    }

    /// Returns whether the filter removes less from the differentiated position than from the
    /// recorded velocity, summed over the joints.
    pub(super) fn is_differentiated_quieter(&self) -> bool {
        let removed = |values: Vec<f64>| distance(&self.filtered(values.clone()), &values);
        let joints = || 0..self.raw.run.joints;
        let recorded: f64 = joints().map(|joint| removed(self.even(Run::qd, joint))).sum();
        let slope = |joint: usize| derivative(&self.even(Run::q, joint), self.step);
        recorded > joints().map(|joint| removed(slope(joint))).sum()
    }

    /// Returns whether the recorded velocities lag their positions.
    pub(super) fn lag(&self) -> bool {
        let of_joint = |joint: usize| {
            let [q, qd] = [Run::q, Run::qd].map(|of| self.filtered(self.even(of, joint)));
            Lag::of_joint(&q, &qd, self.step)
        };
        let lags: Vec<Lag> = (0..self.raw.run.joints).filter_map(of_joint).collect();
        Lag::contradict(&lags, self.step)
    }

    /// Returns positions, velocities and accelerations as far as the samples up to each one alone
    /// tell, K x 3n; 0 where a recording is not as long yet. `cut_off` is the low-pass's \[Hz\].
    pub(super) fn before(&self, cut_off: f64, differentiated: bool) -> Vec<f64> {
        let n = self.raw.run.joints;
        let past = Past::new(cut_off, self.step, !differentiated);
        let mut rows = Vec::new();
        for joint in 0..n {
            let q = self.even(Run::q, joint);
            let qd = if differentiated { vec![] } else { self.even(Run::qd, joint) };
            rows.resize(3 * n * q.len(), 0.0);
            let told = rows.chunks_exact_mut(3 * n).skip(past.samples() - 1).enumerate();
            for (first, row) in told {
                let known = past.at_last(|k| q[first + k], |k| qd[first + k]);
                known.iter().enumerate().for_each(|(part, x)| row[part * n + joint] = *x);
            }
        }
        rows
    }

    /// Returns the filtered log with the ends still in place; `gains` has one value per joint.
    pub(super) fn log(&self, gains: &[f64], differentiated: bool) -> PreparedLog {
        let n = self.raw.run.joints;
        let mut log = without_motion(self.raw, self.step);
        log.differentiated = differentiated;
        for (joint, gain) in gains.iter().enumerate() {
            let q = self.filtered(self.even(Run::q, joint));
            let qd = if differentiated {
                derivative(&q, self.step)
            } else {
                self.filtered(self.even(Run::qd, joint))
            };
            let tau = self.filtered(self.even(Run::torque, joint));
            let columns = [
                (&mut log.q, q),
                (&mut log.qdd, derivative(&qd, self.step)),
                (&mut log.qd, qd),
                (&mut log.tau, tau.into_iter().map(|tau| gain * tau).collect()),
            ];
            columns.into_iter().for_each(|(rows, column)| set_column(rows, joint, n, &column));
        }
        log
    }

    /// Replaces the torques by the input (11).
    pub(super) fn compensate(&self, log: &mut PreparedLog, robot: &Robot) {
        let n = log.joints;
        let taken_off = |k: usize| {
            let (tau, robot) = (log.tau(k), warm_robot(robot, log, k));
            let u = robot.input_from_holding_torque(log.q(k), log.qd(k), tau);
            tau.iter().zip(&u).map(|(tau, u)| tau - u).collect::<Vec<f64>>()
        };
        let rows: Vec<f64> = (0..log.len()).flat_map(taken_off).collect();
        for joint in 0..n {
            let column = rows.iter().skip(joint).step_by(n).copied().collect();
            let torques = log.tau.iter_mut().skip(joint).step_by(n);
            torques.zip(self.filtered(column)).for_each(|(torque, off)| *torque -= off);
        }
    }
}

/// Returns the robot with the friction that it has at sample `k`, if the log has it.
fn warm_robot<'a>(robot: &'a Robot, log: &PreparedLog, k: usize) -> Cow<'a, Robot> {
    if robot.warms_by().is_empty() {
        return Cow::Borrowed(robot);
    }
    let n = log.joints;
    let warm = robot.at_run(log.order.unwrap_or(1) as f64);
    Cow::Owned(match log.temperatures.get(k * n..(k + 1) * n) {
        Some(temperatures) => warm.at_temperature(temperatures),
        None => warm,
    })
}

/// Returns the log of a recording with its order and its temperatures, which change too slowly to
/// need the low-pass. All else is zero.
fn without_motion(raw: &RawLog, step: f64) -> PreparedLog {
    let (n, run) = (raw.run.joints, &raw.run);
    let samples = resampled(&run.times, raw.column(Run::q, 0), step).len();
    let mut log = PreparedLog::zeros(&raw.name, n, samples, step);
    log.order = raw.order;
    if !run.temperatures.is_empty() {
        log.temperatures = vec![0.0; log.q.len()];
        for joint in 0..n {
            let column = resampled(&run.times, raw.column(Run::temperature, joint), step);
            set_column(&mut log.temperatures, joint, n, &column);
        }
    }
    log
}

/// Replaces a column of rows of `n` values.
fn set_column(rows: &mut [f64], joint: usize, n: usize, column: &[f64]) {
    rows.iter_mut().skip(joint).step_by(n).zip(column).for_each(|(cell, value)| *cell = *value);
}

/// Returns the squared Euclidean distance.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}
