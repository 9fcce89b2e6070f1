//! The input along a nominal motion whose samples become known one by one.

use reachtube_reach::LinearSystem;

use crate::data::condition::Condition;
use crate::data::correction::InputCorrection;
use crate::data::settings::Equations;
use crate::data::setup::Setup;
use crate::error::Result;
use crate::nominal::corrector::Corrector;
use crate::nominal::robot_equations::RobotEquations;
use crate::nominal::simulate::BOUND;
use crate::nominal::steps::LinearSteps;

/// Corrects inputs along nominal motions of a linear model, as problems with recordings do.
#[derive(Debug)]
pub(crate) struct LiveNominal {
    corrector: Corrector<'static>,
    equations: Option<RobotEquations<'static>>,
    /// The step from one sample to the next.
    steps: LinearSteps,
}

impl LiveNominal {
    /// Prepares the correction of a model; `None` where its input is the recorded one.
    ///
    /// # Errors
    ///
    /// As [`Corrected::motion`](crate::nominal::motion::Corrected::motion).
    pub(crate) fn new(setup: &Setup, system: &LinearSystem, step: f64) -> Result<Option<Self>> {
        if setup.is_recorded_input() {
            return Ok(None);
        }
        let Setup { robot, settings, condition, .. } = setup;
        let none = InputCorrection::none(robot.joint_count());
        let correction = setup.correction.as_ref().unwrap_or(&none);
        let condition = condition.clone().unwrap_or_else(Condition::first);
        let corrector = Corrector::new(robot, correction, settings, &condition)?.into_owned();
        let equations = match settings.equations {
            Equations::Model => None,
            Equations::Robot => Some(RobotEquations::new(robot, system)?.into_owned()),
        };
        Ok(Some(Self { corrector, equations, steps: LinearSteps::new(system, &[0.0, step]) }))
    }

    /// Replaces the input `u` (n) at the nominal state `x` (2n) by the corrected one, and computes
    /// the next state; returns whether it is bounded.
    pub(crate) fn advance(&mut self, x: &[f64], u: &mut [f64], next: &mut [f64]) -> bool {
        let (q, qd) = x.split_at(u.len());
        self.corrector.take_off(q, qd, u);
        if let Some(equations) = &mut self.equations {
            equations.replace(x, u);
        }
        self.steps.advance(0, x, u, next);
        next.iter().all(|x| x.abs() < BOUND)
    }
}
