//! The recorded points of a model that is not linear, and where they lie in its computed outer
//! sets.

use std::borrow::Cow;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use reachtube_reach::{
    GeneratorRows, Membership, MembershipProof, MembershipWorkspace, Place, Zonotope,
};
use reachtube_recordings::Run;

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::notion::points::projections;
use crate::notion::proof::{SLACK, proves};
use crate::notion::sweep::OUTSIDE;
use crate::sets::UncertaintySets;

/// How accurately the growth of a set is known that a point outside needs.
const GAUGE: f64 = 1e-7;

/// Numbers of parts of the time so far, within each of which generators that a step adds have one
/// factor in common: smaller sets, in which most points lie.
const HELD: [usize; 2] = [24, 200];

/// A direction in which the computed set at a sample is asked how far it reaches.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Asked<'a> {
    /// The sample.
    pub sample: usize,
    /// The direction l, 2n.
    pub direction: &'a [f64],
}

/// Where the recorded points of a case lie in its computed outer sets.
#[derive(Debug, Clone, Default)]
pub(crate) struct CasePoints {
    /// Number of points after the first sample, each counted once for each projection.
    pub points: usize,
    /// Points that were not proved to lie in the set.
    pub unproved: Vec<UnprovedPoint>,
    /// At each sample and in each projection the point that is furthest outside.
    pub furthest: Vec<FurthestPoint>,
    /// For each direction that was asked, by its index, max lᵀ x over the set, without the noise
    /// set; in floating point.
    pub reaches: Vec<(usize, f64)>,
}

/// A point that was not proved to lie in a computed set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct UnprovedPoint {
    /// The run (index in the source).
    pub run: usize,
    /// Whether a direction shows, in floating point, that it lies outside.
    pub is_outside: bool,
}

/// A point outside a computed set, with the direction that shows it.
#[derive(Debug, Clone)]
pub(crate) struct FurthestPoint {
    pub sample: usize,
    /// The run (index in the source).
    pub run: usize,
    /// The direction l, 2n.
    pub direction: Vec<f64>,
    /// By which factor the set would have to grow at least.
    pub ratio: f64,
    /// The point from the centre of the set, 2n.
    pub deviation: Vec<f64>,
    /// max lᵀ x over the recorded points of the sample, and the run that has it.
    pub bound: f64,
    pub bound_run: usize,
    /// max lᵀ x over the set, without the noise set.
    pub reach: f64,
}

impl CasePoints {
    /// Adds the points of another sample.
    pub(crate) fn add(&mut self, other: Self) {
        self.points += other.points;
        self.unproved.extend(other.unproved);
        self.furthest.extend(other.furthest);
        self.reaches.extend(other.reaches);
    }
}

/// The recorded runs of a case, to be compared with its computed sets.
pub(crate) struct CaseRuns<'a> {
    runs: Vec<(usize, Cow<'a, Run>)>,
    /// The states of each projection in which points must lie in the set.
    projections: Vec<Vec<usize>>,
    noise: Vec<f64>,
    asked: &'a [Asked<'a>],
    /// The number of generators at the sample before.
    generators: AtomicUsize,
}

