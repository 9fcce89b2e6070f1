//! Static friction at rest.
//!
//! The torque of a joint at rest is known only up to a band: friction takes up any torque between
//! its limits. A joint that comes to rest keeps a part of the friction of its last motion, with the
//! side d = ±1 that the joint comes from. The mean part is measured where joints come from both
//! sides, and is taken out. What is left is not noise, because it is the same in all rests: a
//! torque c d of any size, and another part of the slopes by which friction rises with the load in
//! each quadrant. The rows of a joint at rest are weighted for that, so that what these can explain
//! counts for less, and the standard errors of a regression on the rows cover them.

use crate::prepare::log::PreparedLog;
use crate::regression::singular::Singular;
use nalgebra::DMatrix;
use reachtube_robot::Robot;

/// Size of a column that may explain torque of any size, in units of the noise.
const ANY_SIZE: f64 = 1e4;

/// Share of a joint's rests that must be reached from each side.
const LEAST_SHARE: f64 = 0.1;

/// Number of rests of which the sides are compared.
const FEWEST_RESTS: usize = 10;

/// A robot with the friction and the gravity that are known so far.
#[derive(Clone, Copy)]
pub(crate) struct KnownFriction<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Standard deviation of the torque of each joint at rest \[N m\].
    pub deviations: &'a [f64],
}

/// Returns the sign of the last velocity of each joint before sample `rest` that was above `speed`
/// \[rad/s\], n entries; 0 if the recording has none.
pub(crate) fn sides(log: &PreparedLog, rest: usize, speed: f64) -> Vec<f64> {
    let of_joint = |joint: usize| {
        let before = (0..rest).rev().map(|k| log.qd(k)[joint]);
        before.into_iter().find(|qd| qd.abs() > speed).map_or(0.0, f64::signum)
    };
    (0..log.joints).map(of_joint).collect()
}

/// The rests of all joints in recordings.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rests {
    /// Number of joints n.
    pub joints: usize,
    /// Mean positions \[rad\], row-major rests x n.
    pub q: Vec<f64>,
    /// Mean torques \[N m\], row-major rests x n.
    pub tau: Vec<f64>,
    /// The sides from which the joints come, row-major rests x n: 1 from below, -1 from above, 0 if
    /// the recordings do not show it.
    pub sides: Vec<f64>,
}

/// Friction that one joint may keep at its rests.
pub(crate) struct Kept {
    /// Its mean \[N m\], one entry per rest.
    pub mean: Vec<f64>,
    /// Columns by which it may differ, with coefficients of variance 1, in units of the noise.
    pub columns: DMatrix<f64>,
}

impl Rests {
    pub(crate) fn len(&self) -> usize {
        self.q.len() / self.joints.max(1)
    }

    /// Returns the positions at a rest \[rad\], n entries.
    pub(crate) fn q(&self, rest: usize) -> &[f64] {
        &self.q[rest * self.joints..(rest + 1) * self.joints]
    }

    fn side(&self, rest: usize, joint: usize) -> f64 {
        self.sides[rest * self.joints + joint]
    }

    /// Returns the friction that a joint may keep. Without known friction it may have any size.
    pub(crate) fn kept(&self, known: Option<KnownFriction>, joint: usize) -> Kept {
        let nothing = || Kept {
            mean: vec![0.0; self.len()],
            columns: DMatrix::from_fn(self.len(), 1, |k, _| ANY_SIZE * self.side(k, joint)),
        };
        let Some(KnownFriction { robot, deviations }) = known else { return nothing() };
        let coulomb = &robot.joints()[joint].friction.coulomb;
        let load: Vec<f64> =
            (0..self.len()).map(|k| robot.gravity_torque(self.q(k))[joint]).collect();
        let friction: Vec<f64> =
            load.iter().enumerate().map(|(k, l)| coulomb.torque(*l, self.side(k, joint))).collect();
        let moved: f64 = friction.iter().map(|f| f.abs()).sum();
        if moved == 0.0 || deviations[joint] == 0.0 {
            return nothing();
        }
        let found = load
            .iter()
            .enumerate()
            .map(|(k, load)| self.side(k, joint) * (self.tau[k * self.joints + joint] - load));
        let part = (found.sum::<f64>() / moved).clamp(0.0, 1.0);
        // Column 0 is the side, the others are the slopes of the quadrants.
        let column = |k: usize, column: usize| {
            let (side, slope) = (self.side(k, joint), coulomb.torque(load[k], self.side(k, joint)));
            let without = coulomb.torque(f64::MIN_POSITIVE.copysign(load[k]), side);
            let quadrant = 1 + usize::from(side < 0.0) + 2 * usize::from(load[k] < 0.0);
            match column {
                0 => ANY_SIZE * side,
                own if own == quadrant => part * (slope - without) / deviations[joint],
                _ => 0.0,
            }
        };
        Kept {
            mean: friction.iter().map(|friction| part * friction).collect(),
            columns: DMatrix::from_fn(self.len(), 5, column),
        }
    }
}

