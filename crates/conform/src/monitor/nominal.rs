//! The input along a nominal motion whose samples become known one by one.

use reachtube_reach::LinearSystem;

use crate::data::condition::Condition;
use crate::data::setup::{Compensation, Setup};
use crate::error::Result;
use crate::nominal::simulate::BOUND;
use crate::nominal::steps::LinearSteps;

/// Corrects inputs along nominal motions of a linear model, as problems with recordings do.
#[derive(Debug)]
pub(crate) struct LiveNominal {
    compensation: Box<dyn Compensation>,
    /// The step from one sample to the next.
    steps: LinearSteps,
}

impl LiveNominal {
    /// Prepares the correction of a model; `None` if its input is the recorded one.
    pub(crate) fn new(setup: &Setup, system: &LinearSystem, step: f64) -> Result<Option<Self>> {
        let Setup { drive, dynamics, condition, .. } = setup;
        let condition = condition.clone().unwrap_or_else(Condition::first);
        let steps = || LinearSteps::new(system, &[0.0, step]);
        let compensation = drive.compensation(dynamics, &condition, None)?;
        Ok(compensation.map(|compensation| Self { compensation, steps: steps() }))
    }

    /// Replaces the input `u` (m) at the nominal state `x` (N) by the corrected one, and computes
    /// the next state; returns whether it is bounded.
    pub(crate) fn advance(&mut self, x: &[f64], u: &mut [f64], next: &mut [f64]) -> bool {
        self.compensation.apply(0, x, u);
        self.steps.advance(0, x, u, next);
        next.iter().all(|x| x.abs() < BOUND)
    }
}
