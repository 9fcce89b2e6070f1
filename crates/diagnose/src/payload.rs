use nalgebra::{DMatrix, DVector};
use reachtube_robot::{Parameter, ParameterKind, Regressor, Robot};

use crate::needed::NeededTorques;

/// Number of samples of a recording that are compared.
const SAMPLES: usize = 400;

/// A payload is found if it leaves less than this part of the squares of what is unexplained
/// otherwise, in the half of the recording that did not give it.
const LEFT: f64 = 0.5;

/// The inertial parameters of a body.
const BODY: [ParameterKind; 10] = [
    ParameterKind::Mass,
    ParameterKind::MomentX,
    ParameterKind::MomentY,
    ParameterKind::MomentZ,
    ParameterKind::Ixx,
    ParameterKind::Ixy,
    ParameterKind::Iyy,
    ParameterKind::Ixz,
    ParameterKind::Iyz,
    ParameterKind::Izz,
];

/// What is added to the diagonal of the normal equations of columns of length 1, so that parameters
/// that a recording does not show are no error.
const RIDGE: f64 = 1e-6;

/// A body at the last link that explains torques of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShownPayload {
    /// Its mass, kg; negative if the last link has less than the robot's.
    pub mass: f64,
    /// The part of the squares of what is unexplained otherwise that it explains, in the halves of
    /// the recording that did not give it.
    pub explained: f64,
}

/// Returns the body at the last link that explains most of what a recording needs beyond a robot;
/// `None` unless it explains at least half, also in the half of the recording that did not give
/// it, and has some mass.
#[must_use]
pub fn payload(robot: &Robot, recording: &NeededTorques) -> Option<ShownPayload> {
    let n = robot.joint_count();
    let count = recording.recorded.len() / n;
    let samples: Vec<usize> = (0..count).step_by(count.div_ceil(SAMPLES).max(1)).collect();
    let halves = samples.split_at(samples.len() / 2);
    let halves = [halves.0, halves.1].map(|half| Rows::of(robot, recording, half));
    let [first, second] = [halves[0].body()?, halves[1].body()?];
    let left = halves[0].missed(&second) + halves[1].missed(&first);
    let part = left / (halves[0].torques.norm_squared() + halves[1].torques.norm_squared());
    let mass = 0.5 * (first[0] + second[0]);
    let is_alike = first[0] * second[0] > 0.0;
    (part < LEFT && is_alike).then_some(ShownPayload { mass, explained: 1.0 - part })
}

/// What is unexplained in some samples, and what the parameters of a body at the last link add.
struct Rows {
    y: DMatrix<f64>,
    torques: DVector<f64>,
}

impl Rows {
    fn of(robot: &Robot, recording: &NeededTorques, samples: &[usize]) -> Self {
        let n = robot.joint_count();
        let columns = BODY.map(|kind| Parameter { joint: n - 1, kind });
        let states: Vec<[Vec<f64>; 3]> = samples
            .iter()
            .map(|k| recording.motion.map(|values| values[k * n..(k + 1) * n].to_vec()))
            .collect();
        let missed = samples.iter().flat_map(|k| {
            (k * n..(k + 1) * n).map(|row| recording.recorded[row] - recording.needed[row])
        });
        let torques = DVector::from_iterator(samples.len() * n, missed);
        Self { y: Regressor::new(robot, &columns).stacked(&states), torques }
    }

    /// Returns the parameters of the body by least squares.
    fn body(&self) -> Option<DVector<f64>> {
        let scales: Vec<f64> =
            self.y.column_iter().map(|column| column.norm().max(f64::MIN_POSITIVE)).collect();
        let mut y = self.y.clone();
        y.column_iter_mut().zip(&scales).for_each(|(mut column, scale)| column /= *scale);
        let normal = y.tr_mul(&y) + DMatrix::identity(y.ncols(), y.ncols()) * RIDGE;
        let mut body = normal.cholesky()?.solve(&y.tr_mul(&self.torques));
        body.iter_mut().zip(&scales).for_each(|(value, scale)| *value /= *scale);
        Some(body)
    }

    fn missed(&self, body: &DVector<f64>) -> f64 {
        (&self.torques - &self.y * body).norm_squared()
    }
}
