use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, OnceLock};

use reachtube_abstraction::{OperatingBox, PolynomialModel};
use reachtube_recordings::{ReadOptions, Run, RunSource, State};
use reachtube_robot::friction::WarmingBy;
use reachtube_robot::{Robot, RobotDescription};

use crate::data::case::Case;
use crate::data::condition::Condition;
use crate::data::correction::InputCorrection;
use crate::data::dynamics::Dynamics;
use crate::data::kept::KeptRuns;
use crate::data::origin::Origin;
use crate::data::recordings::Recordings;
use crate::data::sensor_noise::SensorNoise;
use crate::data::settings::{Equations, Notion, Settings};
use crate::data::suite::{Suite, SuiteReader};
use crate::deviation::Deviation;
use crate::error::{Error, Result};
use crate::explain::trace;
use crate::grids::Grids;
use crate::notion::elsewhere::PointServer;
use crate::progress::Progress;

/// What decides a conformance besides the recordings: the robot, its model and the settings.
///
/// The robot names the joints, turns recorded torques into inputs and is written into the model
/// file; all that follows the reading uses only the model.
#[derive(Debug, Clone)]
pub struct Setup {
    /// The robot.
    pub robot: Robot,
    /// The model of its motion.
    pub dynamics: Dynamics,
    /// The settings.
    pub settings: Settings,
    /// The nominal initial states of suites by their name, 2n each, where they are known. Any
    /// other suite starts at the mean of the recordings at hand.
    pub nominal_starts: BTreeMap<String, Vec<f64>>,
    /// What is taken off the recorded inputs along the nominal motions, where anything is.
    pub correction: Option<InputCorrection>,
    /// The condition that friction is taken in, whatever that of a run is; nothing where each run
    /// has its own.
    pub condition: Option<Condition>,
}

impl Setup {
    /// Makes the model of `robot` that `settings` ask for.
    ///
    /// # Errors
    ///
    /// Settings that do not fit the robot, a robot that is not physical at the expansion point.
    pub fn new(robot: Robot, settings: Settings) -> Result<Self> {
        settings.validate(robot.joint_count())?;
        let dynamics = Dynamics::new(&robot, &settings)?;
        Self::of(robot, dynamics, settings)
    }

    /// Takes a model as [`PolynomialModel::load`] reads it, with its robot, expansion point and
    /// operating box.
    ///
    /// # Errors
    ///
    /// [`Error::Unbounded`] when the model's error was found to have no bound over its box, and
    /// settings that do not fit.
    pub fn with_abstraction(model: PolynomialModel, settings: Settings) -> Result<Self> {
        let settings = settings.with_abstraction(&model)?;
        settings.validate(model.joints())?;
        let robot = Robot::from_description(model.robot())?;
        let dynamics = Dynamics::of(model, settings.method);
        Self::of(robot, dynamics, settings)
    }

    fn of(robot: Robot, dynamics: Dynamics, settings: Settings) -> Result<Self> {
        if settings.equations == Equations::Robot && dynamics.linear_system().is_none() {
            return Err(Error::Equations);
        }
        let nominal_starts = BTreeMap::new();
        Ok(Self { robot, dynamics, settings, nominal_starts, correction: None, condition: None })
    }

    /// Returns whether the model's input is the recorded one, with nothing taken off it along the
    /// nominal motion.
    pub(crate) fn is_recorded_input(&self) -> bool {
        self.correction.is_none()
            && self.robot.warms_by().is_empty()
            && self.settings.equations == Equations::Model
    }
}

/// Which runs stay in memory, sample by sample, after they were folded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Keep {
    /// Those that have a nominal solution of their own.
    #[default]
    Needed,
    /// All, as figures and explanations need them; up to 256 MiB, beyond which runs are read again.
    All,
}

/// A problem: a model, settings and recordings, which are read once and folded into what the steps
/// need. [`conform`](crate::conform), [`check`](crate::check()), [`reach`](crate::reach()) and
/// [`explain`](crate::explain()) take it.
///
/// # Examples
///
/// ```
/// use reachtube_conform::{Keep, Problem, Settings, Setup, Silent, conform};
/// use reachtube_recordings::{MemoryRuns, Run, Torque};
/// use reachtube_robot::Robot;
///
/// // Two runs of the arm at rest, a little apart.
/// let mut runs = MemoryRuns::default();
/// for offset in [0.0, 0.001] {
///     let states = [vec![offset; 6], vec![0.0; 6]].concat().repeat(3);
///     let run = Run::new(6, vec![0.0, 0.004, 0.008], states, vec![0.0; 18])?;
///     runs.push(&format!("run{offset}"), Some("A"), None, run);
/// }
/// let setup = Setup::new(Robot::lwa4p(), Settings::new(Torque::Compensated, 6))?;
/// let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent)?;
/// let found = conform(&problem, &Silent, None)?;
/// assert!(found.verdict.conformant);
/// assert!((found.sets.initial_set.radius[0] - 0.0005).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Problem {
    setup: Setup,
    pub(crate) read: Arc<Read>,
    grids: OnceLock<Grids>,
    pub(crate) cases: OnceLock<Vec<Case>>,
    deviations: OnceLock<Vec<Deviation>>,
    /// Where the points are, if they are with other processes.
    pub(crate) point_server: Option<Arc<dyn PointServer>>,
}

