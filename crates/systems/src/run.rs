use std::path::{Path, PathBuf};

use rayon::prelude::*;
use reachtube_files::hex;
use reachtube_reach::TimeGrid;
use reachtube_recordings::{NamedColumns, NamedRun, read_named, table_files};
use sha2::{Digest, Sha256};

use crate::description::SystemKind;
use crate::error::{Error, Result};
use crate::system::OutputSystem;

/// Samples of a discrete system may be this part of a step off.
const OFF: f64 = 0.01;

/// A recording of a system.
#[derive(Debug, Clone, PartialEq)]
pub struct SystemRun {
    /// Its name: the file, with the number of the run if the file has several.
    pub name: String,
    /// Times since the first sample, K, s, strictly increasing.
    pub times: Vec<f64>,
    /// Inputs, row-major K x m.
    pub inputs: Vec<f64>,
    /// Outputs, row-major K x p.
    pub outputs: Vec<f64>,
    /// The states at the first sample, N, if they were recorded.
    pub states: Option<Vec<f64>>,
    /// SHA-256 of the file.
    pub sha256: String,
}

impl SystemRun {
    /// Returns a run of numbers in memory: times (K), inputs (K x m) and outputs (K x p), both
    /// row-major, and the states at the first sample (N), if they are known. The first time becomes
    /// 0, and the SHA-256 is of the numbers.
    #[must_use]
    pub fn of_numbers(
        name: impl Into<String>,
        times: Vec<f64>,
        inputs: Vec<f64>,
        outputs: Vec<f64>,
        states: Option<Vec<f64>>,
    ) -> Self {
        let mut digest = Sha256::new();
        let all = times.iter().chain(&inputs).chain(&outputs).chain(states.iter().flatten());
        all.for_each(|number| digest.update(number.to_le_bytes()));
        let first = times.first().copied().unwrap_or_default();
        Self {
            name: name.into(),
            times: times.iter().map(|time| time - first).collect(),
            inputs,
            outputs,
            states,
            sha256: hex(&digest.finalize()),
        }
    }

    /// Returns the number of samples K.
    #[must_use]
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Returns whether there is no sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Returns the first `count` samples of the run, or all if it has no more.
    pub(crate) fn before(&self, count: usize) -> Self {
        let [m, p] = [&self.inputs, &self.outputs].map(|all| all.len() / self.len());
        let count = count.min(self.len());
        Self {
            times: self.times[..count].to_vec(),
            inputs: self.inputs[..count * m].to_vec(),
            outputs: self.outputs[..count * p].to_vec(),
            ..self.clone()
        }
    }

    /// Returns the run from sample `first` on.
    pub(crate) fn after(&self, first: usize) -> Self {
        let [m, p] = [&self.inputs, &self.outputs].map(|all| all.len() / self.len());
        Self {
            times: self.times[first..].iter().map(|time| time - self.times[first]).collect(),
            inputs: self.inputs[first * m..].to_vec(),
            outputs: self.outputs[first * p..].to_vec(),
            states: None,
            ..self.clone()
        }
    }
}

impl OutputSystem {
    /// Reads the recordings at a path: a CSV file, or a folder of them. A file with a column `run`
    /// has several. Samples later than `until` s after the first are left out.
    ///
    /// # Errors
    ///
    /// Defects of files; samples that are not where the system has them.
    pub fn read(&self, path: &Path, until: Option<f64>) -> Result<Vec<SystemRun>> {
        let files = table_files(path)?;
        if files.is_empty() {
            return Err(Error::NoRun { folder: path.into() });
        }
        let description = self.description();
        let names: Vec<String> = Self::names(&description.inputs)
            .into_iter()
            .chain(Self::names(&description.outputs))
            .collect();
        let states = Self::names(&description.states);
        let columns = NamedColumns { required: &names, optional: &states, step: description.step };
        let read = |file: &PathBuf| read_named(file, &columns).map(|runs| (file.clone(), runs));
        let read: Vec<_> = files.par_iter().map(read).collect();
        let (mut found, mut defects) = (Vec::new(), Vec::new());
        for file in read {
            match file {
                Ok((file, (runs, sha256))) => {
                    found.extend(runs.into_iter().map(|run| (file.clone(), run, sha256.clone())));
                }
                Err(own) => defects.extend(own),
            }
        }
        if !defects.is_empty() {
            return Err(reachtube_recordings::Error::Defects(defects).into());
        }
        found.into_iter().map(|(file, run, sha256)| self.run(&file, run, sha256, until)).collect()
    }

    fn run(
        &self,
        file: &Path,
        run: NamedRun,
        sha256: String,
        until: Option<f64>,
    ) -> Result<SystemRun> {
        let (m, p) = (self.description().inputs.len(), self.outputs());
        let name = match run.number {
            Some(number) => format!("{}, run {number}", file.display()),
            None => file.display().to_string(),
        };
        let kept = run.times.iter().take_while(|time| until.is_none_or(|until| **time <= until));
        let count = kept.count();
        let rows = run.required.chunks_exact(m + p).take(count);
        let column =
            |from: usize, to: usize| rows.clone().flat_map(move |row| &row[from..to]).copied();
        let states = run.optional.get(..self.description().states.len());
        let run = SystemRun {
            inputs: column(0, m).collect(),
            outputs: column(m, m + p).collect(),
            states: states.filter(|states| !states.is_empty()).map(<[f64]>::to_vec),
            times: run.times[..count].to_vec(),
            name,
            sha256,
        };
        if run.len() < 2 {
            return Err(Error::Short { run: run.name, samples: run.times.len(), needed: 2 });
        }
        Ok(run)
    }

    /// Returns the time between the samples of a run, s.
    ///
    /// # Errors
    ///
    /// [`Error::Times`] where they are not even, or a discrete system has other times.
    pub(crate) fn step_of(&self, run: &SystemRun) -> Result<f64> {
        let wrong = |problem| Error::Times { run: run.name.clone(), problem };
        let Some(step) = self.description().step else {
            let grid = TimeGrid::from_times(&run.times)?;
            return grid.step().ok_or_else(|| {
                let steps = (1..run.len()).map(|k| run.times[k] - run.times[k - 1]);
                let [low, high] = steps.fold([f64::INFINITY, 0.0], |[low, high], step| {
                    [low.min(step), high.max(step)]
                });
                wrong(format!("its samples are {low} to {high} s apart, and not even"))
            });
        };
        debug_assert!(self.description().kind != SystemKind::Continuous);
        let off = |k: &usize| (run.times[*k] - *k as f64 * step).abs() > OFF * step;
        match (0..run.len()).find(off) {
            None => Ok(step),
            Some(k) => Err(wrong(format!(
                "sample {k} is {} s after the first, and the system has it after {:.6} s",
                run.times[k],
                k as f64 * step
            ))),
        }
    }
}
