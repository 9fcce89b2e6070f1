//! The verdict about a motion that is stopped.

use reachtube_arm::OfArm;
use reachtube_conform::data::Case;
use reachtube_robot::Robot;

use crate::body::body::Body;
use crate::error::Result;
use crate::scene::scenario::Scene;
use crate::stop::along::Motion;
use crate::stop::path::Path;
use crate::stop::rule::StopRule;
use crate::verdict::decide::{NextStep, stop_advice};
use crate::verdict::question::Question;
use crate::verdict::stop_witness::{StopSearch, TOUCH_OF_STOP};
use crate::verdict::stops::{MotionStops, stop_from};
use crate::verdict::verification::{Answer, Verification};
use crate::verdict::witness::Approach;

impl Verification {
    /// Adds the stops of a scenario: the answer then holds for the motion up to the stop and for
    /// the stop from each sample up to `MotionStops::covered_until`, until standstill. Obstacles
    /// go on growing meanwhile.
    ///
    /// If a stop is triggered at a distance d, the sample before has each link further than d from
    /// each obstacle. So a link that moves by w until standstill, in the time T from that sample,
    /// stays more than d - w - vT away from an obstacle with the speed v. The larger of this
    /// and the distance from the obstacle as the scenario has it counts.
    ///
    /// # Guarantee
    ///
    /// Safe is proved with directed rounding, for every motion of the model and every stop by the
    /// robot's equations, as [`Category::stop`](crate::Category::stop). If a stop may begin at any
    /// sample, it may also begin at none: then a motion without a stop that touches is a witness.
    ///
    /// # Panics
    ///
    /// Panics if robot, body or brakes have another number of joints.
    #[must_use]
    pub fn with_stops(
        mut self,
        robot: &Robot,
        (body, scene): (&Body, &Scene),
        rule: &StopRule,
    ) -> Self {
        let stops = MotionStops::new(robot, (body, scene), rule, &self.reach);
        let is_clear = stops.is_clear(scene);
        self.answer = match (rule.distance, self.answer) {
            (None, Answer::Unsafe) => Answer::Unsafe,
            (None, Answer::Safe) if is_clear => Answer::Safe,
            (Some(_), _) if is_clear && self.lost.is_none() => Answer::Safe,
            _ => Answer::Undecided,
        };
        if rule.distance.is_some() {
            // The motion without a stop is not one of the scenario.
            self.closest = None;
            self.advice = self.lost.is_some().then_some(NextStep::SetLost);
        }
        self.stops = Some(stops);
        self
    }
}

impl Question<'_> {
    /// Adds the stops to the verdict about a motion, and if they leave it open, a stopped motion
    /// that comes close and what would decide.
    pub(super) fn stopped(
        &self,
        rule: &StopRule,
        (index, case): (usize, &Case),
        motion: Verification,
    ) -> Result<Verification> {
        let Self { problem, tube, body, scene, .. } = *self;
        let robot = problem.robot();
        let mut found = motion.with_stops(robot, (body, scene), rule);
        let Some(stops) = &mut found.stops else { return Ok(found) };
        if found.answer != Answer::Undecided || stops.samples == 0 || stops.is_clear(scene) {
            return Ok(found);
        }
        let sets = &*problem.sets_along(&tube.sets, case)?;
        let search = StopSearch {
            approach: Approach { problem, case, sets, body, scene },
            rule,
            path: Path::through(&found.reach.times, &Motion::of_reach(&found.reach).middle()),
        };
        if let Some(witness) = search.closest(&stops.pairs, stops.last) {
            if witness.distance < scene.clearance - TOUCH_OF_STOP {
                let from = witness.stop.as_ref().map_or(0.0, |stop| stop.from);
                let k = found.reach.times.partition_point(|time| *time < from);
                stops.worst = stop_from(robot, rule, &found.reach, k);
                (found.answer, found.advice) = (Answer::Unsafe, None);
            }
            if found.closest.as_ref().is_none_or(|known| witness.distance < known.distance) {
                found.closest = Some(witness);
            }
        }
        if found.answer == Answer::Undecided && found.advice.is_none() {
            found.advice = Some(stop_advice(self, rule, index)?);
        }
        Ok(found)
    }
}
