use crate::prepare::log::PreparedLog;
use crate::samples::Sampling;
use reachtube_robot::Robot;

/// One sample of a moving joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionSample {
    /// Velocity \[rad/s\], not 0.
    pub qd: f64,
    /// Acceleration \[rad/s²\].
    pub qdd: f64,
    /// Gravity torque \[N m\].
    pub load: f64,
    /// Recorded torque minus the gravity torque \[N m\].
    pub torque: f64,
}

impl FrictionSample {
    /// Returns the index of the motor quadrant in the order of a1 to a8: driving forward, driving
    /// backward, braking backward, braking forward.
    pub(super) fn quadrant(&self) -> usize {
        match (self.qd > 0.0, self.load > 0.0) {
            (true, true) => 0,
            (false, false) if self.load < 0.0 => 1,
            (false, _) => 2,
            (true, false) => 3,
        }
    }
}

/// Counts the samples of each quadrant, in the order of a1 to a8.
pub(super) fn quadrant_counts(samples: &[FrictionSample]) -> [usize; 4] {
    let mut counts = [0; 4];
    samples.iter().for_each(|s| counts[s.quadrant()] += 1);
    counts
}

/// Takes the samples of a log in which `joint` moves and all other joints are at rest.
pub(super) fn isolated_samples(
    robot: &Robot,
    log: &PreparedLog,
    joint: usize,
    sampling: &Sampling,
) -> Vec<FrictionSample> {
    let stride = sampling.stride(log);
    let moving = log.moving_mask(&sampling.slow, sampling.margin);
    let at_rest = |k: usize, j: usize| log.qd(k)[j].abs() < sampling.slow[j];
    let isolated = |k: &usize| {
        let own = moving[*k * log.joints + joint];
        (0..log.joints).all(|j| if j == joint { own } else { at_rest(*k, j) })
    };
    let sample = |k: usize| {
        let load = robot.gravity_torque(log.q(k))[joint];
        FrictionSample {
            qd: log.qd(k)[joint],
            qdd: log.qdd(k)[joint],
            load,
            torque: log.tau(k)[joint] - load,
        }
    };
    (0..log.len()).step_by(stride).filter(isolated).map(sample).collect()
}
