//! An arm without its robot and torques: joints whose acceleration is the disturbance.

use std::any::Any;
use std::path::Path;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use reachtube_conform::data::{Case, Condition, Drive, LiveInput, RunInput, Signals};
use reachtube_conform::{Error, Result};
use reachtube_finding::Advice;
use reachtube_reach::{LinearSystem, System};
use reachtube_recordings::{Defect, Run};

use crate::arm::Arm;
use crate::input::grid;
use crate::input_error;
use crate::live_input::NoInput;
use crate::settings::Equations;

/// An arm that drives a model by where its motion starts, and by nothing later.
#[derive(Debug)]
pub(crate) struct Kinematic(pub Arm);

/// Returns the model of `n` joints whose accelerations are the inputs.
pub(crate) fn system(n: usize) -> Result<LinearSystem> {
    let mut a = DMatrix::zeros(2 * n, 2 * n);
    let mut b = DMatrix::zeros(2 * n, n);
    a.view_mut((0, n), (n, n)).fill_with_identity();
    b.view_mut((n, 0), (n, n)).fill_with_identity();
    Ok(LinearSystem::new(a, b, DVector::zeros(2 * n))?)
}

impl Drive for Kinematic {
    /// The input is the acceleration that is left of the one at the start. Without a motion before
    /// the run, that is 0.
    fn input(
        &self,
        path: &Path,
        run: &Run,
        _at: Option<&Condition>,
    ) -> Result<RunInput, Vec<Defect>> {
        let grid = grid(path, run, self.0.robot())?;
        let (n, equations) = (run.joints, self.0.settings.equations);
        let still = vec![0.0; n];
        let start = run.before.get(2 * n..).unwrap_or(&still);
        let at = |time: &f64| {
            let part = equations.part_left(*time);
            start.iter().map(move |acceleration| part * acceleration)
        };
        Ok(RunInput { grid: Arc::new(grid), inputs: run.times.iter().flat_map(at).collect() })
    }

    fn input_key(&self, _at: Option<&Condition>) -> String {
        format!("{:?}", self.0.settings.equations)
    }

    fn live_input(&self) -> Result<Box<dyn LiveInput>> {
        match self.0.settings.equations {
            Equations::Velocity => Ok(Box::new(NoInput)),
            _ => Err(Error::Drive(
                Advice::from("a monitor does not know the acceleration at the start of a motion")
                    .with("equations", "velocity"),
            )),
        }
    }

    fn signals(&self) -> &Signals {
        &self.0.signals
    }

    fn input_error(&self, case: &Case) -> Result<(Vec<f64>, usize)> {
        Ok(input_error::of_accelerations(case))
    }

    fn reading(&self) -> String {
        self.0.reading()
    }

    fn identity(&self) -> String {
        self.0.identity()
    }

    fn record(&self, system: &System) -> serde_json::Value {
        self.0.record(system)
    }

    /// Returns the arm, for callers that need its links.
    fn any(&self) -> &dyn Any {
        &self.0
    }
}
