use reachtube_recordings::Run;

/// A recording prepared for regression: K evenly spaced samples of n joints, filtered without
/// delay.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// The file's name.
    pub name: String,
    /// Number of joints n.
    pub joints: usize,
    /// Time between samples \[s\].
    pub step: f64,
    /// Time of the first sample after that of the recording's first \[s\].
    pub start: f64,
    /// Positions \[rad\], row-major K x n.
    pub q: Vec<f64>,
    /// Velocities \[rad/s\], likewise.
    pub qd: Vec<f64>,
    /// Accelerations \[rad/s²\], likewise.
    pub qdd: Vec<f64>,
    /// Torques \[N m\] after the gains, likewise.
    pub tau: Vec<f64>,
}

impl Log {
    /// A log of zeros.
    pub fn blank(name: &str, joints: usize, samples: usize, step: f64) -> Self {
        let zeros = vec![0.0; joints * samples];
        let [q, qd, qdd, tau] = [zeros.clone(), zeros.clone(), zeros.clone(), zeros];
        Self { name: name.into(), joints, step, start: 0.0, q, qd, qdd, tau }
    }

    /// Number of samples K.
    pub fn len(&self) -> usize {
        self.q.len() / self.joints
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.q.is_empty()
    }

    /// Positions at sample k \[rad\].
    pub fn q(&self, k: usize) -> &[f64] {
        &self.q[k * self.joints..(k + 1) * self.joints]
    }

    /// Velocities at sample k \[rad/s\].
    pub fn qd(&self, k: usize) -> &[f64] {
        &self.qd[k * self.joints..(k + 1) * self.joints]
    }

    /// Accelerations at sample k \[rad/s²\].
    pub fn qdd(&self, k: usize) -> &[f64] {
        &self.qdd[k * self.joints..(k + 1) * self.joints]
    }

    /// Torques at sample k \[N m\].
    pub fn tau(&self, k: usize) -> &[f64] {
        &self.tau[k * self.joints..(k + 1) * self.joints]
    }

    /// Time of sample k after the recording's first \[s\].
    pub fn time(&self, k: usize) -> f64 {
        self.start + k as f64 * self.step
    }

    /// Whether each joint moves, row-major K x n: not slower than `slow` \[rad/s\], and not for
    /// `margin` \[s\] before and after.
    ///
    /// A low-pass spreads the step of Coulomb friction where a joint turns over about half a period
    /// of its cut-off.
    pub fn moves(&self, slow: &[f64], margin: f64) -> Vec<bool> {
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

    /// The samples `range` alone.
    pub fn part(&self, range: std::ops::Range<usize>) -> Self {
        let n = self.joints;
        let rows = |values: &[f64]| values[range.start * n..range.end * n].to_vec();
        let [q, qd, qdd, tau] =
            [&self.q, &self.qd, &self.qdd, &self.tau].map(|values| rows(values));
        Self {
            name: self.name.clone(),
            joints: n,
            step: self.step,
            start: self.time(range.start),
            q,
            qd,
            qdd,
            tau,
        }
    }
}

/// A recording as it was read, with its columns in the order of the robot's joints.
#[derive(Debug, Clone)]
pub struct RawLog {
    /// The file's name.
    pub name: String,
    /// The samples.
    pub run: Run,
}

impl RawLog {
    /// One column: values of `joint` by sample.
    pub(super) fn column<'a>(
        &'a self,
        which: fn(&'a Run, usize) -> &'a [f64],
        joint: usize,
    ) -> impl Fn(usize) -> f64 + 'a {
        move |k| which(&self.run, k)[joint]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_moves_where_it_is_fast_and_does_not_turn_soon() {
        let mut log = Log::blank("turns", 1, 20, 0.1);
        log.qd = (0..20).map(|k| if k == 10 { 0.0 } else { 1.0 }).collect();
        let at_rest: Vec<usize> = (0..20).filter(|k| !log.moves(&[0.5], 0.2)[*k]).collect();
        assert_eq!(at_rest, [8, 9, 10, 11, 12]);
        assert_eq!(log.moves(&[0.5], 0.0).iter().filter(|moves| !**moves).count(), 1);
    }
}
