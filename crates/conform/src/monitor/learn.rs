//! Learns what healthy motion is, by passing its recordings through a monitor.

use reachtube_recordings::{ReadOptions, RunSource};

use crate::data::setup::Setup;
use crate::error::{Error, Result};
use crate::model::file::Model;
use crate::monitor::fault_watch::{FaultWatch, Task};
use crate::monitor::healthy::HealthyMotion;
use crate::monitor::monitor::Monitor;
use crate::monitor::schedule::Schedule;
use crate::monitor::statistics::{Range, Shape};

/// Speed above which a part counts as moving, over the root mean square of its speed: slower, the
/// law of dry friction decides the torque.
const GATE: f64 = 1.0 / 3.0;

/// Root mean square of a speed below which a part counts as resting, rad/s or m/s.
const AT_REST: f64 = 1e-3;

impl HealthyMotion {
    /// Learns from recordings at a schedule's times, for a model with its setup. They are read four
    /// times, one by one.
    ///
    /// # Errors
    ///
    /// [`Error::TooFewHealthy`] for less than two recordings, [`Error::Healthy`] for a recording
    /// that cannot be used, and the errors of [`Monitor::new`].
    pub fn learn(
        model: &Model,
        setup: Setup,
        schedule: Schedule,
        runs: &dyn RunSource,
    ) -> Result<Self> {
        let count = runs.runs().len();
        if count < 2 {
            return Err(Error::TooFewHealthy { count });
        }
        let mut monitor = Monitor::new(model, setup, schedule)?;
        let n = model.inputs();
        let shape = Shape { gate: vec![0.0; n], ripple: vec![[0.0; 2]; n], load: 1.0 };
        let mut lesson = |first: usize, shape: &Shape, task: Task| -> Result<FaultWatch> {
            monitor.begin_lesson(shape.clone(), task)?;
            for index in (first..count).step_by(2) {
                follow(&mut monitor, runs, index)?;
            }
            monitor.end_lesson().ok_or(Error::TooFewHealthy { count })
        };
        let speeds = lesson(0, &shape, Task::Speeds { squares: vec![0.0; n], count: 0 })?;
        let shape = Shape { gate: gates(&speeds.task), ..shape };
        let products = Task::Ripple { products: vec![[0.0; 5]; n], load: 0.0, count: 0 };
        let (ripple, load) = ripple(&lesson(0, &shape, products)?.task);
        let shape = Shape { ripple, load, ..shape };
        let unknown = Task::Ranges(vec![None; 2 * n + 1]);
        let Task::Ranges(ranges) = lesson(0, &shape, unknown)?.task else {
            return Err(Error::TooFewHealthy { count });
        };
        let ranges: Vec<Option<Range>> =
            ranges.into_iter().map(|range| range.filter(|[low, high]| low < high)).collect();
        let task = Task::Scores { ranges: ranges.clone(), largest: [1.0; 2] };
        let factors = match lesson(1, &shape, task)?.task {
            Task::Scores { largest, .. } => largest,
            _ => [1.0; 2],
        };
        Ok(Self { shape, ranges, factors, scored: count / 2 })
    }
}

fn follow(monitor: &mut Monitor, runs: &dyn RunSource, index: usize) -> Result<()> {
    let wrong = |problem: &dyn std::fmt::Display| Error::Healthy {
        name: runs.run_name(index).display().to_string(),
        problem: problem.to_string(),
    };
    let options = ReadOptions::of(monitor.inputs());
    let run = runs.read(index, &options).map_err(|defects| match defects.first() {
        Some(defect) => wrong(defect),
        None => wrong(&"it cannot be read"),
    })?;
    for (k, &time) in run.times.iter().enumerate() {
        let pushed = monitor.push(time, run.q(k), run.qd(k), run.torque(k));
        pushed.map_err(|problem| wrong(&problem))?;
    }
    monitor.finish();
    Ok(())
}

fn gates(task: &Task) -> Vec<f64> {
    let Task::Speeds { squares, count } = task else { return Vec::new() };
    let gate = |square: &f64| {
        let speed = (square / (*count).max(1) as f64).sqrt();
        if speed > AT_REST { GATE * speed } else { f64::INFINITY }
    };
    squares.iter().map(gate).collect()
}

/// Returns the ripple of each part by least squares, and the mean square of the weight's torque.
fn ripple(task: &Task) -> (Vec<[f64; 2]>, f64) {
    let Task::Ripple { products, load, count } = task else { return (Vec::new(), 1.0) };
    let of_part = |[ss, sc, cc, sy, cy]: &[f64; 5]| {
        let determinant = ss * cc - sc * sc;
        if determinant <= 1e-6 * ss * cc {
            return [0.0; 2];
        }
        [(cc * sy - sc * cy) / determinant, (ss * cy - sc * sy) / determinant]
    };
    let load = load / (*count).max(1) as f64;
    (products.iter().map(of_part).collect(), if load > 0.0 { load } else { 1.0 })
}
