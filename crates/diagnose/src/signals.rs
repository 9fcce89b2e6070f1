use crate::change::Change;

/// Joints whose velocities have a correlation beyond this move alike.
const ALIKE: f64 = 0.995;

/// A recording of an arm, filtered, in rows of n values.
#[derive(Debug, Clone)]
pub struct Signals<'a> {
    /// Time between samples, s.
    pub step: f64,
    /// Positions, velocities and accelerations, rad and s.
    pub motion: [&'a [f64]; 3],
    /// Torques, N m.
    pub torques: &'a [f64],
    /// Whether a joint moves; its torque is not used where it does not.
    pub moves: Vec<bool>,
}

impl Signals<'_> {
    /// Returns the samples at which at least one of n joints moves.
    pub(crate) fn moving(&self, n: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.moves.len() / n).filter(move |k| self.moves[k * n..(k + 1) * n].contains(&true))
    }

    /// Returns the torque of a joint at a sample as `change` reads the recording; `None` beyond its
    /// ends.
    pub(crate) fn read(&self, change: &Change) -> impl Fn(usize, usize) -> Option<f64> {
        let n = change.lags.len();
        let shift = |lag: &f64| (lag / self.step).round() as isize;
        let shifts: Vec<isize> = change.lags.iter().map(shift).collect();
        move |k, joint| {
            let at = k.checked_add_signed(shifts[joint])? * n + change.torque_columns[joint];
            Some(change.torque_factors[joint] * self.torques.get(at)?)
        }
    }

    fn products(&self, n: usize, [a, b]: [usize; 2]) -> [f64; 3] {
        let rows = self.motion[1].chunks_exact(n);
        rows.fold([0.0; 3], |[aa, ab, bb], qd| {
            [aa + qd[a] * qd[a], ab + qd[a] * qd[b], bb + qd[b] * qd[b]]
        })
    }
}

/// Returns whether two of n joints move alike in all recordings.
pub(crate) fn move_alike(recordings: &[Signals], n: usize, joints: [usize; 2]) -> bool {
    let sums = recordings.iter().map(|log| log.products(n, joints));
    let [aa, ab, bb] = sums.fold([0.0; 3], |[a, b, c], [x, y, z]| [a + x, b + y, c + z]);
    aa > 0.0 && bb > 0.0 && ab * ab > ALIKE * ALIKE * aa * bb
}
