use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::change::Change;
use crate::signals::Signals;

/// Number of parts of the recordings, each of which is left out in turn.
const PARTS: usize = 8;

/// A joint that moves in fewer samples is not judged.
const FEWEST: f64 = 64.0;

/// Part of the diagonal that is added to normal equations: effects that the recordings do not
/// distinguish are no error.
const RIDGE: f64 = 1e-9;

/// Columns of a sample: the recorded torque, the torque of the described links' inertia, and the
/// torque of gravity of 1 m/s² along each axis of the base ...
const WIDTH: usize = 9;

/// ... then friction and motors: q̈, q̇, its sign and 1.
const FRICTION: [usize; 4] = [5, 6, 7, 8];

/// Combination of the columns of a sample.
pub(crate) type Terms = SVector<f64, WIDTH>;

type Gram = SMatrix<f64, WIDTH, WIDTH>;

/// Products of the columns of a sample, summed over parts of the recordings, for each joint.
pub(crate) struct Moments {
    parts: Vec<Vec<Gram>>,
    has_motors: bool,
}

/// What some terms explain of the torque of a joint.
pub(crate) struct JointTerms {
    /// The values of the free terms, then of friction.
    pub values: Vec<f64>,
    /// The values of the free terms without each part of the recordings.
    without: Vec<Vec<f64>>,
    /// The sum of the squares of what is not explained in the parts that were left out.
    pub missed: f64,
}

impl JointTerms {
    /// Returns the standard error of a free term by the jackknife over parts of the recordings.
    pub(crate) fn error(&self, term: usize) -> f64 {
        let count = self.without.len() as f64;
        let mean = self.without.iter().map(|values| values[term]).sum::<f64>() / count;
        let sum: f64 = self.without.iter().map(|values| (values[term] - mean).powi(2)).sum();
        (sum * (count - 1.0) / count).sqrt()
    }
}

pub(crate) fn recorded() -> Terms {
    unit(0)
}

pub(crate) fn inertia() -> Terms {
    unit(1)
}

pub(crate) fn gravity(acceleration: [f64; 3]) -> Terms {
    (0..3).map(|axis| unit(2 + axis) * acceleration[axis]).sum()
}

fn unit(column: usize) -> Terms {
    Terms::ith(column, 1.0)
}

impl Moments {
    /// Sums over about `most` samples of recordings in which a joint moves, as `change` reads them.
    pub(crate) fn new(robot: &Robot, logs: &[Signals], change: &Change, most: usize) -> Self {
        let n = robot.joint_count();
        let along = [0, 1, 2].map(|axis| {
            robot.with_gravity([0, 1, 2].map(|other| f64::from(u8::from(axis == other))))
        });
        let samples = logs.iter().map(|log| log.moves.len() / n).sum::<usize>();
        let stride = samples.div_ceil(most).max(1);
        let pieces = PARTS.div_ceil(logs.len().max(1));
        let mut parts = vec![vec![Gram::zeros(); n]; PARTS.min(pieces * logs.len()).max(2)];
        for (at, log) in logs.iter().enumerate() {
            let count = log.moves.len() / n;
            let torques = log.read(change);
            for k in (0..count).step_by(stride) {
                let row = |values: &'_ [f64]| values[k * n..(k + 1) * n].to_vec();
                let [q, qd, qdd] = log.motion.map(row);
                let [q, qd, qdd] = [change.q(&q), change.rates(&qd), change.rates(&qdd)];
                let inertia = robot.motion_torque(&q, &qd, &qdd);
                let gravities = along.each_ref().map(|robot| robot.gravity_torque(&q));
                let part = (at * pieces + k * pieces / count) % parts.len();
                for joint in (0..n).filter(|joint| log.moves[k * n + change.motion_columns[*joint]])
                {
                    let Some(torque) = torques(k, joint) else { continue };
                    let motor = robot.joints()[joint].armature * qdd[joint];
                    let [x, y, z] = gravities.each_ref().map(|gravity| gravity[joint]);
                    let rigid = [torque, inertia[joint] - motor, x, y, z];
                    let friction = [qdd[joint], qd[joint], qd[joint].signum(), 1.0];
                    let columns = Terms::from_iterator(rigid.into_iter().chain(friction));
                    parts[part][joint] += columns * columns.transpose();
                }
            }
        }
        Self { parts, has_motors: change.torque != Torque::Link }
    }

    pub(crate) fn joints(&self) -> usize {
        self.parts[0].len()
    }

    fn whole(&self, joint: usize) -> Gram {
        self.parts.iter().map(|part| part[joint]).sum()
    }

    /// Returns the root mean square of some terms of a joint.
    pub(crate) fn size(&self, joint: usize, terms: &Terms) -> f64 {
        let gram = self.whole(joint);
        (square(&gram, terms) / gram[(WIDTH - 1, WIDTH - 1)].max(1.0)).sqrt()
    }

