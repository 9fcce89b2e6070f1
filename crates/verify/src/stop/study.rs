//! Questions about the stops of a robot.

use reachtube_arm::OfArm;
use reachtube_conform::{Problem, UncertaintySets};
use reachtube_finding::Finding;
use reachtube_recordings::RunSource;
use reachtube_robot::JointKind;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Result;
use crate::stop::along::{WorstStop, stops_along};
use crate::stop::annex_b::{AnnexB, annex_b};
use crate::stop::brakes::Brakes;
use crate::stop::category::Category;
use crate::stop::delay_span::DelaySpan;
use crate::stop::findings::findings;
use crate::stop::recorded::{RecordedStop, outside, recorded_stops};

/// A question about the stops of a robot.
#[derive(Debug)]
pub struct StopQuestion<'a> {
    /// The brakes.
    pub brakes: &'a Brakes,
    /// How the robot is stopped along the motions, and was in the recorded stops.
    pub category: &'a Category,
    /// A stop begins at every sample of this number, from 1.
    pub every: usize,
    /// Whether the table of ISO 10218-1 is made.
    pub table: bool,
    /// Recorded stops, if there are any.
    pub recorded: Option<&'a dyn RunSource>,
}

/// The answer to a question about the stops of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StopStudy {
    /// The stop category, 0 or 1, along the motions and of the recorded stops.
    pub category: u8,
    /// The worst stop of each suite and joint.
    pub stops: Vec<WorstStop>,
    /// The table of ISO 10218-1, Annex B.
    pub annex_b: Option<AnnexB>,
    /// Recorded stops beside the proved ones.
    pub recorded: Vec<RecordedStop>,
    /// The findings, in the order in which they are read: the verdict first.
    pub findings: Vec<Finding>,
}

/// Encloses the stops from recorded motions, the stops of the table, and recorded stops. The error
/// of the drives' torque lies in U of `sets`.
///
/// # Guarantee
///
/// Outer, as [`Category::stop`]. Ways and times are infinite if no standstill is proved.
///
/// # Errors
///
/// The defects of a recorded stop; a robot that is not valid with its load.
pub fn stop_study(
    problem: &Problem,
    sets: &UncertaintySets,
    question: &StopQuestion,
) -> Result<StopStudy> {
    let StopQuestion { brakes, category, every, table, recorded } = *question;
    let robot = problem.robot();
    let recorded = recorded.map(|source| recorded_stops(robot, brakes, category, source));
    let recorded = recorded.transpose()?.unwrap_or_default();
    let input_set = |rates: &[f64]| problem.input_set_at(sets, rates);
    let annex_b = table.then(|| annex_b(robot, brakes, &input_set)).transpose()?;
    let along = |brakes: &Brakes| stops_along(problem, brakes, category, every);
    let stops = along(brakes)?;
    let span = DelaySpan::new(&stops, brakes, along)?;
    let unit = JointKind::column(&robot.kinds(), JointKind::position_unit).any();
    let findings = findings((&stops, &span), annex_b.as_ref(), &recorded, &unit);
    Ok(StopStudy { category: category.number(), stops, annex_b, recorded, findings })
}

impl StopStudy {
    /// Returns whether a standstill is proved from each sample.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.stops.iter().all(|worst| worst.proved == worst.samples && worst.samples > 0)
    }

    /// Returns the recorded stop that is furthest beyond the proved one; `None` if all are within.
    #[must_use]
    pub fn outside(&self) -> Option<&RecordedStop> {
        outside(&self.recorded)
    }
}
