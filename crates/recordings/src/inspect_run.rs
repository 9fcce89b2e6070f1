//! The summary of one run, which is all of it that an inspection keeps.

use reachtube_reach::TimeGrid;

use crate::notes::run_notes;
use crate::run::Run;
use crate::source::RunSource;
use crate::units::integral_gap;

/// Speed below which a joint sticks, rad/s.
const STICKING: f64 = 0.01;

/// The summary of one run.
pub(crate) struct InspectedRun {
    /// Place in the order of recording, from 1.
    pub order: u64,
    /// Number of samples.
    pub samples: usize,
    /// Duration, s.
    pub duration: f64,
    /// Time between samples, s, where it is fixed.
    pub step: Option<f64>,
    /// Shortest and longest time between two samples, s.
    pub steps: [f64; 2],
    /// Whether the run has the torques of the first run of its group at the same times.
    pub same_torque: bool,
    /// Summary of each joint, n.
    pub joints: Vec<JointOfRun>,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub sha256: String,
}

/// The summary of one joint over a run.
pub(crate) struct JointOfRun {
    /// Lowest and highest position, rad.
    pub position: [f64; 2],
    /// First position, rad.
    pub first: f64,
    /// Last position, rad.
    pub last: f64,
    /// Highest speed, rad/s.
    pub speed: f64,
    /// Largest magnitude of the torque, N m.
    pub torque: f64,
    /// Lowest and highest temperature, °C, if recorded.
    pub temperature: Option<[f64; 2]>,
    /// Number of samples in which the joint sticks.
    pub sticking: usize,
    /// Largest difference between q and the integral of qd, rad.
    pub integral_gap: f64,
}

impl InspectedRun {
    /// Summarises run `index` of a source; `first` is the first run of its group.
    pub(crate) fn new(source: &dyn RunSource, index: usize, run: &Run, first: &Run) -> Self {
        let steps = run.times.windows(2).map(|pair| pair[1] - pair[0]);
        Self {
            order: source.runs()[index].order,
            samples: run.len(),
            duration: run.duration(),
            step: TimeGrid::from_times(&run.times).ok().and_then(|grid| grid.step()),
            steps: steps.fold([f64::INFINITY, 0.0], |[a, b], h| [a.min(h), b.max(h)]),
            same_torque: same_torque(first, run),
            joints: (0..run.joints).map(|joint| JointOfRun::new(run, joint)).collect(),
            notes: run_notes(&source.runs()[index], run),
            sha256: run.sha256.clone(),
        }
    }

    pub(crate) fn has_temperatures(&self) -> bool {
        self.joints.iter().any(|joint| joint.temperature.is_some())
    }

    pub(crate) fn joint_count(&self) -> usize {
        self.joints.len()
    }
}

impl JointOfRun {
    fn new(run: &Run, joint: usize) -> Self {
        let samples = 0..run.len();
        let positions = || samples.clone().map(|k| run.q(k)[joint]);
        let speeds = || samples.clone().map(|k| run.qd(k)[joint].abs());
        let temperatures = run.temperatures.iter().skip(joint).step_by(run.joints);
        Self {
            temperature: range(temperatures.copied()),
            position: [
                positions().fold(f64::INFINITY, f64::min),
                positions().fold(f64::NEG_INFINITY, f64::max),
            ],
            first: run.q(0)[joint],
            last: run.q(run.len() - 1)[joint],
            speed: speeds().fold(0.0, f64::max),
            torque: samples.clone().map(|k| run.torque(k)[joint].abs()).fold(0.0, f64::max),
            sticking: speeds().filter(|speed| *speed < STICKING).count(),
            integral_gap: integral_gap(run, joint),
        }
    }
}

/// Returns the smallest and the largest of some values; `None` for no value.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    values.fold(None, |range: Option<[f64; 2]>, value| {
        let [low, high] = range.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    })
}

/// Returns whether two runs have equal torques at equal times, up to the end of the shorter one.
/// The torque of the last sample acts on nothing and is not compared.
fn same_torque(a: &Run, b: &Run) -> bool {
    if a.joints != b.joints {
        return false;
    }
    let count = a.len().min(b.len());
    let since_start = |run: &Run, k: usize| run.times[k] - run.times[0];
    let acting = count.saturating_sub(1) * a.joints;
    a.torques[..acting] == b.torques[..acting]
        && (0..count).all(|k| (since_start(a, k) - since_start(b, k)).abs() <= 1e-9)
}
