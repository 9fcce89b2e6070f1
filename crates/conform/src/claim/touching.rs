//! The recorded points that decide the sets.

use std::collections::HashSet;

use crate::claim::witness::{PointWitness, SeparatedPoint};
use crate::data::problem::Problem;
use crate::error::Result;
use crate::found::TOUCHING;
use crate::hulls::Hulls;
use crate::linear::program::Program;
use crate::tube::judged::{Along, At};
use crate::tube::linear::Linear;
use crate::tube::plant::Slice;
use crate::witness::Witness;

/// Returns the points that touch the boundary of the reachable set in the direction of a cut, the
/// closest first, each once, under the state that counts most in the direction.
///
/// # Errors
///
/// As [`Problem::grids`].
pub(crate) fn touching(
    problem: &Problem,
    plant: &Linear,
    program: &Program,
    hulls: &Hulls,
    cuts: &[(At, Vec<f64>, Along)],
) -> Result<Vec<Witness>> {
    let mut seen = HashSet::new();
    let mut touching = Vec::new();
    for ((at, direction, along), cut) in cuts.iter().zip(&program.cuts) {
        let (from_centre, reach) = program.reach(cut, &hulls.sets);
        let ratio = from_centre / reach;
        if ratio < 1.0 - TOUCHING || !seen.insert((at, along.owner)) {
            continue;
        }
        let (centre, _) = plant.slice(&hulls.sets, *at).centre();
        let deviation: Vec<f64> = along.point.iter().zip(&centre).map(|(x, c)| x - c).collect();
        let point = SeparatedPoint {
            suite: along.owner.0 as usize,
            file: &along.file,
            sample: at.1 as usize,
            time: hulls.time(problem, *at)?,
            hull: &hulls.radii(*at),
            deviation: &deviation,
            direction,
            ratio,
        };
        touching.push(PointWitness::new(problem, &point).into_witness());
    }
    touching.sort_by(|a, b| (b.excess / b.radius).total_cmp(&(a.excess / a.radius)));
    Ok(touching)
}
