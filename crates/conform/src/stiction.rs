//! Whether U covers the dry friction of joints that may come to rest.
//!
//! The input of a model is free of dry friction: it was taken off the motor torque at recorded
//! states. At zero velocity friction is a set of torques, from the limit of backward motion to the
//! limit of forward motion. Another motion under the same motor torque may stick where the recorded
//! one moved, so that U must cover the difference there.

use reachtube_recordings::Torque;
use reachtube_robot::friction::{Friction, Viscous};
use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::Interval;

use crate::data::problem::Problem;
use crate::reach::SuiteReach;
use crate::sets::UncertaintySets;

/// A joint whose velocity may be zero in a reachable set, and its dry friction there.
#[derive(Debug, Clone, PartialEq)]
pub struct Stiction {
    /// Index of the joint, from 0.
    pub joint: usize,
    /// Number of steps in which the velocity may be zero.
    pub steps: usize,
    /// Largest difference between two values of dry friction in one of these steps \[N m; N\].
    pub torque: f64,
    /// Largest torque that U contains in both directions \[N m; N\]; 0 if there is none.
    pub room: f64,
    /// The suite or run in which the difference is the largest.
    pub case: String,
    /// Start of the step in which it is the largest, s.
    pub time: f64,
}

impl Stiction {
    /// Returns whether U covers every dry friction that is possible where the velocity may be zero.
    #[must_use]
    pub fn is_covered(&self) -> bool {
        self.torque <= self.room
    }
}

/// Returns the joints whose velocity may be zero in a step of these reachable sets, from base to
/// tip; none for link torques, which friction is no part of.
///
/// # Guarantee
///
/// Outer, directed rounding, for the robot's constants as loaded: if a joint is covered, the input
/// of every motion in the sets, with any dry friction that is possible there, lies in U around an
/// input whose dry friction was taken off at a state of the same step. A disturbance that is held
/// over steps covers friction as far as it is held over them, and a constant one covers nothing.
/// The law of warming is not part of it.
#[must_use]
pub fn stiction(
    problem: &Problem,
    sets: &UncertaintySets,
    reached: &[SuiteReach],
) -> Vec<Stiction> {
    if problem.settings().torque == Torque::Link {
        return Vec::new();
    }
    let robot = problem.robot();
    let mut search = Search::new(robot, sets);
    for reach in reached {
        for k in 0..reach.tube.len() {
            search.step(reach, k);
        }
    }
    search.found.into_iter().flatten().collect()
}

/// Dry friction over boxes of states.
struct Search<'a> {
    robot: &'a Robot,
    dry: Vec<Friction>,
    room: Vec<f64>,
    ws: Workspace<Interval>,
    load: Vec<Interval>,
    found: Vec<Option<Stiction>>,
}

impl<'a> Search<'a> {
    fn new(robot: &'a Robot, sets: &UncertaintySets) -> Self {
        let n = robot.joint_count();
        let dry = |friction: Friction| Friction { viscous: Viscous::default(), ..friction };
        let room = |j: usize| {
            let [centre, radius] = [sets.input_set.centre[j].abs(), sets.input_set.radius[j]];
            (Interval::point(radius) - Interval::point(centre)).lo().max(0.0)
        };
        Self {
            robot,
            dry: robot.joints().iter().map(|joint| dry(joint.friction)).collect(),
            room: (0..n).map(room).collect(),
            ws: Workspace::new(robot),
            load: vec![Interval::ZERO; n],
            found: vec![None; n],
        }
    }

    /// Takes in the step from sample `k` on.
    fn step(&mut self, reach: &SuiteReach, k: usize) {
        let (q, qd) = reach.tube.bounds(k).split_at(self.load.len());
        if !qd.iter().any(|velocity| velocity.contains_zero()) {
            return;
        }
        let (sin, cos) = self.robot.sin_cos(q);
        self.robot.gravity(&sin, &cos, &mut self.ws, &mut self.load);
        for (joint, velocity) in qd.iter().enumerate().filter(|(_, qd)| qd.contains_zero()) {
            let range = self.dry[joint].range_near_zero(self.load[joint], *velocity);
            let torque = range.width();
            if torque == 0.0 {
                continue;
            }
            let steps = self.found[joint].as_ref().map_or(0, |known| known.steps) + 1;
            match &mut self.found[joint] {
                Some(known) if known.torque >= torque => known.steps = steps,
                found => {
                    let (room, time) = (self.room[joint], reach.times[k]);
                    let case = reach.name();
                    *found = Some(Stiction { joint, steps, torque, room, case, time });
                }
            }
        }
    }
}
