use std::fmt::Write;

use reachtube_files::SealedFile;
use reachtube_scalar::Interval;

use crate::error::{Error, Result};
use crate::model::SystemModel;
use crate::motion::NominalMotions;
use crate::rows::SetRows;
use crate::run::SystemRun;
use crate::system::OutputSystem;

/// Most samples of a motion that is not recorded.
const MOST_SAMPLES: f64 = 1e6;

/// The reachable outputs along a recording, at its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputTube {
    /// The recording.
    pub run: String,
    /// Times since its first sample, s.
    pub times: Vec<f64>,
    /// The nominal outputs, row-major K x p, to nearest.
    pub nominal: Vec<f64>,
    /// The lowest and the highest reachable outputs, K x p each.
    pub bounds: [Vec<f64>; 2],
}

impl SystemModel {
    /// Makes the model of a system whose sets are all given.
    ///
    /// # Errors
    ///
    /// [`Error::System`] for a system with sets that are to be found.
    pub fn given(system: &OutputSystem) -> Result<Self> {
        let [start, disturbance, noise] = &system.forms;
        if system.forms.iter().any(|form| form.factors > 0) {
            let problem = "the sets of the system are to be found; give X0, W and V with fixed = \
                           true, or as \"none\", or find them with `conform --system` first";
            return Err(Error::System { file: None, problem: problem.into() });
        }
        let sets = crate::rows::SystemSets {
            start: start.with(&[], &[]),
            disturbance: disturbance.with(&[], &[]),
            noise: noise.with(&[], &[]),
        };
        Ok(Self::new(system.description().clone(), sets).sealed())
    }

    /// Computes the reachable outputs along recordings. Their recorded outputs count only where
    /// they tell the start.
    ///
    /// # Guarantee
    ///
    /// The bounds enclose the hull of the reachable set of each output, which is exact up to
    /// rounding; directed rounding.
    ///
    /// # Errors
    ///
    /// Recordings that do not fit the system.
    pub fn reach(&self, runs: &[SystemRun]) -> Result<Vec<OutputTube>> {
        let system = self.system()?;
        let runs = system.with_past(runs)?;
        let motions = NominalMotions::new(&system, &runs)?;
        let rows = SetRows::new(&system, &motions);
        let p = system.outputs();
        let of = |(run, own): (&SystemRun, &crate::motion::RunDeviations)| {
            let (mut bounds, mut nominal) = ([Vec::new(), Vec::new()], Vec::new());
            for (at, (recorded, deviation)) in run.outputs.iter().zip(&own.outputs).enumerate() {
                let hull = rows.hull(own.of_step, at / p, at % p, &self.sets);
                let middle = Interval::point(*recorded) - *deviation;
                let centre = middle + hull.centre;
                bounds[0].push((centre - hull.radius).lo());
                bounds[1].push((centre + hull.radius).hi());
                nominal.push(middle.mid());
            }
            OutputTube { run: run.name.clone(), times: run.times.clone(), nominal, bounds }
        };
        Ok(runs.iter().zip(&motions.deviations).map(of).collect())
    }

    /// Computes the reachable outputs from the start of the description on, with inputs of 0, up to
    /// `until` s. A continuous system has samples every `step` s.
    ///
    /// # Guarantee
    ///
    /// As [`reach`](Self::reach).
    ///
    /// # Errors
    ///
    /// [`Error::System`] without a start, or without a step.
    pub fn reach_until(&self, until: f64, step: Option<f64>) -> Result<OutputTube> {
        let system = self.system()?;
        let wrong = |problem: &str| Error::System { file: None, problem: problem.into() };
        if system.fixed_start().is_none() {
            return Err(wrong(
                "the system has no start; write start = { at = [..] }, or give recordings",
            ));
        }
        let step = match (self.system.step, step) {
            (Some(step), None) | (None, Some(step)) => step,
            (None, None) => {
                return Err(wrong("a continuous system needs a step, the time between samples"));
            }
            (Some(_), Some(_)) => return Err(wrong("a discrete system has a step of its own")),
        };
        let count = (until / step + 1e-9).floor() + 1.0;
        if !(2.0..=MOST_SAMPLES).contains(&count) {
            return Err(wrong("the motion has fewer than 2 samples, or more than 1e6"));
        }
        let count = count as usize;
        let run = SystemRun {
            name: "start".into(),
            times: (0..count).map(|k| k as f64 * step).collect(),
            inputs: vec![0.0; count * self.system.inputs.len()],
            outputs: vec![0.0; count * self.system.outputs.len()],
            states: None,
            sha256: String::new(),
        };
        Ok(self.reach(&[run])?.remove(0))
    }
}

impl OutputTube {
    /// Returns the tube as CSV: times, and the lowest, nominal and highest value of each output.
    #[must_use]
    pub fn to_csv(&self, model: &SystemModel) -> String {
        let mut out = "t".to_string();
        for output in &model.system.outputs {
            let name = output.name();
            let _ = write!(out, ",{name}_low,{name}_nominal,{name}_high");
        }
        out.push('\n');
        let p = model.system.outputs.len();
        for (k, time) in self.times.iter().enumerate() {
            let _ = write!(out, "{time}");
            for at in k * p..(k + 1) * p {
                let [low, high] = self.bounds.each_ref().map(|bounds| bounds[at]);
                let _ = write!(out, ",{low},{},{high}", self.nominal[at]);
            }
            out.push('\n');
        }
        out
    }
}