    /// Returns the sum of the squares of a joint's torque about its mean; 0 if it moves little.
    pub(crate) fn variance(&self, joint: usize) -> f64 {
        let (gram, one) = (self.whole(joint), WIDTH - 1);
        let count = gram[(one, one)];
        if count < FEWEST { 0.0 } else { gram[(0, 0)] - gram[(0, one)].powi(2) / count }
    }

    /// Returns the power that friction takes from a joint, with the values of its terms, by the
    /// product of the root mean squares of torque and speed; below 0 if it drives the joint.
    pub(crate) fn friction_power(&self, joint: usize, friction: &[f64]) -> f64 {
        let (gram, speed) = (self.whole(joint), FRICTION[1]);
        let power = friction[friction.len() - 3] * gram[(speed, speed)]
            + friction[friction.len() - 2] * gram[(speed, FRICTION[2])];
        power / (gram[(0, 0)] * gram[(speed, speed)]).sqrt().max(f64::MIN_POSITIVE)
    }

    /// Explains what `torque` leaves of a joint's torque by `free` terms and friction.
    pub(crate) fn explained(&self, joint: usize, torque: &Terms, free: &[Terms]) -> JointTerms {
        let terms = self.with_friction(free);
        let whole = self.whole(joint);
        let (mut without, mut missed) = (Vec::new(), 0.0);
        for part in &self.parts {
            let values = solved(&(whole - part[joint]), torque, &terms);
            missed += square(&part[joint], &left(torque, &terms, &values)).max(0.0);
            without.push(values);
        }
        JointTerms { values: solved(&whole, torque, &terms), without, missed }
    }

    fn with_friction(&self, free: &[Terms]) -> Vec<Terms> {
        let friction = &FRICTION[usize::from(!self.has_motors)..];
        free.iter().copied().chain(friction.iter().map(|column| unit(*column))).collect()
    }

    /// Returns the values of terms that all joints share, each joint weighted by the inverse of
    /// `missed`, and how well they are determined: the sums of the squares of what friction leaves
    /// of the terms.
    pub(crate) fn shared(
        &self,
        torque: &Terms,
        free: &[Terms; 3],
        missed: &[f64],
    ) -> ([f64; 3], SMatrix<f64, 3, 3>) {
        let (mut normal, mut right) = (SMatrix::<f64, 3, 3>::zeros(), SVector::<f64, 3>::zeros());
        for (joint, missed) in missed.iter().enumerate().filter(|(_, missed)| **missed > 0.0) {
            let (gram, friction) = (self.whole(joint), self.with_friction(&[]));
            let own = |terms: &Terms| left(terms, &friction, &solved(&gram, terms, &friction));
            let (torque, free) = (own(torque), free.map(|terms| own(&terms)));
            let product = |a: &Terms, b: &Terms| (a.transpose() * gram * b)[0] / missed;
            normal += SMatrix::from_fn(|i, k| product(&free[i], &free[k]));
            right += SVector::from_fn(|i, _| product(&free[i], &torque));
        }
        let eigen = normal.symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let mut values = SVector::<f64, 3>::zeros();
        let mut kept = SMatrix::<f64, 3, 3>::zeros();
        for (at, size) in eigen.eigenvalues.iter().enumerate().filter(|(_, s)| **s > 1e-3 * largest)
        {
            let direction = eigen.eigenvectors.column(at).into_owned();
            values += direction * (direction.dot(&right) / size);
            kept += direction * direction.transpose();
        }
        (values.into(), kept)
    }
}

fn square(gram: &Gram, terms: &Terms) -> f64 {
    (terms.transpose() * gram * terms)[0]
}

fn left(torque: &Terms, terms: &[Terms], values: &[f64]) -> Terms {
    terms.iter().zip(values).fold(*torque, |left, (term, value)| left - term * *value)
}

/// Returns the values of terms that come nearest to a torque.
fn solved(gram: &Gram, torque: &Terms, terms: &[Terms]) -> Vec<f64> {
    let count = terms.len();
    let product = |a: &Terms, b: &Terms| (a.transpose() * gram * b)[0];
    let sizes: Vec<f64> =
        terms.iter().map(|term| square(gram, term).max(f64::MIN_POSITIVE).sqrt()).collect();
    let normal = DMatrix::from_fn(count, count, |i, k| {
        product(&terms[i], &terms[k]) / (sizes[i] * sizes[k]) + if i == k { RIDGE } else { 0.0 }
    });
    let right = DVector::from_fn(count, |i, _| product(&terms[i], torque) / sizes[i]);
    let values = normal.cholesky().map_or_else(|| DVector::zeros(count), |own| own.solve(&right));
    values.iter().zip(&sizes).map(|(value, size)| value / size).collect()
}
