use std::any::Any;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::path::Path;
use std::sync::Arc;

use reachtube_finding::{Advice, Finding};
use reachtube_reach::System;
use reachtube_recordings::{Defect, GapLimit, ReadOptions, Run};
use reachtube_scalar::Interval;

use crate::data::case::Case;
use crate::data::condition::Condition;
use crate::data::input::RunInput;
use crate::data::live_input::LiveInput;
use crate::data::notion::Notion;
use crate::data::residual::Residual;
use crate::data::settings::{Method, Settings};
use crate::data::signals::Signals;
use crate::error::{Error, Result};
use crate::fit::group::Group;
use crate::fit::record::FittedParameter;
use crate::plausibility::remark::Remark;
use crate::result::code::Code;

/// What decides a conformance besides the recordings: what drives a system along them, the system
/// and the settings.
#[derive(Debug, Clone)]
pub struct Setup {
    /// What turns recordings into inputs of the system.
    pub(crate) drive: Arc<dyn Drive>,
    /// The model of the motion.
    pub(crate) dynamics: System,
    /// The settings.
    pub(crate) settings: Settings,
    /// The nominal initial states of suites by their name, N each, where they are known. Any other
    /// suite starts at the mean of the recordings at hand.
    pub nominal_starts: BTreeMap<String, Vec<f64>>,
    /// The condition that the drive is taken in, whatever a run's condition is; `None` if each run
    /// has its own.
    pub(crate) condition: Option<Condition>,
}

/// What turns recordings into inputs of a system.
///
/// The inputs of a recording are computed when it is read. What else is taken off them depends on
/// the nominal motion: a [`Compensation`] evaluates it along that motion.
pub trait Drive: Debug + Send + Sync {
    /// Returns the sample times of a recording and the input along it, in a condition if one is
    /// given.
    ///
    /// # Errors
    ///
    /// Defects of units and times, under the name `path`.
    fn input(
        &self,
        path: &Path,
        run: &Run,
        at: Option<&Condition>,
    ) -> Result<RunInput, Vec<Defect>>;

    /// Returns a text that is the same for two drives, or conditions, if and only if they give
    /// every recording the same input. Inputs that were computed under another key are computed
    /// again.
    fn input_key(&self, at: Option<&Condition>) -> String;

    /// Returns what evaluates the inputs of samples.
    ///
    /// # Errors
    ///
    /// Inputs that samples alone do not give.
    fn live_input(&self) -> Result<Box<dyn LiveInput>>;

    /// Returns what the numbers of the model are.
    fn signals(&self) -> &Signals;

    /// Returns what finds how far dry friction of the inputs may differ between states; `None`
    /// where the inputs have none.
    fn dry_friction(&self) -> Option<Box<dyn DryFriction + '_>> {
        None
    }

    /// Returns whether the input depends on the condition of the run.
    fn input_differs_by_run(&self) -> bool {
        false
    }

    /// Returns whether runs that share their input may differ in what is compensated.
    fn compensation_differs_by_run(&self) -> bool {
        false
    }

    /// Returns what is taken off the input along nominal motions of `system` in a condition; `None`
    /// if nothing is. `near` is what compensations near the same motion share.
    ///
    /// # Errors
    ///
    /// A system that does not fit.
    fn compensation(
        &self,
        _system: &System,
        _at: &Condition,
        _near: Option<&Near>,
    ) -> Result<Option<Box<dyn Compensation>>> {
        Ok(None)
    }

    /// Returns what compensations near a motion (samples x N) share, to first order, if anything.
    fn near(&self, _motion: &[f64]) -> Option<Near> {
        None
    }

    /// Returns, for each input, the sum of the squares of what is wrong with its prediction along a
    /// case, and the number of samples.
    ///
    /// # Errors
    ///
    /// When the compensation does not fit.
    fn input_error(&self, case: &Case) -> Result<(Vec<f64>, usize)> {
        Ok((vec![0.0; case.parts()], 0))
    }

    /// Returns whether a fit has chosen its parameters.
    fn is_fitted(&self) -> bool {
        false
    }

    /// Returns the SHA-256 of the recordings that its parameters were identified from.
    fn seen(&self) -> &[String] {
        &[]
    }

    /// Returns whether it depends on temperatures.
    fn needs_temperatures(&self) -> bool {
        false
    }

    /// Returns a text that says all that the reading of recordings depends on.
    fn reading(&self) -> String;

    /// Returns a text that says all that inputs and compensations depend on.
    fn identity(&self) -> String;

    /// Returns what a fit may move; `None` where it can move nothing.
    fn fits(&self) -> Option<&dyn Fits> {
        None
    }

    /// Returns the remark of a kind about the parameters of a part (from 0), if the recordings give
    /// reason for one. The last argument returns the lowest and the highest recorded value of a
    /// state.
    fn remark(
        &self,
        _code: Code,
        _part: usize,
        _recorded: &dyn Fn(usize) -> [f64; 2],
    ) -> Option<Remark> {
        None
    }

    /// Returns the most likely cause of an implausible answer about these recordings, whose sets
    /// were found by a method. `held_out` is a cause that is known already, if any.
    fn cause(
        &self,
        _runs: Vec<Run>,
        _method: Method,
        held_out: Option<Finding>,
    ) -> Option<Finding> {
        held_out
    }

    /// Returns what computes the torque that motions at even steps \[s\] do not account for.
    ///
    /// # Errors
    ///
    /// Parameters that do not allow it.
    fn residual(&self, _step: f64) -> Result<Box<dyn Residual>> {
        let words = "healthy motion is judged by torques, and no robot drives the model";
        Err(Error::Drive(Advice::from(words)))
    }

    /// Returns the record of itself and of the system in a model file, which a
    /// [`Loader`](crate::model::Loader) reads.
    fn record(&self, system: &System) -> serde_json::Value;

    /// Returns the type that implements it.
    fn any(&self) -> &dyn Any;
}

