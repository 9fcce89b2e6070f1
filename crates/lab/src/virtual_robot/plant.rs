//! The physics of the virtual robot between two commands of its controller.

use reachtube_robot::{Robot, Workspace};

use super::elementary::{sin, sin_cos};
use super::friction::JointFriction;
use super::parameters::VirtualRobotParameters;
use super::truth::VirtualRobot;

/// Longest step of the simulation \[s\].
const STEP: f64 = 1e-3;

/// Largest change of a velocity in the last sweep over the joints \[rad/s\].
const SWEEP_TOLERANCE: f64 = 1e-13;

/// Most sweeps over the joints in one step. Motors dominate the mass matrix of an arm with gears,
/// so some ten suffice.
const MOST_SWEEPS: usize = 200;

/// The moving arm.
pub(super) struct Plant<'a> {
    parameters: &'a VirtualRobotParameters,
    robot: &'a Robot,
    capacities: &'a [f64],
    /// Positions \[rad\], n.
    pub q: Vec<f64>,
    /// Velocities \[rad/s\], n.
    pub qd: Vec<f64>,
    /// Temperatures of the joints \[°C\], n.
    pub temperatures: Vec<f64>,
    /// Accelerations over the last step \[rad/s²\], n.
    qdd: Vec<f64>,
    friction: Vec<JointFriction>,
    /// Friction work since the temperatures were updated \[J\], n.
    work: Vec<f64>,
    scratch: Scratch,
}

/// Memory of a step, n entries each, and n² for the mass matrix.
struct Scratch {
    ws: Workspace<f64>,
    /// Positions in the middle of the step \[rad\].
    middle: Vec<f64>,
    /// Velocities in the middle of the step \[rad/s\].
    speed: Vec<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    mass: Vec<f64>,
    gravity: Vec<f64>,
    coriolis: Vec<f64>,
    /// Viscous friction \[N m\].
    viscous: Vec<f64>,
    /// Limits of dry friction \[N m\].
    limits: Vec<[f64; 2]>,
    /// Momentum after the step without dry friction \[N m s\].
    momentum: Vec<f64>,
    /// Velocities after the step \[rad/s\].
    next: Vec<f64>,
}

impl<'a> Plant<'a> {
    /// Returns the arm at rest at `q` \[rad\] with its joints at `temperatures` \[°C\].
    pub(super) fn at_rest(robot: &'a VirtualRobot, q: &[f64], temperatures: &[f64]) -> Self {
        let (truth, zeros) = (robot.truth(), vec![0.0; q.len()]);
        let friction = truth.joints().iter().map(JointFriction::new);
        let mut plant = Self {
            parameters: robot.parameters(),
            robot: truth,
            capacities: robot.capacities(),
            q: q.to_vec(),
            qd: zeros.clone(),
            temperatures: temperatures.to_vec(),
            qdd: zeros.clone(),
            friction: friction.collect(),
            work: zeros,
            scratch: Scratch::new(truth),
        };
        plant.warm_up(0.0);
        plant
    }

    pub(super) fn advance(&mut self, torque: &[f64], duration: f64) {
        let steps = (duration / STEP - 1e-9).ceil().max(0.0);
        for _ in 0..steps as usize {
            self.step(torque, duration / steps);
        }
    }

    /// Updates the temperatures \[°C\] after `duration` \[s\]: friction work heats each joint, and
    /// it cools toward the surroundings.
    pub(super) fn warm_up(&mut self, duration: f64) {
        let parameters = self.parameters;
        for (i, temperature) in self.temperatures.iter_mut().enumerate() {
            let work = std::mem::take(&mut self.work[i]);
            let heating = if work > 0.0 { work / self.capacities[i] } else { 0.0 };
            let excess = *temperature - parameters.ambient_temperature;
            *temperature += heating - excess * duration / parameters.cooling_time;
            self.friction[i].warm_to(*temperature);
        }
    }

