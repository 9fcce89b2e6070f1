//! The verdict about each motion.

use std::fmt;

use reachtube_conform::data::Case;
use reachtube_conform::tube::Lost;
use reachtube_conform::{Problem, SuiteReach, Tube, reach};
use schemars::JsonSchema;
use serde::Serialize;

use crate::body::body::Body;
use crate::error::{Error, Result};
use crate::margin::Margin;
use crate::scene::scenario::Scene;
use crate::stop::rule::StopRule;
use crate::verdict::clearance::{Clearance, clearances};
use crate::verdict::decide::{NextStep, advice, clears};
use crate::verdict::question::Question;
use crate::verdict::stops::MotionStops;
use crate::verdict::witness::{Approach, Witness};

/// A simulated motion overlaps an obstacle only if it does so by more than the error of the
/// simulation, m.
const TOUCH: f64 = 1e-6;

/// Whether the links stay clear of the obstacles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Answer {
    /// On every motion of the model each link keeps the clearance.
    Safe,
    /// No distance was proved, and no motion was found that comes too close.
    Undecided,
    /// A motion of the model comes too close.
    Unsafe,
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Safe => "safe",
            Self::Undecided => "undecided",
            Self::Unsafe => "unsafe",
        })
    }
}

/// The verdict about a suite, or about a run that has its own nominal motion.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Verification {
    /// The suite, and the run.
    pub case: String,
    /// The answer.
    pub answer: Answer,
    /// The smallest proved distance of each link from each obstacle, smallest first.
    pub clearances: Vec<Clearance>,
    /// The margin of each link about the nominal motion.
    #[serde(skip)]
    pub margins: Vec<Margin>,
    /// The simulated motion that comes closest, unless the answer is safe.
    pub closest: Option<Witness>,
    /// The changes that decide, if the answer is undecided.
    pub advice: Option<NextStep>,
    /// The stops from the samples of the motion, if the scenario has any.
    pub stops: Option<MotionStops>,
    /// The early end of the reachable set, if any.
    pub lost: Option<Lost>,
    /// The reachable set.
    #[serde(skip)]
    pub reach: SuiteReach,
}

/// Decides for each motion of a problem whether the links stay clear under the sets of `tube`; with
/// a rule for stops, also until standstill.
///
/// # Guarantee
///
/// Safe is proved with directed rounding, for every motion of the model from X0 under U and at
/// every time, and as [`Verification::with_stops`] for stops. Unsafe rests on a motion that is
/// simulated in floating point and comes closer than the clearance by more than 1e-6 m, during a
/// stop by more than 1e-4 m.
///
/// # Errors
///
/// [`Error::NoPair`] and [`Error::SingleSample`], which leave nothing to decide; as
/// [`reach()`](reach()).
pub fn verify(
    problem: &Problem,
    tube: &Tube,
    (body, scene): (&Body, &Scene),
    stops: Option<&StopRule>,
) -> Result<Vec<Verification>> {
    scene.refuse_without_pair(body)?;
    let reached = reach(problem, tube)?;
    if let Some(still) = reached.iter().find(|reach| reach.times.len() < 2 && reach.lost.is_none())
    {
        return Err(Error::SingleSample { case: still.name() });
    }
    let question = Question { problem, tube, body, scene };
    // A stop that is triggered at a distance ends each motion that would come close.
    let is_open = stops.is_none_or(|rule| rule.distance.is_none());
    let cases = problem.cases()?.iter().zip(reached).enumerate();
    let decide = |(index, (case, reach)): (usize, (&Case, SuiteReach))| {
        let motion = question.motion((index, case), reach, is_open)?;
        match stops {
            Some(rule) => question.stopped(rule, (index, case), motion),
            None => Ok(motion),
        }
    };
    cases.map(decide).collect()
}

/// Returns the answer of a motion that was found and of a proof.
pub(super) fn answered(closest: Option<&Witness>, is_proved: bool, scene: &Scene) -> Answer {
    match closest {
        Some(found) if found.distance < scene.clearance - TOUCH => Answer::Unsafe,
        _ if is_proved => Answer::Safe,
        _ => Answer::Undecided,
    }
}

impl Scene {
    /// Refuses obstacles that concern no link with a capsule.
    pub(super) fn refuse_without_pair(&self, body: &Body) -> Result<()> {
        let concerns = |joint: usize| self.obstacles.iter().any(|it| it.concerns(joint));
        match body.capsules().iter().any(|capsule| concerns(capsule.joint)) {
            true => Ok(()),
            false => Err(Error::NoPair),
        }
    }
}

impl Question<'_> {
    /// Decides about a motion without a stop. If that `is_open` and not proved to be safe, it seeks
    /// a motion that touches, and what would decide.
    fn motion(
        &self,
        (index, case): (usize, &Case),
        reach: SuiteReach,
        is_open: bool,
    ) -> Result<Verification> {
        let Self { problem, tube, body, scene } = *self;
        let mut clearances = clearances(body, scene, &reach, scene.refine);
        clearances.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let margins = body.margins(&reach);
        let lost = reach.lost.clone();
        let proved = clears(&clearances, scene);
        let closest = if proved || !is_open {
            None
        } else {
            let sets = &*problem.sets_along(&tube.sets, case)?;
            let approach = Approach { problem, case, sets, body, scene };
            let open = clearances.iter().filter(|pair| pair.distance <= scene.clearance);
            let found = open.filter_map(|pair| approach.closest(pair));
            found.min_by(|a, b| a.distance.total_cmp(&b.distance))
        };
        let answer = answered(closest.as_ref(), proved && lost.is_none(), scene);
        let advice = match (answer, &lost) {
            (Answer::Undecided, Some(_)) => Some(NextStep::SetLost),
            (Answer::Undecided, None) if is_open => Some(advice(self, index)?),
            _ => None,
        };
        let (case, stops) = (case.name.clone(), None);
        Ok(Verification { case, answer, clearances, margins, closest, advice, stops, lost, reach })
    }
}