/// Takes out of rows what columns with coefficients of variance 1, in units of the noise, explain:
/// multiplies each column of `rows` by the square root of (I + N Nᵀ)⁻¹ for the columns N.
pub(crate) fn discount(columns: &DMatrix<f64>, rows: &mut DMatrix<f64>) {
    if columns.amax() == 0.0 {
        return;
    }
    let Singular { u, values, .. } = Singular::of(columns);
    let negligible = f64::EPSILON * values.max();
    for (direction, size) in u.column_iter().zip(values.iter()).filter(|(_, s)| **s > negligible) {
        let factor = 1.0 / 1f64.hypot(*size) - 1.0;
        let parts = rows.tr_mul(&direction);
        for (mut column, part) in rows.column_iter_mut().zip(parts.iter()) {
            column.axpy(factor * part, &direction, 1.0);
        }
    }
}

/// Returns a warning for each joint that comes to nearly all its rests from one side.
///
/// `sides` are row-major rests x n.
pub(crate) fn one_sided(robot: &Robot, sides: &[f64]) -> Vec<String> {
    let n = robot.joint_count();
    let warning = |(joint, name): (usize, &String)| {
        let own = || sides.iter().skip(joint).step_by(n);
        let [below, above] = [1.0, -1.0].map(|side| own().filter(|own| **own == side).count());
        let known = below + above;
        let few = (below.min(above) as f64) < LEAST_SHARE * known as f64;
        (known >= FEWEST_RESTS && few).then(|| {
            format!(
                "{name} comes to {} of {known} poses from the same side, so that its static \
                    friction looks like gravity; approach each pose from both sides",
                below.max(above)
            )
        })
    };
    let names = robot.joints().iter().map(|joint| &joint.name);
    names.enumerate().filter_map(warning).collect()
}

/// Returns a sentence about the rests of which the recordings do not show how they were reached, if
/// there are any. `sides` are row-major rests x n.
pub(crate) fn unknown_sides(sides: &[f64], joints: usize) -> Option<String> {
    let rests = sides.chunks_exact(joints);
    let (count, unknown) =
        (rests.len(), rests.filter(|sides| sides.iter().all(|side| *side == 0.0)).count());
    (unknown > 0).then(|| {
        format!(
            "the recordings of {unknown} of {count} poses begin at rest and do not show from which \
             side they were reached; static friction counts as noise of the torque"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_friction_explains_counts_for_less() {
        let side = DMatrix::from_row_slice(4, 1, &[1.0, -1.0, 1.0, -1.0]);
        let mut rows = DMatrix::from_row_slice(4, 2, &[3., 1., 1., 2., 3., 3., 1., 5.]);
        discount(&(1e9 * &side), &mut rows);
        // Without the difference of both sides, which has any size.
        assert!((rows.column(0) - DMatrix::from_element(4, 1, 2.0)).amax() < 1e-6);
        assert!(side.tr_mul(&rows).amax() < 1e-6);
        // A column of the size of the noise: N has the norm 1, so that its part shrinks by √2.
        let mut rows = side.clone();
        discount(&(0.5 * &side), &mut rows);
        assert!((rows - side / 2f64.sqrt()).amax() < 1e-12);
    }

    #[test]
    fn the_side_is_that_of_the_last_motion() {
        let mut log = PreparedLog::zeros("rest", 2, 6, 0.1);
        log.qd = vec![0.5, 0.0, -0.2, 0.0, -0.001, 0.3, 0.0, 0.002, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(sides(&log, 4, 0.01), [-1.0, 1.0]);
        assert_eq!(sides(&log, 2, 0.01), [-1.0, 0.0]);
        let robot = Robot::lwa4p();
        let up: Vec<f64> = (0..12 * 6).map(|k| if k == 7 { -1.0 } else { 1.0 }).collect();
        let warnings = one_sided(&robot, &up);
        assert!(warnings.len() == 6 && warnings[1].contains("joint2 comes to 11 of 12 poses"));
        let both: Vec<f64> = (0..12 * 6).map(|k| if k / 6 % 2 == 0 { -1.0 } else { 1.0 }).collect();
        assert!(one_sided(&robot, &both).is_empty());
    }
}