impl<'a> CaseRuns<'a> {
    /// Collects the runs of a case.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`].
    pub(crate) fn new(
        problem: &'a Problem,
        case: &Case,
        sets: &UncertaintySets,
        asked: &'a [Asked<'a>],
    ) -> Result<Self> {
        let (suite, settings) = (&problem.recordings().suites[case.suite], problem.settings());
        let mine = suite.every_run()?.iter().map(|summary| summary.index);
        let mine = mine.filter(|index| case.run.is_none_or(|run| run == *index));
        Ok(Self {
            runs: mine.map(|index| Ok((index, problem.run(index)?))).collect::<Result<_>>()?,
            projections: projections(settings.notion, settings.states, problem.joints()),
            noise: (0..2 * problem.joints()).map(|i| sets.noise_radius(i)).collect(),
            asked,
            generators: AtomicUsize::new(0),
        })
    }

    /// Asks the set at a sample how far it reaches, and judges the points there. At the first
    /// sample the set is a box, and its hull says all.
    ///
    /// # Guarantee
    ///
    /// As [`at_sample`](Self::at_sample).
    pub(crate) fn take(&self, sample: usize, zonotope: &Zonotope, found: &mut CasePoints) {
        let here = self.asked.iter().enumerate().filter(|(_, asked)| asked.sample == sample);
        found.reaches.extend(here.map(|(index, at)| (index, reach(zonotope, at.direction))));
        let count = zonotope.generators().len();
        let stride = count.saturating_sub(self.generators.swap(count, Ordering::Relaxed));
        if sample > 0 {
            for projection in &self.projections {
                self.at_sample(sample, zonotope, projection, stride, found);
            }
        }
    }

    /// Adds the points that no set judged, because the set was lost before.
    pub(crate) fn finish(&self, samples: usize, found: &mut CasePoints) {
        for (run, recorded) in &self.runs {
            let lost = recorded.len().saturating_sub(samples.max(1)) * self.projections.len();
            found.points += lost;
            let point = UnprovedPoint { run: *run, is_outside: false };
            found.unproved.extend(std::iter::repeat_n(point, lost));
        }
    }

    /// Judges the points of one sample in one projection.
    ///
    /// # Guarantee
    ///
    /// Each point that is not among the unproved ones lies in the projection of the zonotope and
    /// the noise set: directed rounding.
    fn at_sample(
        &self,
        sample: usize,
        zonotope: &Zonotope,
        projection: &[usize],
        stride: usize,
        found: &mut CasePoints,
    ) {
        let noise: Vec<f64> = projection.iter().map(|i| self.noise[*i]).collect();
        let rows = GeneratorRows::of_zonotope(zonotope, projection, &noise);
        let here = self.runs.iter().filter(|(_, run)| sample < run.len());
        let recorded: Vec<(usize, &[f64])> =
            here.map(|(index, run)| (*index, run.state(sample))).collect();
        found.points += recorded.len();
        let deviation = |(run, x): &(usize, &[f64])| -> (usize, Vec<f64>) {
            (*run, projection.iter().map(|&i| x[i] - zonotope.centre()[i]).collect())
        };
        let mut left: Vec<(usize, Vec<f64>)> = recorded.iter().map(deviation).collect();
        // Smaller sets first.
        for parts in HELD {
            let held = sample.div_ceil(parts);
            if held > 1 && !left.is_empty() {
                left = unproved(&Membership::new(&rows.merged(stride, held)), left);
            }
        }
        if left.is_empty() {
            return;
        }
        let set = Membership::new(&rows);
        let proof = MembershipProof::new(&set);
        let of_point = |work: &mut _, (run, d): (usize, Vec<f64>)| {
            if holds(&set, proof.as_ref(), &d, SLACK[0], work) {
                return None;
            }
            let ratio = match set.locate(&d, OUTSIDE, work) {
                Place::Outside { ratio, .. } => Some(ratio),
                _ if holds(&set, proof.as_ref(), &d, SLACK[1], work) => return None,
                _ => None,
            };
            Some((UnprovedPoint { run, is_outside: ratio.is_some() }, ratio, d))
        };
        let unproved: Vec<_> =
            left.into_par_iter().map_init(|| set.workspace(), of_point).flatten().collect();
        found.unproved.extend(unproved.iter().map(|(point, ..)| *point));
        let outside = unproved.iter().filter_map(|(point, ratio, d)| Some((point, (*ratio)?, d)));
        let worst = outside.max_by(|a, b| a.1.total_cmp(&b.1));
        found.furthest.extend(worst.and_then(|(point, _, d)| {
            let (ratio, short) = set.gauge(d, GAUGE, &mut set.workspace())?;
            let spread = |values: &[f64]| {
                let mut all = vec![0.0; self.noise.len()];
                projection.iter().zip(values).for_each(|(&i, x)| all[i] = *x);
                all
            };
            let direction = spread(&short);
            let along = recorded.iter().map(|(run, x)| (*run, dot(&direction, x)));
            let (bound_run, bound) = along.max_by(|a, b| a.1.total_cmp(&b.1))?;
            Some(FurthestPoint {
                sample,
                run: point.run,
                ratio,
                deviation: spread(d),
                bound,
                bound_run,
                reach: reach(zonotope, &direction),
                direction,
            })
        }));
    }
}

/// Returns max lᵀ x over a zonotope, in floating point.
fn reach(zonotope: &Zonotope, l: &[f64]) -> f64 {
    dot(l, zonotope.centre()) + zonotope.generators().map(|g| dot(l, g).abs()).sum::<f64>()
}

/// Returns the points, with their runs, that are not proved to lie in a set.
fn unproved(set: &Membership, points: Vec<(usize, Vec<f64>)>) -> Vec<(usize, Vec<f64>)> {
    let Some(proof) = MembershipProof::new(set) else { return points };
    let left = |work: &mut _, point: (usize, Vec<f64>)| {
        (!holds(set, Some(&proof), &point.1, SLACK[0], work)).then_some(point)
    };
    points.into_par_iter().map_init(|| set.workspace(), left).flatten().collect()
}

/// Returns whether a recorded point less the centre of a set, which is not exact, is proved to lie
/// in the set about 0.
fn holds(
    set: &Membership,
    proof: Option<&MembershipProof>,
    d: &[f64],
    slack: f64,
    work: &mut MembershipWorkspace,
) -> bool {
    let error: Vec<f64> = d.iter().map(|x| f64::EPSILON * x.abs() + f64::MIN_POSITIVE).collect();
    proof.is_some_and(|proof| proves(set, proof, d, &error, slack, work))
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
