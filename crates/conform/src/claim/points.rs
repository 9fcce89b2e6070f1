//! Recorded points that lie in the reachable set, or in its projections on the phase planes.

use std::sync::{Mutex, OnceLock, PoisonError};

use crate::claim::claim::Claim;
use crate::claim::look::{Look, Near};
use crate::claim::sample_points::{SamplePoints, points};
use crate::claim::sample_set::{CentredPoints, OUTSIDE, SampleSet};
use crate::data::problem::Problem;
use crate::data::settings::{Noise, Settings};
use crate::error::Result;
use crate::sets::UncertaintySets;
use crate::tube::judged::{Along, At, Judged, PointOutside};
use crate::tube::plant::{Plant, Slice};
use crate::tube::tube::Tube;

/// Sets are taken when no point needs them to grow by more than this part.
const TOLERANCE: f64 = 2e-5;

/// The same with a noise set, which does not grow, so that the others have to grow more.
const TOLERANCE_WITH_NOISE: f64 = 2e-6;

/// How accurately points near the boundary are distinguished from others.
const NEAR: f64 = 1e-3;

/// How accurately the growth is known that a point outside a computed outer set needs.
const GAUGE: f64 = 1e-7;

/// Recorded points in memory.
pub(crate) struct Points<'a> {
    problem: &'a Problem,
    samples: Vec<SamplePoints>,
    /// The states of each projection in which points must lie in the set.
    projections: Vec<Vec<usize>>,
    tolerance: f64,
    /// For each sample, the points in a list; lists that were asked for stay.
    lists: Mutex<Vec<(Near, Vec<Vec<usize>>)>>,
}

impl<'a> Points<'a> {
    pub(crate) fn new(problem: &'a Problem) -> Result<Self> {
        let (projections, tolerance) = (problem.projections(), tolerance(problem.settings()));
        Ok(Self {
            problem,
            samples: points(problem)?,
            projections,
            tolerance,
            lists: Mutex::default(),
        })
    }

    fn file(&self, run: u32) -> String {
        self.problem.entry(run as usize).file.clone()
    }

    /// Returns the index of a sample, which is in the order of strands and samples.
    fn index(&self, at: At) -> Option<usize> {
        self.samples.binary_search_by_key(&at, SamplePoints::place).ok()
    }

    fn along(&self, (at, direction): &(At, Vec<f64>)) -> Along {
        let points = &self.samples[self.index(*at).expect("a sample with a point")];
        let (point, value) = points.furthest(direction);
        let owner = points.owners[point];
        let (file, point) = (self.file(owner.1), points.point(point).to_vec());
        Along { owner, file, point, value }
    }

    fn in_lists(&self, plant: &dyn Plant, wanted: &[Near]) -> Result<Vec<Vec<usize>>> {
        let mut lists = self.lists.lock().unwrap_or_else(PoisonError::into_inner);
        let mut all = vec![Vec::new(); self.samples.len()];
        for near in wanted {
            let known = match lists.iter().position(|(known, _)| known == near) {
                Some(known) => known,
                None => {
                    lists.push((near.clone(), self.near(plant, near)?));
                    lists.len() - 1
                }
            };
            for (all, list) in all.iter_mut().zip(&lists[known].1) {
                all.extend(list);
            }
        }
        for list in &mut all {
            list.sort_unstable();
            list.dedup();
        }
        Ok(all)
    }

