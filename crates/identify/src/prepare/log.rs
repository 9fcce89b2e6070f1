use reachtube_diagnose::Signals;

/// A recording prepared for regression: K evenly spaced samples of n joints, filtered without
/// phase shift.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedLog {
    /// Name of the file.
    pub name: String,
    /// Number of joints n.
    pub joints: usize,
    /// Time between samples \[s\].
    pub step: f64,
    /// Time of the first sample, counted from the first sample of the recording \[s\].
    pub start: f64,
    /// Positions \[rad\], row-major K x n.
    pub q: Vec<f64>,
    /// Velocities \[rad/s\], row-major K x n.
    pub qd: Vec<f64>,
    /// Accelerations \[rad/s²\], row-major K x n.
    pub qdd: Vec<f64>,
    /// Torques \[N m\] after the gains, row-major K x n.
    pub tau: Vec<f64>,
    /// Whether the velocities are the differentiated positions.
    pub differentiated: bool,
    /// Temperatures of the joints \[°C\], row-major K x n; empty if none were recorded.
    pub temperatures: Vec<f64>,
    /// Positions, velocities and accelerations at each sample, as far as it and earlier ones alone
    /// tell ([`Run::before`]), rad, rad/s and rad/s², row-major K x 3n; empty if unknown.
    ///
    /// [`Run::before`]: reachtube_recordings::Run::before
    pub before: Vec<f64>,
    /// Number of the recording since the robot's start, from 1, if it is known.
    pub order: Option<u64>,
    /// Least speed of each joint about each sample \[rad/s\], row-major K x n, for a log that was
    /// thinned; else empty.
    pub(crate) slowest: Vec<f64>,
}

impl PreparedLog {
    #[must_use]
    pub(crate) fn zeros(name: &str, joints: usize, samples: usize, step: f64) -> Self {
        let zeros = vec![0.0; joints * samples];
        let [q, qd, qdd, tau] = [zeros.clone(), zeros.clone(), zeros.clone(), zeros];
        Self {
            name: name.into(),
            joints,
            step,
            start: 0.0,
            q,
            qd,
            qdd,
            tau,
            differentiated: false,
            temperatures: vec![],
            before: vec![],
            order: None,
            slowest: vec![],
        }
    }

    /// Returns the log with every `stride`-th sample. It remembers the least speed within `margin`
    /// \[s\] of each sample, so that [`PreparedLog::moving_mask`] knows the samples between.
    #[must_use]
    pub(crate) fn thinned(&self, stride: usize, margin: f64) -> Self {
        if stride <= 1 {
            return self.clone();
        }
        let (n, reach) = (self.joints, (margin / self.step).round() as usize);
        let kept = || (0..self.len()).step_by(stride);
        let slowest = |k: usize, joint: usize| {
            let about = k.saturating_sub(reach)..(k + reach + 1).min(self.len());
            about.map(|k| self.qd(k)[joint].abs()).fold(f64::INFINITY, f64::min)
        };
        let rows = |values: &[f64]| match values {
            [] => vec![],
            values => kept().flat_map(|k| values[k * n..(k + 1) * n].iter().copied()).collect(),
        };
        Self {
            step: self.step * stride as f64,
            q: rows(&self.q),
            qd: rows(&self.qd),
            qdd: rows(&self.qdd),
            tau: rows(&self.tau),
            temperatures: rows(&self.temperatures),
            before: vec![],
            slowest: kept().flat_map(|k| (0..n).map(move |j| slowest(k, j))).collect(),
            name: self.name.clone(),
            ..*self
        }
    }

    /// Returns the number of samples K.
    #[must_use]
    pub fn len(&self) -> usize {
        self.q.len() / self.joints
    }

    /// Returns the positions at sample k \[rad\], n entries.
    #[must_use]
    pub fn q(&self, k: usize) -> &[f64] {
        &self.q[k * self.joints..(k + 1) * self.joints]
    }

    /// Returns the velocities at sample k \[rad/s\], n entries.
    #[must_use]
    pub fn qd(&self, k: usize) -> &[f64] {
        &self.qd[k * self.joints..(k + 1) * self.joints]
    }

    /// Returns the accelerations at sample k \[rad/s²\], n entries.
    #[must_use]
    pub fn qdd(&self, k: usize) -> &[f64] {
        &self.qdd[k * self.joints..(k + 1) * self.joints]
    }

