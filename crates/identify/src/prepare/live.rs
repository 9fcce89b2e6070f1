use reachtube_recordings::{EvenSamples, Preparation, Sample, SampleError, Torque};
use reachtube_robot::{Robot, Workspace};

use crate::error::{Error, Result};
use crate::prepare::low_pass::LowPass;
use crate::prepare::past::Past;
use crate::prepare::settings::{VelocitySource, gain_of_each_joint};

/// Periods of the cut-off to both sides over which samples are weighed. Beyond them, the low-pass
/// has died out to a thousandth.
const PERIODS: f64 = 3.0;

/// Weights of the derivative of fourth order, times the step.
const SLOPE: [f64; 5] = [1.0 / 12.0, -8.0 / 12.0, 0.0, 8.0 / 12.0, -1.0 / 12.0];

/// Prepares samples one at a time as [`prepare`](crate::prepare::prepare) prepares recordings: at
/// even times, with gains, filtered without phase shift, and without gravity and dry friction.
///
/// The low-pass weighs samples before and after each one, so that an answer comes late by twice
/// three periods of the cut-off: once for the signals, and once more for what is subtracted from
/// the torques, which is computed from them. It is cut off there, where `prepare` weighs all
/// samples; the difference is below a thousandth of a step. Nothing is allocated after the
/// preparation was made.
#[derive(Debug, Clone)]
pub struct LiveLog {
    gains: Vec<f64>,
    even: EvenSamples,
    filter: Option<LiveFilter>,
    made: Sample,
}

impl LiveLog {
    /// Prepares samples of `robot` that are `step` \[s\] apart, with gaps of `longest_gap` \[s\] at
    /// most. [`VelocitySource::Quieter`] would need the whole recording: velocities are the
    /// recorded ones unless most recordings of the model had others.
    ///
    /// # Errors
    ///
    /// [`Error::SampledTooSlowly`] where the low-pass needs more samples; [`Error::GainCount`] and
    /// [`Error::Gain`].
    pub fn new(
        robot: &Robot,
        preparation: &Preparation,
        velocity: VelocitySource,
        step: f64,
        longest_gap: f64,
    ) -> Result<Self> {
        let n = robot.joint_count();
        let Preparation { torque, gains, cut_off, differentiated, .. } = preparation;
        let differentiates = *differentiated || velocity == VelocitySource::Differentiated;
        let filter = match (torque, cut_off) {
            (Torque::Compensated, _) | (_, None) => None,
            (_, Some(cut_off)) => Some(LiveFilter::new(robot, *cut_off, step, differentiates)?),
        };
        let gains = gain_of_each_joint(gains, n)?;
        let even = EvenSamples::new(n, step, longest_gap);
        Ok(Self { gains, even, filter, made: Sample::zeros(n) })
    }

    /// Returns the time by which samples are late, s.
    #[must_use]
    pub fn delay(&self) -> f64 {
        self.filter.as_ref().map_or(0.0, LiveFilter::delay)
    }

    /// Forgets all samples.
    pub fn clear(&mut self) {
        self.even.clear();
        self.filter.iter_mut().for_each(LiveFilter::clear);
    }

    /// Takes a sample: time \[s\], and positions, velocities and torques (n each). The samples that
    /// it completes follow from [`next`](Self::next).
    ///
    /// # Errors
    ///
    /// As [`EvenSamples::take`].
    pub fn take(&mut self, time: f64, parts: [&[f64]; 3]) -> std::result::Result<(), SampleError> {
        self.even.take(time, parts)
    }

    /// Returns the next prepared sample, if it is complete, and its state as far as the recorded
    /// samples up to it alone tell, 2n; empty if nothing is filtered.
    #[expect(clippy::should_implement_trait, reason = "an iterator cannot lend its items")]
    pub fn next(&mut self) -> Option<(&Sample, &[f64])> {
        let Self { gains, even, filter, made } = self;
        while let Some(sample) = even.next() {
            made.copy(sample);
            let n = gains.len();
            let torques = made.values[2 * n..].iter_mut().zip(&*gains);
            torques.for_each(|(torque, gain)| *torque *= gain);
            let is_complete = filter.as_mut().is_none_or(|filter| filter.filtered(made));
            if is_complete {
                return Some((made, filter.as_ref().map_or(&[], LiveFilter::told)));
            }
        }
        None
    }
}

