//! The claim and the plant of a problem.

use crate::claim::claim::{Claim, Rows};
use crate::claim::look::Look;
use crate::claim::points::Points;
use crate::data::notion::Notion;
use crate::data::problem::Problem;
use crate::data::settings::Settings;
use crate::error::Result;
use crate::search::optimality::{LARGEST_GAP, LARGEST_GAP_OF_POINTS};
use crate::sets::UncertaintySets;
use crate::tube::linear::Linear;
use crate::tube::plant::Plant;
use crate::tube::polynomial::Polynomial;
use crate::tube::tube::Tube;

impl Notion {
    /// Returns the relative gap above which sets are not called the smallest: cutting planes end
    /// below it.
    pub(crate) fn largest_gap(self) -> f64 {
        if self.asks_points() { LARGEST_GAP_OF_POINTS } else { LARGEST_GAP }
    }
}

impl Settings {
    /// Returns how far samples are used, to follow the word "samples"; empty if all are used.
    pub(crate) fn until_words(&self) -> String {
        self.until.map_or_else(String::new, |until| format!(" up to {until} s after the first"))
    }
}

pub(crate) fn claim(problem: &Problem) -> Result<Box<dyn Claim + '_>> {
    Ok(match problem.settings().notion {
        Notion::Hull => Box::new(Rows),
        _ => Box::new(Points::new(problem)?),
    })
}

pub(crate) fn plant(problem: &Problem) -> Result<Box<dyn Plant + '_>> {
    Ok(match problem.dynamics().linear_system() {
        Some(_) => Box::new(Linear::new(problem)?),
        None => Box::new(Polynomial::new(problem)),
    })
}

impl Tube {
    /// Computes the reachable sets under `sets` on all cores.
    ///
    /// # Guarantee
    ///
    /// For a linear model as [`ReachSets`](reachtube_reach::ReachSets): bounds from inside and from
    /// outside. For any other model outer, as [`Flowpipe`](reachtube_reach::Flowpipe), for every
    /// measurable disturbance with values in U.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`]; when a solution cannot be enclosed.
    pub fn new(problem: &Problem, sets: UncertaintySets) -> Result<Self> {
        match problem.dynamics().linear_system() {
            Some(_) => Linear::tube_without_points(problem, sets),
            // These sets are not computed twice: the points are judged on the way.
            None => claim(problem)?.judge(&Polynomial::new(problem), &sets, &Look::proof()),
        }
    }
}

/// Judges the recorded points in reachable sets, where the notion asks them and they were not
/// judged yet.
pub(crate) fn judged(problem: &Problem, tube: &Tube) -> Result<Option<Tube>> {
    if !problem.settings().notion.asks_points() || tube.judged.is_some() {
        return Ok(None);
    }
    let claim = claim(problem)?;
    claim.judge(&*plant(problem)?, &tube.sets, &Look::proof()).map(Some)
}
