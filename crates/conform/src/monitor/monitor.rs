use std::sync::Arc;

use reachtube_reach::{Propagation, TimeGrid};
use reachtube_recordings::{EvenSamples, Sample, SampleError};
use schemars::JsonSchema;
use serde::Serialize;

use crate::data::live_input::LiveInput;
use crate::data::settings::NominalStart;
use crate::data::setup::Setup;
use crate::error::{Error, Result};
use crate::model::file::Model;
use crate::monitor::alarm::Alarm;
use crate::monitor::fault_watch::{FaultWatch, Task};
use crate::monitor::healthy::HealthyMotion;
use crate::monitor::leave::Leave;
use crate::monitor::nominal::LiveNominal;
use crate::monitor::schedule::Schedule;
use crate::monitor::statistics::Shape;
use crate::monitor::window::{Sets, Window};
use crate::tube::grids::Grid;

/// The weight of one more window in the drift, once there are many.
const DRIFT_WEIGHT: f64 = 1.0 / 16.0;

/// Compares samples with the reachable sets of a linear model as they are recorded.
///
/// The motion is cut into overlapping windows ([`Schedule`]). Each begins at a measured state, as a
/// recording of a suite of its own does, and its values are compared with the model's set as
/// [`check()`](crate::check()) compares the rows of recordings, whatever the model's notion is.
/// After it was made, a monitor allocates nothing, and the time for a sample is bounded. Where U
/// grows with the nominal motion, a window is judged at its end, when its motion is known, and its
/// samples are kept until then.
///
/// # Guarantee
///
/// A value that is not reported lies in the interval hull of the reachable set, widened by V, in
/// each window that is open: some disturbance reaches it in that state. For a value that is
/// reported as [proved](Leave::proved), no start in X0, no disturbance with values in U of the
/// model's kind and no noise in V explain the window up to that sample, under the inputs and times
/// as they are in double precision. That also disproves the notions phase-plane and exact,
/// whose sets lie in the hull. Values at times between samples are interpolated and carry what
/// that changes.
#[derive(Debug)]
pub struct Monitor {
    even: EvenSamples,
    input: Box<dyn LiveInput>,
    judge: Judge,
    setup: Setup,
}

/// What judges samples at even times.
#[derive(Debug)]
struct Judge {
    sets: Sets,
    nominal: Option<LiveNominal>,
    /// Steps from the beginning of one window to the beginning of the next.
    every: u64,
    windows: Vec<Window>,
    /// Number of samples since the beginning.
    count: u64,
    /// Whether windows start where the samples before them tell, and what these tell, 2n; empty if
    /// it is not known.
    is_told: bool,
    told: Vec<f64>,
    /// The input of the sample, m, and of the one before.
    input: Vec<f64>,
    before: Vec<f64>,
    leaves: Vec<Leave>,
    /// What else tells faults, and the alarms of the samples that were taken last.
    faults: Option<FaultWatch>,
    alarms: Vec<Alarm>,
    progress: Progress,
}

/// How many samples, windows and rows there were.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, JsonSchema)]
pub struct Totals {
    /// Samples at even times.
    pub samples: u64,
    /// Windows that ended.
    pub windows: u64,
    /// Windows with a value outside the set.
    pub left: u64,
    /// Rows: a window's value in one state at one sample.
    pub rows: u64,
    /// Rows that do not hold.
    pub outside: u64,
    /// Alarms of motion unlike healthy motion.
    pub alarms: u64,
}

/// What was found so far.
#[derive(Debug)]
struct Progress {
    totals: Totals,
    /// The part of the set that the last window used, which has ended, 2n.
    last: Vec<f64>,
    /// The part used by the open windows and the last one, 2n.
    used: Vec<f64>,
    /// The largest part used, 2n.
    largest: Vec<f64>,
    drift: Vec<f64>,
}

