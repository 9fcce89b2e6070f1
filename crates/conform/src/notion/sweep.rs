//! The search for recorded points outside the reachable sets.

use std::borrow::Cow;

use nalgebra::DVectorView;
use rayon::prelude::*;
use reachtube_reach::{GeneratorRows, Membership, MembershipWorkspace, Place, SampleGenerators};
use reachtube_scalar::Interval;

use crate::data::problem::Problem;
use crate::data::settings::Notion;
use crate::error::Result;
use crate::grids::Grid;
use crate::linear::cut::Cut;
use crate::notion::points::{SamplePoints, points, projections};
use crate::notion::proof::Unproved;
use crate::sets::UncertaintySets;

/// How accurately the growth of a set is known that a point outside needs, in parts of what is
/// tolerated.
const GAUGE: f64 = 0.1;

/// How accurately points near the boundary are separated from others.
const NEAR: f64 = 1e-3;

/// A point counts as outside when the set must grow by more than this part.
pub(super) const OUTSIDE: f64 = 1e-9;

/// A factor of growth that is below another by this part is below it whatever the rounding.
const CLEARLY_BELOW: f64 = 1.0 - 1e-9;

/// Number of disturbances, held over equally many steps, that suffice for most points.
const HELD: usize = 24;

/// Equal parts of a sample over which a disturbance is held that may be any measurable function.
pub(super) const PARTS: usize = 2;

/// All that the notions of enclosure need of a problem, besides the sets.
pub(crate) struct Sweep<'a> {
    pub grids: &'a [Grid],
    pub generators: Vec<SampleGenerators<'a>>,
    pub points: Cow<'a, [SamplePoints]>,
    /// The states of each projection in which points must lie in the set.
    pub projections: Vec<Vec<usize>>,
    pub states: usize,
}

/// A projection of the reachable set at one sample, about 0: first a smaller set of few generators,
/// in which most points lie, then the set itself.
pub(crate) struct SampleSet<'a> {
    sweep: &'a Sweep<'a>,
    at: &'a SamplePoints,
    sets: &'a UncertaintySets,
    projection: &'a [usize],
    /// Number of steps over which the smaller set's disturbances are held.
    pub held: usize,
    coarse: (Membership, MembershipWorkspace),
    fine: Option<(Membership, MembershipWorkspace)>,
}

/// A point outside a reachable set, with the direction that shows it.
#[derive(Debug, Clone)]
pub(crate) struct Outside {
    /// Index of its sample among the samples of the sweep.
    pub at: usize,
    /// Which projection.
    pub projection: usize,
    /// Which of the sample's points.
    pub point: usize,
    /// The direction, 2n entries.
    pub direction: Vec<f64>,
    /// By which factor the set would have to grow at least.
    pub ratio: f64,
}

impl<'a> SampleSet<'a> {
    /// Returns the smaller set.
    pub(crate) fn coarse(&mut self) -> &mut (Membership, MembershipWorkspace) {
        &mut self.coarse
    }

    /// Returns the set itself, which is made when it is first asked for.
    pub(crate) fn fine(&mut self) -> &mut (Membership, MembershipWorkspace) {
        let (sweep, at, sets, projection) = (self.sweep, self.at, self.sets, self.projection);
        self.fine.get_or_insert_with(|| sweep.members(at, sets, projection, 1))
    }

    /// Returns whether a point, in the projection and from the set's centre, lies in the set grown
    /// by the factor 1 + `tolerance`, in floating point.
    pub(crate) fn contains(&mut self, d: &[f64], tolerance: f64) -> bool {
        let (set, work) = &mut self.coarse;
        if set.locate(d, tolerance, work) == Place::Inside {
            return true;
        }
        let (set, work) = self.fine();
        set.locate(d, tolerance, work) == Place::Inside
    }
}

impl SampleSet<'_> {
    /// Returns by which factor the set would have to grow for a point, in the projection and from
    /// the set's centre, with the direction that shows it; `None` if it must not grow by more
    /// than the factor 1 + `tolerance`. Nothing also where the factor is surely below `known`,
    /// which saves the search for it. The answer does not depend on the points before.
    pub(crate) fn growth(
        &mut self,
        d: &[f64],
        tolerance: f64,
        known: Option<f64>,
    ) -> Option<(f64, Vec<f64>)> {
        let accuracy = GAUGE * tolerance;
        let scaled = |factor: f64| d.iter().map(|x| x / factor).collect::<Vec<_>>();
        if let Some(known) = known {
            // The factor that is found is never above the true one.
            let d = scaled(known * CLEARLY_BELOW / (1.0 + accuracy));
            if self.contains(&d, accuracy) {
                return None;
            }
        }
        let d = scaled(1.0 + tolerance);
        let (coarse, work) = self.coarse();
        if coarse.locate(&d, accuracy, work) == Place::Inside {
            return None;
        }
        let (fine, work) = self.fine();
        let (ratio, direction) = fine.gauge(&d, accuracy, work)?;
        Some((ratio * (1.0 + tolerance), direction))
    }
}

