//! The nonlinear robot with friction, driven by motor torque held over each sample.

use crate::{Robot, Workspace};

/// A simulated motion, sample by sample; row k belongs to time k · `sample_time`.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Time between rows \[s\].
    pub sample_time: f64,
    /// Positions \[rad\], one row a sample, one entry a joint.
    pub q: Vec<Vec<f64>>,
    /// Velocities \[rad/s\], likewise.
    pub qd: Vec<Vec<f64>>,
}

/// Classical Runge-Kutta integration of a robot with friction; reused, it does not allocate.
///
/// The dynamics is (4) with (5): M_m q̈ = tau_m - tau_c(g(q), q̇) - tau_v(q̇) - c - g. Friction jumps where a joint turns
/// and is 0 at rest: the integrator has no stiction, a joint that would stick chatters about zero velocity with an
/// amplitude of Coulomb torque times substep over inertia.
#[derive(Clone, Debug)]
pub struct Simulator<'a> {
    robot: &'a Robot,
    ws: Workspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    torque: Vec<f64>,
    stage: [Vec<f64>; 2],
    /// Velocity and acceleration of the stage, and their weighted sums.
    slope: [Vec<f64>; 2],
    sum: [Vec<f64>; 2],
}

impl Robot {
    /// Simulates from q0 \[rad\], qd0 \[rad/s\] under motor torques \[N m\] on the link's side, row k held from sample k
    /// to k + 1, with `substeps` Runge-Kutta steps a sample. The trajectory has one row more than `tau_motor`.
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
        let mut simulator = Simulator::new(self);
        let (mut q, mut qd) = (q0.to_vec(), qd0.to_vec());
        let mut trajectory = Trajectory { sample_time, q: vec![q.clone()], qd: vec![qd.clone()] };
        for tau in tau_motor {
            simulator.advance(&mut q, &mut qd, tau, sample_time, substeps);
            trajectory.q.push(q.clone());
            trajectory.qd.push(qd.clone());
        }
        trajectory
    }
}

impl<'a> Simulator<'a> {
    /// A simulator of one robot.
    pub fn new(robot: &'a Robot) -> Self {
        let zeros = || vec![0.0; robot.joint_count()];
        Self {
            robot,
            ws: Workspace::new(robot),
            sin: zeros(),
            cos: zeros(),
            torque: zeros(),
            stage: [zeros(), zeros()],
            slope: [zeros(), zeros()],
            sum: [zeros(), zeros()],
        }
    }

    /// Advances q \[rad\] and q̇ \[rad/s\] by `duration` \[s\] under a constant motor torque \[N m\], in equal substeps.
    pub fn advance(
        &mut self,
        q: &mut [f64],
        qd: &mut [f64],
        tau_motor: &[f64],
        duration: f64,
        substeps: usize,
    ) {
        for _ in 0..substeps {
            self.step(q, qd, tau_motor, duration / substeps as f64);
        }
    }

    fn step(&mut self, q: &mut [f64], qd: &mut [f64], tau_motor: &[f64], h: f64) {
        self.sum.iter_mut().for_each(|s| s.fill(0.0));
        self.slope.iter_mut().for_each(|s| s.fill(0.0));
        // Where each stage stands, and its weight.
        for (reach, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            add_scaled(&mut self.stage[0], q, reach * h, &self.slope[0]);
            add_scaled(&mut self.stage[1], qd, reach * h, &self.slope[1]);
            self.slope_at_stage(tau_motor);
            for (sum, slope) in self.sum.iter_mut().zip(&self.slope) {
                sum.iter_mut().zip(slope).for_each(|(a, b)| *a += weight * b);
            }
        }
        q.iter_mut().zip(&self.sum[0]).for_each(|(x, s)| *x += h / 6.0 * s);
        qd.iter_mut().zip(&self.sum[1]).for_each(|(x, s)| *x += h / 6.0 * s);
    }

    fn slope_at_stage(&mut self, tau_motor: &[f64]) {
        let [q, qd] = &self.stage;
        for ((sin, cos), q) in self.sin.iter_mut().zip(&mut self.cos).zip(q) {
            (*sin, *cos) = q.sin_cos();
        }
        let [velocity, acceleration] = &mut self.slope;
        velocity.copy_from_slice(qd);
        self.robot.gravity(&self.sin, &self.cos, &mut self.ws, &mut self.torque);
        for (i, joint) in self.robot.joints().iter().enumerate() {
            let friction = &joint.friction;
            let lost = friction.coulomb.torque(self.torque[i], qd[i]) + friction.viscous.torque(&qd[i]);
            self.torque[i] = tau_motor[i] - lost;
        }
        self.robot.forward_dynamics(&self.sin, &self.cos, qd, &self.torque, &mut self.ws, acceleration);
    }
}

/// out = x + k y.
fn add_scaled(out: &mut [f64], x: &[f64], k: f64, y: &[f64]) {
    out.iter_mut().zip(x.iter().zip(y)).for_each(|(o, (x, y))| *o = x + k * y);
}