/// What was read of the recordings. It does not depend on the model.
#[derive(Debug)]
pub(crate) struct Read {
    pub origin: Origin,
    pub recordings: Recordings,
    pub kept: Arc<HashMap<usize, Run>>,
    pub sensor_noise: SensorNoise,
    /// The robot whose inputs the suites have.
    pub robot: RobotDescription,
}

impl Problem {
    /// Reads the suites `names` of `source` (all when none is named) on all cores.
    ///
    /// # Errors
    ///
    /// Every defect of every run, an unknown suite, a run that starts outside the box over which
    /// the model's error was bounded.
    pub fn read(
        setup: Setup,
        source: Box<dyn RunSource>,
        names: &[String],
        keep: Keep,
        progress: &dyn Progress,
    ) -> Result<Self> {
        let Setup { robot, settings, .. } = &setup;
        settings.validate(robot.joint_count())?;
        trace::check_settings(settings)?;
        let kept = KeptRuns::default();
        let reader = SuiteReader {
            source: source.as_ref(),
            options: read_options(&setup),
            robot,
            torque: settings.torque,
            nominal: settings.nominal,
            nominal_starts: &setup.nominal_starts,
            kept: &kept,
            keep_all: keep == Keep::All
                || settings.explain.is_some()
                || settings.notion != Notion::Hull,
        };
        let recordings = Recordings::read(&reader, names, progress)?;
        check_starts(&setup, source.as_ref(), &recordings)?;
        Ok(Self::of_recordings(setup, Origin::Source(source.into()), recordings, kept.into_runs()))
    }

    /// Makes the problem of recordings that were read, and notes what a user should know of them.
    pub(crate) fn of_recordings(
        setup: Setup,
        origin: Origin,
        mut recordings: Recordings,
        kept: HashMap<usize, Run>,
    ) -> Self {
        let notes = recordings.data_notes(&setup, &origin);
        recordings.notes.extend(notes);
        recordings.notes.extend(leaving_notes(&setup, &recordings));
        recordings.notes.extend(unknown_temperature(&setup, &recordings));
        let sensor_noise = sensor_noise(&setup, &recordings);
        let (robot, kept) = (setup.robot.description().clone(), Arc::new(kept));
        Self::of(setup, Arc::new(Read { origin, recordings, kept, sensor_noise, robot }))
    }

    /// Returns the problem of another model and other settings with the same recordings, which are
    /// not read again. What was recorded and how it was read must stay: the number of joints, the
    /// kind of torque, the nominal starts and the end of the runs.
    #[must_use]
    pub fn with_setup(&self, setup: Setup) -> Self {
        Self::of(setup, Arc::clone(&self.read))
    }

    pub(super) fn of(setup: Setup, read: Arc<Read>) -> Self {
        let (grids, cases, deviations) = Default::default();
        Self { setup, read, grids, cases, deviations, point_server: None }
    }

    /// Returns the setup: robot, model, settings.
    #[must_use]
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Returns the robot.
    #[must_use]
    pub fn robot(&self) -> &Robot {
        &self.setup.robot
    }

    /// Returns the model.
    #[must_use]
    pub fn dynamics(&self) -> &Dynamics {
        &self.setup.dynamics
    }

