use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::problem::Problem;
use crate::error::Result;
use crate::sets::UncertaintySets;
use crate::tube::judged::{At, Judged};
use crate::tube::rows::{RecordedBounds, Row, rows};
use crate::tube::strand::{Lost, Strand};

/// The reachable set that recordings are compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Enclosure {
    /// The hull of the set, taken from inside: a value in it is reachable in that state.
    #[default]
    Inner,
    /// A computed set around the reachable set: what a formal analysis uses, and all that can be
    /// computed for a model that is not linear.
    Outer,
}

impl Enclosure {
    /// Returns the set's name for messages.
    #[must_use]
    pub fn set_name(self) -> &'static str {
        match self {
            Self::Inner => "reachable set",
            Self::Outer => "computed outer set",
        }
    }
}

/// The reachable sets of a problem's model under some uncertainty sets, at the samples of its
/// recordings.
#[derive(Debug)]
pub struct Tube {
    /// The uncertainty sets.
    pub sets: UncertaintySets,
    /// Which bound of the reachable sets recordings are compared with.
    pub(crate) enclosure: Enclosure,
    /// One for each of the problem's grids if the model is linear, for each of its cases where it
    /// is not.
    pub(crate) strands: Vec<Strand>,
    /// What was found about the recorded points in the sets, once they were judged.
    pub(crate) judged: Option<Judged>,
}

impl Tube {
    pub(crate) fn of(sets: UncertaintySets, enclosure: Enclosure, strands: Vec<Strand>) -> Self {
        Self { sets, enclosure, strands, judged: None }
    }

    pub(crate) fn reaches(&self, (strand, sample): At) -> bool {
        (sample as usize) < self.strands[strand as usize].hull.len()
    }

    pub(crate) fn time(&self, (strand, sample): At) -> f64 {
        self.strands[strand as usize].times.times()[sample as usize]
    }

    /// Returns the radii of the interval hull at a sample with the noise set, 2n; infinite if the
    /// set was lost.
    pub(crate) fn radii(&self, (strand, sample): At) -> Vec<f64> {
        let hull = &self.strands[strand as usize].hull;
        let radius = |i: usize| {
            let bounds = hull.bounds(sample as usize, i);
            bounds.map_or(f64::INFINITY, |bounds| bounds.radius) + self.sets.noise_radius(i)
        };
        (0..self.sets.initial_set.dimension()).map(radius).collect()
    }

    /// Returns the end of the longest recording, s, and the radii of the interval hull with the
    /// noise set at the end of each recording, the largest in each state, 2n; infinite if a
    /// reachable set ends early. Recordings on one grid whose sets differ by the scale of U count
    /// by their mean.
    pub(crate) fn at_end(&self) -> (f64, Vec<f64>) {
        let states = self.sets.initial_set.dimension();
        let mut all = (0.0f64, vec![0.0f64; states]);
        let mut strands = (0..).zip(&self.strands).peekable();
        while let Some((first, strand)) = strands.next() {
            let (sample, time) = strand.end();
            let mut sums: Vec<f64> = self.radii((first, sample as u32));
            sums.iter_mut().for_each(|sum| *sum *= strand.cases as f64);
            let mut cases = strand.cases;
            while let Some((next, other)) = strands.next_if(|(_, other)| strand.shares(other)) {
                cases += other.cases;
                let radii = self.radii((next, sample as u32));
                let pairs = sums.iter_mut().zip(radii);
                pairs.for_each(|(sum, radius)| *sum += radius * other.cases as f64);
            }
            all.0 = all.0.max(time);
            let pairs = all.1.iter_mut().zip(sums);
            pairs.for_each(|(largest, sum)| *largest = largest.max(sum / cases as f64));
        }
        all
    }

    /// Returns the smallest and the largest radius of the hull in a state at the end of a
    /// recording, with the noise set; infinite where a reachable set ends early. They differ on one
    /// grid where U grows with the nominal motion.
    #[must_use]
    pub fn range_at_end(&self, state: usize) -> [f64; 2] {
        let strands = (0..).zip(&self.strands);
        let radii = strands.map(|(at, strand)| self.radii((at, strand.end().0 as u32))[state]);
        radii.fold([f64::INFINITY, 0.0], |[a, b], radius| [a.min(radius), b.max(radius)])
    }

    /// Returns where reachable sets, or nominal motions, could not be followed to the end.
    pub(crate) fn lost(&self, problem: &Problem) -> Result<Vec<Lost>> {
        let of_sets = self.strands.iter().filter_map(|strand| strand.lost.clone());
        let runaways = match problem.dynamics().linear_system() {
            Some(_) => &problem.deviations_until()?.runaways[..],
            None => &[],
        };
        Ok(of_sets.chain(runaways.iter().map(Lost::from)).collect())
    }

    /// Hands every row of every suite to `visit`.
    ///
    /// # Guarantee
    ///
    /// As [`rows`]: deviations of a linear model are outer and its hulls inner; for any other model
    /// measured states are compared with the outer enclosure.
    pub(crate) fn for_each_row(
        &self,
        problem: &Problem,
        mut visit: impl FnMut(&Row),
    ) -> Result<()> {
        let states = problem.settings().states;
        for recorded in RecordedBounds::all(problem)? {
            rows(&recorded, &self.strands[recorded.strand], &self.sets, states, &mut visit);
        }
        Ok(())
    }
}
