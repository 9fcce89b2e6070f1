//! The cases of a problem, and the correction of their inputs.

use std::sync::Arc;

use rayon::prelude::*;

use crate::data::case::Case;
use crate::data::condition::Condition;
use crate::data::envelope::Envelope;
use crate::data::input::RunInput;
use crate::data::problem::Problem;
use crate::data::runaway::Runaway;
use crate::data::settings::NominalStart;
use crate::data::setup::Setup;
use crate::data::suite::Suite;
use crate::data::summary::RunSummary;
use crate::error::{Error, Result};
use crate::nominal::motion::motion_until;

impl Problem {
    /// Returns the cases of all suites, in their order. They are made on first use and stay in
    /// memory.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub fn cases(&self) -> Result<&[Case]> {
        if let Some(cases) = self.cases.get() {
            return Ok(cases);
        }
        let suites = 0..self.recordings().suites.len();
        let parts: Vec<Vec<Case>> =
            suites.map(|suite| self.cases_of(suite, Ok)).collect::<Result<_>>()?;
        Ok(self.cases.get_or_init(|| parts.concat()))
    }

    /// Hands each case of suite `index` to `visit`, on all cores, without keeping it; returns the
    /// answers in the order of the cases.
    pub(crate) fn cases_of<T: Send>(
        &self,
        index: usize,
        visit: impl Fn(Case) -> Result<T> + Sync,
    ) -> Result<Vec<T>> {
        let suite = &self.recordings().suites[index];
        self.recorded_cases_of(suite, index, self.differs_by_run(), |case| {
            visit(self.corrected(case)?)
        })
    }

    /// Hands each case of a suite with its recorded inputs to `visit`, on all cores; a case is one
    /// run when `by_run`, or when the runs of the suite do not share their inputs.
    pub(crate) fn recorded_cases_of<T: Send>(
        &self,
        suite: &Suite,
        index: usize,
        by_run: bool,
        visit: impl Fn(Case) -> Result<T> + Sync,
    ) -> Result<Vec<T>> {
        let knows_run = self.setup().condition.is_none();
        let by_run = knows_run && (by_run || self.setup().drive.input_differs_by_run());
        match suite.shared.as_ref().filter(|_| !by_run && self.inputs_are_current()) {
            Some(input) => Ok(vec![visit(Case {
                name: format!("suite {}", suite.entry.name),
                suite: index,
                run: None,
                grid: Arc::clone(&input.grid),
                inputs: Arc::clone(&input.inputs),
                start: suite.nominal_start.clone(),
                measured: Arc::clone(&suite.envelope),
                condition: self.setup().condition.clone().unwrap_or_else(Condition::first),
            })?]),
            None => {
                let own = |summary: &RunSummary| visit(self.case_of_run(suite, index, summary)?);
                suite.every_run()?.par_iter().map(own).collect()
            }
        }
    }

    pub(crate) fn differs_by_run(&self) -> bool {
        self.setup().drive.compensation_differs_by_run()
    }

    /// Returns whether the problem's drive, in its condition, gives the inputs that were computed
    /// at reading.
    fn inputs_are_current(&self) -> bool {
        let Setup { drive, condition, .. } = self.setup();
        self.read.input_key == drive.input_key(condition.as_ref())
    }

    fn case_of_run(&self, suite: &Suite, index: usize, summary: &RunSummary) -> Result<Case> {
        let run = summary.index;
        let recorded = self.run(run)?;
        let path = self.read.origin.run_name(run);
        let condition = self.setup().condition.as_ref().unwrap_or(&summary.condition).clone();
        let RunInput { grid, inputs } = (self.setup().drive)
            .input(&path, &recorded, Some(&condition))
            .map_err(reachtube_recordings::Error::Defects)?;
        let mut measured = Envelope::new(self.shape().states);
        measured.include(run as u32, &recorded.states);
        let start = match self.settings().nominal {
            NominalStart::Mean => suite.nominal_start.clone(),
            NominalStart::Own => recorded.state(0).to_vec(),
            NominalStart::Past => summary.told_start.clone(),
        };
        let name = format!("suite {}, run {}", suite.entry.name, self.entry(run).file);
        let measured = Arc::new(measured);
        Ok(Case { name, suite: index, run: Some(run), grid, inputs, start, measured, condition })
    }

    /// Hands each case of suite `index` to `visit` as [`cases_of`](Self::cases_of) does, and where
    /// its nominal motion diverges, if it does.
    pub(crate) fn cases_until<T: Send>(
        &self,
        index: usize,
        visit: impl Fn(Case, Option<Runaway>) -> Result<T> + Sync,
    ) -> Result<Vec<T>> {
        let suite = &self.recordings().suites[index];
        self.recorded_cases_of(suite, index, self.differs_by_run(), |case| {
            let (case, runaway) = self.corrected_until(case)?;
            visit(case, runaway)
        })
    }

    fn corrected(&self, case: Case) -> Result<Case> {
        match self.corrected_until(case)? {
            (case, None) => Ok(case),
            (_, Some(Runaway { case, time, .. })) => Err(Error::RunsAway { case, time }),
        }
    }

    /// Takes the correction off the inputs of a case, up to where its nominal motion diverges.
    fn corrected_until(&self, case: Case) -> Result<(Case, Option<Runaway>)> {
        let Setup { drive, dynamics, .. } = self.setup();
        let compensation = drive.compensation(dynamics, &case.condition, None)?;
        if compensation.is_none() {
            return Ok((case, None));
        }
        let (motion, runaway) = motion_until(dynamics, &case, None, compensation)?;
        Ok((Case { inputs: motion.inputs.into(), ..case }, runaway))
    }
}