    /// Returns the settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.setup.settings
    }

    /// Returns the recordings.
    #[must_use]
    pub fn recordings(&self) -> &Recordings {
        &self.read.recordings
    }

    /// Returns the noise of the sensors, as it was given or estimated.
    #[must_use]
    pub fn sensor_noise(&self) -> &SensorNoise {
        &self.read.sensor_noise
    }

    /// Returns the number of joints n.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.setup.robot.joint_count()
    }

    /// Returns the sample grids of the recordings, with e^{At}, Γ(t) and κ(t) of the linear model.
    /// They are computed when first asked for.
    ///
    /// # Errors
    ///
    /// [`Error::NotLinear`] for any other model; when the solution of the system cannot be enclosed
    /// over a grid.
    pub fn grids(&self) -> Result<&Grids> {
        if let Some(grids) = self.grids.get() {
            return Ok(grids);
        }
        let system = self.dynamics().linear_system().ok_or(Error::NotLinear)?;
        let runs = self.read.recordings.suites.iter().flat_map(|suite| &suite.runs);
        let times = runs.map(|run| run.grid.as_ref());
        let grids = Grids::new(times, system, self.settings().disturbance)?;
        Ok(self.grids.get_or_init(|| grids))
    }

    /// Returns the deviations of all suites from the nominal solutions of the linear model. They
    /// are computed when first asked for.
    ///
    /// # Guarantee
    ///
    /// Outer, as [`Deviation::new`].
    ///
    /// # Errors
    ///
    /// As [`grids`](Self::grids) and [`run`](Self::run).
    pub fn deviations(&self) -> Result<&[Deviation]> {
        if let Some(deviations) = self.deviations.get() {
            return Ok(deviations);
        }
        let grids = self.grids()?;
        let of = |suite| self.cases_of(suite, |case| Ok(Deviation::new(grids, &case)));
        let suites = (0..self.read.recordings.suites.len()).map(of).collect::<Result<Vec<_>>>()?;
        Ok(self.deviations.get_or_init(|| Deviation::merge(suites.into_iter().flatten())))
    }
}

/// Refuses recordings that start outside the box over which the model's error was bounded: an
/// initial set that holds them would leave it too.
fn check_starts(setup: &Setup, source: &dyn RunSource, recordings: &Recordings) -> Result<()> {
    let Some(operating_box) = &setup.settings.operating_box else { return Ok(()) };
    for run in recordings.suites.iter().flat_map(|suite| &suite.runs) {
        for (i, &value) in run.start.iter().enumerate() {
            let [low, high] = side(operating_box, i);
            if !(low..=high).contains(&value) {
                let file = source.runs()[run.index].file.clone();
                let state = State::from_index(i, setup.robot.joint_count());
                return Err(Error::StartsOutsideBox { file, state, value, low, high });
            }
        }
    }
    Ok(())
}

/// Names, for each suite that leaves the box, where it does so first.
fn leaving_notes(setup: &Setup, recordings: &Recordings) -> Vec<String> {
    let Some(operating_box) = &setup.settings.operating_box else { return Vec::new() };
    let leaves = |suite: &Suite| {
        let envelope = &suite.envelope;
        let outside = |k: usize, i: usize| {
            let [low, high] = side(operating_box, i);
            envelope.upper(k, i) > high || envelope.lower(k, i) < low
        };
        let states = envelope.dimension();
        let mut places = (0..envelope.len()).flat_map(|k| (0..states).map(move |i| (k, i)));
        let (k, i) = places.find(|&(k, i)| outside(k, i))?;
        Some(format!(
            "suite {}: {} leaves the operating box at sample {k}. The model error has no proved \
             bound outside the box; there it is covered only by these recordings",
            suite.entry.name,
            State::from_index(i, setup.robot.joint_count())
        ))
    };
    recordings.suites.iter().filter_map(leaves).collect()
}

/// Says where friction depends on a temperature that a recording does not have.
fn unknown_temperature(setup: &Setup, recordings: &Recordings) -> Option<String> {
    let by_temperature = setup.robot.warms_by().contains(&WarmingBy::Temperature);
    let with: usize = recordings.suites.iter().map(|s| s.totals.with_temperature()).sum();
    let without = recordings.run_count() - with;
    (by_temperature && without > 0).then(|| {
        format!(
            "friction of the robot depends on temperature, and {without} of the {} recordings \
             have no columns temp1 to tempn; they are taken at the reference temperature",
            recordings.run_count()
        )
    })
}

/// The noise of the sensors, as the settings give it or these recordings show it.
pub(super) fn sensor_noise(setup: &Setup, recordings: &Recordings) -> SensorNoise {
    match &setup.settings.sensor_noise {
        Some(radius) => SensorNoise::given(radius.clone()),
        None => SensorNoise::estimate(recordings, setup.robot.joint_count()),
    }
}

pub(crate) fn read_options(setup: &Setup) -> ReadOptions {
    let Settings { gap_limit, until, .. } = setup.settings;
    ReadOptions { joints: Some(setup.robot.joint_count()), gap_limit, until }
}

/// The side of the box for state `i`, q then q̇.
pub(crate) fn side(operating_box: &OperatingBox, i: usize) -> [f64; 2] {
    let n = operating_box.q.len();
    if i < n { operating_box.q[i] } else { operating_box.qd[i - n] }
}
