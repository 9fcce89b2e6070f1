use std::path::Path;

use sha2::{Digest, Sha256};

use reachtube_files::hex;

use super::Defect;
use super::reading::read_samples;

/// How long the time between two samples may be. The input is taken as held until the next sample,
/// so a gap is a guess about the input.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum GapLimit {
    /// 1.9 times the usual time between samples at a fixed rate, 10 times where the times jitter.
    #[default]
    Usual,
    /// As many seconds.
    Seconds(f64),
}

/// One recording: K samples of n joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Number of joints n.
    pub joints: usize,
    /// Time of the first sample as recorded, s.
    pub start: f64,
    /// Times since the first sample, s, strictly increasing from 0, K. The difference is taken of
    /// the numbers as written, to the picosecond, so that times since 1970 lose nothing.
    pub times: Vec<f64>,
    /// States x = (q, q̇), rad and rad/s, row-major K x 2n.
    pub states: Vec<f64>,
    /// Recorded torques, N m, row-major K x n.
    pub torques: Vec<f64>,
    /// SHA-256 of the file, lower-case hexadecimal.
    pub sha256: String,
}

impl Run {
    /// Reads the run in the file `path`; samples later than `until` seconds after the first are
    /// left out. A run of other than `joints` joints is a defect.
    ///
    /// # Errors
    ///
    /// Every defect of the file, with line and joint.
    pub fn read(
        path: &Path,
        joints: Option<usize>,
        gap_limit: GapLimit,
        until: Option<f64>,
    ) -> Result<Self, Vec<Defect>> {
        let bytes = std::fs::read(path).map_err(|source| {
            vec![Defect::new(
                path,
                None,
                format!("cannot read: {source}"),
                "check the path and its permissions",
            )]
        })?;
        let mut run = read_samples(path, &bytes, joints, gap_limit)?;
        run.sha256 = hex(&Sha256::digest(&bytes));
        run.truncate(until);
        Ok(run)
    }

    /// No sample of `joints` joints.
    pub(super) fn empty(joints: usize) -> Self {
        Self {
            joints,
            start: 0.0,
            times: vec![],
            states: vec![],
            torques: vec![],
            sha256: String::new(),
        }
    }

    /// Number of samples K.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Time from the first to the last sample, s.
    pub fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// The state (q, q̇) at sample k, 2n entries.
    pub fn state(&self, k: usize) -> &[f64] {
        &self.states[k * 2 * self.joints..(k + 1) * 2 * self.joints]
    }

    /// Joint positions at sample k, rad.
    pub fn q(&self, k: usize) -> &[f64] {
        &self.state(k)[..self.joints]
    }

    /// Joint velocities at sample k, rad/s.
    pub fn qd(&self, k: usize) -> &[f64] {
        &self.state(k)[self.joints..]
    }

    /// Recorded torques at sample k, N m.
    pub fn torque(&self, k: usize) -> &[f64] {
        &self.torques[k * self.joints..(k + 1) * self.joints]
    }

    fn truncate(&mut self, until: Option<f64>) {
        let Some(until) = until else { return };
        let end = until * (1.0 + 1e-12);
        let count = self.times.partition_point(|&t| t <= end);
        self.times.truncate(count);
        self.states.truncate(count * 2 * self.joints);
        self.torques.truncate(count * self.joints);
    }
}

/// q1..qn, qd1..qdn, tau1..taun.
pub fn column_names(n: usize) -> impl Iterator<Item = String> {
    ["q", "qd", "tau"]
        .into_iter()
        .flat_map(move |prefix| (1..=n).map(move |i| format!("{prefix}{i}")))
}

/// The column of state `i` (from 0) of a robot of `joints` joints: q1..qn, qd1..qdn.
pub fn state_name(i: usize, joints: usize) -> String {
    column_names(joints).nth(i).unwrap_or_default()
}
