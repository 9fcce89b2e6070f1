use crate::needed::NeededTorques;

/// Longest lag that is tried, s.
const LONGEST: f64 = 0.2;

/// Number of samples of all recordings that are compared.
const SAMPLES: usize = 4000;

/// A lag is found if the product over the joints of the parts that it leaves of the squares of what
/// is unexplained otherwise, in the half of the recordings that did not choose it, is below this.
const CLEAR: f64 = 0.1;

/// The squares of what torques miss that are moved by each of some numbers of samples.
struct Squares {
    /// The longest lag in samples; lag i is i samples less this.
    longest: usize,
    /// The sums for each half of the recordings and each lag, n.
    halves: [Vec<Vec<f64>>; 2],
}

/// Returns the time by which the torques of n joints come later than the motion that they belong
/// to, s; it is negative where they come earlier. `None` unless the lag explains much more of them,
/// also in the half of each recording that did not choose it. Recordings whose time between samples
/// differs from the first one's are no evidence.
#[must_use]
pub fn torque_lag(recordings: &[NeededTorques], joints: usize) -> Option<f64> {
    let step = recordings.first()?.step;
    let squares = Squares::of(recordings, joints, step);
    let carries_over = |[own, other]: [usize; 2]| {
        let chosen = squares.least(&[own]);
        chosen.is_some_and(|lag| squares.score(&[other], lag) < CLEAR.ln())
    };
    let is_clear = [[0, 1], [1, 0]].into_iter().all(carries_over);
    is_clear.then(|| squares.lag(step)).flatten()
}

/// Returns the lag as [`torque_lag`] does, also where it explains little: what is left of one that
/// was taken off.
#[must_use]
pub fn remaining_lag(recordings: &[NeededTorques], joints: usize) -> Option<f64> {
    let step = recordings.first()?.step;
    Squares::of(recordings, joints, step).lag(step)
}

impl Squares {
    fn of(recordings: &[NeededTorques], joints: usize, step: f64) -> Self {
        let longest = (LONGEST / step).round() as usize;
        let alike = || recordings.iter().filter(|own| own.step == step);
        let rows: usize = alike().map(|own| own.recorded.len() / joints).sum();
        let stride = rows.div_ceil(SAMPLES).max(1);
        let none = vec![vec![0.0; joints]; 2 * longest + 1];
        let mut halves = [none.clone(), none];
        for own in alike() {
            let rows = own.recorded.len() / joints;
            for k in (longest..rows.saturating_sub(longest)).step_by(stride) {
                let half = &mut halves[usize::from(2 * k > rows)];
                for (lag, sums) in half.iter_mut().enumerate() {
                    let late = k + lag - longest;
                    for (joint, sum) in sums.iter_mut().enumerate() {
                        let missed =
                            own.recorded[late * joints + joint] - own.needed[k * joints + joint];
                        *sum += missed * missed;
                    }
                }
            }
        }
        Self { longest, halves }
    }

    fn least(&self, halves: &[usize]) -> Option<usize> {
        let lags = 0..=2 * self.longest;
        lags.min_by(|a, b| self.score(halves, *a).total_cmp(&self.score(halves, *b)))
    }

    /// Returns the lag that leaves least of both halves, s.
    fn lag(&self, step: f64) -> Option<f64> {
        let both = [0, 1];
        let best = self.least(&both)?;
        let is_inside = best > 0 && best < 2 * self.longest;
        // The parabola through three sums has its least between samples.
        let between = is_inside.then(|| {
            let [before, at, after] = [best - 1, best, best + 1].map(|lag| self.sum(&both, lag));
            0.5 * (before - after) / (before - 2.0 * at + after)
        });
        Some((best as f64 - self.longest as f64 + between.unwrap_or(0.0)) * step)
    }

    fn of_joint(&self, halves: &[usize], lag: usize, joint: usize) -> f64 {
        halves.iter().map(|half| self.halves[*half][lag][joint]).sum()
    }

    fn part(&self, halves: &[usize], lag: usize, joint: usize) -> f64 {
        let without = self.of_joint(halves, self.longest, joint).max(f64::MIN_POSITIVE);
        self.of_joint(halves, lag, joint).max(f64::MIN_POSITIVE) / without
    }

    fn joints(&self) -> usize {
        self.halves[0][0].len()
    }

    /// Returns the logarithm of the product of the joints' parts.
    fn score(&self, halves: &[usize], lag: usize) -> f64 {
        (0..self.joints()).map(|joint| self.part(halves, lag, joint).ln()).sum()
    }

    /// Returns the sum of the joints' parts, a parabola about its least.
    fn sum(&self, halves: &[usize], lag: usize) -> f64 {
        (0..self.joints()).map(|joint| self.part(halves, lag, joint)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the lag that is found in torques of two joints that are `late`, s.
    fn found(late: f64, noise: f64) -> Option<f64> {
        let step = 0.02;
        let at = |k: usize, late: f64| {
            let t = step * k as f64 - late;
            [(1.3 * t).sin() + (3.1 * t).cos(), 5.0 * (2.1 * t).cos()]
        };
        let error = |k: usize| noise * (((k * 7919) % 1009) as f64 / 1009.0 - 0.5);
        let recorded: Vec<f64> =
            (0..1000).flat_map(|k| at(k, late).map(|torque| torque + error(k))).collect();
        let needed = (0..1000).flat_map(|k| at(k, 0.0)).collect();
        torque_lag(&[NeededTorques { step, motion: [&[]; 3], recorded: &recorded, needed }], 2)
    }

    #[test]
    fn late_and_early_torques_are_found_between_samples() {
        for late in [0.04, 0.03, -0.1] {
            let own = found(late, 0.1).unwrap();
            assert!((own - late).abs() < 2e-3, "{own}");
        }
        assert_eq!(found(0.0, 0.1), None);
        assert_eq!(found(0.04, 30.0), None, "noise shows no lag");
    }
}