impl<'a> Sweep<'a> {
    /// Collects the points and the generators of a problem.
    ///
    /// # Errors
    ///
    /// As [`points`].
    pub(crate) fn new(problem: &'a Problem) -> Result<Self> {
        Self::of_notion(problem, problem.settings().notion)
    }

    /// Collects the points and the generators of a problem for another notion than its own.
    ///
    /// # Errors
    ///
    /// As [`points`].
    pub(crate) fn of_notion(problem: &'a Problem, notion: Notion) -> Result<Self> {
        Self::of_points(problem, notion, points(problem)?.into())
    }

    /// Prepares the generators of a problem alone.
    ///
    /// # Errors
    ///
    /// As [`Problem::grids`].
    pub(crate) fn without_points(problem: &'a Problem) -> Result<Self> {
        Self::of_points(problem, problem.settings().notion, Cow::default())
    }

    /// Prepares the generators of a problem for points that were collected.
    ///
    /// # Errors
    ///
    /// As [`Problem::grids`].
    pub(crate) fn of_points(
        problem: &'a Problem,
        notion: Notion,
        points: Cow<'a, [SamplePoints]>,
    ) -> Result<Self> {
        let (grids, settings) = (problem.grids()?.as_slice(), problem.settings());
        let generators =
            |grid: &'a Grid| SampleGenerators::new(&grid.propagation, settings.disturbance, PARTS);
        Ok(Self {
            grids,
            generators: grids.iter().map(generators).collect::<Result<_, _>>()?,
            points,
            projections: projections(notion, settings.states, problem.joints()),
            states: 2 * problem.joints(),
        })
    }

    /// The centre of the reachable set of the deviation, and how far it may be off, 2n each.
    pub(crate) fn centre(&self, at: &SamplePoints, sets: &UncertaintySets) -> (Vec<f64>, Vec<f64>) {
        let propagation = &self.grids[at.grid].propagation;
        let (e, gamma) = (propagation.exponential(at.sample), propagation.integral(at.sample));
        let UncertaintySets { initial_set, input_set, .. } = sets;
        let entry = |i: usize| {
            let start = e.row(i).into_iter().zip(&initial_set.centre);
            let input = gamma.row(i).into_iter().zip(&input_set.centre);
            let sum = start.chain(input).fold(Interval::ZERO, |sum, (x, c)| sum + *x * *c);
            (sum.mid(), sum.rad())
        };
        (0..self.states).map(entry).unzip()
    }

    /// The radii of the set's interval hull, 2n, in floating point.
    pub(crate) fn hull(&self, at: &SamplePoints, sets: &UncertaintySets) -> Vec<f64> {
        let grid = &self.grids[at.grid];
        let (e, gain) = (grid.propagation.exponential(at.sample), &grid.input_gains[at.sample]);
        let radius = |i: usize| {
            let start = e.row(i).into_iter().zip(&sets.initial_set.radius);
            let input = gain.row(i).into_iter().zip(&sets.input_set.radius);
            let sum: f64 = start.chain(input).map(|(x, r)| x.mid().abs() * r).sum();
            sum + sets.noise_radius(i)
        };
        (0..self.states).map(radius).collect()
    }

    /// Returns the number of points, each counted once for each projection.
    pub(crate) fn point_count(&self) -> usize {
        let points: usize = self.points.iter().map(|at| at.owners.len()).sum();
        points * self.projections.len()
    }

    /// Returns how many of some points are outside, in floating point.
    pub(crate) fn count_outside(&self, sets: &UncertaintySets, unproved: &[Unproved]) -> usize {
        let in_one_set = |a: &Unproved, b: &Unproved| (a.at, a.projection) == (b.at, b.projection);
        let of_set = |points: &[Unproved]| {
            let (at, projection) =
                (&self.points[points[0].at], &self.projections[points[0].projection]);
            let (centre, _) = self.centre(at, sets);
            let (set, mut work) = self.members(at, sets, projection, 1);
            let is_outside = |unproved: &&Unproved| {
                let d = at.point(unproved.point);
                let d: Vec<f64> = projection.iter().map(|&i| d[i] - centre[i]).collect();
                matches!(set.locate(&d, OUTSIDE, &mut work), Place::Outside { .. })
            };
            points.iter().filter(is_outside).count()
        };
        unproved.par_chunk_by(in_one_set).map(of_set).sum()
    }

