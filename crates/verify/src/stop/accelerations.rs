//! Enclosed accelerations over a box of states.

use nalgebra::DMatrix;
use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, div_up, sub_down};

/// The robot's terms over a box of positions and velocities.
pub(super) struct Terms<'a> {
    robot: &'a Robot,
    workspace: Workspace<Interval>,
    /// M_m(q), n x n.
    pub mass: Vec<Interval>,
    /// c(q, q̇) + g(q), n.
    pub bias: Vec<Interval>,
    /// g(q), n.
    pub gravity: Vec<Interval>,
    rest: Vec<Interval>,
}

impl<'a> Terms<'a> {
    pub(super) fn new(robot: &'a Robot) -> Self {
        let n = robot.joint_count();
        let zero = vec![Interval::ZERO; n];
        Self {
            robot,
            workspace: Workspace::new(robot),
            mass: vec![Interval::ZERO; n * n],
            bias: zero.clone(),
            gravity: zero.clone(),
            rest: zero,
        }
    }

    /// Encloses the terms over a box.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(super) fn over(&mut self, q: &[Interval], qd: &[Interval]) {
        let (sin, cos) = self.robot.sin_cos(q);
        let Self { robot, workspace, mass, bias, gravity, rest } = self;
        robot.crba(&sin, &cos, workspace, mass);
        robot.rnea(&sin, &cos, qd, rest, workspace, bias);
        robot.gravity(&sin, &cos, workspace, gravity);
    }
}

/// The accelerations a of the joints that move, the solution of M a = τ for the matrix and the
/// torques of a box, while the other joints stand.
///
/// With R near M⁻¹ and E = I - R M, each solution satisfies a = R τ + E a.
pub(super) struct Accelerations {
    /// R, row by row.
    inverse: Vec<f64>,
    /// E, row by row.
    error: Vec<Interval>,
    /// τ of the joints that move.
    torque: Vec<Interval>,
    /// Bounds of all accelerations.
    pub all: Vec<Interval>,
}

impl Accelerations {
    /// Encloses the accelerations of the joints `moving` under the torques τ (n). `None` if the
    /// box is too wide to bound M⁻¹.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(super) fn new(mass: &[Interval], moving: &[usize], torque: &[Interval]) -> Option<Self> {
        let (n, m) = (torque.len(), moving.len());
        let entry = |i: usize, j: usize| mass[moving[i] * n + moving[j]];
        let inverse = DMatrix::from_fn(m, m, |i, j| entry(i, j).mid()).try_inverse()?;
        let inverse: Vec<f64> = (0..m * m).map(|at| inverse[(at / m, at % m)]).collect();
        let error_entry = |at: usize| {
            let (i, j) = (at / m, at % m);
            let unit = Interval::point(if i == j { 1.0 } else { 0.0 });
            let products = (0..m).map(|k| Interval::point(inverse[i * m + k]) * entry(k, j));
            products.fold(unit, |sum, product| sum - product)
        };
        let error: Vec<Interval> = (0..m * m).map(error_entry).collect();
        let torque: Vec<Interval> = moving.iter().map(|j| torque[*j]).collect();
        let mut found = Self { inverse, error, torque, all: Vec::new() };
        // |a| <= max |R τ| / (1 - |E|), then a = R τ + E a once more with these bounds.
        let row_sum =
            |i: usize| (0..m).fold(0.0, |sum, j| add_up(sum, found.error[i * m + j].mag()));
        let norm = (0..m).map(row_sum).fold(0.0, f64::max);
        if norm.is_nan() || norm >= 0.9 {
            return None;
        }
        let free = |i: usize| found.linear(i, found.torque[i]);
        let largest = (0..m).map(|i| free(i).mag()).fold(0.0, f64::max);
        let bound = div_up(largest, sub_down(1.0, norm));
        found.all = vec![Interval::centred(0.0, bound); m];
        found.all = (0..m).map(|i| found.of(i, found.torque[i])).collect();
        found.all = (0..m).map(|i| found.of(i, found.torque[i])).collect();
        Some(found)
    }

    /// Encloses the acceleration of the moving joint at index `i` under its own torque `own`.
    pub(super) fn of(&self, i: usize, own: Interval) -> Interval {
        let m = self.torque.len();
        let terms = (0..m).map(|j| self.error[i * m + j] * self.all[j]);
        terms.fold(self.linear(i, own), |sum, term| sum + term)
    }

    fn linear(&self, i: usize, own: Interval) -> Interval {
        let m = self.torque.len();
        let torque = |j: usize| if i == j { own } else { self.torque[j] };
        let terms = (0..m).map(|j| torque(j) * self.inverse[i * m + j]);
        terms.fold(Interval::ZERO, |sum, term| sum + term)
    }
}

/// Returns an upper bound of the torque that holds a joint which stands, while others accelerate.
pub(super) fn holding_torque(
    terms: &Terms,
    joint: usize,
    (moving, accelerations): (&[usize], &[Interval]),
) -> f64 {
    let n = terms.bias.len();
    let pairs = moving.iter().zip(accelerations);
    let coupled = pairs.map(|(j, a)| terms.mass[joint * n + j] * *a);
    coupled.fold(terms.bias[joint], |sum, term| sum + term).mag()
}
