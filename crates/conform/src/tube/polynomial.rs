//! A model that is not linear over recordings: outer enclosures of the reachable sets of its state,
//! for each case.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use reachtube_reach::{Flowpipe, GeneratorRows, Zonotope};

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::program::costs::{SampleTimes, distinct_shares};
use crate::sets::UncertaintySets;
use crate::tube::flowpipes::{Effort, attempt, furthest};
use crate::tube::judged::{At, Judged};
use crate::tube::linearised::round;
use crate::tube::plant::{Costs, Plant, Round, Slice, Watch};
use crate::tube::state::SearchState;
use crate::tube::strand::Strand;
use crate::tube::tube::{Enclosure, Tube};

/// Numbers of parts of the time so far, within each of which generators that a step adds have one
/// factor in common: smaller sets, in which most points lie.
const HELD: [usize; 2] = [24, 200];

/// A model that is not linear over recordings. Its strands are cases.
pub(crate) struct Polynomial<'a> {
    pub problem: &'a Problem,
    /// Effort after a set is lost.
    pub effort: Effort,
}

impl<'a> Polynomial<'a> {
    /// Returns the plant that tries hard.
    pub(crate) fn new(problem: &'a Problem) -> Self {
        Self { problem, effort: Effort::Whole }
    }

    /// Computes the outer set of a case; of several attempts the one that comes furthest, and what
    /// was found in that one.
    fn strand(
        &self,
        (index, case): (usize, &Case),
        sets: &UncertaintySets,
        watch: Option<&Watch>,
    ) -> Result<(Strand, Judged)> {
        let system = self.problem.nonlinear().polynomial_system()?;
        let of = |vertices: usize| {
            let (judged, count) = (Mutex::new(Judged::default()), AtomicUsize::new(0));
            let visit = |sample: usize, zonotope: Zonotope| {
                let before = count.swap(zonotope.generators().len(), Ordering::Relaxed);
                let stride = zonotope.generators().len().saturating_sub(before);
                let slice = ZonotopeSlice { zonotope, case: index, sample, stride, sets };
                let Some(watch) = watch.filter(|_| sample > 0) else { return };
                let here = watch(&slice);
                let mut all = judged.lock().expect("no thread panics");
                *all = std::mem::take(&mut *all).merge(here);
            };
            let visit = watch.is_some().then_some(&visit as reachtube_reach::Visit);
            let flowpipe = attempt(system, case, sets, vertices, visit)?;
            Ok((flowpipe, judged.into_inner().expect("no thread panics")))
        };
        let (flowpipe, judged) = furthest(self.effort, of, |(flowpipe, _)| flowpipe)?;
        Ok((Strand::along(case, flowpipe), judged))
    }
}

impl Plant for Polynomial<'_> {
    fn is_exact(&self) -> bool {
        false
    }

    fn round<'a>(
        &'a self,
        state: &mut SearchState,
        before: Option<Round<'a>>,
    ) -> Result<Round<'a>> {
        // Two programs would take twice the memory.
        drop(before);
        round(self.problem, state)
    }

    fn tube(&self, sets: &UncertaintySets, watch: Option<&Watch>) -> Result<(Tube, Judged)> {
        let cases = self.problem.cases()?.par_iter().enumerate();
        let found: Vec<(Strand, Judged)> =
            cases.map(|case| self.strand(case, sets, watch)).collect::<Result<_>>()?;
        let (strands, judged): (Vec<Strand>, Vec<Judged>) = found.into_iter().unzip();
        let judged = judged.into_iter().fold(Judged::default(), Judged::merge);
        Ok((Tube::of(sets.clone(), Enclosure::Outer, strands), judged))
    }

    fn centre(&self, tube: &Tube, (strand, sample): At) -> Vec<f64> {
        let flowpipe = flowpipe(&tube.strands[strand as usize]);
        flowpipe.sample(sample as usize).iter().map(|side| side.mid()).collect()
    }

    fn costs(&self, tube: &Tube) -> Result<Costs> {
        let weights = self.problem.settings().weights.of_states(self.problem.states());
        let times = tube.strands.iter().map(|strand| strand.times.times());
        let (shares, SampleTimes { parts, step }) =
            (distinct_shares(times.clone()), SampleTimes::new(times));
        let mut costs = Costs::NONE;
        for ((strand, shares), parts) in tube.strands.iter().zip(&shares).zip(&parts) {
            let flowpipe = flowpipe(strand);
            for (k, (share, part)) in shares.iter().zip(parts).enumerate() {
                if k >= flowpipe.len() {
                    return Ok(Costs::LOST);
                }
                let widths = flowpipe.sample(k).iter().map(|hull| hull.width()).enumerate();
                let widths = widths.map(|(i, width)| width + 2.0 * tube.sets.noise_radius(i));
                let weighted = widths.clone().zip(&weights).map(|(width, weight)| weight * width);
                let (weighted, time) = (weighted.sum::<f64>(), part * step);
                costs.cost += time * weighted;
                costs.of_samples += share * weighted;
                if k + 1 < parts.len() {
                    costs.volume += time * widths.product::<f64>();
                }
            }
        }
        Ok(costs)
    }
}

fn flowpipe(strand: &Strand) -> &Flowpipe {
    strand.flowpipe().expect("the tubes of this plant have flowpipes")
}

/// The computed outer set of a case at one sample.
struct ZonotopeSlice<'a> {
    zonotope: Zonotope,
    case: usize,
    sample: usize,
    /// Number of generators that the last step added.
    stride: usize,
    sets: &'a UncertaintySets,
}

impl Slice for ZonotopeSlice<'_> {
    fn at(&self) -> At {
        (self.case as u32, self.sample as u32)
    }

    fn centre(&self) -> (Vec<f64>, Vec<f64>) {
        let centre = self.zonotope.centre().to_vec();
        let exact = vec![0.0; centre.len()];
        (centre, exact)
    }

    fn generators(&self, states: &[usize], held: usize) -> GeneratorRows {
        let noise: Vec<f64> = states.iter().map(|i| self.sets.noise_radius(*i)).collect();
        let rows = GeneratorRows::of_zonotope(&self.zonotope, states, &noise);
        if held == 1 { rows } else { rows.merged(self.stride, held) }
    }

    fn coarse(&self) -> Vec<usize> {
        HELD.map(|parts| self.sample.div_ceil(parts)).to_vec()
    }

    fn support(&self, l: &[f64]) -> f64 {
        let along = |x: &[f64]| l.iter().zip(x).map(|(l, x)| l * x).sum::<f64>();
        along(self.zonotope.centre())
            + self.zonotope.generators().map(|g| along(g).abs()).sum::<f64>()
    }
}