impl Monitor {
    /// Makes the monitor of a model with its setup.
    ///
    /// # Errors
    ///
    /// [`Error::NotLinear`] for a model whose sets cannot be computed ahead of its motion,
    /// [`Error::SettingRange`] for a schedule that is not possible, and when the solution of the
    /// system cannot be enclosed over a window.
    pub fn new(model: &Model, setup: Setup, schedule: Schedule) -> Result<Self> {
        let [steps, every] = schedule.steps()?;
        let system = setup.dynamics().linear_system().ok_or(Error::NotLinear)?;
        let (n, settings, step) = (model.inputs(), setup.settings(), schedule.step);
        let times = TimeGrid::uniform(step, steps + 1);
        let propagation = Propagation::new(system, &times)?;
        let input_gains = settings.disturbance.input_gains(&propagation);
        let grid = Grid { times: Arc::new(times), propagation, input_gains };
        let parts = &setup.drive.signals().parts;
        let doubling = settings.input_doubling.clone().map(|rates| (parts.clone(), rates));
        let sets = Sets::new(grid, model.sets(), settings.states.rows(2 * n), doubling);
        let input = setup.drive.live_input()?;
        let windows = vec![Window::new(n); steps / every + 1];
        // Samples at even times that one sample may complete.
        let at_once = (schedule.longest_gap / step).ceil() as usize + 1;
        let mut judge = Judge {
            nominal: LiveNominal::new(&setup, system, step)?,
            every: every as u64,
            windows,
            count: 0,
            is_told: settings.nominal == NominalStart::Past,
            told: Vec::with_capacity(2 * n),
            input: vec![0.0; n],
            before: vec![0.0; n],
            leaves: Vec::new(),
            faults: None,
            alarms: Vec::with_capacity(at_once * (2 * n + 1)),
            progress: Progress::new(2 * n),
            sets,
        };
        judge.leaves.reserve(at_once * judge.most_at_once());
        Ok(Self { even: EvenSamples::new(n, step, schedule.longest_gap), input, judge, setup })
    }

    /// Takes a sample: its time \[s\], positions, velocities and torques (n each; rad, rad/s, N m,
    /// of the model's kind). Returns the values that are outside, in the open windows one after
    /// another.
    ///
    /// # Errors
    ///
    /// A sample that cannot be used. It changes nothing.
    pub fn push(
        &mut self,
        time: f64,
        q: &[f64],
        qd: &[f64],
        torque: &[f64],
    ) -> Result<&[Leave], SampleError> {
        if self.judge.is_told && self.judge.told.is_empty() {
            return Err(SampleError::NotTold);
        }
        self.even.take(time, [q, qd, torque])?;
        let Self { even, input, judge, .. } = self;
        judge.leaves.clear();
        judge.alarms.clear();
        while let Some(sample) = even.next() {
            input.evaluate(sample, &mut judge.input);
            judge.take(sample);
        }
        Ok(&self.judge.leaves)
    }

    /// Takes what the samples up to the next one tell of its state, 2n, rad and rad/s, which a
    /// window starts from that opens there. Only models need it whose settings have
    /// [`NominalStart::Past`].
    pub fn tell(&mut self, state: &[f64]) {
        self.judge.told.clear();
        self.judge.told.extend_from_slice(state);
    }

    /// Begins anew, as at the end of a recording: the next sample may have any time. The totals
    /// stay.
    pub fn finish(&mut self) {
        let Self { even, judge, .. } = self;
        judge.leaves.clear();
        judge.alarms.clear();
        even.clear();
        judge.count = 0;
        judge.faults.iter_mut().for_each(FaultWatch::clear);
        judge.windows.iter_mut().for_each(|window| window.sample = None);
    }

    /// Compares motion with healthy motion, too, from now on: see [`alarms`](Self::alarms).
    ///
    /// # Errors
    ///
    /// When no robot can be made with a payload only.
    pub fn watch(&mut self, healthy: &HealthyMotion) -> Result<()> {
        let ranges = healthy.ranges();
        let outside = vec![false; ranges.len()];
        self.begin_task(healthy.shape.clone(), Task::Watch { ranges, outside })
    }

    /// Returns what the samples that were pushed last show to be unlike healthy motion; nothing
    /// unless [`watch`](Self::watch) was called. Each alarm is raised once, when a number leaves
    /// its range.
    #[must_use]
    pub fn alarms(&self) -> &[Alarm] {
        &self.judge.alarms
    }

    /// Learns from the samples that follow, without windows.
    pub(crate) fn begin_lesson(&mut self, shape: Shape, task: Task) -> Result<()> {
        self.judge.windows.clear();
        self.judge.is_told = false;
        self.begin_task(shape, task)
    }

    pub(crate) fn end_lesson(&mut self) -> Option<FaultWatch> {
        self.judge.faults.take()
    }

    fn begin_task(&mut self, shape: Shape, task: Task) -> Result<()> {
        let step = self.step();
        let residual = self.setup.drive.residual(step)?;
        self.judge.faults = Some(FaultWatch::new(residual, shape, step, task));
        Ok(())
    }

