use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use reachtube_reach::{Nonlinear, System};
use reachtube_recordings::{Run, RunEntry, RunSource};

use crate::data::case::Case;
use crate::data::kept::KeptRuns;
use crate::data::notes::recording_notes;
use crate::data::origin::Origin;
use crate::data::recordings::Recordings;
use crate::data::runaway::Runaway;
use crate::data::sensor_noise::SensorNoise;
use crate::data::settings::Settings;
use crate::data::setup::{Setup, read_options};
use crate::data::shape::Shape;
use crate::data::signals::{Part, Signals};
use crate::data::suite::SuiteReader;
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::tube::deviation::{Deviation, Nominal};
use crate::tube::grids::Grids;
use crate::tube::place::Place;

/// Which runs stay in memory, sample by sample, after they were folded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Keep {
    /// Suites that have a nominal motion of their own.
    #[default]
    Needed,
    /// All, as figures need them; up to 256 MiB, beyond which runs are read again.
    All,
}

/// A problem: a model, settings and recordings, which are read once and folded into what the steps
/// need. [`conform`](crate::conform), [`check`](crate::check()) and [`reach`](crate::reach())
/// take it.
#[derive(Debug)]
pub struct Problem {
    setup: Setup,
    pub(crate) read: Arc<Read>,
    grids: OnceLock<Grids>,
    pub(crate) cases: OnceLock<Vec<Case>>,
    deviations: OnceLock<Deviations>,
}

/// The deviations of all suites from nominal motions of a linear model.
#[derive(Debug)]
pub(crate) struct Deviations {
    /// The deviations. They are infinite after a nominal motion ran away.
    pub all: Vec<Deviation>,
    /// Where U is scaled, the places of the strands that they face.
    pub places: Vec<Place>,
    /// Where nominal motions run away.
    pub runaways: Vec<Runaway>,
}

/// What was read of the recordings. It does not depend on the model.
#[derive(Debug)]
pub(crate) struct Read {
    pub origin: Origin,
    pub recordings: Recordings,
    pub kept: Arc<HashMap<usize, Run>>,
    pub sensor_noise: SensorNoise,
    pub input_key: String,
}

impl Problem {
    /// Reads the suites `names` of `source` (all when none is named) on all cores.
    ///
    /// # Errors
    ///
    /// Every defect of every run, an unknown suite.
    pub fn read(
        setup: Setup,
        source: Box<dyn RunSource>,
        names: &[String],
        keep: Keep,
        progress: &dyn Progress,
    ) -> Result<Self> {
        let Setup { drive, dynamics, settings, .. } = &setup;
        settings.validate(dynamics.inputs())?;
        let kept = KeptRuns::default();
        let reader = SuiteReader {
            source: source.as_ref(),
            options: read_options(&setup),
            drive: &**drive,
            shape: Shape::of_states(dynamics.states(), dynamics.inputs()),
            nominal: settings.nominal,
            nominal_starts: &setup.nominal_starts,
            kept: &kept,
            keep_all: keep == Keep::All || settings.notion.asks_points(),
        };
        let recordings = Recordings::read(&reader, names, progress)?;
        Ok(Self::of_recordings(setup, Origin::Source(source.into()), recordings, kept.into_runs()))
    }

    pub(crate) fn of_recordings(
        setup: Setup,
        origin: Origin,
        mut recordings: Recordings,
        kept: HashMap<usize, Run>,
    ) -> Self {
        let notes = recording_notes(&setup, &origin, &recordings);
        recordings.notes.extend(notes);
        let sensor_noise = sensor_noise(&setup, &recordings);
        let (input_key, kept) = (setup.drive.input_key(None), Arc::new(kept));
        Self::of(setup, Arc::new(Read { origin, recordings, kept, sensor_noise, input_key }))
    }

    /// Returns the problem of another model and other settings with the same recordings, which are
    /// not read again. What was recorded and how it was read must stay: the number of inputs, the
    /// kind of torque, the nominal starts and the end of the runs.
    #[must_use]
    pub fn with_setup(&self, setup: Setup) -> Self {
        Self::of(setup, Arc::clone(&self.read))
    }

    pub(super) fn of(setup: Setup, read: Arc<Read>) -> Self {
        let (grids, cases, deviations) = Default::default();
        Self { setup, read, grids, cases, deviations }
    }

    /// Returns the setup: drive, model, settings.
    #[must_use]
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Returns the model.
    #[must_use]
    pub fn dynamics(&self) -> &System {
        &self.setup.dynamics
    }

    /// Returns the model, which is not linear.
    ///
    /// # Panics
    ///
    /// For a linear model, which has steps of its own.
    pub(crate) fn nonlinear(&self) -> &dyn Nonlinear {
        self.dynamics().nonlinear_system().expect("steps of models that are not linear")
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

    /// Returns the number of inputs n.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.setup.dynamics.inputs()
    }

    /// Returns the number of states, 2n.
    #[must_use]
    pub fn states(&self) -> usize {
        self.setup.dynamics.states()
    }

    pub(crate) fn shape(&self) -> Shape {
        Shape::of_states(self.states(), self.inputs())
    }

    /// Returns what the numbers of the model are.
    #[must_use]
    pub fn signals(&self) -> &Signals {
        self.setup.drive.signals()
    }

    /// Returns the parts of the system, whose states are looked at together.
    pub(crate) fn parts(&self) -> &[Part] {
        &self.signals().parts
    }

    /// Returns the states of each projection in which recorded points must lie in the set.
    pub(crate) fn projections(&self) -> Vec<Vec<usize>> {
        let rows = self.settings().states.rows(self.states());
        self.settings().notion.projections(rows, self.parts())
    }

