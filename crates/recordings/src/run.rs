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
    /// Makes a run of `joints` joints from numbers in memory: `times` (s, strictly increasing, K),
    /// `states` (q then q̇, rad and rad/s, row-major K x 2n) and `torques` (N m, row-major K x n).
    /// Times are counted from the first.
    ///
    /// # Errors
    ///
    /// A sentence that names the array and the sample when lengths do not fit, a number is not
    /// finite, or times do not increase.
    pub fn new(
        joints: usize,
        times: Vec<f64>,
        states: Vec<f64>,
        torques: Vec<f64>,
    ) -> Result<Self, String> {
        let samples = times.len();
        for (name, values, width) in
            [("times", &times, 1), ("states", &states, 2 * joints), ("torques", &torques, joints)]
        {
            if values.len() != samples * width {
                let needed = samples * width;
                let length = values.len();
                return Err(format!(
                    "{name} has {length} numbers; {samples} samples of {joints} joints need {needed}"
                ));
            }
            if let Some(at) = values.iter().position(|value| !value.is_finite()) {
                let (value, sample) = (values[at], at / width);
                return Err(format!("{name} holds {value} at sample {sample}; drop that sample"));
            }
        }
        if let Some(k) = (1..samples).find(|&k| times[k] <= times[k - 1]) {
            return Err(format!(
                "the time of sample {k} is not later than that of the sample before; sort the \
                 samples and drop duplicates"
            ));
        }
        let start = times.first().copied().ok_or("a run needs one sample at least")?;
        let times = times.iter().map(|time| time - start).collect();
        Ok(Self { joints, start, times, states, torques, sha256: String::new() })
    }

    /// No sample of `joints` joints.
    pub(crate) fn empty(joints: usize) -> Self {
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

    /// Drops the samples later than `until` seconds after the first.
    pub(crate) fn truncate(&mut self, until: Option<f64>) {
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
