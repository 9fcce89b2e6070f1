//! Plans: commands that are not sent yet.

use std::path::Path;

use reachtube_logs::LogFiles;
use reachtube_recordings::Wanted;
use reachtube_scalar::Interval;
use reachtube_scalar::number::significant;

use crate::basis::{delayed, rates};
use crate::error::{Error, Result};
use crate::model::{JointTracking, TrackingModel};
use crate::recording::{FEWEST_SAMPLES, Plan, Reading};

/// Beyond the recorded speed by no more than this part, a command counts as one like the recorded.
pub(crate) const AS_FAST: f64 = 1e-9;

impl Plan {
    /// Reads the plans at a path, a log or a folder of them, for the joints of a model.
    /// Columns of commanded positions count before others, so that a log is a plan too. The notes
    /// say how they were read.
    ///
    /// # Errors
    ///
    /// Defects of files, a path without a plan, and plans of fewer than 3 samples.
    pub fn read(
        path: &Path,
        model: &TrackingModel,
        until: Option<f64>,
    ) -> Result<(Vec<Self>, Vec<String>)> {
        let axes = model.axes();
        let reading = Reading { until, ..model.reading(&axes) };
        let logs = LogFiles::find(path)?;
        if logs.is_empty() {
            return Err(Error::NoLog { folder: path.into() });
        }
        let (mut plans, mut notes) = (Vec::new(), Vec::new());
        for log in logs {
            for (plan, logged) in reading.logged(&log, Wanted::Plan)? {
                let (file, samples) = (plan.file.clone(), plan.times.len());
                if samples < FEWEST_SAMPLES {
                    return Err(Error::Short { file, samples });
                }
                let own = logged.notes.into_iter().chain(plan.long_step(model.step));
                own.for_each(|note| {
                    if !notes.contains(&note) {
                        notes.push(note);
                    }
                });
                plans.push(plan);
            }
        }
        Ok((plans, notes))
    }

    /// Returns the plan at a part of its speed, above 0 and up to 1. Steps are divided so that they
    /// stay about as long as they were; the command in between is the cubic polynomial with the
    /// positions and speeds of both samples.
    ///
    /// # Panics
    ///
    /// Panics with fewer than 3 samples.
    #[must_use]
    pub fn slowed(&self, part: f64) -> Self {
        let (n, pieces) = (self.joints.len(), (1.0 / part).round().max(1.0) as usize);
        let last = self.times.len() - 1;
        let (mut times, mut command) = (Vec::new(), Vec::new());
        for index in 0..=last * pieces {
            let (k, s) = (index / pieces, (index % pieces) as f64 / pieces as f64);
            let step = if k < last { self.times[k + 1] - self.times[k] } else { 0.0 };
            times.push((self.times[k] + s * step) / part);
            command.extend((0..n).map(|joint| {
                let (at, speed) = (k * n + joint, |k: usize| self.rates(k, joint)[0].mid());
                if s == 0.0 {
                    return self.command[at];
                }
                let [start, end] = [self.command[at], self.command[at + n]];
                let [first, second] = [step * speed(k), step * speed(k + 1)];
                let rise = s * s * (3.0 - 2.0 * s);
                start + rise * (end - start) + s * (1.0 - s) * ((1.0 - s) * first - s * second)
            }));
        }
        Self { times, command, ..self.clone() }
    }

    /// Returns the name of the file.
    #[must_use]
    pub fn name(&self) -> String {
        self.file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Returns a note on a step that is much longer than the recorded steps.
    fn long_step(&self, usual: f64) -> Option<String> {
        let steps = self.times.windows(2).map(|pair| (pair[1] - pair[0], pair[0]));
        let (step, time) = steps.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (step > LONG * usual).then(|| {
            format!(
                "{}: the step of {} s at {time:.3} s is {:.0} times as long as the recorded steps, \
                 and the set is wide there; give the plan at the rate of the logs",
                self.file.display(),
                significant(step, 3),
                step / usual
            )
        })
    }

    /// Encloses ṙ and r̈ of a joint at sample `k`.
    pub(crate) fn rates(&self, k: usize, joint: usize) -> [Interval; 2] {
        let n = self.joints.len();
        rates(k, &self.times, |k| Interval::point(self.command[k * n + joint]))
    }
}

/// Where the joints of an arm can be that follows a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanTube {
    /// Lower bounds of the actual positions at the samples of the plan, K x n, rad.
    pub lower: Vec<f64>,
    /// Upper bounds, K x n, rad.
    pub upper: Vec<f64>,
    /// Lower and upper bounds of the velocities over the steps between samples, (K - 1) x n, rad/s.
    pub velocities: Vec<Interval>,
}