    /// Returns the states of each kind, such as all positions: the first states of all parts, then
    /// their second ones.
    pub(crate) fn kinds(&self) -> Vec<Vec<usize>> {
        let most = self.parts().iter().map(|part| part.states.len()).max().unwrap_or(0);
        let of =
            |at: usize| self.parts().iter().filter_map(move |part| part.states.get(at)).copied();
        (0..most).map(|at| of(at).collect()).collect()
    }

    /// Returns the source's entry of run `index`.
    ///
    /// # Panics
    ///
    /// Where the source has no run `index`, or the fold that the problem was made of has not kept
    /// its entry; it keeps the entries of the runs in [`Suite::runs`](crate::data::Suite::runs) and
    /// of the runs that have a bound of an envelope.
    #[must_use]
    pub fn entry(&self, index: usize) -> &RunEntry {
        self.read.origin.entry(index)
    }

    /// Returns the lowest and the highest recorded value of state `i`.
    pub(crate) fn recorded_bounds(&self, i: usize) -> [f64; 2] {
        let envelopes = self.recordings().suites.iter().map(|suite| &suite.envelope);
        let samples =
            envelopes.flat_map(|envelope| (0..envelope.len()).map(move |k| (envelope, k)));
        samples.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (envelope, k)| {
            [low.min(envelope.lower(k, i)), high.max(envelope.upper(k, i))]
        })
    }

    /// Returns whether a recording of the source is marked as simulated.
    #[must_use]
    pub fn is_simulated(&self) -> bool {
        self.read.origin.is_simulated()
    }

    /// Returns the samples of run `index`: from memory, or read once more where they were not kept.
    ///
    /// # Errors
    ///
    /// Defects, [`Error::Changed`] when the recording is not the one that was read first, or
    /// [`Error::Fold`] when the problem was made of a fold that has not kept them.
    pub fn run(&self, index: usize) -> Result<Cow<'_, Run>> {
        if let Some(run) = self.read.kept.get(&index) {
            return Ok(Cow::Borrowed(run));
        }
        let Origin::Source(source) = &self.read.origin else {
            return Err(Error::Fold(format!(
                "it has not kept the samples of run {index}, and this step needs them; read the \
                 recordings on one machine for it"
            ).into()));
        };
        let run = source
            .read(index, &read_options(self.setup()))
            .map_err(reachtube_recordings::Error::Defects)?;
        let summaries = self.read.recordings.suites.iter().flat_map(|suite| &suite.runs);
        let read_first = summaries.into_iter().find(|summary| summary.index == index);
        if read_first.is_some_and(|summary| summary.sha256 != run.sha256) {
            return Err(Error::Changed { path: source.run_name(index) });
        }
        Ok(Cow::Owned(run))
    }

    /// Returns the sample grids of the recordings, with e^{At}, Γ(t) and κ(t) of the linear model.
    /// They are computed when first asked for.
    ///
    /// # Errors
    ///
    /// [`Error::NotLinear`] for any other model; when the solution of the system cannot be enclosed
    /// over a grid.
    pub(crate) fn grids(&self) -> Result<&Grids> {
        if let Some(grids) = self.grids.get() {
            return Ok(grids);
        }
        let system = self.dynamics().linear_system().ok_or(Error::NotLinear)?;
        let runs = self.read.recordings.suites.iter().flat_map(|suite| &suite.runs);
        let times = runs.map(|run| run.grid.as_ref());
        let grids = Grids::new(times, system, self.settings().disturbance)?;
        Ok(self.grids.get_or_init(|| grids))
    }

    /// Returns the deviations of all suites from the nominal motions of the linear model. They
    /// are computed when first asked for.
    ///
    /// # Guarantee
    ///
    /// Outer, as [`Deviation::new`].
    pub(crate) fn deviations(&self) -> Result<&[Deviation]> {
        let Deviations { all, runaways, .. } = self.deviations_until()?;
        match runaways.first() {
            None => Ok(all),
            Some(Runaway { case, time, .. }) => {
                Err(Error::RunsAway { case: case.clone(), time: *time })
            }
        }
    }

    /// Returns the deviations of all suites, and where nominal motions run away: deviations are
    /// infinite from there on, so that no set encloses them.
    pub(crate) fn deviations_until(&self) -> Result<&Deviations> {
        if let Some(deviations) = self.deviations.get() {
            return Ok(deviations);
        }
        let grids = self.grids()?;
        let of_case = |case, runaway: Option<Runaway>| {
            let nominal = Nominal::new(grids, &case);
            let (deviation, scale) = (Deviation::new(&case, &nominal), self.scale(&case, &nominal));
            Ok(match &runaway {
                Some(at) => (deviation.lost_after(at.sample), scale, runaway),
                None => (deviation, scale, None),
            })
        };
        let of = |suite| self.cases_until(suite, of_case);
        let suites = (0..self.read.recordings.suites.len()).map(of).collect::<Result<Vec<_>>>()?;
        let cases: Vec<_> = suites.into_iter().flatten().collect();
        let places = match self.settings().input_doubling {
            Some(_) => Place::distinct(cases.iter().map(|(own, scale, _)| (own.strand, scale))),
            None => Vec::new(),
        };
        let mut runaways = Vec::new();
        let faced = cases.into_iter().map(|(own, scale, runaway)| {
            runaways.extend(runaway);
            Deviation { strand: Place::find(&places, own.strand, &scale), ..own }
        });
        let all = Deviation::merge(faced);
        Ok(self.deviations.get_or_init(|| Deviations { all, places, runaways }))
    }
}

pub(super) fn sensor_noise(setup: &Setup, recordings: &Recordings) -> SensorNoise {
    match &setup.settings.sensor_noise {
        Some(radius) => SensorNoise::given(radius.clone()),
        None => SensorNoise::estimate(recordings, setup.dynamics.inputs()),
    }
}
