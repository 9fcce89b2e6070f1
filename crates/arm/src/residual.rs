//! The torque that a motion does not account for, sample by sample, without allocation.

use reachtube_conform::data::{Residual, Torques};
use reachtube_conform::{Error, Result};
use reachtube_recordings::{Sample, Torque};
use reachtube_robot::{Robot, Workspace};

use crate::corrector::only_payload;

/// Half the time over which accelerations are taken, s: a push of 50 ms shows whole.
const HALF: f64 = 0.025;

/// What a row of the ring holds of each joint: position, input, its part by the ripple's sine and
/// cosine, sin q, cos q and gravity torque.
const ROW: usize = 7;

/// Computes the input minus what the robot's equations of motion need for the measured motion.
///
/// Accelerations are second differences of positions, so that neither the noise nor the filter of
/// measured velocities enters. The input is averaged with the weights of that difference.
#[derive(Debug)]
pub(super) struct ArmResidual {
    robot: Robot,
    /// A robot that only has a mass of 1 kg at its tip.
    unit_payload: Robot,
    workspace: Workspace<f64>,
    /// Reciprocal period of the motor's angle over the joint's, n; 0 if no ripple is expected.
    ratios: Vec<f64>,
    step: f64,
    /// Steps of half the time of the difference.
    half: usize,
    /// The last samples, of which `newest` is the last.
    ring: Vec<f64>,
    newest: usize,
    count: usize,
    qdd: Vec<f64>,
    torques: Torques,
}

impl ArmResidual {
    /// Prepares a robot's residual.
    ///
    /// # Errors
    ///
    /// When no robot can be made with a payload only.
    pub(super) fn new(robot: &Robot, torque: Torque, step: f64) -> Result<Self> {
        let n = robot.joint_count();
        let zeros = || vec![0.0; n];
        let half = (HALF / step).round().max(1.0) as usize;
        // Sensors behind the gear measure the ripple itself.
        let ratio = |ratio: Option<f64>| ratio.filter(|_| torque != Torque::Link).unwrap_or(0.0);
        Ok(Self {
            robot: robot.clone(),
            unit_payload: Robot::from_description(&only_payload(robot.description()))
                .map_err(Error::other)?,
            workspace: Workspace::new(robot),
            ratios: robot.joints().iter().map(|joint| ratio(joint.gear_ratio)).collect(),
            step,
            half,
            ring: vec![0.0; (2 * half + 1) * ROW * n],
            newest: 0,
            count: 0,
            qdd: zeros(),
            torques: Torques {
                speed: zeros(),
                torque: zeros(),
                ripple: [zeros(), zeros()],
                weight: zeros(),
            },
        })
    }

    /// Returns a part of the row of the sample `age` steps before the newest one.
    fn part(&self, age: usize, part: usize) -> &[f64] {
        let (n, length) = (self.ratios.len(), 2 * self.half + 1);
        let begin = ((self.newest + length - age) % length * ROW + part) * n;
        &self.ring[begin..begin + n]
    }

    fn evaluate(&mut self, n: usize) {
        let (m, span) = (self.half, self.half as f64 * self.step);
        for j in 0..n {
            let [new, middle, old] = [0, m, 2 * m].map(|age| self.part(age, 0)[j]);
            self.torques.speed[j] = (new - old) / (2.0 * span);
            self.qdd[j] = (new - 2.0 * middle + old) / (span * span);
        }
        let Torques { mut torque, mut ripple, speed, weight } = std::mem::take(&mut self.torques);
        torque.fill(0.0);
        ripple.iter_mut().for_each(|part| part.fill(0.0));
        let square = (m * m) as f64;
        for age in 0..=2 * m {
            // The input of a sample acts until the next one.
            let held = (age as f64 - 0.5).min((2 * m - age) as f64 + 0.5).max(0.0) / square;
            let here = age.min(2 * m - age) as f64 / square;
            let [input, sine, cosine] = [1, 2, 3].map(|part| self.part(age, part));
            for j in 0..n {
                torque[j] += held * input[j];
                ripple[0][j] += here * sine[j];
                ripple[1][j] += here * cosine[j];
            }
        }
        self.torques = Torques { speed, torque, ripple, weight };
        let begin = (self.newest + 2 * m + 1 - m) % (2 * m + 1) * ROW * n;
        let part = |part: usize| &self.ring[begin + part * n..begin + (part + 1) * n];
        let [sin, cos, gravity] = [4, 5, 6].map(part);
        let Self { robot, unit_payload, workspace, torques, qdd, .. } = self;
        let Torques { speed, torque, weight, .. } = torques;
        // Newton-Euler into the buffer of the weight, which is computed last.
        robot.rnea(sin, cos, speed, qdd, workspace, weight);
        for (j, joint) in robot.joints().iter().enumerate() {
            torque[j] -= weight[j] - gravity[j] + joint.friction.viscous.torque(&speed[j]);
        }
        unit_payload.gravity(sin, cos, workspace, weight);
    }
}

impl Residual for ArmResidual {
    fn clear(&mut self) {
        self.count = 0;
    }

    fn take(&mut self, sample: &Sample, u: &[f64]) -> bool {
        let (n, length) = (u.len(), 2 * self.half + 1);
        self.newest = (self.newest + 1) % length;
        self.count += 1;
        let begin = self.newest * ROW * n;
        let row = &mut self.ring[begin..begin + ROW * n];
        let mut parts = row.chunks_exact_mut(n);
        let [Some(q), Some(input), Some(sine), Some(cosine), Some(sin), Some(cos), Some(gravity)] =
            std::array::from_fn::<_, ROW, _>(|_| parts.next())
        else {
            return false;
        };
        let (measured, qd) = sample.state().split_at(n);
        q.copy_from_slice(measured);
        input.copy_from_slice(u);
        for (j, joint) in self.robot.joints().iter().enumerate() {
            (sin[j], cos[j]) = joint.kind.sin_cos(&q[j]);
        }
        self.robot.gravity(sin, cos, &mut self.workspace, gravity);
        for (j, joint) in self.robot.joints().iter().enumerate() {
            let motor = u[j] + gravity[j] + joint.friction.dry_torque(gravity[j], qd[j]);
            let (s, c) = (self.ratios[j] * q[j]).sin_cos();
            let motor = if self.ratios[j] == 0.0 { 0.0 } else { motor };
            (sine[j], cosine[j]) = (motor * s, motor * c);
        }
        if self.count < length {
            return false;
        }
        self.evaluate(n);
        true
    }

    fn torques(&self) -> &Torques {
        &self.torques
    }
}