/// The last rows of a table, oldest first.
#[derive(Debug, Clone)]
struct Rows {
    width: usize,
    count: usize,
    /// Number of rows that were taken.
    taken: u64,
    /// Twice as many rows as are kept, so that the kept ones lie side by side.
    rows: Vec<f64>,
}

impl Rows {
    fn new(width: usize, count: usize) -> Self {
        Self { width, count, taken: 0, rows: vec![0.0; 2 * width * count] }
    }

    fn take(&mut self, row: &[f64]) {
        let at = (self.taken % self.count as u64) as usize;
        for at in [at, at + self.count] {
            self.rows[at * self.width..(at + 1) * self.width].copy_from_slice(row);
        }
        self.taken += 1;
    }

    /// Returns the rows, once there are as many as are kept.
    fn all(&self) -> Option<&[f64]> {
        let start = (self.taken % self.count as u64) as usize * self.width;
        (self.taken >= self.count as u64)
            .then(|| &self.rows[start..start + self.width * self.count])
    }

    /// Returns the last `count` rows, once there are as many; at most as many as are kept.
    fn last(&self, count: usize) -> Option<&[f64]> {
        let end = (self.taken % self.count as u64) as usize + self.count;
        let rows = (end - count) * self.width..end * self.width;
        (self.taken >= count as u64).then(|| &self.rows[rows])
    }

    /// Adds up the columns from `first` on, weighed, into `sums`, one per column. The weights are
    /// centred on the rows.
    fn weighed(&self, first: usize, weights: &[f64], sums: &mut [f64]) {
        sums.fill(0.0);
        let skipped = (self.count - weights.len()) / 2;
        let Some(rows) = self.all() else { return };
        let rows = rows.chunks_exact(self.width).skip(skipped);
        for (row, weight) in rows.zip(weights) {
            let columns = sums.iter_mut().zip(&row[first..]);
            columns.for_each(|(sum, value)| *sum += weight * value);
        }
    }
}

/// The low-pass, and what is subtracted from the torques, sample by sample.
#[derive(Debug, Clone)]
struct LiveFilter {
    robot: Robot,
    step: f64,
    weights: Vec<f64>,
    /// The weights of the filtered signal's derivative, where velocities need it.
    slope: Vec<f64>,
    differentiates: bool,
    raw: Rows,
    /// The filtered sample, 3n.
    filtered: Rows,
    off: Rows,
    past: Past,
    /// What the samples up to each one tell, 2n.
    told: Rows,
    row: Vec<f64>,
    taken_off: Vec<f64>,
    workspace: Workspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    gravity: Vec<f64>,
}

impl LiveFilter {
    fn new(robot: &Robot, cut_off: f64, step: f64, differentiates: bool) -> Result<Self> {
        let rate = step.recip();
        let low_pass = LowPass::new(cut_off, rate).ok_or_else(|| Error::SampledTooSlowly {
            log: "the samples".into(),
            rate,
            cut_off,
        })?;
        // The warmth of a running robot is unknown: it counts as in its first run.
        let robot = if robot.warms_by().is_empty() { robot.clone() } else { robot.at_run(1.0) };
        let n = robot.joint_count();
        let weights = low_pass.weights(PERIODS);
        let slope = convolved(&weights, step);
        let zeros = || vec![0.0; n];
        let delay = slope.len() / 2 + weights.len() / 2;
        Ok(Self {
            past: Past::new(cut_off, step, !differentiates),
            told: Rows::new(2 * n, delay + 1),
            step,
            raw: Rows::new(3 * n, slope.len()),
            filtered: Rows::new(3 * n, weights.len() / 2 + 1),
            off: Rows::new(n, weights.len()),
            weights,
            slope,
            differentiates,
            row: vec![0.0; 3 * n],
            taken_off: zeros(),
            workspace: Workspace::new(&robot),
            sin: zeros(),
            cos: zeros(),
            gravity: zeros(),
            robot,
        })
    }

