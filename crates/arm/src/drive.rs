//! How an arm drives a model of its motion along recordings.

use std::any::Any;
use std::path::Path;
use std::sync::Arc;

use reachtube_abstraction::Abstraction;
use reachtube_conform::data::{
    Asked, Case, Compensation, Condition, Drive, DryFriction, Fits, LiveInput, Near, Parameters,
    Residual, RunInput, Signals,
};
use reachtube_conform::plausibility::Remark;
use reachtube_conform::settings::Method;
use reachtube_conform::{Code, Error, Group, Result, Setup};
use reachtube_finding::Finding;
use reachtube_reach::System;
use reachtube_recordings::{Defect, Run, Torque};
use reachtube_robot::friction::WarmingBy;

use crate::arm::Arm;
use crate::causes::likely_cause;
use crate::correction::InputCorrection;
use crate::corrector::Corrector;
use crate::dry_friction::JointFriction;
use crate::friction;
use crate::input::input;
use crate::input_error;
use crate::live_input::ArmInput;
use crate::loads::LoadsNear;
use crate::parameters::ArmParameters;
use crate::record::DriveRecord;
use crate::residual::ArmResidual;
use crate::robot_equations::RobotEquations;
use crate::settings::{ArmSettings, Equations};
use crate::setup::not_linear;
use crate::system::system;

impl Drive for Arm {
    fn input(
        &self,
        path: &Path,
        run: &Run,
        at: Option<&Condition>,
    ) -> Result<RunInput, Vec<Defect>> {
        let warm = at.and_then(|at| self.warm(at));
        input(path, run, warm.as_ref().unwrap_or(&self.robot), self.settings.torque)
    }

    /// Friction is in the input of motor and link torques, and viscous friction in the input of
    /// link torques may be fitted.
    fn input_key(&self, at: Option<&Condition>) -> String {
        let warm = at.filter(|_| !self.robot.warms_by().is_empty());
        let warm = warm.map_or_else(String::new, |at| format!("{at:?}"));
        match self.settings.torque {
            Torque::Compensated => String::new(),
            Torque::Motor => warm,
            Torque::Link => warm + &json(self.robot.description()),
        }
    }

    fn live_input(&self) -> Result<Box<dyn LiveInput>> {
        Ok(Box::new(ArmInput::new(self)))
    }

    fn signals(&self) -> &Signals {
        &self.signals
    }

    /// Link torques have no friction of the joints.
    fn dry_friction(&self) -> Option<Box<dyn DryFriction + '_>> {
        let friction = || Box::new(JointFriction::new(&self.robot)) as Box<dyn DryFriction>;
        (self.settings.torque != Torque::Link).then(friction)
    }

    fn input_differs_by_run(&self) -> bool {
        !self.robot.warms_by().is_empty()
    }

    fn compensation_differs_by_run(&self) -> bool {
        self.correction.as_ref().is_some_and(InputCorrection::differs_by_run)
    }

    fn compensation(
        &self,
        system: &System,
        at: &Condition,
        near: Option<&Near>,
    ) -> Result<Option<Box<dyn Compensation>>> {
        if self.is_recorded_input() {
            return Ok(None);
        }
        let none = InputCorrection::none(self.robot.joint_count());
        let correction = self.correction.as_ref().unwrap_or(&none);
        let corrector = Corrector::new(self, correction, at)?;
        let equations = match self.settings.equations {
            Equations::Robot => {
                let model = system.linear_system().ok_or_else(not_linear)?;
                Some(RobotEquations::new(&self.robot, model)?)
            }
            _ => None,
        };
        Ok(Some(Box::new(Corrected { corrector, equations, near: near.cloned() })))
    }

    fn near(&self, motion: &[f64]) -> Option<Near> {
        Some(Arc::new(LoadsNear::along(&self.robot, motion)))
    }

    fn input_error(&self, case: &Case) -> Result<(Vec<f64>, usize)> {
        input_error::of_case(self, case)
    }

    fn is_fitted(&self) -> bool {
        self.correction.is_some()
    }

    fn seen(&self) -> &[String] {
        &self.robot.description().identified_from
    }

    fn needs_temperatures(&self) -> bool {
        let correction = self.correction.as_ref();
        correction.is_some_and(|known| known.reference_temperatures.is_some())
            || self.robot.warms_by().contains(&WarmingBy::Temperature)
    }

    /// Limits and friction of the robot, and what its torques are.
    fn reading(&self) -> String {
        json(&(self.robot.description(), self.settings.torque))
    }

    fn identity(&self) -> String {
        let Self { robot, correction, settings, .. } = self;
        json(&(robot.description(), correction, settings))
    }

    fn fits(&self) -> Option<&dyn Fits> {
        Some(self)
    }

    fn remark(
        &self,
        code: Code,
        part: usize,
        recorded: &dyn Fn(usize) -> [f64; 2],
    ) -> Option<Remark> {
        friction::remark(&self.robot, code, part, recorded)
    }

    fn cause(&self, runs: Vec<Run>, method: Method, held_out: Option<Finding>) -> Option<Finding> {
        likely_cause(self, runs, method, held_out)
    }

    fn residual(&self, step: f64) -> Result<Box<dyn Residual>> {
        Ok(Box::new(ArmResidual::new(&self.robot, self.settings.torque, step)?))
    }

    fn record(&self, system: &System) -> serde_json::Value {
        let record = DriveRecord::new(self, system);
        serde_json::to_value(record).expect("numbers are finite and keys are strings")
    }

    fn any(&self) -> &dyn Any {
        self
    }
}

impl Fits for Arm {
    fn check(&self, groups: &[Group]) -> Result<()> {
        let is_friction = |group: &Group| {
            matches!(group, Group::Viscous | Group::Cubic | Group::Coulomb | Group::WarmUp)
        };
        if self.settings.torque == Torque::Link && groups.iter().any(is_friction) {
            let why = "there is no friction in link torques; fit inertia or payload";
            return Err(Error::Fit(why.into()));
        }
        Ok(())
    }

    /// Returns the linear model of the same robot about the same point.
    fn linear(&self, setup: &Setup) -> Result<Setup> {
        let setup = setup.clone().with_method(Method::Program);
        let settings = ArmSettings { abstraction: Abstraction::default(), ..self.settings.clone() };
        let dynamics = system(&self.robot, &settings, Method::Program)?;
        Ok(setup.with_drive(Arc::new(Self { settings, ..self.clone() }), dynamics))
    }

    fn parameters(&self, setup: &Setup, asked: &Asked) -> Box<dyn Parameters> {
        Box::new(ArmParameters::new(self, setup, asked))
    }
}

/// What is taken off the inputs of an arm along one nominal motion.
#[derive(Debug)]
struct Corrected {
    corrector: Corrector,
    equations: Option<RobotEquations>,
    near: Option<Near>,
}

impl Compensation for Corrected {
    fn apply(&mut self, k: usize, x: &[f64], u: &mut [f64]) {
        let (q, qd) = x.split_at(u.len());
        let near = self.near.as_ref().and_then(|near| near.downcast_ref::<LoadsNear>());
        self.corrector.take_off(near.map(|loads| (loads, k)), q, &qd[..u.len()], u);
        if let Some(equations) = &mut self.equations {
            equations.replace(x, u);
        }
    }
}

fn json(of: &impl serde::Serialize) -> String {
    serde_json::to_string(of).expect("numbers are finite and keys are strings")
}
