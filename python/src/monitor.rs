//! Samples one at a time, or as arrays, beside the sets of a model.

use std::path::Path;

use pyo3::prelude::*;
use reachtube::arm;
use reachtube::conform::data::{Side, Signals};
use reachtube::conform::monitor::{Alarm, Fault, Leave, Schedule};
use reachtube::identify::prepare::VelocitySource;
use reachtube::pipeline::LiveMonitor;

use crate::arrays::{Input, Output, array, values};
use crate::failure::{Failure, Result};
use crate::findings::list;
use crate::recordings::NativeSource;

/// Time, window, part, state, side, value, excess, radius, proved, first.
type Left = (f64, f64, usize, String, &'static str, f64, f64, f64, bool, bool);

/// Time, fault, part, value, and the least and the largest value without an alarm.
type Alarmed = (f64, &'static str, Option<usize>, f64, f64, f64);

/// A monitor of a model.
#[pyclass(name = "Monitor", module = "reachtube._reachtube")]
pub(crate) struct NativeMonitor {
    monitor: LiveMonitor,
    signals: Signals,
    /// The first value outside.
    first: Option<Leave>,
    alarms: Vec<Alarm>,
    alarm_bound: Option<f64>,
}

#[pymethods]
impl NativeMonitor {
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        model: &str,
        step: f64,
        horizon: Option<f64>,
        every: Option<f64>,
        max_gap: Option<f64>,
        differentiate: bool,
        healthy: Option<PyRef<'_, NativeSource>>,
    ) -> PyResult<Self> {
        let made = || -> Result<Self> {
            let (model, _) = arm::parse(model, Path::new("the model"))?;
            let own = Schedule::new(&model, step);
            let usual = Schedule::with_horizon(horizon.unwrap_or(own.horizon), step);
            let schedule = Schedule {
                every: every.unwrap_or(usual.every),
                longest_gap: max_gap.unwrap_or(usual.longest_gap),
                ..usual
            };
            let velocity = match differentiate {
                true => VelocitySource::Differentiated,
                false => VelocitySource::Recorded,
            };
            let mut monitor = LiveMonitor::new(&model, schedule, velocity)?;
            let mut alarm_bound = None;
            if let Some(healthy) = &healthy {
                let known = LiveMonitor::learn(&model, schedule, velocity, &healthy.source)?;
                monitor.watch(&known)?;
                alarm_bound = Some(known.bound());
            }
            let alarms = Vec::new();
            Ok(Self { monitor, signals: model.signals, first: None, alarms, alarm_bound })
        };
        made().map_err(|failure| failure.raised(py))
    }

    /// Takes samples: K times, and K x n positions, velocities and torques.
    fn push(
        &mut self,
        py: Python<'_>,
        times: Input<'_>,
        q: Input<'_>,
        qd: Input<'_>,
        tau: Input<'_>,
    ) -> PyResult<Vec<Left>> {
        let n = self.signals.parts.len();
        let mut take = || -> Result<Vec<Left>> {
            let count = times.as_array().len();
            let times = values("t", &times, &[count])?;
            let [q, qd, tau] = [("q", &q), ("qd", &qd), ("tau", &tau)]
                .map(|(name, array)| values(name, array, &[count, n]));
            let (q, qd, tau) = (q?, qd?, tau?);
            let mut all = Vec::new();
            for (k, &time) in times.iter().enumerate() {
                let row = |of: &'_ [f64]| k * n..(k * n + n).min(of.len());
                let left = self.monitor.push(time, &q[row(&q)], &qd[row(&qd)], &tau[row(&tau)]);
                let wrong = |error| Failure::Setting(format!("sample {k}: {error}"));
                let left = left.map_err(wrong)?;
                self.first = self.first.or(left.first().copied());
                all.extend(left.iter().map(left_of));
                self.alarms.extend_from_slice(self.monitor.alarms());
            }
            Ok(all)
        };
        take().map_err(|failure| failure.raised(py))
    }

    fn finish(&mut self) {
        self.monitor.finish();
    }

    /// Returns all alarms so far.
    fn alarms(&self) -> Vec<Alarmed> {
        self.alarms.iter().map(alarm_of).collect()
    }

    fn alarm_bound(&self) -> Option<f64> {
        self.alarm_bound
    }

    /// Returns the findings, a JSON list: the verdict, the first value outside, the first alarm.
    fn findings(&self) -> String {
        let first = self.first.map(|leave| leave.finding(&self.signals));
        let verdict = self.monitor.found().totals().finding();
        let alarm = self.alarms.first().map(|alarm| alarm.finding(&self.signals));
        list(&[verdict].into_iter().chain(first).chain(alarm).collect::<Vec<_>>())
    }

    /// Samples, windows, windows left, rows, rows outside.
    fn totals(&self) -> (u64, u64, u64, u64, u64) {
        let totals = self.monitor.found().totals();
        (totals.samples, totals.windows, totals.left, totals.rows, totals.outside)
    }

    fn used<'py>(&self, py: Python<'py>) -> Output<'py> {
        self.states(py, self.monitor.found().used())
    }

    fn largest_used<'py>(&self, py: Python<'py>) -> Output<'py> {
        self.states(py, self.monitor.found().largest_used())
    }

    fn drift<'py>(&self, py: Python<'py>) -> Output<'py> {
        self.states(py, self.monitor.found().drift())
    }

    fn delay(&self) -> f64 {
        self.monitor.delay()
    }

    fn horizon(&self) -> f64 {
        self.monitor.found().horizon()
    }
}

impl NativeMonitor {
    fn states<'py>(&self, py: Python<'py>, values: &[f64]) -> Output<'py> {
        array(py, values.to_vec(), &[values.len()])
    }
}

fn alarm_of(alarm: &Alarm) -> Alarmed {
    let Alarm { time, fault, part, value, range: [low, high] } = *alarm;
    let fault = match fault {
        Fault::Push => "push",
        Fault::Drag => "drag",
        Fault::Payload => "payload",
    };
    (time, fault, part, value, low, high)
}

fn left_of(leave: &Leave) -> Left {
    let Leave { time, window, part, state, side, value, excess, radius, proved, first } = *leave;
    let side = match side {
        Side::Upper => "upper",
        Side::Lower => "lower",
    };
    (time, window, part, state.to_string(), side, value, excess, radius, proved, first)
}
