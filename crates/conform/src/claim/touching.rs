//! The recorded points that decide the sets.

use std::collections::HashSet;

use crate::claim::witness::{PointWitness, SeparatedPoint};
use crate::data::problem::Problem;
use crate::program::program::Program;
use crate::search::found::TOUCHING;
use crate::tube::direction::Direction;
use crate::tube::plant::Plant;
use crate::tube::tube::Tube;
use crate::tube::witness::Witness;

/// Returns the points that touch what the program's sets reach in the direction of one of its cuts,
/// the closest first, each once, under the state that counts most in the direction.
pub(crate) fn touching(
    (problem, plant): (&Problem, &dyn Plant),
    program: &Program,
    tube: &Tube,
    directions: &[Direction],
) -> Vec<Witness> {
    let with_ratio = directions.iter().zip(&program.cuts).map(|(direction, cut)| {
        let (from_centre, reach) = program.reach(cut, &tube.sets);
        (direction, from_centre / reach)
    });
    let mut touching: Vec<(&Direction, f64)> =
        with_ratio.filter(|(_, ratio)| *ratio >= 1.0 - TOUCHING).collect();
    touching.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut seen = HashSet::new();
    touching
        .retain(|(known, _)| tube.reaches(known.at) && seen.insert((known.at, known.along.owner)));
    let witness = |(known, ratio): (&Direction, f64)| {
        let Direction { at, direction, along, .. } = known;
        let centre = plant.centre(tube, *at);
        let deviation: Vec<f64> = along.point.iter().zip(centre).map(|(x, c)| x - c).collect();
        let point = SeparatedPoint {
            suite: along.owner.0 as usize,
            file: &along.file,
            sample: at.1 as usize,
            time: tube.time(*at),
            hull: &tube.radii(*at),
            deviation: &deviation,
            direction,
            ratio,
        };
        PointWitness::new(problem, &point).into_witness()
    };
    touching.into_iter().map(witness).collect()
}
