//! The virtual robot in motion: physics, sensors and controllers together.

use super::controller::Controller;
use super::plant::Plant;
use super::recording::Recording;
use super::sensors::Sensors;
use super::truth::VirtualRobot;
use crate::motion::{Planned, SAMPLE_TIME};

/// The virtual robot in motion.
pub(crate) struct Arm<'a> {
    plant: Plant<'a>,
    sensors: Sensors,
    controller: Controller<'a>,
}

/// What a sample of a recording has as its torque.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Logged {
    /// The input u: the torque without compensated gravity and Coulomb friction.
    Input,
    /// The commanded motor torque.
    Motor,
}

impl<'a> Arm<'a> {
    /// Returns the arm at rest at `q` \[rad\], with its joints at `temperatures` \[°C\].
    pub(crate) fn at_rest(robot: &'a VirtualRobot, q: &[f64], temperatures: &[f64]) -> Self {
        Self {
            plant: Plant::at_rest(robot, q, temperatures),
            sensors: Sensors::at_rest(robot.parameters(), q),
            controller: Controller::at_rest(robot, q),
        }
    }

    pub(crate) fn temperatures(&self) -> &[f64] {
        &self.plant.temperatures
    }

    /// Follows a plan over `cycles` by computed-torque control. `plan` takes the number of the
    /// cycle, from 0. The recording has one sample per cycle, taken when it begins.
    pub(crate) fn follow(
        &mut self,
        cycles: usize,
        logged: Logged,
        plan: impl Fn(usize) -> Planned,
    ) -> Recording {
        self.record(cycles, logged, |controller, sensors, k| {
            controller.follow(&sensors.q, &sensors.qd, &plan(k));
        })
    }

    /// Applies `inputs` \[N m\] open loop, row-major cycles x n. `planned` takes the number of the
    /// cycle and returns the planned velocities \[rad/s\], n.
    pub(crate) fn open_loop(
        &mut self,
        inputs: &[f64],
        planned: impl Fn(usize) -> Vec<f64>,
    ) -> Recording {
        let n = self.plant.q.len();
        self.record(inputs.len() / n, Logged::Input, |controller, sensors, k| {
            controller.open_loop(&sensors.q, &planned(k), &inputs[k * n..(k + 1) * n]);
        })
    }

    fn record(
        &mut self,
        cycles: usize,
        logged: Logged,
        mut control: impl FnMut(&mut Controller<'a>, &Sensors, usize),
    ) -> Recording {
        let mut recording = Recording::new(self.plant.q.len(), cycles);
        for k in 0..cycles {
            control(&mut self.controller, &self.sensors, k);
            let torque = match logged {
                Logged::Input => &self.controller.input,
                Logged::Motor => self.controller.newest(),
            };
            let Sensors { q, qd, .. } = &self.sensors;
            recording.push(q, qd, torque, &self.plant.temperatures);
            self.cycle();
        }
        recording
    }

    /// Moves the arm over one cycle and measures where it is then.
    fn cycle(&mut self) {
        let ([before, after], part) = self.controller.acting();
        self.plant.advance(before, part * SAMPLE_TIME);
        self.plant.advance(after, (1.0 - part) * SAMPLE_TIME);
        self.plant.warm_up(SAMPLE_TIME);
        self.sensors.measure(&self.plant.q);
    }
}
