//! Simulation of a robot with friction under motor torque, in one call.

use crate::field::{DrivenBy, RobotField};
use crate::robot::Robot;
use reachtube_ode::RungeKutta4;

/// A simulated motion at samples; row k belongs to time k · `sample_time`.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Time between rows \[s\].
    pub sample_time: f64,
    /// Positions \[rad\], one row per sample, one entry per joint.
    pub q: Vec<Vec<f64>>,
    /// Velocities \[rad/s\], one row per sample, one entry per joint.
    pub qd: Vec<Vec<f64>>,
}

impl Robot {
    /// Simulates the robot from q0 \[rad\], qd0 \[rad/s\] under motor torques on the link side
    /// \[N m\].
    ///
    /// Row k of `tau_motor` is held from sample k to k + 1, over `substeps` Runge-Kutta steps. The
    /// trajectory has one row more than `tau_motor`. [`RobotField`] offers other inputs, sample
    /// times and integrators, and many runs at once.
    ///
    /// # Examples
    ///
    /// ```
    /// let robot = reachtube_robot::Robot::lwa4p();
    /// let tau = vec![vec![0.0; 6]; 10];
    /// let motion = robot.simulate(&[0.5; 6], &[0.0; 6], &tau, 0.004, 4);
    /// assert_eq!(motion.q.len(), 11);
    /// assert!(motion.qd[10][1] != 0.0); // it falls
    /// ```
    pub fn simulate(
        &self,
        q0: &[f64],
        qd0: &[f64],
        tau_motor: &[Vec<f64>],
        sample_time: f64,
        substeps: usize,
    ) -> Trajectory {
        let mut field = RobotField::new(self, DrivenBy::Motor);
        let mut method = RungeKutta4::new(2 * self.joint_count());
        let mut x = [q0, qd0].concat();
        let mut trajectory =
            Trajectory { sample_time, q: vec![q0.to_vec()], qd: vec![qd0.to_vec()] };
        for tau in tau_motor {
            method.integrate(&mut field, [0.0, sample_time], substeps, &mut x, tau);
            let (q, qd) = x.split_at(self.joint_count());
            trajectory.q.push(q.to_vec());
            trajectory.qd.push(qd.to_vec());
        }
        trajectory
    }
}