    /// Returns the torques at sample k \[N m\], n entries.
    #[must_use]
    pub fn tau(&self, k: usize) -> &[f64] {
        &self.tau[k * self.joints..(k + 1) * self.joints]
    }

    /// Returns the time of sample k, counted from the first sample of the recording \[s\].
    #[must_use]
    pub(crate) fn time(&self, k: usize) -> f64 {
        self.start + k as f64 * self.step
    }

    /// Returns whether each joint moves at each sample, row-major K x n.
    ///
    /// A joint moves if it is at least as fast as its entry of `slow` \[rad/s\] throughout `margin`
    /// \[s\] before and after the sample. The margin is needed because a low-pass spreads the step
    /// of Coulomb friction at a reversal over about half a period of its cut-off.
    #[must_use]
    pub(crate) fn moving_mask(&self, slow: &[f64], margin: f64) -> Vec<bool> {
        if !self.slowest.is_empty() {
            let fast = |(at, slowest): (usize, &f64)| *slowest >= slow[at % self.joints];
            return self.slowest.iter().enumerate().map(fast).collect();
        }
        let reach = (margin / self.step).round() as usize;
        let mut moves = vec![true; self.qd.len()];
        for (joint, slow) in slow.iter().enumerate() {
            let forward: Vec<usize> = (0..self.len()).map(|k| k * self.joints + joint).collect();
            let backward: Vec<usize> = forward.iter().rev().copied().collect();
            for order in [forward, backward] {
                let mut since = usize::MAX;
                for at in order {
                    since = if self.qd[at].abs() < *slow { 0 } else { since.saturating_add(1) };
                    moves[at] &= since > reach;
                }
            }
        }
        moves
    }

    /// Returns the log for a diagnosis, with the joints that [move](Self::moving_mask).
    pub(crate) fn signals(&self, slow: &[f64], margin: f64) -> Signals<'_> {
        Signals {
            step: self.step,
            motion: [&self.q, &self.qd, &self.qdd],
            torques: &self.tau,
            moves: self.moving_mask(slow, margin),
        }
    }

    /// Returns the log of the samples in `range`.
    #[must_use]
    pub fn interval(&self, range: std::ops::Range<usize>) -> Self {
        let n = self.joints;
        let of = |values: &[f64]| match values {
            [] => vec![],
            values => values[range.start * n..range.end * n].to_vec(),
        };
        let [q, qd, qdd, tau, temperatures, slowest] =
            [&self.q, &self.qd, &self.qdd, &self.tau, &self.temperatures, &self.slowest]
                .map(|values| of(values));
        Self {
            name: self.name.clone(),
            differentiated: self.differentiated,
            joints: n,
            step: self.step,
            start: self.time(range.start),
            q,
            qd,
            qdd,
            tau,
            temperatures,
            before: self
                .before
                .get(range.start * 3 * n..range.end * 3 * n)
                .map_or(vec![], <[f64]>::to_vec),
            order: self.order,
            slowest,
        }
    }
}

/// Returns at most `most` logs, evenly spread over those given.
pub(crate) fn spread(logs: &[PreparedLog], most: usize) -> Vec<&PreparedLog> {
    let count = logs.len().min(most);
    (0..count).map(|k| &logs[k * logs.len() / count]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_does_not_move_near_a_reversal() {
        let mut log = PreparedLog::zeros("reversal", 1, 20, 0.1);
        log.qd = (0..20).map(|k| if k == 10 { 0.0 } else { 1.0 }).collect();
        let at_rest: Vec<usize> = (0..20).filter(|k| !log.moving_mask(&[0.5], 0.2)[*k]).collect();
        assert_eq!(at_rest, [8, 9, 10, 11, 12]);
        assert_eq!(log.moving_mask(&[0.5], 0.0).iter().filter(|moves| !**moves).count(), 1);
        // A thinned log knows the samples that it has lost.
        let thinned = log.thinned(4, 0.2);
        assert_eq!((thinned.len(), thinned.step), (5, 0.4));
        let at_rest = (0..5).filter(|k| !thinned.moving_mask(&[0.5], 0.2)[*k]);
        assert_eq!(at_rest.collect::<Vec<_>>(), [2, 3]);
    }
}
