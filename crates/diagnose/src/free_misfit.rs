use nalgebra::{Cholesky, DMatrix, DVector};
use reachtube_robot::{Parameter, Regressor, Robot};

use crate::change::Change;
use crate::hypothesis::Hypothesis;
use crate::likeliest::{Misfit, likeliest_fault};
use crate::signals::Signals;

/// Number of samples that suffice to recognise a fault.
const ENOUGH_SAMPLES: usize = 300;

/// What is added to the diagonal of the normal equations of columns of length 1, so that columns
/// that the recordings do not distinguish are no error.
const RIDGE: f64 = 1e-12;

/// The torque that no parameters of a robot explain in some recordings.
pub struct FreeMisfit<'a> {
    robot: &'a Robot,
    columns: Vec<Parameter>,
    recordings: Vec<Signals<'a>>,
    stride: usize,
}

/// The weighted rows of a regression, each of one joint.
struct Rows {
    joints: Vec<usize>,
    y: DMatrix<f64>,
    torques: DVector<f64>,
}

impl<'a> FreeMisfit<'a> {
    /// Takes recordings of a robot whose parameters `columns` are free; their effects must be
    /// independent.
    #[must_use]
    pub fn new(robot: &'a Robot, columns: Vec<Parameter>, recordings: Vec<Signals<'a>>) -> Self {
        let moving = recordings.iter().map(|own| own.moving(robot.joint_count()).count());
        let stride = moving.sum::<usize>().div_ceil(ENOUGH_SAMPLES).max(1);
        Self { robot, columns, recordings, stride }
    }

    /// Returns the one fault of the columns that explains the torque best, with the joint whose
    /// squared residuals drop most, and the share that remains of them. `None` if no fault explains
    /// enough. Only degrees are looked for if the recordings do not determine all combinations of
    /// parameters.
    #[must_use]
    pub fn likeliest_fault(&self, is_determined: bool) -> Option<(Hypothesis, (usize, f64))> {
        likeliest_fault(self, is_determined)
    }

    fn rows(&self, change: &Change) -> Rows {
        let n = self.robot.joint_count();
        let (mut joints, mut torques, mut kept, mut states) = (vec![], vec![], vec![], vec![]);
        for own in &self.recordings {
            let late = own.read(change);
            let has_torque = |k: &usize| (0..n).all(|joint| late(*k, joint).is_some());
            for k in own.moving(n).step_by(self.stride).filter(has_torque) {
                let row = |values: &'a [f64]| &values[k * n..(k + 1) * n];
                for joint in 0..n {
                    if own.moves[k * n + change.motion_columns[joint]] {
                        joints.push(joint);
                        torques.extend(late(k, joint));
                        kept.push(states.len() * n + joint);
                    }
                }
                let [q, qd, qdd] = own.motion.map(row);
                states.push([change.q(q), change.rates(qd), change.rates(qdd)]);
            }
        }
        let y = Regressor::new(self.robot, &self.columns).stacked(&states).select_rows(&kept);
        Rows { joints, y, torques: DVector::from_vec(torques) }
    }
}

impl Misfit for FreeMisfit<'_> {
    fn robot(&self) -> &Robot {
        self.robot
    }

    fn recordings(&self) -> &[Signals<'_>] {
        &self.recordings
    }

    /// Returns the root mean square of the torque of each joint that no parameters explain, N m.
    ///
    /// The second of two fits weights each joint by its residuals.
    fn sizes(&self, change: &Change) -> Option<Vec<f64>> {
        let rows = self.rows(change);
        if rows.joints.len() < 2 * self.columns.len() {
            return None;
        }
        let mut sizes = rows.sizes(&rows.torques, self.robot.joint_count());
        for _ in 0..2 {
            sizes = rows.sizes(&rows.residuals(&sizes)?, sizes.len());
        }
        Some(sizes)
    }
}

impl Rows {
    fn sizes(&self, values: &DVector<f64>, joints: usize) -> Vec<f64> {
        let mut sums = vec![[0.0; 2]; joints];
        for (joint, value) in self.joints.iter().zip(values.iter()) {
            sums[*joint] = [sums[*joint][0] + value * value, sums[*joint][1] + 1.0];
        }
        let size = |[sum, count]: [f64; 2]| (sum / count.max(1.0)).sqrt().max(f64::MIN_POSITIVE);
        sums.into_iter().map(size).collect()
    }

    /// Returns the residuals of the fit whose rows have weights inverse to the `sizes` of their
    /// joints.
    fn residuals(&self, sizes: &[f64]) -> Option<DVector<f64>> {
        let weight = |row: usize| sizes[self.joints[row]].recip();
        let mut y = self.y.clone();
        y.row_iter_mut().enumerate().for_each(|(row, mut y)| y *= weight(row));
        let scales: Vec<f64> =
            y.column_iter().map(|column| column.norm().max(f64::MIN_POSITIVE)).collect();
        y.column_iter_mut().zip(&scales).for_each(|(mut column, scale)| column /= *scale);
        let right = DVector::from_fn(y.nrows(), |row, _| weight(row) * self.torques[row]);
        let normal = y.tr_mul(&y) + DMatrix::identity(y.ncols(), y.ncols()) * RIDGE;
        let mut theta = Cholesky::new(normal)?.solve(&y.tr_mul(&right));
        theta.iter_mut().zip(&scales).for_each(|(theta, scale)| *theta /= *scale);
        Some(&self.torques - &self.y * theta)
    }
}
