/// A recording: K samples of n joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Number of joints n.
    pub joints: usize,
    /// Time of the first sample as recorded, s.
    pub start: f64,
    /// Times since the first sample, K, s, strictly increasing from 0. For a file, differences are
    /// taken between the decimal numbers as written, to the picosecond.
    pub times: Vec<f64>,
    /// States x = (q, q̇), rad and rad/s, row-major K x 2n.
    pub states: Vec<f64>,
    /// Recorded torques, N m, row-major K x n.
    pub torques: Vec<f64>,
    /// Recorded temperatures of the joints, °C, row-major K x n; empty if none were recorded.
    pub temperatures: Vec<f64>,
    /// Positions, velocities and accelerations at the first sample, as far as it and earlier ones
    /// alone tell, 3n, rad, rad/s and rad/s²; empty if that is unknown.
    pub before: Vec<f64>,
    /// SHA-256 of the file, or of the numbers of a run in memory, in lower-case hexadecimal.
    pub sha256: String,
}

/// Why numbers are no run. Samples are counted from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// There is no joint.
    #[error("a run needs one joint at least")]
    NoJoint,
    /// There is no sample.
    #[error("a run needs one sample at least")]
    NoSample,
    /// An array does not have one row per sample.
    #[error("{array} has {length} numbers, but {samples} samples of {joints} joints need {needed}")]
    Length {
        /// Name of the array.
        array: &'static str,
        /// Its length.
        length: usize,
        /// Number of samples.
        samples: usize,
        /// Number of joints.
        joints: usize,
        /// The length that it needs.
        needed: usize,
    },
    /// A number is not finite.
    #[error("{array} holds {value} at sample {sample}; drop that sample")]
    NotFinite {
        /// Name of the array.
        array: &'static str,
        /// The number.
        value: f64,
        /// The sample.
        sample: usize,
    },
    /// Times do not increase.
    #[error(
        "the time of sample {sample}, {time} s, is not later than the time of the sample before; \
         sort the samples and drop duplicates"
    )]
    NotLater {
        /// The sample.
        sample: usize,
        /// Its time, s.
        time: f64,
    },
}

/// Checks that an array has `needed` finite numbers for its samples and joints.
fn check_rows(
    array: &'static str,
    values: &[f64],
    [samples, joints, needed]: [usize; 3],
) -> Result<(), RunError> {
    let length = values.len();
    if length != needed {
        return Err(RunError::Length { array, length, samples, joints, needed });
    }
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => {
            Err(RunError::NotFinite { array, value: values[at], sample: at * samples / needed })
        }
    }
}

impl Run {
    /// Returns a run of `joints` joints from numbers in memory: `times` (K, s, strictly
    /// increasing), `states` (q then q̇, row-major K x 2n, rad and rad/s) and `torques` (row-major
    /// K x n, N m). The first time becomes 0.
    ///
    /// # Errors
    ///
    /// The error names the array and the sample when there is no joint or no sample, lengths do
    /// not fit, a number is not finite, or times do not increase.
    pub fn new(
        joints: usize,
        times: Vec<f64>,
        states: Vec<f64>,
        torques: Vec<f64>,
    ) -> Result<Self, RunError> {
        if joints == 0 {
            return Err(RunError::NoJoint);
        }
        let samples = times.len();
        for (array, values, width) in
            [("times", &times, 1), ("states", &states, 2 * joints), ("torques", &torques, joints)]
        {
            check_rows(array, values, [samples, joints, samples * width])?;
        }
        if let Some(sample) = (1..samples).find(|&k| times[k] <= times[k - 1]) {
            return Err(RunError::NotLater { sample, time: times[sample] });
        }
        let start = times.first().copied().ok_or(RunError::NoSample)?;
        let times = times.iter().map(|time| time - start).collect();
        let [temperatures, before] = [vec![], vec![]];
        let sha256 = String::new();
        Ok(Self { joints, start, times, states, torques, temperatures, before, sha256 })
    }

