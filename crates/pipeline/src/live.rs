use reachtube_arm::ArmModel;
use reachtube_conform::monitor::{Alarm, HealthyMotion, Leave, Monitor, Schedule};
use reachtube_conform::{Error as ConformError, Model};
use reachtube_identify::prepare::{LiveLog, VelocitySource};
use reachtube_recordings::{MemoryRuns, ReadOptions, Run, RunSource, SampleError};
use reachtube_robot::Robot;

use crate::error::Result;

/// Leaves that are kept for one sample, for each state of the model.
const KEPT: usize = 64;

/// A [`Monitor`] of samples as the logs of a model hold them: prepared as its recordings were
/// ([`LiveLog`]) before they are compared with its sets.
#[derive(Debug)]
pub struct LiveMonitor {
    log: Option<LiveLog>,
    monitor: Monitor,
    leaves: Vec<Leave>,
    alarms: Vec<Alarm>,
}

impl LiveMonitor {
    /// Makes the monitor of a model. Recordings choose between recorded and differentiated
    /// velocities by their noise; here `velocity` does.
    ///
    /// # Errors
    ///
    /// As [`Monitor::new`] and [`LiveLog::new`].
    pub fn new(model: &Model, schedule: Schedule, velocity: VelocitySource) -> Result<Self> {
        let Schedule { step, longest_gap, .. } = schedule;
        let monitor = Monitor::new(model, model.setup()?, schedule)?;
        let log = match &model.preparation {
            None => None,
            Some(known) => {
                let robot = Robot::from_description(&model.robot())?;
                Some(LiveLog::new(&robot, known, velocity, step, longest_gap)?)
            }
        };
        let leaves = Vec::with_capacity(KEPT * 2 * model.inputs());
        let alarms = Vec::with_capacity(KEPT * (2 * model.inputs() + 1));
        Ok(Self { log, monitor, leaves, alarms })
    }

    /// Learns what healthy motion is from recordings as the logs of a model hold them.
    ///
    /// # Errors
    ///
    /// As [`HealthyMotion::learn`] and [`LiveLog::new`].
    pub fn learn(
        model: &Model,
        schedule: Schedule,
        velocity: VelocitySource,
        runs: &dyn RunSource,
    ) -> Result<HealthyMotion> {
        let Some(known) = &model.preparation else {
            return Ok(HealthyMotion::learn(model, model.setup()?, schedule, runs)?);
        };
        let Schedule { step, longest_gap, .. } = schedule;
        let robot = Robot::from_description(&model.robot())?;
        let mut log = LiveLog::new(&robot, known, velocity, step, longest_gap)?;
        let mut prepared = MemoryRuns::default();
        for index in 0..runs.runs().len() {
            let name = runs.run_name(index).display().to_string();
            let wrong = |problem: String| ConformError::Healthy { name: name.clone(), problem };
            let options = ReadOptions::of(model.inputs());
            let run = runs.read(index, &options).map_err(|defects| {
                let problem = defects.first().map(ToString::to_string);
                wrong(problem.unwrap_or_else(|| "it cannot be read".into()))
            })?;
            let run = live_run(&mut log, &run).map_err(&wrong)?;
            prepared.push(&name, None, None, run);
        }
        Ok(HealthyMotion::learn(model, model.setup()?, schedule, &prepared)?)
    }

    /// Compares motion with healthy motion, too, as [`Monitor::watch`] does.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn watch(&mut self, healthy: &HealthyMotion) -> Result<()> {
        Ok(self.monitor.watch(healthy)?)
    }

    /// Returns what the samples that were pushed last show to be unlike healthy motion.
    #[must_use]
    pub fn alarms(&self) -> &[Alarm] {
        if self.log.is_none() { self.monitor.alarms() } else { &self.alarms }
    }

    /// Takes a sample as [`Monitor::push`] does: time \[s\], positions, velocities and torques as
    /// recorded.
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
        let Self { log, monitor, leaves, alarms, .. } = self;
        let Some(log) = log else { return monitor.push(time, q, qd, torque) };
        log.take(time, [q, qd, torque])?;
        leaves.clear();
        alarms.clear();
        let n = q.len();
        while let Some((sample, told)) = log.next() {
            monitor.tell(told);
            let (state, torque) = (sample.state(), sample.torque());
            let left = monitor.push(sample.time, &state[..n], &state[n..], torque)?;
            let room = leaves.capacity() - leaves.len();
            leaves.extend_from_slice(&left[..left.len().min(room)]);
            let (raised, room) = (monitor.alarms(), alarms.capacity() - alarms.len());
            alarms.extend_from_slice(&raised[..raised.len().min(room)]);
        }
        Ok(leaves)
    }

    /// Ends a recording, as [`Monitor::finish`].
    pub fn finish(&mut self) {
        self.log.iter_mut().for_each(LiveLog::clear);
        self.leaves.clear();
        self.alarms.clear();
        self.monitor.finish();
    }

    /// Returns what was found so far.
    #[must_use]
    pub fn found(&self) -> &Monitor {
        &self.monitor
    }

    /// Returns the time by which answers are late, s.
    #[must_use]
    pub fn delay(&self) -> f64 {
        self.log.as_ref().map_or(0.0, LiveLog::delay)
    }
}

/// Returns a recording as a log prepares it sample by sample.
fn live_run(log: &mut LiveLog, run: &Run) -> Result<Run, String> {
    let [mut times, mut states, mut torques] = [vec![], vec![], vec![]];
    for (k, &time) in run.times.iter().enumerate() {
        let parts = [run.q(k), run.qd(k), run.torque(k)];
        log.take(time, parts).map_err(|problem| problem.to_string())?;
        while let Some((sample, _)) = log.next() {
            times.push(sample.time);
            states.extend_from_slice(sample.state());
            torques.extend_from_slice(sample.torque());
        }
    }
    let delay = log.delay();
    log.clear();
    if times.is_empty() {
        return Err(format!(
            "it lasts {:.3} s, but the filter of the model's recordings needs samples from \
             {delay:.3} s after each one and as long before it; give longer recordings",
            run.duration()
        ));
    }
    Run::new(run.joints, times, states, torques).map_err(|problem| problem.to_string())
}

#[cfg(test)]
mod tests {
    use reachtube_recordings::{Preparation, Torque};

    use super::*;

    #[test]
    fn a_recording_shorter_than_the_filter_is_refused_with_both_times() {
        let robot = Robot::lwa4p();
        let known = Preparation {
            torque: Torque::Motor,
            gains: vec![],
            cut_off: Some(5.0),
            window: None,
            differentiated: false,
            columns: Default::default(),
            log: Default::default(),
        };
        let mut log = LiveLog::new(&robot, &known, VelocitySource::Recorded, 0.01, 0.02).unwrap();
        let times = (0..21).map(|k| 0.01 * f64::from(k)).collect();
        let run = Run::new(6, times, vec![0.0; 252], vec![0.0; 126]).unwrap();
        let refused = live_run(&mut log, &run).unwrap_err();
        assert!(refused.starts_with("it lasts 0.200 s, but the filter"), "{refused}");
        assert!(refused.contains(&format!("from {:.3} s after", log.delay())), "{refused}");
    }
}
