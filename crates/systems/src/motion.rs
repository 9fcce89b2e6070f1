//! The nominal motions of recordings, and how far recorded outputs deviate from them.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use reachtube_reach::{IntervalVector, Propagation};
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{sub_down, sub_up};

use crate::description::{NominalStartRule, SystemKind};
use crate::error::{Error, Result};
use crate::run::SystemRun;
use crate::system::OutputSystem;

/// Singular values below this part of the largest one count as 0.
const RANK: f64 = 1e-9;

/// What of a recording a model has to hold.
#[derive(Debug, Clone)]
pub(crate) struct RunDeviations {
    /// The name of the recording.
    pub run: String,
    /// The number of its time between samples, from 0.
    pub of_step: usize,
    /// Recorded minus nominal outputs, row-major K x p, enclosed.
    pub outputs: Vec<Interval>,
}

/// The solutions of a system for samples that are one time apart.
#[derive(Debug)]
pub(crate) struct StepSolutions {
    /// The time between samples, s.
    pub step: f64,
    /// The solution, as long as the longest recording.
    pub propagation: Propagation,
}

/// A system along recordings.
#[derive(Debug)]
pub(crate) struct NominalMotions {
    /// The solutions, one for each time between samples.
    pub solutions: Vec<StepSolutions>,
    /// The recordings.
    pub deviations: Vec<RunDeviations>,
    /// Over how many first samples starts are estimated; 0 if they are known.
    pub start_samples: usize,
    /// Whether the outputs of these samples do not tell all states.
    pub is_unobserved: bool,
}

impl NominalMotions {
    /// Solves a system along recordings.
    ///
    /// # Guarantee
    ///
    /// Outer: recorded minus nominal outputs lie in the deviations, directed rounding. The nominal
    /// start and inputs are what they are in double precision.
    pub(crate) fn new(system: &OutputSystem, runs: &[SystemRun]) -> Result<Self> {
        let steps = runs.iter().map(|run| system.step_of(run)).collect::<Result<Vec<f64>>>()?;
        let mut distinct = steps.clone();
        distinct.sort_by(f64::total_cmp);
        distinct.dedup();
        let solution = |step: &f64| {
            let own = runs.iter().zip(&steps).filter(|(_, own)| *own == step);
            let count = own.map(|(run, _)| run.len()).max().unwrap_or(0);
            Ok(StepSolutions { step: *step, propagation: system.propagation(*step, count)? })
        };
        system.refuse_long_delays(runs)?;
        let solutions = distinct.iter().map(solution).collect::<Result<Vec<_>>>()?;
        let estimates: Vec<StartEstimate> =
            solutions.iter().map(|of| StartEstimate::new(system, &of.propagation)).collect();
        let of_run = |(run, step): (&SystemRun, &f64)| {
            let at = distinct.partition_point(|other| other < step);
            let solved = &solutions[at];
            let start = system.start(run, solved, &estimates[at])?;
            Ok(RunDeviations {
                run: run.name.clone(),
                of_step: at,
                outputs: system.deviations(run, solved, &start),
            })
        };
        let deviations = runs.par_iter().zip(&steps).map(of_run).collect::<Result<_>>()?;
        let is_estimated = runs.iter().any(|run| system.known_start(run).is_none());
        let used = estimates.iter().filter(|_| is_estimated);
        Ok(Self {
            deviations,
            start_samples: used.clone().map(|of| of.samples).max().unwrap_or(0),
            is_unobserved: used.clone().any(|of| of.rank < system.a.nrows()),
            solutions,
        })
    }
}

/// How first samples tell where a motion starts.
pub(crate) struct StartEstimate {
    /// The number of samples.
    samples: usize,
    /// How many directions of the state they tell.
    rank: usize,
    /// The state that fits outputs (samples x p) best is this times them.
    inverse: DMatrix<f64>,
}