    fn delay(&self) -> f64 {
        (self.slope.len() / 2 + self.weights.len() / 2) as f64 * self.step
    }

    fn clear(&mut self) {
        let Self { raw, filtered, off, told, .. } = self;
        [raw, filtered, off, told].into_iter().for_each(|of| of.taken = 0);
    }

    /// Takes a sample and replaces it by the one that it completes, if it completes one.
    fn filtered(&mut self, sample: &mut Sample) -> bool {
        let n = self.taken_off.len();
        self.raw.take(&sample.values);
        self.tell();
        if self.raw.all().is_none() {
            return false;
        }
        // Filtered signals, and derivatives of them.
        let signals = &mut self.row[..];
        self.raw.weighed(0, &self.weights, signals);
        if self.differentiates {
            self.raw.weighed(0, &self.slope, &mut signals[n..2 * n]);
        }
        self.filtered.take(&self.row);
        self.take_off();
        self.off.take(&self.taken_off);
        if self.off.all().is_none() {
            return false;
        }
        // The sample in the middle of what is subtracted.
        self.off.weighed(0, &self.weights, &mut self.taken_off);
        let Some(row) = self.filtered.all().map(|rows| &rows[..3 * n]) else { return false };
        sample.values.copy_from_slice(row);
        for (joint, torque) in sample.values[2 * n..].iter_mut().enumerate() {
            *torque -= self.taken_off[joint];
        }
        sample.time -= self.delay();
        true
    }

    /// Estimates the state at the newest sample from it and earlier ones.
    fn tell(&mut self) {
        let (n, width) = (self.taken_off.len(), self.raw.width);
        let Self { raw, past, told, row, .. } = self;
        if let Some(rows) = raw.last(past.samples()) {
            for joint in 0..n {
                let of = |column: usize| move |k: usize| rows[k * width + column];
                let [q, qd, _] = past.at_last(of(joint), of(n + joint));
                (row[joint], row[n + joint]) = (q, qd);
            }
        }
        told.take(&row[..2 * n]);
    }

    /// Returns the state that the samples up to the one that was completed last tell.
    fn told(&self) -> &[f64] {
        self.told.all().map_or(&[], |rows| &rows[..self.told.width])
    }

    /// Computes gravity and the dry friction that acts or holds, at the filtered state, as
    /// [`Robot::input_from_holding_torque`] takes them off.
    fn take_off(&mut self) {
        let n = self.taken_off.len();
        let Self { robot, row, taken_off, workspace, sin, cos, gravity, .. } = self;
        let [q, qd, tau] = [0, 1, 2].map(|part| &row[part * n..(part + 1) * n]);
        for (j, joint) in robot.joints().iter().enumerate() {
            (sin[j], cos[j]) = joint.kind.sin_cos(&q[j]);
        }
        robot.gravity(sin, cos, workspace, gravity);
        for (j, joint) in robot.joints().iter().enumerate() {
            let driving = tau[j] - gravity[j];
            let friction = joint.friction.holding_torque(gravity[j], qd[j], driving);
            taken_off[j] = tau[j] - (driving - friction);
        }
    }
}

/// Returns the weights of the derivative of what `weights` give.
fn convolved(weights: &[f64], step: f64) -> Vec<f64> {
    let mut slopes = vec![0.0; weights.len() + SLOPE.len() - 1];
    for (at, weight) in weights.iter().enumerate() {
        for (k, slope) in SLOPE.iter().enumerate() {
            slopes[at + k] += weight * slope / step;
        }
    }
    slopes
}

#[cfg(test)]
mod tests {
    use reachtube_recordings::{Preparation, Run, Torque};
    use reachtube_robot::Robot;