    /// Prepares the reachable set at a sample in one projection.
    pub(crate) fn set<'b>(
        &'b self,
        at: &'b SamplePoints,
        sets: &'b UncertaintySets,
        projection: &'b [usize],
    ) -> SampleSet<'b> {
        let held = held(at);
        let coarse = self.members(at, sets, projection, held);
        SampleSet { sweep: self, at, sets, projection, held, coarse, fine: None }
    }

    fn members(
        &self,
        at: &SamplePoints,
        sets: &UncertaintySets,
        projection: &[usize],
        held: usize,
    ) -> (Membership, MembershipWorkspace) {
        let set = Membership::new(&self.rows(at, sets, projection, held));
        let work = set.workspace();
        (set, work)
    }

    /// The generators of the reachable set at a sample in one projection, for disturbances that are
    /// held over `held` steps.
    pub(crate) fn rows(
        &self,
        at: &SamplePoints,
        sets: &UncertaintySets,
        projection: &[usize],
        held: usize,
    ) -> GeneratorRows {
        let noise: Vec<f64> = (0..self.states).map(|i| sets.noise_radius(i)).collect();
        let radii = [&sets.initial_set.radius[..], &sets.input_set.radius, &noise];
        self.generators[at.grid].at(at.sample, radii, projection, held)
    }

    /// The generators of a smaller set, of which there are few.
    pub(crate) fn coarse_rows(
        &self,
        at: &SamplePoints,
        sets: &UncertaintySets,
        projection: &[usize],
    ) -> GeneratorRows {
        self.rows(at, sets, projection, held(at))
    }

    /// Returns, for each sample, the points that are outside the set shrunk by the factor `margin`,
    /// or close to its boundary.
    pub(crate) fn near(&self, sets: &UncertaintySets, margin: f64) -> Vec<Vec<usize>> {
        let of_sample = |at: &SamplePoints| {
            let (centre, _) = self.centre(at, sets);
            let mut near = vec![false; at.owners.len()];
            for projection in &self.projections {
                let mut set = self.set(at, sets, projection);
                for (d, near) in at.iter().zip(&mut near) {
                    let of_state = |&i: &usize| (d[i] - centre[i]) / margin;
                    let d: Vec<f64> = projection.iter().map(of_state).collect();
                    *near |= !set.contains(&d, NEAR);
                }
            }
            (0..near.len()).filter(|point| near[*point]).collect()
        };
        self.points.par_iter().map(of_sample).collect()
    }

    /// Returns, for each sample and projection, that one of the points `near` that is furthest
    /// outside, where the set must grow by more than the factor 1 + `tolerance`. Each point is
    /// judged alone, so that neither the order nor the grouping of the points makes a difference;
    /// of points that are equally far, the one with the lowest owner counts.
    pub(crate) fn outside(
        &self,
        sets: &UncertaintySets,
        tolerance: f64,
        near: &[Vec<usize>],
    ) -> Vec<Outside> {
        let of_sample = |index: usize| {
            let at = &self.points[index];
            let (centre, _) = self.centre(at, sets);
            let worst = |projection: usize| {
                let states = &self.projections[projection];
                let mut set = self.set(at, sets, states);
                let mut worst: Option<Outside> = None;
                for &point in &near[index] {
                    let d = at.point(point);
                    let d: Vec<f64> = states.iter().map(|&i| d[i] - centre[i]).collect();
                    let known = worst.as_ref().map(|worst| worst.ratio);
                    let Some((ratio, short)) = set.growth(&d, tolerance, known) else { continue };
                    let owner = |point: usize| at.owners[point];
                    let is_further = worst.as_ref().is_none_or(|worst| {
                        ratio > worst.ratio
                            || ratio == worst.ratio && owner(point) < owner(worst.point)
                    });
                    if is_further {
                        let mut direction = vec![0.0; self.states];
                        states.iter().zip(short).for_each(|(&i, l)| direction[i] = l);
                        worst = Some(Outside { at: index, projection, point, direction, ratio });
                    }
                }
                worst
            };
            (0..self.projections.len()).filter_map(worst).collect::<Vec<_>>()
        };
        let samples: Vec<usize> =
            (0..near.len()).filter(|index| !near[*index].is_empty()).collect();
        samples.into_par_iter().flat_map_iter(of_sample).collect()
    }

    /// Returns the row of the program that a direction gives at a sample, for the largest lᵀ d of
    /// its points.
    pub(crate) fn cut(&self, (grid, sample): (usize, usize), l: &[f64], bound: f64) -> Cut {
        let propagation = &self.grids[grid].propagation;
        let (e, gamma) = (propagation.exponential(sample), propagation.integral(sample));
        let along = |column: DVectorView<'_, Interval>| {
            column.iter().zip(l).map(|(x, l)| x.mid() * l).sum::<f64>()
        };
        let centre = e.column_iter().chain(gamma.column_iter()).map(along).collect();
        let (initial, input) = self.generators[grid].gains(sample, l);
        Cut {
            centre,
            radius: [initial, input].concat(),
            noise: l.iter().map(|l| l.abs()).collect(),
            bound,
        }
    }
}

/// The number of steps over which the disturbances of a smaller set are held.
fn held(at: &SamplePoints) -> usize {
    at.sample.div_ceil(HELD)
}
