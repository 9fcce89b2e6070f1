//! The virtual robot, driven open loop.

use reachtube_ode::RungeKutta4;
use reachtube_robot::{DrivenBy, Robot, RobotField, Workspace};

use super::sensors::Sensors;
use super::unmodelled::{
    COMPENSATION_SPEED, COULOMB_PER_KELVIN, LINK_RATIO, RIPPLE_RATIO, STICKING_SPEED,
    STRIBECK_RATIO, STRIBECK_SPEED, body, friction_ratio,
};
use crate::error::Result;
use crate::motion::SAMPLE_TIME;

/// Controller cycles per sample. Friction is held over a cycle: near rest it acts as a damping of
/// about 400 1/s on a joint, which a cycle of 1 ms follows without chatter.
const CYCLES_PER_SAMPLE: usize = 4;

/// The virtual robot at one temperature.
pub(super) struct VirtualRobot<'a> {
    nominal: &'a Robot,
    body: Robot,
    /// Coulomb friction of each joint over the nominal one \[-\].
    coulomb_ratio: Vec<f64>,
    /// Rise of dry friction toward standstill over Coulomb friction \[-\].
    stribeck_ratio: f64,
}

/// The memory in which the torque of a cycle is computed, n each.
struct Scratch {
    ws: Workspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    /// Gravity of the nominal robot \[N m\].
    gravity: Vec<f64>,
    /// Torque on the joints \[N m\].
    torque: Vec<f64>,
}

impl<'a> VirtualRobot<'a> {
    /// Returns the virtual robot with the nominal model `nominal` and its joints at `temperatures`
    /// \[°C\].
    pub fn new(nominal: &'a Robot, temperatures: &[f64]) -> Result<Self> {
        let ratio = |temperature: &f64| friction_ratio(*temperature, COULOMB_PER_KELVIN);
        let coulomb_ratio = temperatures.iter().map(ratio).collect();
        let body = body(nominal, temperatures)?;
        Ok(Self { nominal, body, coulomb_ratio, stribeck_ratio: 0.0 })
    }

    /// Returns the robot whose dry friction rises toward standstill.
    pub fn with_stribeck(self) -> Self {
        Self { stribeck_ratio: STRIBECK_RATIO, ..self }
    }

    /// Drives the robot from q \[rad\] and q̇ \[rad/s\] by `inputs` \[N m\], row-major K x n, each
    /// held over a sample. Returns the measured (q, q̇), row-major K x 2n; the last input has no
    /// effect on them.
    pub fn run(&self, q: Vec<f64>, qd: Vec<f64>, inputs: &[f64]) -> Vec<f64> {
        let n = q.len();
        let mut field = RobotField::new(&self.body, DrivenBy::Motor);
        let mut method = RungeKutta4::new(2 * n);
        let mut scratch = Scratch::new(self.nominal);
        let mut sensors = Sensors::new(&q, &qd);
        let mut states = Vec::with_capacity(2 * inputs.len());
        let mut x = [q, qd].concat();
        let cycle = SAMPLE_TIME / CYCLES_PER_SAMPLE as f64;
        for input in inputs.chunks_exact(n) {
            sensors.record(&x[..n], &mut states);
            for _ in 0..CYCLES_PER_SAMPLE {
                self.joint_torque(&x[..n], &x[n..], input, &mut scratch);
                method.step(&mut field, 0.0, cycle, &mut x, &scratch.torque);
            }
        }
        states
    }

