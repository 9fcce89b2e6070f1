//! Recorded points in one projection of the reachable set at one sample.

use rayon::prelude::*;
use reachtube_reach::{Membership, MembershipProof, MembershipWorkspace, Place};
use reachtube_scalar::rounding::add_up;

use crate::claim::sample_points::SamplePoints;
use crate::tube::plant::Slice;

/// How accurately the growth of a set is known that a point outside needs, in parts of what is
/// tolerated.
const GAUGE: f64 = 0.1;

/// A point counts as outside when the set must grow by more than this part.
pub(crate) const OUTSIDE: f64 = 1e-9;

/// A factor of growth that is below another by this part is below it whatever the rounding.
const CLEARLY_BELOW: f64 = 1.0 - 1e-9;

/// What the factors of a point are kept below 1 by, so that the proof has room: the second where
/// the first is too much.
const SLACK: [f64; 2] = [1e-6, 1e-9];

/// How accurately the factors reach the point, in parts of the slack.
const ACCURACY: f64 = 1e-3;

/// Number of points at least that one core takes at once.
const AT_ONCE: usize = 8;

/// A projection of the reachable set at one sample, about 0: first smaller sets of few generators,
/// in which most points lie, then the set itself.
pub(crate) struct SampleSet<'a> {
    slice: &'a dyn Slice,
    states: &'a [usize],
    /// For each set, the smallest first, the number of steps over which its disturbances are held.
    held: Vec<usize>,
    /// The sets, which are made on first use.
    sets: Vec<Option<(Membership, MembershipWorkspace)>>,
}

/// How a point was proved: by factors of the generators.
pub(crate) struct Factors<'a> {
    /// Number of steps over which the disturbances are held.
    pub held: usize,
    pub limit: f64,
    pub set: &'a Membership,
    pub work: &'a MembershipWorkspace,
}

/// The points of a sample, from the centre of the set there.
pub(crate) struct CentredPoints<'a> {
    pub at: &'a SamplePoints,
    centre: Vec<f64>,
    /// How far the centre may be off.
    error: Vec<f64>,
}

impl<'a> CentredPoints<'a> {
    pub(crate) fn new(at: &'a SamplePoints, slice: &dyn Slice) -> Self {
        let (centre, error) = slice.centre();
        Self { at, centre, error }
    }

    pub(crate) fn point(&self, index: usize, states: &[usize]) -> Vec<f64> {
        let measured = self.at.point(index);
        states.iter().map(|&i| measured[i] - self.centre[i]).collect()
    }

    pub(crate) fn whole(&self, index: usize) -> Vec<f64> {
        self.at.point(index).iter().zip(&self.centre).map(|(x, c)| x - c).collect()
    }

    /// Returns whether factors of at most 1 - `slack` were found that prove that a point lies in a
    /// set.
    ///
    /// # Guarantee
    ///
    /// As [`MembershipProof::holds`].
    fn is_proved(
        &self,
        index: usize,
        states: &[usize],
        proof: &MembershipProof,
        (set, slack): (&Membership, f64),
        work: &mut MembershipWorkspace,
    ) -> bool {
        let d = self.point(index, states);
        // The point and the centre are not exact, nor is their difference.
        let radius = |(x, &i): (&f64, &usize)| {
            let given = add_up(self.at.error(index, i), self.error[i]);
            add_up(given, f64::EPSILON * x.abs() + f64::MIN_POSITIVE)
        };
        let radius: Vec<f64> = d.iter().zip(states).map(radius).collect();
        let scaled: Vec<f64> = d.iter().map(|x| x / (1.0 - slack)).collect();
        set.locate(&scaled, ACCURACY * slack, work) == Place::Inside
            && proof.holds(&d, &radius, 1.0 - slack, work)
    }
}

impl<'a> SampleSet<'a> {
    /// Prepares the reachable set of a slice in the entries `states`.
    pub(crate) fn new(slice: &'a dyn Slice, states: &'a [usize]) -> Self {
        let mut held = slice.coarse();
        held.retain(|held| *held > 1);
        held.push(1);
        let sets = held.iter().map(|_| None).collect();
        Self { slice, states, held, sets }
    }

