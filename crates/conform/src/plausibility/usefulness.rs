use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::problem::Problem;
use crate::data::suite::Suite;
use crate::plausibility::nominal_fit::NominalFit;
use crate::sets::UncertaintySets;
use crate::tube::tube::Tube;

/// The share of a part's range over all recordings that counts as its motion within one recording
/// at least, so that a part that rests there decides nothing.
const PART_OF_RANGE: f64 = 0.05;

/// X0 that is wider than what the recorded starts and the noise of the sensors explain by more than
/// this factor is vacuous ...
const FACTOR_OF_STARTS: f64 = 5.0;

/// ... where it is also wider than this part of the recorded motion.
const PART_OF_MOTION: f64 = 0.5;

/// Inputs and widths below this, N m, rad or rad/s, are rounding.
const SMALLEST: f64 = 1e-6;

/// Width of the sets beside the motion of each part. Sets that were proved to enclose every
/// recording may be so wide that they imply nothing; the model is then vacuous.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Usefulness {
    /// The end of the longest recording, s, to which the widths belong.
    pub horizon: f64,
    /// The width of the reachable set beside the motion, one entry for each part.
    pub parts: Vec<PartWidth>,
    /// The vacuous sets; none of a model that is useful.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) vacuous: Vec<Vacuity>,
}

/// The reachable set of a part's position at the end of the recordings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartWidth {
    /// Half the width of the set with V, rad (m); `None` if the reachable set was lost.
    pub half_width: Option<f64>,
    /// The root mean square over the suites of the part's largest distance from its start, and at
    /// least 5 % of its range over all recordings, rad (m).
    pub displacement: f64,
}

/// A vacuous set of one part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Vacuity {
    /// The part, from 1.
    pub part: usize,
    /// The set.
    pub set: VacuousSet,
    /// Its width.
    pub size: f64,
    /// What it is compared with: the motion of the part over all recordings, or the width that
    /// starts and noise explain.
    pub compared_with: f64,
}

/// Which set is vacuous.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum VacuousSet {
    /// The reachable set of the position.
    Reachable,
    /// X0 of the position.
    InitialPosition,
    /// X0 of the velocity.
    InitialVelocity,
}

impl PartWidth {
    /// Returns half the width of the set by the displacement: below 0.5 the set is useful, above 1
    /// it is vacuous. Infinite where the set was lost.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.half_width.map_or(f64::INFINITY, |half_width| half_width / self.displacement)
    }
}

impl Usefulness {
    pub(crate) fn new(problem: &Problem, tube: &Tube, fit: &NominalFit) -> Self {
        let n = problem.inputs();
        let (horizon, radii) = tube.at_end();
        let half_width = |part: usize| radii[part].is_finite().then_some(radii[part]);
        let displacement = |part: usize| displacement(problem, fit, part);
        let width =
            |part| PartWidth { half_width: half_width(part), displacement: displacement(part) };
        let parts: Vec<PartWidth> = (0..n).map(width).collect();
        // A single sample shows no motion to compare with.
        let compared = if horizon > 0.0 { n } else { 0 };
        let vacuous = (0..compared)
            .flat_map(|part| {
                let reachable = of_reachable_set(fit, &parts[part], part);
                reachable.into_iter().chain(of_sets(problem, &tube.sets, fit, part))
            })
            .collect();
        Self { horizon, parts, vacuous }
    }

    /// Returns the largest ratio of half a part's set to its displacement, and the part, from 0.
    #[must_use]
    pub fn worst(&self) -> Option<(usize, f64)> {
        let ratios = self.parts.iter().map(PartWidth::ratio).enumerate();
        ratios.max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

fn displacement(problem: &Problem, fit: &NominalFit, part: usize) -> f64 {
    let suites = &problem.recordings().suites;
    let middle = |suite: &Suite, k: usize| {
        0.5 * (suite.envelope.lower(k, part) + suite.envelope.upper(k, part))
    };
    let moved = |suite: &Suite| {
        let distances =
            (0..suite.envelope.len()).map(|k| (middle(suite, k) - middle(suite, 0)).abs());
        distances.fold(0.0, f64::max)
    };
    let moving = suites.iter().filter(|suite| !suite.envelope.is_empty());
    let squares: f64 = moving.map(|suite| moved(suite).powi(2)).sum();
    let [low, high] = fit.recorded[part];
    (squares / suites.len().max(1) as f64).sqrt().max(PART_OF_RANGE * (high - low)).max(SMALLEST)
}

fn of_reachable_set(fit: &NominalFit, width: &PartWidth, part: usize) -> Option<Vacuity> {
    let [low, high] = fit.recorded[part];
    let (size, compared_with) = (2.0 * width.half_width?, high - low);
    let is_vacuous = size > compared_with && size > SMALLEST;
    let set = VacuousSet::Reachable;
    is_vacuous.then_some(Vacuity { part: part + 1, set, size, compared_with })
}

fn of_sets(
    problem: &Problem,
    sets: &UncertaintySets,
    fit: &NominalFit,
    part: usize,
) -> Vec<Vacuity> {
    let n = problem.inputs();
    let initial = |set: VacuousSet, i: usize| {
        let (low, high) = sets.initial_set.bounds(i);
        let explained = 2.0 * (fit.farthest_starts[i] + problem.sensor_noise().radius[i]);
        let [first, last] = fit.recorded[i];
        let limit = (FACTOR_OF_STARTS * explained).max(PART_OF_MOTION * (last - first));
        let (size, part) = (high - low, part + 1);
        let is_vacuous = size > limit.max(SMALLEST);
        is_vacuous.then_some(Vacuity { part, set, size, compared_with: explained })
    };
    let sets = [(VacuousSet::InitialPosition, part), (VacuousSet::InitialVelocity, n + part)];
    sets.into_iter().filter_map(|(set, i)| initial(set, i)).collect()
}
