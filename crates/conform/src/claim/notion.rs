//! The claim and the plant of a problem.

use crate::claim::claim::{Claim, Rows};
use crate::claim::look::Look;
use crate::claim::points::{Points, tolerance};
use crate::claim::remote::{PointServer, Remote};
use crate::claim::traces::Traces;
use crate::data::problem::Problem;
use crate::data::settings::Notion;
use crate::error::Result;
use crate::hulls::{HullKind, Hulls};
use crate::sets::UncertaintySets;
use crate::tube::linear::Linear;
use crate::tube::plant::Plant;
use crate::tube::polynomial::Polynomial;

/// Returns what the notion of a problem claims, about points that `server` has where there is one.
///
/// # Errors
///
/// As [`Points::new`].
pub(crate) fn claim<'a>(
    problem: &'a Problem,
    server: Option<&'a dyn PointServer>,
) -> Result<Box<dyn Claim + 'a>> {
    let settings = problem.settings();
    Ok(match (settings.notion, server) {
        (Notion::Hull, _) => Box::new(Rows),
        (Notion::Trace, _) => Box::new(Traces { problem, points: Points::new(problem)? }),
        (_, Some(server)) => {
            let root = &problem.recordings().root;
            Box::new(Remote { server, root, tolerance: tolerance(settings) })
        }
        (_, None) => Box::new(Points::new(problem)?),
    })
}

/// Returns the model of a problem over its recordings.
///
/// # Errors
///
/// As [`Linear::new`].
pub(crate) fn plant(problem: &Problem) -> Result<Box<dyn Plant + '_>> {
    Ok(match problem.dynamics().linear_system() {
        Some(_) => Box::new(Linear::new(problem)?),
        None => Box::new(Polynomial::new(problem)),
    })
}

impl Hulls {
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
            Some(_) => {
                let grids = problem.grids()?.as_slice();
                let reach = grids.iter().map(|grid| grid.reach(&sets)).collect();
                Ok(Self::of(sets, HullKind::Linear(reach)))
            }
            // These sets are not computed twice: the points are judged on the way.
            None => claim(problem, None)?.judge(&Polynomial::new(problem), &sets, &Look::proof()),
        }
    }
}

/// Returns whether the notion of a problem asks its recorded points.
pub(crate) fn asks_points(problem: &Problem) -> bool {
    problem.settings().notion != Notion::Hull
}

/// Judges the recorded points in reachable sets, where the notion asks them and they were not
/// judged yet.
///
/// # Errors
///
/// As [`Claim::judge`].
pub(crate) fn judged(
    problem: &Problem,
    hulls: &Hulls,
    server: Option<&dyn PointServer>,
) -> Result<Option<Hulls>> {
    if !asks_points(problem) || hulls.judged.is_some() {
        return Ok(None);
    }
    let claim = claim(problem, server)?;
    claim.judge(&*plant(problem)?, &hulls.sets, &Look::proof()).map(Some)
}
