//! Whether U covers the dry friction of parts that may come to rest.
//!
//! The input of a model is free of dry friction: it was taken off the motor torque at recorded
//! states. At zero velocity friction is a set of torques, from the limit of backward motion to the
//! limit of forward motion. Another motion under the same motor torque may stick where the recorded
//! one moved, so that U must cover the difference there.

use reachtube_scalar::Interval;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::problem::Problem;
use crate::data::setup::DryFriction;
use crate::reach::SuiteReach;
use crate::sets::UncertaintySets;

/// A part whose dry friction may differ between motions in a reachable set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stiction {
    /// The part, from 1.
    pub part: usize,
    /// Number of steps in which the velocity may be zero.
    pub steps: usize,
    /// Largest difference between two values of dry friction in one step \[N m; N\].
    pub torque: f64,
    /// Largest torque that U contains in both directions, or by which it was widened if the
    /// settings asked for it \[N m; N\]; 0 if there is none.
    pub room: f64,
    /// The suite or run in which the difference is the largest.
    pub case: String,
    /// Start of the step in which it is the largest, s.
    pub time: f64,
}

impl Stiction {
    /// Returns whether U covers every dry friction that is possible in one step.
    #[must_use]
    pub fn is_covered(&self) -> bool {
        self.torque <= self.room
    }
}

/// Returns the parts whose dry friction may differ between motions in a step of these reachable
/// sets, from base to tip; none for link torques, which friction is no part of. `allowance` has the
/// radii that were added to X0 and U, 3n, or none.
///
/// # Guarantee
///
/// Outer, directed rounding, for the robot's constants as loaded: dry friction is taken off the
/// recorded torque at a state of a step, in the reachable set widened by V, or at the nominal one.
/// For every other state of the same step, whose friction is any that is possible there, both
/// values differ by at most `torque`. A part is covered if U contains this difference; after
/// [`Settings::stiction`](crate::Settings::stiction), if U contains it beside any input of the set
/// before. A disturbance that is held over each sample covers friction as far as friction is held
/// over it, and a constant one covers nothing. The law of warming is not part of it.
#[must_use]
pub fn stiction(
    problem: &Problem,
    sets: &UncertaintySets,
    allowance: &[f64],
    reached: &[SuiteReach],
) -> Vec<Stiction> {
    let Some(friction) = problem.setup().drive.dry_friction() else { return Vec::new() };
    let allowance = problem.settings().stiction.then_some(allowance);
    let mut search = Search::new(friction, sets, allowance);
    for reach in reached {
        for k in 0..reach.tube.len() {
            search.step(reach, k);
        }
    }
    search.found.into_iter().flatten().collect()
}

/// Dry friction over boxes of states.
struct Search<'a> {
    friction: Box<dyn DryFriction + 'a>,
    noise: Vec<Interval>,
    room: Vec<f64>,
    states: Vec<Interval>,
    found: Vec<Option<Stiction>>,
}

impl<'a> Search<'a> {
    fn new(
        friction: Box<dyn DryFriction + 'a>,
        sets: &UncertaintySets,
        allowance: Option<&[f64]>,
    ) -> Self {
        let (states, inputs) = (sets.initial_set.dimension(), sets.input_set.dimension());
        let room = |j: usize| {
            let [centre, radius] = [sets.input_set.centre[j].abs(), sets.input_set.radius[j]];
            match allowance {
                Some(allowance) => allowance.get(states + j).copied().unwrap_or(0.0),
                None => (Interval::point(radius) - Interval::point(centre)).lo().max(0.0),
            }
        };
        let noise = |i: usize| {
            let radius = sets.noise_radius(i);
            Interval::point(-radius).hull(Interval::point(radius))
        };
        Self {
            friction,
            noise: (0..states).map(noise).collect(),
            room: (0..inputs).map(room).collect(),
            states: vec![Interval::ZERO; states],
            found: vec![None; inputs],
        }
    }

    fn step(&mut self, reach: &SuiteReach, k: usize) {
        let nominal = &reach.nominal[k * self.states.len()..];
        for (i, state) in self.states.iter_mut().enumerate() {
            let reached = reach.tube.bounds(k)[i] + self.noise[i];
            *state = reached.hull(Interval::point(nominal[i]));
        }
        let Self { friction, room, states, found, .. } = self;
        friction.spread(states, &mut |j, torque, may_rest| {
            let steps = found[j].as_ref().map_or(0, |known| known.steps) + usize::from(may_rest);
            match &mut found[j] {
                Some(known) if known.torque >= torque => known.steps = steps,
                found => {
                    let (room, time) = (room[j], reach.times[k]);
                    let case = reach.name();
                    *found = Some(Stiction { part: j + 1, steps, torque, room, case, time });
                }
            }
        });
    }
}