    /// Computes the torque on the joints: the motor torque by (11) minus the robot's own Coulomb
    /// friction. The motor torque is the input plus gravity and Coulomb friction of the nominal
    /// model, with ripple.
    fn joint_torque(&self, q: &[f64], qd: &[f64], input: &[f64], scratch: &mut Scratch) {
        let Scratch { ws, sin, cos, gravity, torque } = scratch;
        for (i, q) in q.iter().enumerate() {
            (sin[i], cos[i]) = q.sin_cos();
        }
        self.nominal.gravity(sin, cos, ws, gravity);
        for (i, joint) in self.nominal.joints().iter().enumerate() {
            let coulomb = |load: f64, speed: f64| {
                joint.friction.dry_torque(load, qd[i]) * (qd[i].abs() / speed).tanh()
            };
            let ripple = RIPPLE_RATIO * joint.gear_ratio.map_or(0.0, |ratio| (ratio * q[i]).sin());
            let motor =
                (input[i] + gravity[i] + coulomb(gravity[i], COMPENSATION_SPEED)) * (1.0 + ripple);
            let mut own = self.coulomb_ratio[i] * coulomb(LINK_RATIO * gravity[i], STICKING_SPEED);
            if self.stribeck_ratio > 0.0 {
                own *= 1.0 + self.stribeck_ratio * (-(qd[i] / STRIBECK_SPEED).powi(2)).exp();
            }
            torque[i] = motor - own;
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

#[cfg(test)]
mod tests {
    use super::super::unmodelled::{
        COLD_TEMPERATURE, ENCODER_STEP, NOMINAL_TEMPERATURE, VELOCITY_FILTER_TIME,
    };
    use super::*;

    const SAMPLES: usize = 500;

    fn drive(temperature: f64, qd: f64, input: f64) -> Vec<f64> {
        let robot = Robot::lwa4p();
        let robot = VirtualRobot::new(&robot, &[temperature; 6]).unwrap();
        robot.run(vec![0.4; 6], vec![qd; 6], &[input; 6 * SAMPLES])
    }

    #[test]
    fn a_joint_at_rest_sticks_under_gravity() {
        let states = drive(COLD_TEMPERATURE, 0.0, 0.0);
        let last = &states[states.len() - 12..];
        assert!(last[..6].iter().all(|q| (q - 0.4).abs() < 5e-3), "{last:?}");
        assert!(last[6..].iter().all(|qd| qd.abs() < 5e-3), "{last:?}");
    }

    #[test]
    fn a_moving_joint_comes_to_rest_without_chatter() {
        let states = drive(COLD_TEMPERATURE, 0.3, 0.0);
        for joint in 6..12 {
            let speed: Vec<f64> = states.iter().skip(joint).step_by(12).copied().collect();
            let noise = 2.0 * ENCODER_STEP / VELOCITY_FILTER_TIME;
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
    fn a_slow_robot_with_the_stribeck_effect_stops_earlier() {
        let nominal = Robot::lwa4p();
        let robot = || VirtualRobot::new(&nominal, &[NOMINAL_TEMPERATURE; 6]).unwrap();
        let drive = |robot: VirtualRobot, qd: f64| {
            robot.run(vec![0.4; 6], vec![qd; 6], &[0.0; 6 * SAMPLES])
        };
        let way = |states: &[f64], joint: usize| states[states.len() - 12 + joint] - 0.4;
        let (plain, rising) = (drive(robot(), 0.05), drive(robot().with_stribeck(), 0.05));
        // Joint 6 hardly moves the others.
        assert!(way(&rising, 5) < 0.95 * way(&plain, 5), "{} {}", way(&rising, 5), way(&plain, 5));
        // Far above the Stribeck speed nothing changes.
        let torque = |robot: VirtualRobot| {
            let mut scratch = Scratch::new(&nominal);
            robot.joint_torque(&[0.4; 6], &[1.0; 6], &[1.0; 6], &mut scratch);
            scratch.torque
        };
        assert_eq!(torque(robot()), torque(robot().with_stribeck()));
    }

    #[test]
    fn a_warm_robot_is_faster() {
        let (cold, warm) = (drive(22.0, 0.3, 4.0), drive(42.0, 0.3, 4.0));
        assert!((0..6).all(|i| warm[warm.len() - 12 + i] > cold[cold.len() - 12 + i] + 0.01));
    }
}