    /// Returns the run with the temperatures of its joints, °C, row-major K x n.
    ///
    /// # Errors
    ///
    /// The error names the sample when their number does not fit or one is not finite.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_recordings::Run;
    ///
    /// let run = Run::new(1, vec![0.0, 0.1], vec![0.0; 4], vec![0.0; 2])?;
    /// assert_eq!(run.mean_temperature(), None);
    /// let warm = run.with_temperatures(vec![30.0, 31.0])?;
    /// assert_eq!(warm.mean_temperature(), Some(vec![30.5]));
    /// # Ok::<(), reachtube_recordings::RunError>(())
    /// ```
    pub fn with_temperatures(mut self, temperatures: Vec<f64>) -> Result<Self, RunError> {
        let (samples, joints) = (self.len(), self.joints);
        check_rows("temperatures", &temperatures, [samples, joints, samples * joints])?;
        self.temperatures = temperatures;
        Ok(self)
    }

    /// Returns the number of samples K.
    #[must_use]
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Returns the number of states, 2n.
    #[must_use]
    pub fn dimension(&self) -> usize {
        2 * self.joints
    }

    /// Returns whether there is no sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Returns the time from the first to the last sample, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Returns the state (q, q̇) at sample `k` (from 0), 2n, rad and rad/s.
    #[must_use]
    #[inline]
    pub fn state(&self, k: usize) -> &[f64] {
        &self.states[k * 2 * self.joints..(k + 1) * 2 * self.joints]
    }

    /// Returns the joint positions at sample `k` (from 0), n, rad.
    #[must_use]
    #[inline]
    pub fn q(&self, k: usize) -> &[f64] {
        &self.state(k)[..self.joints]
    }

    /// Returns the joint velocities at sample `k` (from 0), n, rad/s.
    #[must_use]
    #[inline]
    pub fn qd(&self, k: usize) -> &[f64] {
        &self.state(k)[self.joints..]
    }

    /// Returns the recorded torques at sample `k` (from 0), n, N m.
    #[must_use]
    #[inline]
    pub fn torque(&self, k: usize) -> &[f64] {
        &self.torques[k * self.joints..(k + 1) * self.joints]
    }

    /// Returns the recorded temperatures at sample `k` (from 0), n, °C.
    ///
    /// # Panics
    ///
    /// Panics if none were recorded.
    #[must_use]
    pub fn temperature(&self, k: usize) -> &[f64] {
        &self.temperatures[k * self.joints..(k + 1) * self.joints]
    }

    /// Returns the mean temperature of each joint over the samples, n, °C; `None` if none were
    /// recorded.
    #[must_use]
    pub fn mean_temperature(&self) -> Option<Vec<f64>> {
        let mean = |joint: usize| {
            let values = self.temperatures.iter().skip(joint).step_by(self.joints);
            values.sum::<f64>() / self.len() as f64
        };
        (!self.temperatures.is_empty()).then(|| (0..self.joints).map(mean).collect())
    }

    /// Returns some of the samples, in increasing order, with times since the first of them.
    ///
    /// # Panics
    ///
    /// Panics if there is none of them.
    #[must_use]
    pub fn only(&self, samples: impl Iterator<Item = usize> + Clone) -> Self {
        let first = samples.clone().next().expect("a run has a sample");
        let rows = |values: &[f64], width: usize| match values {
            [] => vec![],
            _ => {
                samples.clone().flat_map(|k| &values[width * k..width * (k + 1)]).copied().collect()
            }
        };
        Self {
            joints: self.joints,
            start: self.start + self.times[first],
            times: samples.clone().map(|k| self.times[k] - self.times[first]).collect(),
            states: rows(&self.states, 2 * self.joints),
            torques: rows(&self.torques, self.joints),
            temperatures: rows(&self.temperatures, self.joints),
            before: if first == 0 { self.before.clone() } else { vec![] },
            sha256: self.sha256.clone(),
        }
    }

    /// Drops the samples later than `until` seconds after the first.
    pub(crate) fn truncate(&mut self, until: Option<f64>) {
        let Some(until) = until else { return };
        // A sample at `until` itself is kept, whatever the rounding of its time.
        let end = until * (1.0 + 1e-12);
        let count = self.times.partition_point(|&t| t <= end);
        self.times.truncate(count);
        self.states.truncate(count * 2 * self.joints);
        self.torques.truncate(count * self.joints);
        self.temperatures.truncate(count * self.joints);
    }
}