    use super::LiveLog;
    use crate::prepare::{PrepareSettings, RawLog, VelocitySource, prepare};

    const STEP: f64 = 0.01;

    #[test]
    fn gains_of_another_number_of_joints_are_refused() {
        let (robot, gains) = (Robot::lwa4p(), vec![2.0; 3]);
        let known = Preparation { gains, ..preparation() };
        let refused = LiveLog::new(&robot, &known, VelocitySource::Recorded, STEP, STEP);
        assert!(refused.unwrap_err().to_string().contains("gains: 3 given"));
    }

    fn preparation() -> Preparation {
        Preparation {
            torque: Torque::Motor,
            gains: Vec::new(),
            cut_off: Some(5.0),
            window: None,
            differentiated: false,
            columns: Default::default(),
            log: Default::default(),
        }
    }

    /// A smooth motion of the LWA 4P with torques that fit neither.
    fn run(samples: usize) -> Run {
        let wave = |k: usize, j: usize, f: f64| (f * k as f64 * STEP + j as f64).sin();
        let times = (0..samples).map(|k| k as f64 * STEP).collect();
        let state = |k: usize| {
            let q = (0..6).map(move |j| 0.5 * wave(k, j, 2.0) + 0.002 * wave(k, j, 90.0));
            q.chain((0..6).map(move |j| (2.0 * k as f64 * STEP + j as f64).cos()))
        };
        let torque = |k: usize| (0..6).map(move |j| 9.0 * wave(k, j, 3.0) + wave(k, j, 80.0));
        let states = (0..samples).flat_map(state).collect();
        Run::new(6, times, states, (0..samples).flat_map(torque).collect()).unwrap()
    }

    #[test]
    fn samples_are_prepared_as_recordings_are() {
        let (robot, run) = (Robot::lwa4p(), run(600));
        for torque in [Torque::Motor, Torque::Link] {
            for velocity in [VelocitySource::Recorded, VelocitySource::Differentiated] {
                let gains = vec![1.0, 0.5, 1.0, 2.0, 1.0, 1.0];
                let settings = PrepareSettings {
                    gains: gains.clone(),
                    torque: Some(torque),
                    velocity,
                    ..Default::default()
                };
                let raw = RawLog::new("a", "a", run.clone());
                let log = &prepare(&[raw], &settings, 5.0, Some(&robot)).unwrap().logs[0];
                // The model knows what its recordings were prepared from.
                let differentiated = velocity == VelocitySource::Differentiated;
                let known = Preparation { torque, gains, differentiated, ..preparation() };
                let velocity = VelocitySource::Recorded;
                let mut live = LiveLog::new(&robot, &known, velocity, STEP, STEP).unwrap();
                // The recording was cut by 2.5 periods at its ends.
                let cut = (run.len() - log.len()) / 2;
                let (live_delay, mut count) = (live.delay(), 0);
                for k in 0..run.len() {
                    live.take(run.times[k], [run.q(k), run.qd(k), run.torque(k)]).unwrap();
                    let Some((sample, told)) = live.next() else { continue };
                    assert!((sample.time - run.times[k] + live_delay).abs() < 1e-9);
                    let at = (sample.time / STEP).round() as usize;
                    assert!((sample.time - at as f64 * STEP).abs() < 1e-9);
                    let Some(row) = at.checked_sub(cut).filter(|row| *row < log.len()) else {
                        continue;
                    };
                    let known = [log.q(row), log.qd(row), log.tau(row)].concat();
                    assert_eq!(sample.values.len(), known.len());
                    assert_eq!(told.len(), 12);
                    for (own, known) in told.iter().zip(&log.before[18 * row..]) {
                        assert!((own - known).abs() < 1e-9, "{own} {known}");
                    }
                    for (own, known) in sample.values.iter().zip(known) {
                        let off = (own - known).abs();
                        assert!(off < 0.02, "{torque:?} {velocity:?} {off}");
                    }
                    count += 1;
                }
                assert!(count > 300, "{torque:?} {velocity:?} {count}");
            }
        }
    }
}