    /// Returns, for each sample, the points that are outside the set shrunk by the factor `margin`,
    /// or close to its boundary.
    fn near(&self, plant: &dyn Plant, Near { sets, margin }: &Near) -> Result<Vec<Vec<usize>>> {
        let lists: Vec<OnceLock<Vec<usize>>> =
            self.samples.iter().map(|_| OnceLock::new()).collect();
        let watch = |slice: &dyn Slice| {
            if let Some(index) = self.index(slice.at()) {
                let points = CentredPoints::new(&self.samples[index], slice);
                let mut near = vec![false; points.at.owners.len()];
                for states in &self.projections {
                    let mut set = SampleSet::new(slice, states);
                    for (point, near) in near.iter_mut().enumerate() {
                        let mut d = points.point(point, states);
                        d.iter_mut().for_each(|x| *x /= margin);
                        *near |= !set.contains(&d, NEAR);
                    }
                }
                let near = (0..near.len()).filter(|point| near[*point]).collect();
                lists[index].set(near).expect("a slice is shown once");
            }
            Judged::default()
        };
        plant.tube(sets, Some(&watch))?;
        Ok(lists.into_iter().map(|list| list.into_inner().unwrap_or_default()).collect())
    }

    /// Returns the one of some points that is furthest outside in each projection, where the set
    /// must grow by more than the factor 1 + `tolerance`. Each point is judged alone, so that
    /// neither the order nor the grouping of the points makes a difference; of points that are
    /// equally far, the one with the lowest owner counts.
    fn outside(
        &self,
        points: &CentredPoints,
        set: &mut SampleSet,
        (projection, at): (usize, At),
        tolerance: f64,
        candidates: impl Iterator<Item = usize>,
    ) -> Judged {
        let states = &self.projections[projection];
        let owner = |point: usize| points.at.owners[point];
        let mut worst: Option<(usize, f64, Vec<f64>)> = None;
        for point in candidates {
            let d = points.point(point, states);
            let known = worst.as_ref().map(|worst| worst.1);
            let Some((ratio, short)) = set.growth(&d, tolerance, known) else { continue };
            let is_further = worst.as_ref().is_none_or(|worst| {
                ratio > worst.1 || ratio == worst.1 && owner(point) < owner(worst.0)
            });
            if is_further {
                worst = Some((point, ratio, short));
            }
        }
        let worst = worst.map(|(point, ratio, short)| {
            self.point_outside(points, projection, (point, ratio, short))
        });
        let furthest = worst.map(|worst| ((at, projection as u32), worst)).into_iter().collect();
        Judged { furthest, ..Judged::default() }
    }

    /// Returns the point that a direction shows to be furthest outside a computed outer set.
    fn outside_outer(
        &self,
        points: &CentredPoints,
        set: &mut SampleSet,
        projection: usize,
        unproved: &[(usize, Option<f64>)],
        slice: &dyn Slice,
    ) -> Judged {
        let outside = unproved.iter().filter_map(|(point, ratio)| Some((*point, (*ratio)?)));
        let worst = outside.max_by(|a, b| a.1.total_cmp(&b.1));
        let furthest = worst.and_then(|(point, ratio)| {
            let d = points.point(point, &self.projections[projection]);
            let (_, short) = set.gauge(&d, GAUGE)?;
            let mut worst = self.point_outside(points, projection, (point, ratio, short));
            worst.reach = Some(slice.support(&worst.direction));
            Some(((slice.at(), projection as u32), worst))
        });
        Judged { furthest: furthest.into_iter().collect(), ..Judged::default() }
    }

    fn point_outside(
        &self,
        points: &CentredPoints,
        projection: usize,
        (point, ratio, short): (usize, f64, Vec<f64>),
    ) -> PointOutside {
        let deviation = points.whole(point);
        let mut direction = vec![0.0; deviation.len()];
        self.projections[projection].iter().zip(short).for_each(|(&i, l)| direction[i] = l);
        let owner = points.at.owners[point];
        let file = self.file(owner.1);
        PointOutside { owner, file, deviation, direction, ratio, reach: None }
    }

