//! A model and the recordings it is compared with.

use std::path::PathBuf;

use reachtube::Model;
use reachtube::arm::{self, OfArm};
use reachtube::conform::{
    self, Check, Keep, Notion, Problem, Setup, SuiteReach, Tube, check, reach,
};
use reachtube::export::ExportCase;
use reachtube::finding::{FrontEnd, Summary};
use reachtube::pipeline::{check_job, unexplained_by_model};

use crate::data_arguments::{DataArguments, ModelArguments};
use crate::error::{Error, Result};
use crate::output;
use crate::progress::Progress;

/// A model, the recordings read with its settings, and its reachable sets over them.
pub(crate) struct OpenedCheck {
    pub model: Model,
    pub problem: Problem,
    tube: Tube,
    data: PathBuf,
}

impl OpenedCheck {
    pub(crate) fn tube(&self) -> &Tube {
        &self.tube
    }

    /// Opens the model file, reads the recordings and computes the reachable sets; recordings are
    /// judged by `notion`, or by the notion in the file.
    pub(crate) fn new(args: &ModelArguments, notion: Option<Notion>, keep: Keep) -> Result<Self> {
        let (mut model, setup) = arm::open(&args.model)?;
        // Models that were written later are counted too; the digest stays the file's.
        Model { trust: model.trust, calibration: model.calibration, .. } =
            model.clone().among_others(&args.model);
        Self::with(model, setup, &args.data, notion, keep)
    }

    /// Reads the recordings and computes the reachable sets of a model in memory.
    pub(crate) fn with(
        model: Model,
        setup: Setup,
        args: &DataArguments,
        notion: Option<Notion>,
        keep: Keep,
    ) -> Result<Self> {
        let own = setup.arm().settings.torque;
        let expected = model.preparation.as_ref().map_or(own, |known| known.torque);
        if let Some(given) = args.torque.filter(|given| *given != expected) {
            let [given, model] =
                [given, expected].map(|torque| format!("{torque:?}").to_lowercase());
            return Err(Error::setting(format!(
                "--torque {given}, but the model was found with --torque {model}, and its input \
                 set covers that only; give --torque {model}, or run conform on recordings with \
                 --torque {given}"
            )));
        }
        model.preparation.as_ref().map_or(Ok(()), |_| args.refuse_gap_of_logs())?;
        let job = check_job(model, setup, &args.data)?
            .suites(&args.suites)
            .notion(notion)
            .until(args.until)
            .gap_limit(args.max_gap.into())
            .keep(keep);
        let bar = Progress::new();
        let conform::Opened { model, problem, tube } = job.open(&bar)?;
        Ok(Self { model, problem, tube, data: args.data.clone() })
    }

    /// Prints notes as [`print_notes`] does.
    pub(crate) fn print_notes(&self, args: &DataArguments) {
        print_notes(&self.model, &self.problem, args.until, "--until changes the limit");
    }

    /// Prints a warning for each reason why the sets need not hold for the robot.
    pub(crate) fn warn_beyond_proof(&self) {
        let warnings = self.model.beyond_proof(&self.problem);
        warnings.iter().for_each(|warning| output::warn(&warning.text));
    }

    /// Returns each suite, or run with a nominal motion of its own, as exports take it.
    pub(crate) fn export_cases(&self) -> Result<Vec<ExportCase>> {
        let _bar = Progress::new();
        Ok(ExportCase::all(&self.problem, &self.tube)?)
    }

    /// Compares the recordings with the reachable sets. Where they leave them, says what they show
    /// to be the cause.
    pub(crate) fn check(&self) -> Result<Check> {
        let _bar = Progress::new();
        let check = check(&self.model, &self.problem, &self.tube)?;
        if check.holds() {
            return Ok(check);
        }
        let paths = [self.data.clone()];
        Ok(check.explained_by(unexplained_by_model(&self.model, &paths)?))
    }

    pub(crate) fn summary(&self, check: &Check) -> Summary {
        check.summary(&self.model, &self.tube, FrontEnd::CommandLine)
    }

    /// Returns the reachable set of each suite, at samples and between them.
    pub(crate) fn reach(&self) -> Result<Vec<SuiteReach>> {
        let _bar = Progress::new();
        Ok(reach(&self.problem, &self.tube)?)
    }
}

/// Prints notes on the recordings, and up to which time they are used if that is the model's limit,
/// with what changes it. A check says it in its verdict.
pub(crate) fn print_notes(model: &Model, problem: &Problem, until: Option<f64>, change: &str) {
    if let (None, Some(until)) = (until, model.settings.until) {
        output::note(&format!(
            "samples later than {until} s after the first are not used, as when the sets were \
             found; {change}"
        ));
    }
    output::notes(&problem.recordings().notes);
}