impl StartEstimate {
    /// Finds how many samples are needed: as many as the system says, or twice as many as tell all
    /// states.
    fn new(system: &OutputSystem, propagation: &Propagation) -> Self {
        let (n, count) = (system.a.nrows(), propagation.grid().len());
        let seen = |samples: usize| {
            let rows: Vec<DMatrix<f64>> = (0..samples)
                .map(|k| &system.c * propagation.exponential(k).map(|x| x.mid()))
                .collect();
            let mut all = DMatrix::zeros(samples * system.outputs(), n);
            for (k, own) in rows.iter().enumerate() {
                all.rows_mut(k * own.nrows(), own.nrows()).copy_from(own);
            }
            all
        };
        let rank = |all: &DMatrix<f64>| {
            let values = all.clone().singular_values();
            values.iter().filter(|value| **value > RANK * values.max()).count()
        };
        let samples = match system.description().start {
            Some(NominalStartRule::Samples(samples)) => samples.min(count),
            _ => {
                let longest = n.min(count);
                let best = rank(&seen(longest));
                let least = (1..=longest).find(|k| rank(&seen(*k)) == best).unwrap_or(longest);
                (2 * least).min(count)
            }
        };
        let all = seen(samples);
        let largest = all.clone().singular_values().max();
        let inverse = all.clone().pseudo_inverse(RANK * largest).unwrap_or(all.transpose() * 0.0);
        Self { samples, rank: rank(&all), inverse }
    }
}

impl OutputSystem {
    /// Refuses an input that acts after the end of all recordings.
    fn refuse_long_delays(&self, runs: &[SystemRun]) -> Result<()> {
        let longest = runs.iter().filter_map(|run| run.times.last().copied()).fold(0.0, f64::max);
        let mut delays = self.description().inputs.iter().zip(&self.delays);
        let Some((input, delay)) = delays.find(|(_, delay)| **delay >= longest) else {
            return Ok(());
        };
        let problem = format!(
            "the delay of {} is {delay} s, and no recording is longer than {longest} s; give it \
             in s",
            input.name()
        );
        Err(Error::System { file: None, problem })
    }

    /// Returns where a recording starts, if that need not be estimated.
    fn known_start(&self, run: &SystemRun) -> Option<Vec<f64>> {
        match &self.description().start {
            Some(NominalStartRule::At(start)) => Some(start.clone()),
            Some(NominalStartRule::Samples(_)) => None,
            Some(NominalStartRule::Columns | NominalStartRule::Past { .. }) | None => {
                run.states.clone()
            }
        }
    }

    /// Returns the nominal start of a recording.
    fn start(
        &self,
        run: &SystemRun,
        solved: &StepSolutions,
        estimate: &StartEstimate,
    ) -> Result<Vec<f64>> {
        if let Some(start) = self.known_start(run) {
            return Ok(start);
        }
        if self.description().start == Some(NominalStartRule::Columns) {
            let states = Self::names(&self.description().states);
            return Err(Error::NoStates { run: run.name.clone(), states });
        }
        if run.len() < estimate.samples {
            let (samples, needed) = (run.len(), estimate.samples);
            return Err(Error::Short { run: run.name.clone(), samples, needed });
        }
        let free =
            self.deviations(&run.before(estimate.samples), solved, &vec![0.0; self.a.nrows()]);
        let rest = DVector::from_iterator(free.len(), free.iter().map(|x| x.mid()));
        Ok((&estimate.inverse * rest).data.into())
    }

    /// Returns the inputs that act in each step, in the order of the columns of
    /// [`propagation`](Self::propagation), and the inputs of the outputs at each sample, K x m.
    fn acting_inputs(&self, run: &SystemRun, step: f64) -> (Vec<f64>, Vec<f64>) {
        let (m, count) = (self.description().inputs.len(), run.len());
        let delays = self.delays_in(step);
        let is_continuous = self.description().kind == SystemKind::Continuous;
        let before = |k: usize, steps: usize, i: usize| run.inputs[k.saturating_sub(steps) * m + i];
        let late: Vec<usize> = (0..m).filter(|i| is_continuous && delays[*i].1 > 0.0).collect();
        let (mut acting, mut seen) = (Vec::new(), Vec::with_capacity(count * m));
        for k in 0..count {
            for (i, (whole, part)) in delays.iter().enumerate() {
                let [new, old] = [before(k, *whole, i), before(k, whole + 1, i)];
                // Between samples, the input of a discrete system is taken as linear.
                let between = if *part == 0.0 { new } else { (1.0 - part) * new + part * old };
                acting.push(if is_continuous { new } else { between });
                let held = if *part == 0.0 { new } else { old };
                seen.push(if is_continuous { held } else { between });
            }
            acting.extend(late.iter().map(|i| before(k, delays[*i].0 + 1, *i)));
            acting.extend(std::iter::repeat_n(0.0, self.e.ncols()));
        }
        (acting, seen)
    }

