//! The virtual robot, driven open loop.

use reachtube_ode::RungeKutta4;
use reachtube_robot::{DrivenBy, Robot, RobotField, Workspace};

use super::SAMPLE_TIME;
use super::hidden::{
    self, COMPENSATION_SPEED, COULOMB_PER_KELVIN, ENCODER_STEP, LINK_SHARE, RIPPLE_SHARE,
    STICKING_SPEED, VELOCITY_FILTER, friction_share,
};
use super::number::rounded;
use crate::error::Result;

/// Controller cycles a sample. Friction is held over a cycle: near rest it acts as a damping of
/// about 400 1/s on a joint, which a cycle of a millisecond follows without chatter.
const CYCLES: usize = 4;

/// The virtual robot at one temperature.
pub(super) struct Drive<'a> {
    nominal: &'a Robot,
    body: Robot,
    /// Coulomb friction of each joint over the nominal one.
    coulomb_share: Vec<f64>,
}

/// What the torque of a cycle is computed in, n each.
struct Scratch {
    ws: Workspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    gravity: Vec<f64>,
    torque: Vec<f64>,
}

impl<'a> Drive<'a> {
    /// The virtual robot behind `nominal` with its joints at `temperatures`, °C.
    pub fn new(nominal: &'a Robot, temperatures: &[f64]) -> Result<Self> {
        let coulomb_share =
            temperatures.iter().map(|t| friction_share(*t, COULOMB_PER_KELVIN)).collect();
        Ok(Self { nominal, body: hidden::body(nominal, temperatures)?, coulomb_share })
    }

    /// Drives the robot from q (rad) and q̇ (rad/s) by `inputs` (N m, row-major K x n), each held
    /// for a sample; the last one acts on nothing. Returns what is measured: (q, q̇), row-major K x
    /// 2n.
    pub fn run(&self, q: Vec<f64>, qd: Vec<f64>, inputs: &[f64]) -> Vec<f64> {
        let n = q.len();
        let mut field = RobotField::new(&self.body, DrivenBy::Motor);
        let mut method = RungeKutta4::new(2 * n);
        let mut scratch = Scratch::new(self.nominal);
        let mut sensors = Sensors::new(&q, &qd);
        let mut states = Vec::with_capacity(2 * inputs.len());
        let mut x = [q, qd].concat();
        for input in inputs.chunks_exact(n) {
            sensors.record(&x[..n], &mut states);
            for _ in 0..CYCLES {
                self.joint_torque(&x[..n], &x[n..], input, &mut scratch);
                method.step(&mut field, 0.0, SAMPLE_TIME / CYCLES as f64, &mut x, &scratch.torque);
            }
        }
        states
    }

    /// Motor torque by (11), with gravity and Coulomb friction of the nominal model added and with
    /// ripple, less the robot's own Coulomb friction.
    fn joint_torque(&self, q: &[f64], qd: &[f64], input: &[f64], scratch: &mut Scratch) {
        let Scratch { ws, sin, cos, gravity, torque } = scratch;
        for (i, q) in q.iter().enumerate() {
            (sin[i], cos[i]) = q.sin_cos();
        }
        self.nominal.gravity(sin, cos, ws, gravity);
        for (i, joint) in self.nominal.joints().iter().enumerate() {
            let coulomb = |load: f64, speed: f64| {
                joint.friction.coulomb.torque(load, qd[i]) * (qd[i].abs() / speed).tanh()
            };
            let ripple = RIPPLE_SHARE * joint.gear_ratio.map_or(0.0, |ratio| (ratio * q[i]).sin());
            let motor =
                (input[i] + gravity[i] + coulomb(gravity[i], COMPENSATION_SPEED)) * (1.0 + ripple);
            torque[i] =
                motor - self.coulomb_share[i] * coulomb(LINK_SHARE * gravity[i], STICKING_SPEED);
        }
    }
}

impl Scratch {
    fn new(robot: &Robot) -> Self {
        let zeros = || vec![0.0; robot.joint_count()];
        Self {
            ws: Workspace::new(robot),
            sin: zeros(),
            cos: zeros(),
            gravity: zeros(),
            torque: zeros(),
        }
    }
}

/// Encoders, and the velocity that is computed from them.
struct Sensors {
    q: Vec<f64>,
    qd: Vec<f64>,
}

impl Sensors {
    /// Sensors that have followed the robot to its start.
    fn new(q: &[f64], qd: &[f64]) -> Self {
        let before = q.iter().zip(qd).map(|(q, qd)| encoder(q - qd * SAMPLE_TIME));
        Self { q: before.collect(), qd: qd.to_vec() }
    }

    fn record(&mut self, q: &[f64], states: &mut Vec<f64>) {
        let gain = 1.0 - (-SAMPLE_TIME / VELOCITY_FILTER).exp();
        for ((read, velocity), q) in self.q.iter_mut().zip(&mut self.qd).zip(q) {
            let before = std::mem::replace(read, encoder(*q));
            *velocity += gain * ((*read - before) / SAMPLE_TIME - *velocity);
        }
        states.extend(self.q.iter().chain(&self.qd).copied().map(rounded));
    }
}

/// The position that an encoder shows, rad.
fn encoder(q: f64) -> f64 {
    (q / ENCODER_STEP).round() * ENCODER_STEP
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLES: usize = 500;

    fn drive(temperature: f64, qd: f64, input: f64) -> Vec<f64> {
        let robot = Robot::lwa4p();
        let drive = Drive::new(&robot, &[temperature; 6]).unwrap();
        drive.run(vec![0.4; 6], vec![qd; 6], &[input; 6 * SAMPLES])
    }

    #[test]
    fn a_joint_at_rest_sticks_under_gravity() {
        let states = drive(hidden::COLD, 0.0, 0.0);
        let last = &states[states.len() - 12..];
        assert!(last[..6].iter().all(|q| (q - 0.4).abs() < 5e-3), "{last:?}");
        assert!(last[6..].iter().all(|qd| qd.abs() < 5e-3), "{last:?}");
    }

    #[test]
    fn a_moving_joint_comes_to_rest_without_chatter() {
        let states = drive(hidden::COLD, 0.3, 0.0);
        for joint in 6..12 {
            let speed: Vec<f64> = states.iter().skip(joint).step_by(12).copied().collect();
            let noise = 2.0 * ENCODER_STEP / VELOCITY_FILTER;
            assert!(
                speed[SAMPLES - 1].abs() < noise,
                "joint {} has {} rad/s",
                joint - 5,
                speed[SAMPLES - 1]
            );
            assert!(speed.iter().all(|v| *v > -noise), "joint {} turned round", joint - 5);
        }
    }

    #[test]
    fn a_warm_robot_is_faster() {
        let (cold, warm) = (drive(22.0, 0.3, 4.0), drive(42.0, 0.3, 4.0));
        assert!((0..6).all(|i| warm[warm.len() - 12 + i] > cold[cold.len() - 12 + i] + 0.01));
    }

    #[test]
    fn sensors_follow_a_ramp() {
        let (mut sensors, mut states) = (Sensors::new(&[1.0], &[0.5]), Vec::new());
        for k in 0..100 {
            sensors.record(&[1.0 + 0.5 * SAMPLE_TIME * f64::from(k)], &mut states);
        }
        for (k, state) in states.chunks_exact(2).enumerate() {
            assert!(
                (state[0] - 1.0 - 0.5 * SAMPLE_TIME * k as f64).abs() <= 0.5 * ENCODER_STEP + 1e-6
            );
            assert!((state[1] - 0.5).abs() <= ENCODER_STEP / SAMPLE_TIME);
        }
    }
}