impl TrackingModel {
    /// Returns where the joints can be while the arm follows a plan: at each sample of it, and
    /// between two samples by bounds of the velocities.
    ///
    /// At a sample the bounds are the ends of the sets. Between samples the command moves with the
    /// speeds of both, and the error changes by as much as it ever did in the recordings from one
    /// sample to the next; over a step of the plan that is k times as long as theirs, k times as
    /// much.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding, for errors in the sets of the model.
    ///
    /// # Errors
    ///
    /// [`Error::Beyond`] for a plan that is faster than the recordings.
    pub fn tube(&self, plan: &Plan) -> Result<PlanTube> {
        self.refuse_beyond(plan)?;
        let (n, samples) = (self.joints.len(), plan.times.len());
        let command = delayed(&plan.times, &plan.command, self.delay);
        let plan = &Plan { command, ..plan.clone() };
        let at = |index: usize| {
            let (k, joint) = (index / n, &self.joints[index % n]);
            let rates = plan.rates(k, index % n);
            let nominal = joint.nominal(Interval::point(plan.command[index]), rates);
            let half_width = Interval::point(joint.radius)
                + rates[0].abs() * Interval::point(joint.radius_per_speed);
            nominal + Interval::centred(0.0, half_width.hi())
        };
        let sets: Vec<Interval> = (0..samples * n).map(at).collect();
        let velocity = |index: usize| {
            let (k, joint) = (index / n, index % n);
            let [here, next] = [k, k + 1].map(|k| plan.rates(k, joint)[0]);
            let duration = Interval::point(plan.times[k + 1]) - Interval::point(plan.times[k]);
            let steps = (duration.hi() / self.step - AS_LONG).ceil().max(1.0);
            let change =
                Interval::point(self.joints[joint].largest_change) * Interval::point(steps);
            here.hull(next) + Interval::centred(0.0, (change / duration).hi())
        };
        Ok(PlanTube {
            lower: sets.iter().map(|set| set.lo()).collect(),
            upper: sets.iter().map(|set| set.hi()).collect(),
            velocities: (0..(samples - 1) * n).map(velocity).collect(),
        })
    }

    /// Refuses a plan whose speeds or accelerations are beyond the recorded ones, and says how slow
    /// it has to be.
    fn refuse_beyond(&self, plan: &Plan) -> Result<()> {
        let n = self.joints.len();
        // The part of its speed that each sample allows.
        let part = |index: usize| {
            let (k, joint) = (index / n, &self.joints[index % n]);
            let [speed, acceleration] = plan.rates(k, index % n).map(|rate| rate.mid().abs());
            let JointTracking { largest_speed, largest_acceleration, .. } = *joint;
            let by = |largest: f64, value: f64| {
                if value <= largest * (1.0 + AS_FAST) { 1.0 } else { largest / value }
            };
            let parts = [by(largest_speed, speed), by(largest_acceleration, acceleration).sqrt()];
            let of = [(speed, largest_speed), (acceleration, largest_acceleration)];
            (parts[0].min(parts[1]), index, of, parts[1] < parts[0])
        };
        let worst = (0..plan.command.len()).map(part).min_by(|a, b| a.0.total_cmp(&b.0));
        match worst {
            Some((part, index, of, by_acceleration)) if part < 1.0 => {
                let (value, largest) = of[usize::from(by_acceleration)];
                let joint = &self.joints[index % n];
                Err(Error::Beyond {
                    file: plan.file.clone(),
                    joint: joint.name.clone(),
                    unit: format!("{}/s{}", joint.unit, if by_acceleration { "²" } else { "" }),
                    value,
                    largest,
                    time: plan.times[index / n],
                    part,
                })
            }
            _ => Ok(()),
        }
    }
}

/// A step of a plan that is longer than this many of the recordings is noted.
const LONG: f64 = 3.0;

/// A step of a plan counts as one of the recordings up to this part longer.
const AS_LONG: f64 = 0.5;
