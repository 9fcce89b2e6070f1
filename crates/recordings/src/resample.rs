//! Samples one at a time, at even times: interpolated where they were taken at others.

use crate::sample_error::SampleError;

/// Times that agree to this many s count as equal, as in a grid of recorded times.
const SAME: f64 = 1e-12;

/// One sample: its time, q, q̇ and the torque (3n).
#[derive(Debug, Clone, Default)]
pub struct Sample {
    /// Its time, s.
    pub time: f64,
    /// Positions, velocities and torques, 3n.
    pub values: Vec<f64>,
}

impl Sample {
    /// Returns a sample of zeros.
    #[must_use]
    pub fn zeros(joints: usize) -> Self {
        Self { time: 0.0, values: vec![0.0; 3 * joints] }
    }

    /// Takes the time and the values of another one.
    pub fn copy(&mut self, other: &Self) {
        self.time = other.time;
        self.values.copy_from_slice(&other.values);
    }

    /// Returns the measured state, 2n.
    #[must_use]
    pub fn state(&self) -> &[f64] {
        &self.values[..self.values.len() / 3 * 2]
    }

    /// Returns the torques, n.
    #[must_use]
    pub fn torque(&self) -> &[f64] {
        &self.values[self.values.len() / 3 * 2..]
    }
}

/// Makes samples at the times t_0 + k h of samples at any times, without allocation.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::EvenSamples;
///
/// let mut even = EvenSamples::new(1, 0.5, 0.9);
/// even.take(0.0, [&[1.0], &[0.0], &[0.0]])?;
/// assert_eq!(even.next().map(|sample| sample.time), Some(0.0));
/// even.take(0.8, [&[1.8], &[0.0], &[0.0]])?;
/// assert_eq!(even.next().map(|sample| sample.values[0]), Some(1.5));
/// assert!(even.next().is_none());
/// # Ok::<(), reachtube_recordings::SampleError>(())
/// ```
#[derive(Debug, Clone)]
pub struct EvenSamples {
    step: f64,
    longest_gap: f64,
    /// Time of the first sample, if there was one.
    origin: Option<f64>,
    /// Number of samples that were made.
    count: u64,
    last: Sample,
    new: Sample,
    made: Sample,
}

impl EvenSamples {
    /// Makes samples of `joints` joints, `step` \[s\] apart, and refuses gaps longer than
    /// `longest_gap` \[s\].
    #[must_use]
    pub fn new(joints: usize, step: f64, longest_gap: f64) -> Self {
        let [last, new, made] = [(); 3].map(|()| Sample::zeros(joints));
        Self { step, longest_gap, origin: None, count: 0, last, new, made }
    }

    /// Forgets all samples.
    pub fn clear(&mut self) {
        (self.origin, self.count) = (None, 0);
    }

    /// Takes a sample. The even samples that it completes follow from [`next`](Self::next), which
    /// must be called until there is none.
    ///
    /// # Errors
    ///
    /// A sample that cannot be used; it is not taken.
    pub fn take(&mut self, time: f64, parts: [&[f64]; 3]) -> Result<(), SampleError> {
        let n = self.new.values.len() / 3;
        for (what, part) in ["positions", "velocities", "torques"].into_iter().zip(parts) {
            if part.len() != n {
                return Err(SampleError::Count { what, given: part.len(), needed: n });
            }
        }
        let is_wrong = |value: &f64| !value.is_finite();
        if is_wrong(&time) {
            return Err(SampleError::NotFinite { name: "t".into(), value: time });
        }
        for (name, part) in ["q", "qd", "tau"].into_iter().zip(parts) {
            if let Some(joint) = part.iter().position(is_wrong) {
                let name = format!("{name}{}", joint + 1);
                return Err(SampleError::NotFinite { name, value: part[joint] });
            }
        }
        let previous = self.new.time;
        if self.origin.is_some() && time <= previous {
            return Err(SampleError::Order { time, previous });
        }
        let longest = self.longest_gap;
        if self.origin.is_some() && time - previous > longest * (1.0 + 1e-9) + SAME {
            return Err(SampleError::Gap { time, previous, longest });
        }
        std::mem::swap(&mut self.last, &mut self.new);
        self.new.time = time;
        let parts = self.new.values.chunks_exact_mut(n.max(1)).zip(parts);
        parts.for_each(|(own, part)| own.copy_from_slice(part));
        if self.origin.is_none() {
            self.origin = Some(time);
            self.last.copy(&self.new);
        }
        Ok(())
    }

    /// Returns the next sample at an even time, if the last one that was taken is not before it.
    #[expect(clippy::should_implement_trait, reason = "an iterator cannot lend its items")]
    pub fn next(&mut self) -> Option<&Sample> {
        let due = self.origin? + self.count as f64 * self.step;
        let ahead = self.new.time - due;
        let is_same = ahead.abs() <= SAME + 2.0 * f64::EPSILON * due.abs();
        if !is_same && ahead < 0.0 {
            return None;
        }
        self.count += 1;
        if is_same {
            self.made.copy(&self.new);
            return Some(&self.made);
        }
        let share = (due - self.last.time) / (self.new.time - self.last.time);
        let between = self.last.values.iter().zip(&self.new.values);
        let made = self.made.values.iter_mut().zip(between);
        made.for_each(|(made, (last, new))| *made = last + share * (new - last));
        self.made.time = due;
        Some(&self.made)
    }
}