    fn set(&mut self, index: usize) -> &mut (Membership, MembershipWorkspace) {
        let (slice, states, held) = (self.slice, self.states, self.held[index]);
        self.sets[index].get_or_insert_with(|| {
            let set = Membership::new(&slice.generators(states, held));
            let work = set.workspace();
            (set, work)
        })
    }

    /// Returns whether a point, in the projection and from the set's centre, lies in the set grown
    /// by the factor 1 + `tolerance`, in floating point.
    pub(crate) fn contains(&mut self, d: &[f64], tolerance: f64) -> bool {
        (0..self.held.len()).any(|index| {
            let (set, work) = self.set(index);
            set.locate(d, tolerance, work) == Place::Inside
        })
    }

    /// Returns by which factor the set would have to grow for a point, in the projection and from
    /// the set's centre, with the direction that shows it; `None` if it must not grow by more than
    /// the factor 1 + `tolerance`. `None` also where the factor is surely below `known`, which
    /// saves the search for it. The answer does not depend on the points before.
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
        let last = self.held.len() - 1;
        for index in 0..last {
            let (smaller, work) = self.set(index);
            if smaller.locate(&d, accuracy, work) == Place::Inside {
                return None;
            }
        }
        let (ratio, direction) = self.gauge(&d, accuracy)?;
        Some((ratio * (1.0 + tolerance), direction))
    }

    /// Returns by which factor the set itself would have to grow for a point, with the direction
    /// that shows it; `None` if the point lies in it.
    pub(crate) fn gauge(&mut self, d: &[f64], accuracy: f64) -> Option<(f64, Vec<f64>)> {
        let (set, work) = self.set(self.held.len() - 1);
        set.gauge(d, accuracy, work)
    }

    /// Proves points: by the smaller sets first, then by the set itself. Hands how each was proved
    /// to `proved` and returns its answers, and the points that were not proved, each with the
    /// factor by which the set must grow at least, where it lies outside in floating point.
    ///
    /// # Guarantee
    ///
    /// Each point that is proved lies in the projection of the reachable set with the noise set.
    pub(crate) fn prove<T: Send>(
        &mut self,
        points: &CentredPoints,
        proved: impl Fn(usize, Factors) -> T + Sync,
    ) -> (Vec<T>, Vec<(usize, Option<f64>)>) {
        let mut left: Vec<usize> = (0..points.at.owners.len()).collect();
        let (mut found, mut unproved) = (Vec::new(), Vec::new());
        for index in 0..self.held.len() {
            if left.is_empty() {
                break;
            }
            let (held, states, is_last) =
                (self.held[index], self.states, index + 1 == self.held.len());
            let (set, _) = &*self.set(index);
            let proof = MembershipProof::new(set);
            let of_point = |work: &mut MembershipWorkspace, point: usize| {
                let try_with = |slack: f64, work: &mut MembershipWorkspace| {
                    let proof = proof.as_ref()?;
                    let holds = points.is_proved(point, states, proof, (set, slack), work);
                    holds.then(|| proved(point, Factors { held, limit: 1.0 - slack, set, work }))
                };
                if let Some(found) = try_with(SLACK[0], work) {
                    return Ok(found);
                }
                if !is_last {
                    return Err((point, None));
                }
                let place = set.locate(&points.point(point, states), OUTSIDE, work);
                if let Place::Outside { ratio, .. } = place {
                    return Err((point, Some(ratio)));
                }
                try_with(SLACK[1], work).ok_or((point, None))
            };
            let answers: Vec<std::result::Result<T, (usize, Option<f64>)>> = left
                .into_par_iter()
                .with_min_len(AT_ONCE)
                .map_init(|| set.workspace(), of_point)
                .collect();
            unproved = Vec::new();
            for answer in answers {
                match answer {
                    Ok(answer) => found.push(answer),
                    Err(point) => unproved.push(point),
                }
            }
            left = unproved.iter().map(|(point, _)| *point).collect();
        }
        (found, unproved)
    }
}
