//! What the motors' inertia takes, which needs the velocities of later samples.

use std::collections::VecDeque;

use reachtube_recordings::{Sample, Torque};
use reachtube_robot::Robot;

use crate::input::SPAN;

/// Holds samples back until the velocities after them are known, and adds J q̈ to the input from
/// torques that were measured behind the gear.
#[derive(Debug, Clone)]
pub(super) struct Delayed {
    inertia: Vec<f64>,
    step: f64,
    /// The samples around the one that is due.
    held: VecDeque<Sample>,
    /// Number of the sample that is due.
    due: u64,
    /// Number of samples that were taken.
    taken: u64,
    made: Sample,
    spare: Vec<Sample>,
}

impl Delayed {
    /// Returns `None` if the recorded torques contain the motors' inertia.
    pub(super) fn new(robot: &Robot, torque: Torque, step: f64) -> Option<Self> {
        let inertia: Vec<f64> = robot.joints().iter().map(|joint| joint.armature).collect();
        if torque != Torque::Link || inertia.iter().all(|inertia| *inertia == 0.0) {
            return None;
        }
        let n = inertia.len();
        let capacity = 2 * (SPAN / step).ceil() as usize + 4;
        let spare = (0..capacity).map(|_| Sample::zeros(n)).collect();
        let held = VecDeque::with_capacity(capacity);
        Some(Self { inertia, step, held, due: 0, taken: 0, made: Sample::zeros(n), spare })
    }

    /// Returns the time by which answers are late, s.
    pub(super) fn delay(&self) -> f64 {
        (SPAN / self.step).ceil() * self.step
    }

    /// Returns the number of samples that wait for later ones.
    pub(super) fn waiting(&self) -> usize {
        (self.taken - self.due) as usize
    }

    /// Forgets all samples.
    pub(super) fn clear(&mut self) {
        self.spare.extend(self.held.drain(..));
        (self.due, self.taken) = (0, 0);
    }

    /// Takes the next sample.
    pub(super) fn take(&mut self, sample: &Sample) {
        if let Some(mut own) = self.spare.pop().or_else(|| self.held.pop_front()) {
            own.copy(sample);
            self.held.push_back(own);
            self.taken += 1;
        }
    }

    /// Returns the sample that is due with its torques, if those after it are known or, where
    /// `is_over`, there is none.
    pub(super) fn next(&mut self, is_over: bool) -> Option<&Sample> {
        let time = |k: u64| k as f64 * self.step;
        let last = self.taken.checked_sub(1).filter(|last| self.due <= *last)?;
        let mut after = self.due;
        while after < last && time(after) < time(self.due) + SPAN {
            after += 1;
        }
        if time(after) < time(self.due) + SPAN && !is_over {
            return None;
        }
        let mut before = self.due.max(1) - 1;
        while before > 0 && time(before - 1) >= time(self.due) - SPAN {
            before -= 1;
        }
        let first = self.taken - self.held.len() as u64;
        let held = |k: u64| &self.held[(k - first) as usize];
        let (n, duration) = (self.inertia.len(), time(after) - time(before));
        self.made.copy(held(self.due));
        for (joint, inertia) in self.inertia.iter().enumerate() {
            let change = held(after).values[n + joint] - held(before).values[n + joint];
            // A single sample has no acceleration.
            self.made.added[joint] = if duration > 0.0 { inertia * change / duration } else { 0.0 };
        }
        self.due += 1;
        // Samples that no later one needs.
        while self.held.len() > 1
            && time(self.taken - self.held.len() as u64) + SPAN + self.step < time(self.due)
        {
            self.spare.extend(self.held.pop_front());
        }
        Some(&self.made)
    }
}