    pub(crate) fn inputs(&self) -> usize {
        self.judge.before.len()
    }

    fn step(&self) -> f64 {
        self.judge.sets.grid.times.times().get(1).copied().unwrap_or(0.0)
    }

    /// Returns how many samples, windows and rows there were.
    #[must_use]
    pub fn totals(&self) -> Totals {
        self.judge.progress.totals
    }

    /// Returns the gauge of each state: the largest part of the set's radius, from its centre, that
    /// the open windows and the last one before them used after their first samples, 2n. A value
    /// above 1 is outside. In floating point.
    #[must_use]
    pub fn used(&self) -> &[f64] {
        &self.judge.progress.used
    }

    /// Returns the largest gauge of each state since the beginning, 2n.
    #[must_use]
    pub fn largest_used(&self) -> &[f64] {
        &self.judge.progress.largest
    }

    /// Returns the drift of each state: where in the set, in parts of its radius, windows end, on
    /// average over about the last 16, 2n. A robot that changes moves it away from 0.
    #[must_use]
    pub fn drift(&self) -> &[f64] {
        &self.judge.progress.drift
    }

    /// Returns the time from the beginning of one window to the beginning of the next, s.
    #[must_use]
    pub fn every(&self) -> f64 {
        let times = self.judge.sets.grid.times.times();
        times.get(self.judge.every as usize).copied().unwrap_or(0.0)
    }

    /// Returns the length of a window, s.
    #[must_use]
    pub fn horizon(&self) -> f64 {
        self.judge.sets.grid.times.times().last().copied().unwrap_or(0.0)
    }
}

impl Judge {
    /// Returns how many values may be outside at one sample.
    fn most_at_once(&self) -> usize {
        let samples = if self.sets.doubling.is_some() { self.sets.grid.times.len() } else { 1 };
        self.sets.rows * samples * self.windows.len()
    }

    fn take(&mut self, sample: &Sample) {
        let Self { sets, nominal, windows, before, leaves, progress, .. } = self;
        for window in windows.iter_mut() {
            window.advance(sets, nominal.as_mut(), before);
        }
        if self.count.is_multiple_of(self.every) {
            let free = windows.iter_mut().find(|window| window.sample.is_none());
            let start = if self.is_told { &self.told[..] } else { sample.state() };
            free.into_iter().for_each(|window| window.open(sample, start));
        }
        self.count += 1;
        progress.begin();
        for window in windows.iter_mut().filter(|window| window.sample.is_some()) {
            let rows = window.judge(sets, sample, |leave| {
                progress.totals.left += u64::from(leave.first);
                if leaves.len() < leaves.capacity() {
                    leaves.push(leave);
                }
            });
            progress.take(window, rows);
            if window.sample == Some(sets.last()) {
                progress.end(window);
                window.sample = None;
            }
        }
        self.before.copy_from_slice(&self.input);
        if let Some(faults) = &mut self.faults {
            let Self { alarms, before, progress, .. } = self;
            faults.take(sample, before, |alarm| {
                progress.totals.alarms += 1;
                if alarms.len() < alarms.capacity() {
                    alarms.push(alarm);
                }
            });
        }
    }
}

impl Progress {
    fn new(states: usize) -> Self {
        let zeros = || vec![0.0; states];
        let [last, used, largest, drift] = [zeros(), zeros(), zeros(), zeros()];
        Self { totals: Totals::default(), last, used, largest, drift }
    }

    fn begin(&mut self) {
        self.totals.samples += 1;
        self.used.copy_from_slice(&self.last);
    }

    fn take(&mut self, window: &Window, [rows, outside]: [u64; 2]) {
        self.totals.rows += rows;
        self.totals.outside += outside;
        let used = self.used.iter_mut().zip(&window.used).zip(&mut self.largest);
        for ((used, of_window), largest) in used {
            *used = used.max(*of_window);
            *largest = largest.max(*of_window);
        }
    }

    fn end(&mut self, window: &Window) {
        self.totals.windows += 1;
        let weight = DRIFT_WEIGHT.max(1.0 / self.totals.windows as f64);
        self.last.copy_from_slice(&window.used);
        let drift = self.drift.iter_mut().zip(&window.signed);
        drift.for_each(|(drift, signed)| *drift += weight * (signed - *drift));
    }
}