/// What is taken off the inputs along one nominal motion.
pub trait Compensation: Debug + Send + Sync {
    /// Takes it off the input `u` (m) of sample `k`, where the nominal state is `x` (N).
    fn apply(&mut self, k: usize, x: &[f64], u: &mut [f64]);
}

/// How far the dry friction of inputs may differ between the states in a box.
pub trait DryFriction {
    /// Hands to `visit`, for each input whose friction may differ between two states of a box (N):
    /// its index, the largest difference, and whether the part that it drives may rest.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    fn spread(&mut self, states: &[Interval], visit: &mut dyn FnMut(usize, f64, bool));
}

/// What a fit may move of a drive and its system.
pub trait Fits {
    /// Refuses a fit of groups of parameters that cannot be fitted.
    ///
    /// # Errors
    ///
    /// [`Error::Fit`](crate::Error::Fit).
    fn check(&self, groups: &[Group]) -> Result<()>;

    /// Returns the setup with the linear model that steers a fit.
    ///
    /// # Errors
    ///
    /// A model that cannot be made.
    fn linear(&self, setup: &Setup) -> Result<Setup>;

    /// Returns the parameters of the drive and the system that a fit moves.
    fn parameters(&self, setup: &Setup, asked: &Asked) -> Box<dyn Parameters>;
}

/// What compensations near one motion share.
pub type Near = Arc<dyn Any + Send + Sync>;

/// What a fit asks parameters for.
#[derive(Debug, Clone, Default)]
pub struct Asked<'a> {
    /// The groups of parameters.
    pub groups: &'a [Group],
    /// The lowest and the highest recorded value of each state, N.
    pub bounds: Vec<[f64; 2]>,
    /// Whether the model that the parameters are for is not linear.
    pub is_nonlinear: bool,
    /// The mean temperatures of the recordings, where all of them have some.
    pub temperatures: Option<Vec<f64>>,
}

/// The parameters of a fit, and the model that they give. The number 0 of a parameter stands for
/// its identified value.
pub trait Parameters: Debug + Send + Sync {
    /// Returns the parameters.
    fn list(&self) -> &[FreeParameter];

    /// Returns the identified model.
    fn setup(&self) -> &Setup;

    /// Returns the model with these numbers, one per parameter.
    ///
    /// # Errors
    ///
    /// A model that cannot be made.
    fn apply(&self, numbers: &[f64]) -> Result<Setup>;

    /// Refuses a model that `apply` made and that is impossible.
    ///
    /// # Errors
    ///
    /// What is wrong with it.
    fn check(&self, setup: &Setup) -> Result<()>;

    /// Returns no parameters of the same model.
    fn none(&self) -> Box<dyn Parameters>;

