use crate::error::{Error, Result};
use crate::fit::evaluation::{FitModel, FitTask, Smallest, StepRow};
use crate::fit::group::Group;
use crate::fit::slopes::slopes;
use crate::fit::step::StepProgram;
use crate::program::program::RowIndex;

/// The first trust region: numbers may move by this much.
const FIRST_TRUST: f64 = 0.5;

/// The search ends when the trust region is smaller than this.
const LEAST_TRUST: f64 = 2e-3;

/// What a search found.
#[derive(Debug, Clone)]
pub(crate) struct FoundNumbers {
    /// The numbers of the parameters.
    pub numbers: Vec<f64>,
    /// Number of steps that were accepted.
    pub steps: usize,
    /// The cost with the pull.
    pub value: f64,
}

/// The parameters for which the sets of some tracks cost least, with a pull.
pub(crate) struct Search<'a> {
    pub fit: &'a FitTask<'a>,
    pub tracks: Vec<usize>,
    /// Cost of a number's distance from 0.
    pub pull: f64,
    /// Groups whose numbers stay as they are.
    pub held: Vec<Group>,
    pub effort: SearchEffort,
}

/// When a search ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SearchEffort {
    /// It ends when a step promises, or gains, less than this part of the cost.
    pub settled: f64,
    /// Steps at most.
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

impl Search<'_> {
    /// Searches from `start`.
    ///
    /// # Errors
    ///
    /// When the first program is not solved; [`Error::Cancelled`].
    pub(crate) fn run(&self, start: &[f64]) -> Result<FoundNumbers> {
        let (mut rows, mut own_rows) = (Vec::<StepRow>::new(), Vec::new());
        let mut point = self.point(start.to_vec(), &mut own_rows)?;
        let (mut trust, mut steps) = (FIRST_TRUST, 0);
        'search: for _ in 0..self.effort.steps {
            self.fit.progress.go_on()?;
            let at = (point.numbers.as_slice(), self.held.as_slice());
            let slopes = slopes(self.fit, at, &self.tracks, &point.model, &point.smallest);
            let slopes = match slopes {
                Err(Error::RunsAway { .. }) => break 'search,
                slopes => slopes?,
            };
            let program = self.fit.program(&point.model, &self.tracks);
            loop {
                let step = StepProgram {
                    fit: self.fit,
                    model: &point.model,
                    slopes: &slopes,
                    program: &program,
                    tracks: &self.tracks,
                    numbers: &point.numbers,
                    smallest: &point.smallest,
                    trust,
                    held: &self.held,
                    pull: self.pull,
                };
                let Ok(answer) = step.solve(&mut rows) else { break 'search };
                let promised = self.value(&point) - answer.cost;
                if promised < self.effort.settled * point.smallest.cost {
                    break 'search;
                }
                let moved = largest_move(&answer.numbers, &point.numbers);
                let next = self.point(answer.numbers, &mut own_rows).ok();
                let gained =
                    next.as_ref().map_or(-1.0, |next| self.value(&point) - self.value(next));
                if let Some(next) = next.filter(|_| gained > 0.1 * promised) {
                    if gained > 0.7 * promised && moved > 0.9 * trust {
                        trust *= 2.0;
                    } else if gained < 0.3 * promised {
                        trust = 0.5 * moved;
                    }
                    (point, steps) = (next, steps + 1);
                    if gained < self.effort.settled * point.smallest.cost {
                        break 'search;
                    }
                    break;
                }
                trust = 0.35 * moved.min(trust);
                if trust < LEAST_TRUST {
                    break 'search;
                }
            }
        }
        Ok(FoundNumbers { value: self.value(&point), numbers: point.numbers, steps })
    }

    fn point(&self, numbers: Vec<f64>, rows: &mut Vec<RowIndex>) -> Result<Point> {
        if self.effort.is_physical {
            self.fit.parameters.apply(&numbers)?.robot.check_physical()?;
        }
        let model = self.fit.model(&numbers, &self.tracks, None)?;
        let smallest = self.fit.smallest_from(&model, &self.tracks, rows)?;
        Ok(Point { numbers, model, smallest })
    }

    /// The cost with the pull.
    fn value(&self, point: &Point) -> f64 {
        point.smallest.cost + self.pull * point.numbers.iter().map(|x| x.abs()).sum::<f64>()
    }
}

fn largest_move(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
