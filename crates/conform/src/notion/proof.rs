//! The proof that every recorded point lies in the reachable set.

use rayon::prelude::*;
use reachtube_reach::{Membership, MembershipProof, MembershipWorkspace, Place};
use reachtube_scalar::rounding::add_up;

use crate::notion::points::SamplePoints;
use crate::notion::sweep::Sweep;
use crate::sets::UncertaintySets;

/// What the factors of a point are kept below 1 by, so that the proof has room: the second where
/// the first is too much.
pub(super) const SLACK: [f64; 2] = [1e-6, 1e-9];

/// How accurately the factors reach the point, in parts of the slack.
const ACCURACY: f64 = 1e-3;

/// A point that could not be proved to lie in a projection of the reachable set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unproved {
    /// Index of the sample among the samples of the sweep.
    pub at: usize,
    /// Which of its points.
    pub point: usize,
    /// Which projection.
    pub projection: usize,
}

impl Sweep<'_> {
    /// Returns the points at the samples `samples` that could not be proved to lie in the reachable
    /// set.
    ///
    /// # Guarantee
    ///
    /// Each point that is not returned lies in the exact reachable set.
    pub(crate) fn unproved(&self, sets: &UncertaintySets, samples: &[usize]) -> Vec<Unproved> {
        let of_sample = |&at: &usize| {
            let (centre, error) = self.centre(&self.points[at], sets);
            let mut unproved = Vec::new();
            for projection in 0..self.projections.len() {
                let points = ProjectedPoints::new(self, at, projection, [&centre, &error]);
                let left = self.unproved_in(&points, sets, |_, _| ());
                unproved.extend(left.into_iter().map(|point| Unproved { at, point, projection }));
            }
            unproved
        };
        samples.par_iter().flat_map_iter(of_sample).collect()
    }

    /// The points of one sample that are not proved in one projection: by the smaller set first,
    /// then by the set itself. `proved` takes how each other point was proved.
    pub(super) fn unproved_in(
        &self,
        points: &ProjectedPoints,
        sets: &UncertaintySets,
        mut proved: impl FnMut(usize, Factors),
    ) -> Vec<usize> {
        let mut set = self.set(points.at, sets, points.projection);
        let held = set.held;
        let mut left: Vec<usize> = (0..points.at.owners.len()).collect();
        for (step, slack) in [SLACK[0], SLACK[0], SLACK[1]].into_iter().enumerate() {
            if left.is_empty() {
                break;
            }
            let (members, work) = if step == 0 { set.coarse() } else { set.fine() };
            if let Some(proof) = MembershipProof::new(members) {
                left.retain(|&point| {
                    if !points.is_proved(point, members, &proof, slack, work) {
                        return true;
                    }
                    let held = if step == 0 { held } else { 1 };
                    proved(point, Factors { held, limit: 1.0 - slack, set: members, work });
                    false
                });
            }
        }
        left
    }
}

/// How a point was proved: by factors of the generators.
pub(super) struct Factors<'a> {
    /// Number of steps over which the disturbances are held.
    pub held: usize,
    /// What the factors were kept to.
    pub limit: f64,
    pub set: &'a Membership,
    pub work: &'a MembershipWorkspace,
}

/// The points of a sample in one projection, from the centre of the set.
pub(super) struct ProjectedPoints<'a> {
    pub at: &'a SamplePoints,
    pub projection: &'a [usize],
    centre: &'a [f64],
    /// How far the centre may be off.
    error: &'a [f64],
}

impl<'a> ProjectedPoints<'a> {
    pub(super) fn new(
        sweep: &'a Sweep,
        at: usize,
        projection: usize,
        [centre, error]: [&'a Vec<f64>; 2],
    ) -> Self {
        let (at, projection) = (&sweep.points[at], &sweep.projections[projection]);
        Self { at, projection, centre, error }
    }

    fn is_proved(
        &self,
        point: usize,
        set: &Membership,
        proof: &MembershipProof,
        slack: f64,
        work: &mut MembershipWorkspace,
    ) -> bool {
        let measured = self.at.point(point);
        let d: Vec<f64> = self.projection.iter().map(|&i| measured[i] - self.centre[i]).collect();
        // The deviation and the centre are not exact, nor is their difference.
        let radius = |(x, &i): (&f64, &usize)| {
            let given = add_up(self.at.error(point, i), self.error[i]);
            add_up(given, f64::EPSILON * x.abs() + f64::MIN_POSITIVE)
        };
        let radius: Vec<f64> = d.iter().zip(self.projection).map(radius).collect();
        proves(set, proof, &d, &radius, slack, work)
    }
}

/// Returns whether factors of at most 1 - `slack` were found that prove that all points within
/// `radius` of `d` lie in the set.
///
/// # Guarantee
///
/// As [`MembershipProof::holds`].
pub(super) fn proves(
    set: &Membership,
    proof: &MembershipProof,
    d: &[f64],
    radius: &[f64],
    slack: f64,
    work: &mut MembershipWorkspace,
) -> bool {
    let scaled: Vec<f64> = d.iter().map(|x| x / (1.0 - slack)).collect();
    set.locate(&scaled, ACCURACY * slack, work) == Place::Inside
        && proof.holds(d, radius, 1.0 - slack, work)
}
