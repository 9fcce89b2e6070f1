//! The answers of points in memory.

use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::data::problem::Problem;
use crate::error::Result;
use crate::notion::ask::{
    Answer, At, Near, Owner, PartVerdict, PointAlong, PointOutside, Points, Question,
    RecordedPoint, UnprovedRun,
};
use crate::notion::points::SamplePoints;
use crate::notion::sweep::{OUTSIDE, Outside, Sweep};
use crate::sets::UncertaintySets;

/// For each sample, the points in a list; lists that were asked for stay.
pub(crate) type KnownLists = Vec<(Near, Vec<Vec<usize>>)>;

/// Returns the points of a problem: with the workers of a fleet where there is one, or in memory.
///
/// # Errors
///
/// As [`Sweep::new`].
pub(crate) fn points_of(problem: &Problem) -> Result<Box<dyn Points + '_>> {
    match problem.points_elsewhere() {
        Some(points) => Ok(Box::new(points)),
        None => Ok(Box::new(PointsHere::new(problem)?)),
    }
}

/// The points of a problem, in memory.
pub(crate) struct PointsHere<'a> {
    problem: &'a Problem,
    sweep: Sweep<'a>,
    lists: RefCell<KnownLists>,
}

impl<'a> PointsHere<'a> {
    /// Collects the points of a problem.
    ///
    /// # Errors
    ///
    /// As [`Sweep::new`].
    pub(crate) fn new(problem: &'a Problem) -> Result<Self> {
        Ok(Self { problem, sweep: Sweep::new(problem)?, lists: RefCell::default() })
    }
}

impl Points for PointsHere<'_> {
    fn ask(&self, question: &Question) -> Result<Answer> {
        let file = |run: u32| self.problem.entry(run as usize).file.clone();
        Ok(self.sweep.answer(question, &mut self.lists.borrow_mut(), &file))
    }
}

impl Sweep<'_> {
    /// Answers a question; `file` names a run.
    pub(crate) fn answer(
        &self,
        question: &Question,
        lists: &mut KnownLists,
        file: &dyn Fn(u32) -> String,
    ) -> Answer {
        match question {
            Question::Outside { sets, tolerance, near } => {
                let near = self.in_lists(near, lists);
                let outside = self.outside(sets, *tolerance, &near);
                Answer::Outside(self.by_place(outside, file))
            }
            Question::Furthest { directions } => {
                let along = |(at, direction): &(At, Vec<f64>)| {
                    let points = self.at(*at)?;
                    let (point, value) = points.furthest(direction);
                    Some(PointAlong { point: recorded(points, point, file), value })
                };
                Answer::Furthest(directions.iter().map(along).collect())
            }
            Question::Unproved { sets, at } => {
                let samples: Vec<usize> = match at {
                    None => (0..self.points.len()).collect(),
                    Some(at) => at.iter().filter_map(|at| self.index(*at)).collect(),
                };
                let unproved = self.unproved(sets, &samples);
                let mut at: Vec<At> = unproved.iter().map(|u| self.points[u.at].place()).collect();
                at.dedup();
                Answer::Unproved(at)
            }
            Question::Judge { sets } => Answer::Judge(self.judge(sets, file)),
        }
    }

    /// Returns, for each sample, the points that are in one of the lists.
    fn in_lists(&self, wanted: &[Near], lists: &mut KnownLists) -> Vec<Vec<usize>> {
        let mut all = vec![Vec::new(); self.points.len()];
        for near in wanted {
            let known = match lists.iter().position(|(known, _)| known == near) {
                Some(known) => known,
                None => {
                    lists.push((near.clone(), self.near(&near.sets, near.margin)));
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
        all
    }

    fn judge(&self, sets: &UncertaintySets, file: &dyn Fn(u32) -> String) -> PartVerdict {
        let all: Vec<usize> = (0..self.points.len()).collect();
        let unproved = self.unproved(sets, &all);
        let mut near = vec![Vec::new(); self.points.len()];
        let mut runs: BTreeMap<Owner, UnprovedRun> = BTreeMap::new();
        for point in &unproved {
            near[point.at].push(point.point);
            let at = &self.points[point.at];
            let (owner, first) = (at.owners[point.point], (at.place(), point.projection as u32));
            let run = runs.entry(owner).or_insert_with(|| UnprovedRun {
                file: file(owner.1),
                count: 0,
                first,
            });
            run.count += 1;
            run.first = run.first.min(first);
        }
        let outside = self.outside(sets, OUTSIDE, &near);
        PartVerdict {
            points: self.point_count(),
            unproved: runs,
            outside: self.count_outside(sets, &unproved),
            furthest: self.by_place(outside, file),
        }
    }

    fn by_place(
        &self,
        outside: Vec<Outside>,
        file: &dyn Fn(u32) -> String,
    ) -> BTreeMap<(At, u32), PointOutside> {
        let of = |outside: Outside| {
            let Outside { at, projection, point, direction, ratio } = outside;
            let at = &self.points[at];
            let point = recorded(at, point, file);
            ((at.place(), projection as u32), PointOutside { point, direction, ratio })
        };
        outside.into_iter().map(of).collect()
    }

    /// Returns the index of a sample, which is in the order of grids and samples.
    fn index(&self, at: At) -> Option<usize> {
        self.points.binary_search_by_key(&at, SamplePoints::place).ok()
    }

    fn at(&self, at: At) -> Option<&SamplePoints> {
        self.index(at).map(|index| &self.points[index])
    }
}

fn recorded(at: &SamplePoints, point: usize, file: &dyn Fn(u32) -> String) -> RecordedPoint {
    let owner = at.owners[point];
    RecordedPoint { owner, file: file(owner.1), deviation: at.point(point).to_vec() }
}