/// Returns the names of the columns of a recording after the time: q1..qn, qd1..qdn, tau1..taun.
pub fn column_names(n: usize) -> impl Iterator<Item = String> {
    ["q", "qd", "tau"]
        .into_iter()
        .flat_map(move |prefix| (1..=n).map(move |i| format!("{prefix}{i}")))
}

#[cfg(test)]
mod tests {
    use super::Run;

    #[test]
    fn times_count_from_the_first() {
        let run = Run::new(1, vec![5.0, 5.5], vec![1.0, 2.0, 3.0, 4.0], vec![5.0, 6.0]).unwrap();
        assert_eq!((run.start, &run.times[..], run.duration()), (5.0, &[0.0, 0.5][..], 0.5));
        assert_eq!((run.state(1), run.q(1), run.qd(1)), (&[3.0, 4.0][..], &[3.0][..], &[4.0][..]));
        assert_eq!((run.torque(0), run.len(), run.is_empty()), (&[5.0][..], 2, false));
    }

    #[test]
    fn times_of_some_samples_count_from_the_first_of_them() {
        let times: Vec<f64> = (0..5).map(|k| 2.0 + 0.5 * f64::from(k)).collect();
        let run = Run::new(1, times, (0..10).map(f64::from).collect(), vec![3.0; 5]).unwrap();
        let part = run.with_temperatures(vec![20.0, 21.0, 22.0, 23.0, 24.0]).unwrap().only(2..4);
        assert_eq!((part.start, &part.times[..]), (3.0, &[0.0, 0.5][..]));
        assert_eq!((&part.states[..], part.torques.len()), (&[4.0, 5.0, 6.0, 7.0][..], 2));
        assert_eq!(part.temperatures, [22.0, 23.0]);
    }

    #[test]
    fn temperatures_are_one_per_sample_and_joint() {
        let run = |joints| {
            Run::new(joints, vec![0.0, 1.0], vec![0.0; 4 * joints], vec![0.0; 2 * joints]).unwrap()
        };
        let mut warm = run(2).with_temperatures(vec![20.0, 30.0, 22.0, 31.0]).unwrap();
        assert_eq!(warm.mean_temperature(), Some(vec![21.0, 30.5]));
        warm.truncate(Some(0.5));
        assert_eq!(warm.mean_temperature(), Some(vec![20.0, 30.0]));
        assert_eq!((run(2).mean_temperature(), run(2).temperatures.capacity()), (None, 0));
        assert_eq!(
            run(2).with_temperatures(vec![20.0; 2]).unwrap_err().to_string(),
            "temperatures has 2 numbers, but 2 samples of 2 joints need 4"
        );
        assert_eq!(
            run(1).with_temperatures(vec![20.0, f64::NAN]).unwrap_err().to_string(),
            "temperatures holds NaN at sample 1; drop that sample"
        );
    }

    #[test]
    fn numbers_that_do_not_fit_are_refused() {
        let refused = |joints, times: &[f64], states: &[f64], torques: &[f64]| {
            Run::new(joints, times.to_vec(), states.to_vec(), torques.to_vec())
                .unwrap_err()
                .to_string()
        };
        assert_eq!(refused(0, &[0.0], &[], &[]), "a run needs one joint at least");
        assert_eq!(refused(1, &[], &[], &[]), "a run needs one sample at least");
        assert_eq!(
            refused(2, &[0.0, 1.0], &[0.0; 6], &[0.0; 4]),
            "states has 6 numbers, but 2 samples of 2 joints need 8"
        );
        assert_eq!(
            refused(2, &[0.0, 1.0], &[0.0; 8], &[0.0; 2]),
            "torques has 2 numbers, but 2 samples of 2 joints need 4"
        );
        let states = [0.0, 0.0, 0.0, f64::NAN];
        assert_eq!(
            refused(1, &[0.0, 1.0], &states, &[0.0; 2]),
            "states holds NaN at sample 1; drop that sample"
        );
        assert_eq!(
            refused(1, &[f64::INFINITY, 1.0], &[0.0; 4], &[0.0; 2]),
            "times holds inf at sample 0; drop that sample"
        );
        for times in [[1.0, 1.0], [1.0, 0.5]] {
            let error = refused(1, &times, &[0.0; 4], &[0.0; 2]);
            assert!(error.starts_with("the time of sample 1, "), "{error}");
        }
    }
}
