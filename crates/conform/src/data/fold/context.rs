use std::path::Path;
use std::sync::Arc;

use reachtube_recordings::{Defect, ReadOptions, Run};
use sha2::{Digest, Sha256};

use crate::data::input::RunInput;
use crate::data::settings::NominalStart;
use crate::data::setup::{Drive, Setup, read_options};
use crate::data::shape::Shape;
use crate::error::{Error, Result};
use reachtube_finding::Advice;

/// What the reading of recordings depends on.
#[derive(Debug)]
pub(crate) struct Context {
    pub drive: Arc<dyn Drive>,
    pub shape: Shape,
    pub options: ReadOptions,
    pub nominal: NominalStart,
    /// Whether every run has a nominal motion of its own, whatever its input.
    pub is_own: bool,
    /// SHA-256 of all this.
    pub digest: [u8; 32],
}

impl Context {
    /// Takes from a setup what the reading depends on.
    ///
    /// # Errors
    ///
    /// Settings that need every run sample by sample.
    pub(crate) fn new(setup: &Setup) -> Result<Self> {
        let Setup { drive, dynamics, settings, .. } = setup;
        settings.validate(dynamics.inputs())?;
        if settings.notion.asks_points() {
            let problem = "every notion but the hull needs the points of all recordings in one \
                           memory: use the notion hull, or read the recordings on one machine";
            return Err(Error::Fold(Advice::from(problem).with("notion", "hull")));
        }
        let is_own =
            settings.nominal.is_of_run() || setup.condition.is_none() && setup.differs_by_run();
        let options = read_options(setup);
        let parts = (drive.reading(), settings.until, is_own, settings.nominal);
        let mut text = serde_json::to_string(&parts).expect("settings have string keys");
        text += &format!("{:?}", options.gap_limit);
        let digest = Sha256::digest(text).into();
        let shape = Shape::of_states(dynamics.states(), dynamics.inputs());
        let nominal = settings.nominal;
        Ok(Self { drive: Arc::clone(drive), shape, options, nominal, is_own, digest })
    }

    pub(crate) fn input(&self, file: &str, run: &Run) -> Result<RunInput, Vec<Defect>> {
        let path = Path::new(file);
        run.check_size(path, self.shape.inputs).map_err(|defect| vec![defect])?;
        self.nominal.check(path, run)?;
        self.drive.input(path, run, None)
    }
}