    /// Returns recorded minus nominal outputs of a recording, in floating point.
    pub(crate) fn rough_errors(&self, run: &SystemRun) -> Result<Vec<f64>> {
        let (n, m, p) = (self.a.nrows(), self.description().inputs.len(), self.outputs());
        let step = self.step_of(run)?;
        // A start is estimated from no more samples than these.
        let few = match self.description().start {
            Some(NominalStartRule::Samples(samples)) => samples,
            _ => 2 * n,
        };
        let solved = StepSolutions { step, propagation: self.propagation(step, few.max(2))? };
        let estimate = StartEstimate::new(self, &solved.propagation);
        let mut state = DVector::from_vec(self.start(run, &solved, &estimate)?);
        let of_step = solved.propagation.step(0);
        let [phi, gamma] = [&of_step.phi, &of_step.gamma].map(|matrix| matrix.map(|x| x.mid()));
        let (acting, seen) = self.acting_inputs(run, step);
        let width = gamma.ncols();
        let (mut errors, mut next) = (Vec::with_capacity(run.outputs.len()), state.clone());
        for k in 0..run.len() {
            for i in 0..p {
                let states = self.c.row(i).iter().zip(&state).map(|(c, x)| c * x).sum::<f64>();
                let inputs = self.d.row(i).into_iter().zip(&seen[k * m..]).map(|(d, u)| d * u);
                errors.push(run.outputs[k * p + i] - states - inputs.sum::<f64>());
            }
            next.gemv(1.0, &phi, &state, 0.0);
            for (column, u) in gamma.column_iter().zip(&acting[k * width..]) {
                next.axpy(*u, &column, 1.0);
            }
            std::mem::swap(&mut state, &mut next);
        }
        Ok(errors)
    }

    /// Returns recorded minus nominal outputs of a recording, from a nominal start on.
    fn deviations(&self, run: &SystemRun, solved: &StepSolutions, start: &[f64]) -> Vec<Interval> {
        let (acting, seen) = self.acting_inputs(run, solved.step);
        let start = start.iter().map(|x| Interval::point(*x));
        let start = IntervalVector::from_iterator(self.a.nrows(), start);
        let motion = solved.propagation.solve(&start, &acting);
        let m = self.description().inputs.len();
        let output = |(k, i): (usize, usize)| {
            let states = self.c.row(i).into_iter().zip(motion.state(k).iter().copied());
            let inputs = seen[k * m..(k + 1) * m].iter().map(|u| Interval::point(*u));
            let terms = states.chain(self.d.row(i).into_iter().zip(inputs));
            let nominal = terms.filter(|(factor, _)| **factor != 0.0).map(times);
            let nominal = nominal.reduce(|sum, term| sum + term).unwrap_or(Interval::ZERO);
            let recorded = run.outputs[k * self.outputs() + i];
            let ends = [sub_down(recorded, nominal.hi()), sub_up(recorded, nominal.lo())];
            Interval::new(ends[0], ends[1]).unwrap_or(Interval::ENTIRE)
        };
        let rows = (0..run.len()).flat_map(|k| (0..self.outputs()).map(move |i| (k, i)));
        rows.map(output).collect()
    }
}

/// Encloses a product; exact for a factor of 1.
fn times((factor, of): (&f64, Interval)) -> Interval {
    if *factor == 1.0 { of } else { of * *factor }
}
