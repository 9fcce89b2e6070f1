use crate::error::{Error, Result};
use crate::fit::evaluation::{FitModel, FitTask, Smallest, StepRow};
use crate::fit::slopes::Slopes;
use crate::fit::step::StepProgram;
use crate::program::program::RowIndex;

/// The first trust region: numbers may move by this much.
const FIRST_TRUST: f64 = 0.5;

/// The search ends when the trust region is smaller than this.
const LEAST_TRUST: f64 = 2e-3;

/// The result of a search.
#[derive(Debug, Clone)]
pub(crate) struct FoundNumbers {
    pub numbers: Vec<f64>,
    pub steps: usize,
    /// The cost with the pull.
    pub value: f64,
}

/// The goal of a search.
#[derive(Debug, Clone)]
pub(crate) struct Wanted {
    /// The motion that is not looked at.
    pub left_out: Option<usize>,
    /// Cost of a number's distance from 0.
    pub pull: f64,
    /// The parameters that may move.
    pub free: Vec<usize>,
    pub effort: SearchEffort,
}

/// When a search ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SearchEffort {
    /// It ends when a step promises, or gains, less than this part of the cost.
    pub settled: f64,
    pub steps: usize,
    /// Whether the robot must be physical after each step, at every position that is searched.
    pub is_physical: bool,
}

impl SearchEffort {
    /// For the answer.
    pub(crate) const WHOLE: Self = Self { settled: 5e-5, steps: 40, is_physical: true };
    /// For where to start.
    pub(crate) const START: Self = Self { is_physical: true, ..Self::QUICK };
    /// For comparisons.
    pub(crate) const QUICK: Self = Self { settled: 2e-3, steps: 12, is_physical: false };
}

/// A point of the search.
struct Point {
    numbers: Vec<f64>,
    model: FitModel,
    smallest: Smallest,
}

/// A search over some recordings.
struct Search<'a> {
    fit: &'a FitTask<'a>,
    wanted: &'a Wanted,
    tracks: Vec<usize>,
}

/// What one step of a search hands on to the next.
#[derive(Default)]
struct Known {
    trust: f64,
    /// The recordings that steer.
    chosen: Vec<usize>,
    /// Rows that nearly decide a step, and the sets of a point.
    rows: Vec<StepRow>,
    own_rows: Vec<RowIndex>,
}

impl FitTask<'_> {
    /// Searches the parameters for which the sets of all motions but one cost least, with a pull,
    /// from `start`.
    ///
    /// Derivatives cost most, and few recordings decide the sets. Only the recordings that have
    /// decided them, here or at a step that was not taken, have derivatives and steer a step; the
    /// sets of all recordings decide whether it is taken.
    ///
    /// # Errors
    ///
    /// When the first program is not solved; [`Error::Cancelled`].
    pub(crate) fn search(&self, wanted: &Wanted, start: &[f64]) -> Result<FoundNumbers> {
        Search { fit: self, wanted, tracks: self.tracks(wanted.left_out) }.run(start)
    }
}

impl Search<'_> {
    fn run(&self, start: &[f64]) -> Result<FoundNumbers> {
        let Wanted { free, effort, .. } = self.wanted;
        let mut known = Known { trust: FIRST_TRUST, ..Known::default() };
        let mut point = self.point(start.to_vec(), &mut known.own_rows)?;
        let mut steps = 0;
        while steps < effort.steps {
            self.fit.progress.go_on()?;
            add_deciding(&point, &mut known.chosen);
            let at = (point.numbers.as_slice(), free.as_slice());
            let mut slopes = Slopes::new(self.fit, at, &point.model, &point.smallest)?;
            match slopes.add(&known.chosen) {
                Err(Error::RunsAway { .. }) => break,
                added => added?,
            }
            let Some(next) = self.step(&point, &mut slopes, &mut known) else { break };
            let gained = self.value(&point) - self.value(&next);
            (point, steps) = (next, steps + 1);
            if gained < effort.settled * point.smallest.cost {
                break;
            }
        }
        Ok(FoundNumbers { value: self.value(&point), numbers: point.numbers, steps })
    }

    /// Takes a step from `point`, in a trust region that is small enough for the derivatives;
    /// `None` if no step gains enough.
    fn step(&self, point: &Point, slopes: &mut Slopes, known: &mut Known) -> Option<Point> {
        let Wanted { pull, free, effort, .. } = self.wanted;
        let program = self.fit.program(&point.model, &self.tracks);
        while known.trust >= LEAST_TRUST {
            let step = StepProgram {
                fit: self.fit,
                model: &point.model,
                slopes: &slopes.list,
                program: &program,
                tracks: &known.chosen,
                numbers: &point.numbers,
                smallest: &point.smallest,
                trust: known.trust,
                free,
                pull: *pull,
            };
            let answer = step.solve(&mut known.rows).ok()?;
            let promised = self.value(point) - answer.cost;
            if promised < effort.settled * point.smallest.cost {
                return None;
            }
            let moved = largest_move(&answer.numbers, &point.numbers);
            if let Ok(next) = self.point(answer.numbers, &mut known.own_rows) {
                let gained = self.value(point) - self.value(&next);
                if gained > 0.1 * promised {
                    if gained > 0.7 * promised && moved > 0.9 * known.trust {
                        known.trust *= 2.0;
                    } else if gained < 0.3 * promised {
                        known.trust = 0.5 * moved;
                    }
                    return Some(next);
                }
                // Recordings may decide there that did not steer the step.
                let count = known.chosen.len();
                let added = add_deciding(&next, &mut known.chosen);
                if !added.is_empty() && slopes.add(&added).is_ok() {
                    continue;
                }
                known.chosen.truncate(count);
            }
            known.trust = 0.35 * moved.min(known.trust);
        }
        None
    }

    fn point(&self, numbers: Vec<f64>, rows: &mut Vec<RowIndex>) -> Result<Point> {
        if self.wanted.effort.is_physical {
            let parameters = self.fit.parameters;
            parameters.check(&parameters.apply(&numbers)?)?;
        }
        let model = self.fit.model(&numbers, &self.tracks)?;
        let smallest = self.fit.smallest_from(&model, &self.tracks, rows)?;
        Ok(Point { numbers, model, smallest })
    }

    fn value(&self, point: &Point) -> f64 {
        point.smallest.cost + self.wanted.pull * size(&point.numbers)
    }
}

/// Adds the recordings that decide the sets at a point to `chosen`. Returns the new ones.
fn add_deciding(point: &Point, chosen: &mut Vec<usize>) -> Vec<usize> {
    let mut added: Vec<usize> = point.smallest.deciding.iter().map(|row| row.0).collect();
    added.sort_unstable();
    added.dedup();
    added.retain(|track| !chosen.contains(track));
    chosen.extend(&added);
    added
}

pub(crate) fn size(numbers: &[f64]) -> f64 {
    numbers.iter().map(|x| x.abs()).sum()
}

fn largest_move(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