    /// Returns the numbers that a fit starts from.
    fn start(&self) -> Vec<f64>;

    /// Returns conditions on the numbers, linearised about `numbers`: the sum of the entries
    /// (parameter, factor) is at most the bound.
    fn conditions(&self, numbers: &[f64]) -> Vec<(Vec<(usize, f64)>, f64)>;

    /// Returns whether compensations near a motion share something.
    fn has_near(&self) -> bool;

    /// Returns the parameters at `numbers`, for people.
    fn describe(&self, numbers: &[f64]) -> Vec<FittedParameter>;
}

/// One number that a fit moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeParameter {
    /// Its group.
    pub group: Group,
    /// Its kind: parameters of a kind are moved together first.
    pub kind: u8,
    /// The lowest and the highest number allowed.
    pub bounds: [f64; 2],
    /// Whether it changes A and B, and not only the nominal motions.
    pub changes_system: bool,
}

impl dyn Parameters + '_ {
    /// Returns the number of parameters.
    pub fn len(&self) -> usize {
        self.list().len()
    }

    /// Returns the parameters that are in none of the groups `held`.
    pub fn except(&self, held: &[Group]) -> Vec<usize> {
        let list = self.list().iter().enumerate();
        list.filter(|(_, own)| !held.contains(&own.group)).map(|(p, _)| p).collect()
    }

    /// Returns the groups that have parameters.
    pub fn groups(&self) -> Vec<Group> {
        let has = |group: &Group| self.list().iter().any(|own| own.group == *group);
        Group::ALL.into_iter().filter(has).collect()
    }
}

impl Setup {
    /// Makes the setup of a system and of what drives it.
    ///
    /// # Errors
    ///
    /// Settings that do not fit them.
    pub fn new(drive: Arc<dyn Drive>, dynamics: System, settings: Settings) -> Result<Self> {
        settings.validate(dynamics.inputs())?;
        if settings.input_doubling.is_some() && dynamics.linear_system().is_none() {
            return Err(Error::InputDoubling("a linear model"));
        }
        if settings.stiction && drive.dry_friction().is_none() {
            return Err(Error::Stiction(
                "the inputs have no dry friction, as torques that are measured at the links have \
                 none; leave the setting out",
            ));
        }
        Ok(Self { drive, dynamics, settings, nominal_starts: BTreeMap::new(), condition: None })
    }

    /// Returns the setup of another system and drive, with the same settings and nominal starts.
    #[must_use]
    pub fn with_drive(&self, drive: Arc<dyn Drive>, dynamics: System) -> Self {
        Self { drive, dynamics, ..self.clone() }
    }

    /// Returns the same setup with another way to find the sets.
    #[must_use]
    pub fn with_method(mut self, method: Method) -> Self {
        self.settings.method = method;
        self
    }

    /// Returns what a fit may move.
    ///
    /// # Errors
    ///
    /// [`Error::Fit`] where it can move nothing.
    pub(crate) fn fits(&self) -> Result<&dyn Fits> {
        let nothing = || Error::Fit("what drives the model has no parameters".into());
        self.drive.fits().ok_or_else(nothing)
    }

    /// Returns what drives the system.
    #[must_use]
    pub fn drive(&self) -> &dyn Drive {
        &*self.drive
    }

    /// Returns the model of the motion.
    #[must_use]
    pub fn dynamics(&self) -> &System {
        &self.dynamics
    }

    /// Returns the settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Replaces what recordings are judged by: the notion and the end of the runs where they are
    /// given, and the limit of gaps.
    #[must_use]
    pub fn judged_by(
        mut self,
        notion: Option<Notion>,
        until: Option<f64>,
        gap_limit: GapLimit,
    ) -> Self {
        let Settings { notion: own_notion, until: own_until, .. } = self.settings;
        self.settings.notion = notion.unwrap_or(own_notion);
        self.settings.until = until.or(own_until);
        self.settings.gap_limit = gap_limit;
        self
    }

    pub(crate) fn differs_by_run(&self) -> bool {
        self.drive.input_differs_by_run() || self.drive.compensation_differs_by_run()
    }
}

pub(crate) fn read_options(setup: &Setup) -> ReadOptions {
    let Settings { gap_limit, until, .. } = setup.settings;
    ReadOptions { gap_limit, until, ..ReadOptions::of(setup.dynamics.inputs()) }
}
