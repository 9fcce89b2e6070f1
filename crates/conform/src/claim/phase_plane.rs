//! The phase planes of the parts, for figures.

use rayon::prelude::*;

use crate::claim::sample_points::{SamplePoints, points};
use crate::data::notion::Notion;
use crate::data::problem::Problem;
use crate::data::settings::States;
use crate::error::Result;
use crate::sets::UncertaintySets;
use crate::tube::linear::Linear;
use crate::tube::plant::Slice;

/// The reachable set of one part's position and velocity at one sample, with the recordings
/// there. All values are deviations from the nominal motion.
#[derive(Debug, Clone, PartialEq)]
pub struct PhasePlane {
    /// The part, from 0.
    pub part: usize,
    /// Time since the first sample, s.
    pub time: f64,
    /// The vertices of the set's projection, counter-clockwise: position, velocity.
    pub polygon: Vec<[f64; 2]>,
    /// The interval hull: the lowest and the highest position, then velocity.
    pub hull: [[f64; 2]; 2],
    /// The recorded points.
    pub points: Vec<[f64; 2]>,
}

impl PhasePlane {
    /// Returns the phase plane of each part at the sample where a recording comes closest to the
    /// boundary of the set's projection, or leaves it furthest; empty for a model that is not
    /// linear, or where only positions count.
    ///
    /// # Guarantee
    ///
    /// None: floating point, for figures.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`].
    pub fn of_parts(problem: &Problem, sets: &UncertaintySets) -> Result<Vec<Self>> {
        if problem.dynamics().linear_system().is_none()
            || problem.settings().states == States::Positions
        {
            return Ok(Vec::new());
        }
        let (plant, points) = (Linear::with_slices(problem)?, points(problem)?);
        let planes = Notion::PhasePlane.projections(problem.states(), problem.parts());
        let plane = |(part, states): (usize, &Vec<usize>)| {
            let ratio = |at: &SamplePoints| furthest(&plant.slice(sets, at.place()), at, states);
            let ratios: Vec<f64> = points.par_iter().map(ratio).collect();
            let at = (0..ratios.len()).max_by(|&i, &k| ratios[i].total_cmp(&ratios[k]))?;
            Some(Self::new(&plant, &points[at], sets, (part, states)))
        };
        Ok(planes.iter().enumerate().filter_map(plane).collect())
    }

    fn new(
        plant: &Linear,
        at: &SamplePoints,
        sets: &UncertaintySets,
        (part, states): (usize, &[usize]),
    ) -> Self {
        let slice = plant.slice(sets, at.place());
        let (centre, _) = slice.centre();
        let [q, qd] = [states[0], states[1]];
        let rows = slice.generators(states, 1);
        let hull = slice.hull();
        let bounds = |i: usize| [centre[i] - hull[i], centre[i] + hull[i]];
        Self {
            part,
            time: plant.grids[at.strand].propagation.grid().times()[at.sample],
            polygon: rows.zonotope(vec![centre[q], centre[qd]]).polygon(0, 1),
            hull: [bounds(q), bounds(qd)],
            points: at.iter().map(|d| [d[q], d[qd]]).collect(),
        }
    }
}

/// By which factor the set would have to grow for the furthest of the points, about, from the edges
/// of a smaller set with few generators.
fn furthest(slice: &dyn Slice, at: &SamplePoints, states: &[usize]) -> f64 {
    let (centre, _) = slice.centre();
    let held = slice.coarse().first().copied().unwrap_or(1);
    let vertices = slice.generators(states, held).zonotope(vec![0.0, 0.0]).polygon(0, 1);
    let next = vertices.iter().cycle().skip(1);
    let edges: Vec<[f64; 3]> = vertices
        .iter()
        .zip(next)
        .map(|(a, b)| {
            let normal = [b[1] - a[1], a[0] - b[0]];
            [normal[0], normal[1], normal[0] * a[0] + normal[1] * a[1]]
        })
        .filter(|edge| edge[2] > 0.0)
        .collect();
    let of_point = |d: &[f64]| {
        let [x, y] = [states[0], states[1]].map(|i| d[i] - centre[i]);
        edges.iter().map(|[a, b, reach]| (a * x + b * y) / reach).fold(0.0, f64::max)
    };
    at.iter().map(of_point).fold(0.0, f64::max)
}
