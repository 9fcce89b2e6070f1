use reachtube_conform::Model;
use reachtube_conform::monitor::{Leave, Monitor, Schedule};
use reachtube_identify::prepare::{LiveLog, VelocitySource};
use reachtube_recordings::SampleError;
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
        let monitor = Monitor::new(model, schedule)?;
        let log = match &model.preparation {
            None => None,
            Some(known) => {
                let robot = Robot::from_description(&model.robot)?;
                Some(LiveLog::new(&robot, known, velocity, step, longest_gap)?)
            }
        };
        let leaves = Vec::with_capacity(KEPT * 2 * model.joints());
        Ok(Self { log, monitor, leaves })
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
        let Self { log, monitor, leaves } = self;
        let Some(log) = log else { return monitor.push(time, q, qd, torque) };
        log.take(time, [q, qd, torque])?;
        leaves.clear();
        while let Some(sample) = log.next() {
            let n = q.len();
            let (state, torque) = (sample.state(), sample.torque());
            let left = monitor.push(sample.time, &state[..n], &state[n..], torque)?;
            let room = leaves.capacity() - leaves.len();
            leaves.extend_from_slice(&left[..left.len().min(room)]);
        }
        Ok(leaves)
    }

    /// Ends a recording, as [`Monitor::finish`].
    pub fn finish(&mut self) -> &[Leave] {
        self.log.iter_mut().for_each(LiveLog::clear);
        self.monitor.finish()
    }

    /// Returns what was found so far.
    #[must_use]
    pub fn found(&self) -> &Monitor {
        &self.monitor
    }

    /// Returns the time by which answers are late, s.
    #[must_use]
    pub fn delay(&self) -> f64 {
        self.log.as_ref().map_or(0.0, LiveLog::delay) + self.monitor.delay()
    }
}
