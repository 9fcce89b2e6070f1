//! An exported case: a model over one recorded input, with its sets and our bounds.

use reachtube_arm::OfArm;
use reachtube_conform::data::Case;
use reachtube_conform::{Problem, SuiteReach, Tube, UncertaintySets, reach};
use reachtube_reach::{Disturbance, Hyperrectangle, TimeGrid};
use reachtube_scalar::Interval;

use super::system::System;
use super::text::harmless;
use super::{ExportError, InputForm, Tool};

/// A model over one suite, or over one run with a nominal motion of its own.
#[derive(Debug, Clone)]
pub struct ExportCase {
    /// The model and its robot, in words.
    pub model: String,
    /// The right-hand side.
    pub system: System,
    /// The nominal initial state, 2n.
    pub start: Vec<f64>,
    /// X0 and U about the nominal state and input, and V.
    pub sets: UncertaintySets,
    /// The sample times, which are the tested ones.
    pub grid: TimeGrid,
    /// The input that is held from each sample to the next, samples x n: the recorded one, less the
    /// correction of the model if it has one. Where nominal motions satisfy the robot's equations,
    /// it is the one under which the linear model accelerates as the robot does. The last one acts
    /// on nothing.
    pub inputs: Vec<f64>,
    /// The variation of the disturbance in time.
    pub disturbance: Disturbance,
    /// The nominal motion and our bounds.
    pub reach: SuiteReach,
}

/// An initial state: a point plus a set about it.
#[derive(Debug, Clone, PartialEq)]
pub struct InitialState {
    /// The point, N; 0 for sines and cosines, whose set is absolute.
    pub start: Vec<f64>,
    /// The set about it, N.
    pub set: Hyperrectangle,
}

impl ExportCase {
    /// Takes every case of a problem, with the reachable sets under the sets of `tube`.
    ///
    /// # Errors
    ///
    /// As [`Problem::cases`] and [`reach`](reach()); a suite of a single sample.
    pub fn all(problem: &Problem, tube: &Tube) -> Result<Vec<Self>, ExportError> {
        let reached = reach(problem, tube)?;
        let cases = problem.cases()?.iter().zip(reached);
        cases.map(|(case, reach)| Self::new(problem, tube, case, reach)).collect()
    }

    fn new(
        problem: &Problem,
        tube: &Tube,
        case: &Case,
        reach: SuiteReach,
    ) -> Result<Self, ExportError> {
        if case.grid.len() < 2 {
            return Err(ExportError::NoTime { case: case.name.clone() });
        }
        let settings = problem.settings();
        let arm = problem.arm();
        let abstraction = arm.settings.abstraction;
        Ok(Self {
            model: format!(
                "model {} of order {} of {}, {}",
                u32::from(abstraction.model),
                abstraction.order,
                harmless(arm.robot().name()),
                harmless(&case.name)
            ),
            system: System::new(problem.dynamics(), arm.robot().kinds()),
            start: case.start.clone(),
            sets: problem.sets_along(&tube.sets, case)?.into_owned(),
            grid: case.grid.as_ref().clone(),
            inputs: case.inputs.to_vec(),
            disturbance: settings.disturbance,
            reach,
        })
    }

    /// Returns the number of joints n.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.system.inputs.len()
    }

    /// Returns the input held from sample `k` on, n.
    #[must_use]
    pub fn input(&self, k: usize) -> &[f64] {
        &self.inputs[k * self.joints()..(k + 1) * self.joints()]
    }

    /// Returns the number of steps from sample to sample.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.grid.len() - 1
    }

    /// Returns the time of the last sample, s.
    #[must_use]
    pub fn horizon(&self) -> f64 {
        self.grid.times()[self.steps()]
    }

    /// Returns the tested step, s: the step of the samples, or the mean if they have none.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.grid.step().unwrap_or(self.horizon() / self.steps() as f64)
    }

    /// Returns the step of equally spaced samples.
    ///
    /// # Errors
    ///
    /// [`ExportError::NotUniform`], which names `remedy`.
    pub(crate) fn fixed_step(&self, tool: Tool, remedy: &'static str) -> Result<f64, ExportError> {
        let refusal = || ExportError::NotUniform { tool, case: self.reach.name(), remedy };
        self.grid.step().ok_or_else(refusal)
    }

    /// Returns the input set: U about the recorded input, or for [`InputForm::Range`] the box of
    /// all recorded inputs plus U.
    ///
    /// # Guarantee
    ///
    /// Exact, except that the box is rounded outward.
    #[must_use]
    pub fn input_set(&self, form: InputForm) -> Hyperrectangle {
        if form != InputForm::Range {
            return self.sets.input_set.clone();
        }
        let (n, u) = (self.joints(), bounds(&self.sets.input_set));
        let side = |j: usize| {
            let values = || (0..self.steps()).map(|k| self.input(k)[j]);
            let low = values().fold(f64::INFINITY, f64::min);
            let high = values().fold(f64::NEG_INFINITY, f64::max);
            Interval::new(low, high).expect("a recorded input is a finite number") + u[j]
        };
        hyperrectangle((0..n).map(side))
    }

    /// Returns the initial state. The box of sines and cosines encloses their values over X0; they
    /// are no longer tied to their angle.
    ///
    /// # Guarantee
    ///
    /// Exact for q and q̇; outer, with directed rounding, for sines and cosines.
    #[must_use]
    pub fn initial_state(&self, form: InputForm) -> InitialState {
        let mut start = match form {
            InputForm::Deviation => vec![0.0; self.start.len()],
            _ => self.start.clone(),
        };
        let mut set = self.sets.initial_set.clone();
        if self.system.dimension() > start.len() {
            let q = bounds(&set).into_iter().zip(&self.start).zip(&self.system.kinds);
            let pairs =
                q.map(|((deviation, &q), kind)| kind.sin_cos(&(Interval::point(q) + deviation)));
            let (sine, cosine): (Vec<Interval>, Vec<Interval>) = pairs.unzip();
            let extra = hyperrectangle(sine.into_iter().chain(cosine));
            start.extend(vec![0.0; extra.dimension()]);
            set.centre.extend(extra.centre);
            set.radius.extend(extra.radius);
        }
        InitialState { start, set }
    }
}

impl InitialState {
    /// Returns the bounds of each state, N, rounded outward.
    #[must_use]
    pub fn bounds(&self) -> Vec<Interval> {
        let sides = self.start.iter().zip(bounds(&self.set));
        sides.map(|(&x, side)| if x == 0.0 { side } else { Interval::point(x) + side }).collect()
    }
}

/// Returns the sides of a box, rounded outward.
#[must_use]
pub fn bounds(set: &Hyperrectangle) -> Vec<Interval> {
    let sides = set.centre.iter().zip(&set.radius);
    sides.map(|(&c, &r)| Interval::centred(c, r)).collect()
}

fn hyperrectangle(sides: impl Iterator<Item = Interval>) -> Hyperrectangle {
    let (centre, radius) = sides.map(|side| (side.mid(), side.rad())).unzip();
    Hyperrectangle { centre, radius }
}