    /// Proves the points at a slice. The point furthest outside an exact set is the one with the
    /// largest growth; outside a computed outer set, the one with the largest bound of the growth.
    fn prove(&self, index: usize, slice: &dyn Slice, is_exact: bool) -> Judged {
        let points = CentredPoints::new(&self.samples[index], slice);
        let (count, owners) = (points.at.owners.len(), &points.at.owners);
        let mut judged = Judged { points: count * self.projections.len(), ..Judged::default() };
        for (projection, states) in self.projections.iter().enumerate() {
            let mut set = SampleSet::new(slice, states);
            let (_, unproved) = set.prove(&points, |_, _| ());
            if unproved.is_empty() {
                continue;
            }
            let first = (slice.at(), projection as u32);
            for (point, _) in &unproved {
                judged.leave(owners[*point], self.file(owners[*point].1), first, 1);
            }
            judged.outside += unproved.iter().filter(|(_, ratio)| ratio.is_some()).count();
            judged = judged.merge(if is_exact {
                let candidates = unproved.iter().map(|(point, _)| *point);
                self.outside(&points, &mut set, (projection, slice.at()), OUTSIDE, candidates)
            } else {
                self.outside_outer(&points, &mut set, projection, &unproved, slice)
            });
        }
        judged
    }

    fn search(&self, index: usize, slice: &dyn Slice, tolerance: f64, near: &[usize]) -> Judged {
        if near.is_empty() {
            return Judged::default();
        }
        let points = CentredPoints::new(&self.samples[index], slice);
        let of_projection = |(projection, states): (usize, &Vec<usize>)| {
            let (mut set, place) = (SampleSet::new(slice, states), (projection, slice.at()));
            self.outside(&points, &mut set, place, tolerance, near.iter().copied())
        };
        let found = self.projections.iter().enumerate().map(of_projection);
        found.fold(Judged::default(), Judged::merge)
    }

    /// Adds the points that no slice showed, because the set was lost before.
    fn lost(&self, tube: &Tube, judged: &mut Judged) {
        for points in self.samples.iter().filter(|points| !tube.reaches(points.place())) {
            for owner in &points.owners {
                let count = self.projections.len();
                judged.points += count;
                judged.leave(*owner, self.file(owner.1), (points.place(), 0), count);
            }
        }
    }
}

impl Claim for Points<'_> {
    fn judge(&self, plant: &dyn Plant, sets: &UncertaintySets, look: &Look) -> Result<Tube> {
        let (tube, judged) = match look {
            Look::Search { tolerance, near } => {
                let near = self.in_lists(plant, near)?;
                let watch = |slice: &dyn Slice| match self.index(slice.at()) {
                    Some(index) => self.search(index, slice, *tolerance, &near[index]),
                    None => Judged::default(),
                };
                plant.tube(sets, Some(&watch))?
            }
            Look::Proof { at, asked } => {
                let is_exact = plant.is_exact();
                let watch = |slice: &dyn Slice| {
                    let here = asked.iter().enumerate().filter(|(_, (at, _))| *at == slice.at());
                    let reaches = here.map(|(index, (_, l))| (index, slice.support(l))).collect();
                    let judged = Judged { reaches, ..Judged::default() };
                    let is_asked = at.as_ref().is_none_or(|at| at.contains(&slice.at()));
                    match self.index(slice.at()).filter(|_| is_asked) {
                        Some(index) => judged.merge(self.prove(index, slice, is_exact)),
                        None => judged,
                    }
                };
                let (tube, mut judged) = plant.tube(sets, Some(&watch))?;
                self.lost(&tube, &mut judged);
                (tube, judged)
            }
        };
        Ok(Tube { judged: Some(judged), ..tube })
    }

    fn furthest(&self, directions: &[(At, Vec<f64>)]) -> Vec<Along> {
        directions.iter().map(|direction| self.along(direction)).collect()
    }

    fn tolerance(&self) -> Option<f64> {
        Some(self.tolerance)
    }
}

/// Returns the part by which sets may have to grow for a point before a search goes on.
fn tolerance(settings: &Settings) -> f64 {
    match settings.noise {
        Noise::None => TOLERANCE,
        Noise::Fitted | Noise::Fixed(_) => TOLERANCE_WITH_NOISE,
    }
}