    /// Moves the arm over one step of `h` \[s\].
    ///
    /// The midpoint rule gives M (v⁺ - v) = h (τ - c - g - τ_v - f) with all terms but f in the
    /// middle of the step. Dry friction f is a set at v⁺ = 0 and a limit of that set elsewhere, so
    /// v⁺ minimises v⁺ᵀ M v⁺ / 2 - pᵀ v⁺ + h Σ limit(v⁺) |v⁺|, with p = M v + h (τ - c - g - τ_v).
    /// Minimising over one joint after the other converges, and leaves a joint that sticks at
    /// exactly zero.
    fn step(&mut self, torque: &[f64], h: f64) {
        self.evaluate(torque, h);
        let Scratch { mass, momentum, limits, viscous, next, .. } = &mut self.scratch;
        let n = next.len();
        for (i, next) in next.iter_mut().enumerate() {
            *next = if self.qd[i] == 0.0 { 0.0 } else { self.qd[i] + h * self.qdd[i] };
        }
        let rest = |next: &[f64], i: usize| {
            let row = &mass[i * n..(i + 1) * n];
            let others = (0..n).filter(|j| *j != i).map(|j| row[j] * next[j]).sum::<f64>();
            momentum[i] - others
        };
        for _ in 0..MOST_SWEEPS {
            let mut change = 0.0f64;
            for i in 0..n {
                let [backward, forward] = limits[i];
                let free = rest(next, i);
                // What friction cannot take up moves the joint.
                let moved = (free - h * forward).max(0.0) + (free - h * backward).min(0.0);
                let velocity = moved / mass[i * n + i];
                change = change.max((velocity - next[i]).abs());
                next[i] = velocity;
            }
            if change <= SWEEP_TOLERANCE {
                break;
            }
        }
        for i in 0..n {
            let mean = 0.5 * (self.qd[i] + next[i]);
            let dry = (rest(next, i) - mass[i * n + i] * next[i]) / h;
            self.work[i] += h * ((dry + viscous[i]) * mean).max(0.0);
            self.qdd[i] = (next[i] - self.qd[i]) / h;
            self.q[i] += h * mean;
            self.qd[i] = next[i];
        }
    }

    /// Computes all terms of the step's equation.
    fn evaluate(&mut self, torque: &[f64], h: f64) {
        let Scratch {
            ws,
            middle,
            speed,
            sin: s,
            cos: c,
            mass,
            gravity,
            coriolis,
            viscous,
            limits,
            momentum,
            ..
        } = &mut self.scratch;
        let n = middle.len();
        for i in 0..n {
            middle[i] = self.q[i] + 0.5 * h * self.qd[i];
            speed[i] = self.qd[i] + 0.5 * h * self.qdd[i];
        }
        sin_cos(self.robot.joints(), middle, s, c);
        self.robot.crba(s, c, ws, mass);
        self.robot.gravity(s, c, ws, gravity);
        self.robot.coriolis(s, c, speed, ws, coriolis);
        for (i, joint) in self.robot.joints().iter().enumerate() {
            let ripple = joint.gear_ratio.map_or(0.0, |ratio| sin(ratio * middle[i]));
            let motor = torque[i] * (1.0 + self.parameters.ripple_ratio * ripple);
            limits[i] = self.friction[i].limits(gravity[i], self.qd[i].abs());
            viscous[i] = self.friction[i].viscous(speed[i]);
            let driving = motor - gravity[i] - coriolis[i] - viscous[i];
            let row = &mass[i * n..(i + 1) * n];
            let before = row.iter().zip(&self.qd).map(|(m, v)| m * v).sum::<f64>();
            momentum[i] = before + h * driving;
        }
    }
}

impl Scratch {
    fn new(robot: &Robot) -> Self {
        let n = robot.joint_count();
        let zeros = || vec![0.0; n];
        Self {
            ws: Workspace::new(robot),
            middle: zeros(),
            speed: zeros(),
            sin: zeros(),
            cos: zeros(),
            mass: vec![0.0; n * n],
            gravity: zeros(),
            coriolis: zeros(),
            viscous: zeros(),
            limits: vec![[0.0; 2]; n],
            momentum: zeros(),
            next: zeros(),
        }
    }
}
