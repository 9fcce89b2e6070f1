//! The verdict about a motion that is stopped.

use reachtube_robot::Robot;

use crate::body::body::Body;
use crate::scene::scenario::Scene;
use crate::stop::rule::StopRule;
use crate::verdict::stops::{MotionStops, StopClearance};
use crate::verdict::verification::{Answer, Verification};

impl Verification {
    /// Adds the stops of a scenario: the answer then holds for the motion up to the stop and for
    /// the stop from each sample until standstill. Obstacles go on growing meanwhile.
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
        let keeps = |pair: &StopClearance| pair.distance > scene.clearance;
        let is_clear = stops.samples > 0 && stops.clearances.iter().all(keeps);
        self.answer = match (rule.distance, self.answer) {
            (None, Answer::Unsafe) => Answer::Unsafe,
            (None, Answer::Safe) if is_clear => Answer::Safe,
            (Some(_), _) if is_clear && self.lost.is_none() => Answer::Safe,
            _ => Answer::Undecided,
        };
        if rule.distance.is_some() {
            // The motion without a stop is not one of the scenario.
            (self.closest, self.advice) = (None, None);
        }
        self.stops = Some(stops);
        self
    }
}
